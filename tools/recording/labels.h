/// \file
/// Boxes that people drew round all that moves, in all pictures of a recording or in some. Read
/// from MOTChallenge's `gt.txt` or a COCO file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lcs::bench {

struct LabelledBox {
  int id = -1;  ///< of the object, the same in all pictures; -1: not given
  /// Pixel edges, as those of `sim::ObjectTruth`: a box of one pixel at (0, 0) is 0, 0, 1, 1.
  double left = 0, top = 0, right = 0, bottom = 0;
  /// What is found in it counts neither as right nor as wrong: a crowd, a reflection, what may or
  /// may not move.
  bool ignored = false;
};

/// The labels of one recording's pictures. A picture without labels was not looked at; one in which
/// nothing moves has labels without a box.
class Labels {
 public:
  using Boxes = std::vector<LabelledBox>;

  /// The boxes of a picture.
  /// \param number its place in the recording, from 0.
  /// \param name its file's, without folders; "" for one that has none.
  /// \return null where it was not labelled.
  const Boxes* of(int number, const std::string& name) const;

  std::size_t pictures() const { return by_number_.size() + by_name_.size(); }

  /// \name The boxes of a picture, which counts as labelled from then on. @{
  Boxes& at(int number) { return by_number_[number]; }
  Boxes& at(const std::string& name) { return by_name_[name]; }
  ///@}

 private:
  std::map<int, Boxes> by_number_;
  std::map<std::string, Boxes, std::less<>> by_name_;
};

/// One of these, told by the first character:
///
/// MOTChallenge: rows FRAME,ID,LEFT,TOP,WIDTH,HEIGHT[,CONSIDERED[,...]], frames and pixels from 1.
/// What has 0 for CONSIDERED is ignored. A picture that no row names was not labelled.
///
/// COCO: `images` with `id`, `file_name` and, for videos, `frame_id` (from 0); `annotations` with
/// `image_id`, `bbox` and, where objects are known again, `track_id`. What has 1 for `iscrowd` is
/// ignored. Every image that is listed was labelled.
///
/// \throws scenario::Error naming file and line (of COCO: the entry), and what to do.
Labels read_labels(const std::filesystem::path& file);

}  // namespace lcs::bench
