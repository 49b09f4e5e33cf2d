/// \file
/// Boxes that people drew round all moving objects, in all or some images of a recording. They are
/// read from MOTChallenge's `gt.txt` or a COCO file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lcs::bench {

struct LabelledBox {
  int id = -1;  ///< of the object, the same in all images; -1: not given
  /// Pixel edges as in `sim::ObjectTruth`: the box of the pixel at (0, 0) is 0, 0, 1, 1.
  double left = 0, top = 0, right = 0, bottom = 0;
  /// Detections in it count neither as right nor as wrong: it holds a crowd, a reflection or an
  /// object that may or may not move.
  bool ignored = false;
};

/// The labels of one recording's images. An image without labels was not examined; an examined one
/// in which nothing moves has an empty list of boxes.
class Labels {
 public:
  using Boxes = std::vector<LabelledBox>;

  /// \return the boxes of an image; null if it was not labelled.
  /// \param number index of the image in the recording, from 0.
  /// \param name of its file, without folders; "" if it has no file.
  const Boxes* of(int number, const std::string& name) const;

  std::size_t pictures() const { return by_number_.size() + by_name_.size(); }

  /// \name The boxes of an image; the call marks it as labelled. @{
  Boxes& at(int number) { return by_number_[number]; }
  Boxes& at(const std::string& name) { return by_name_[name]; }
  ///@}

 private:
  std::map<int, Boxes> by_number_;
  std::map<std::string, Boxes, std::less<>> by_name_;
};

/// Reads one of two formats, recognised by the first character:
///
/// MOTChallenge: rows FRAME,ID,LEFT,TOP,WIDTH,HEIGHT[,CONSIDERED[,...]], frames and pixels from 1.
/// A row with 0 for CONSIDERED is ignored. An image without a row was not labelled.
///
/// COCO: `images` with `id`, `file_name` and, for videos, `frame_id` (from 0); `annotations` with
/// `image_id`, `bbox` and, where objects are tracked, `track_id`. Boxes with 1 for `iscrowd` are
/// ignored. Every listed image was labelled.
///
/// \throws input::Error with file and line (COCO: the entry), and the remedy.
Labels read_labels(const std::filesystem::path& file);

}  // namespace lcs::bench
