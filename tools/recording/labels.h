/// \file
/// Boxes that people drew round all moving objects, in all or some images of a recording. They are
/// read from MOTChallenge's `gt.txt`, a COCO file, or KITTI tracking's labels.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lcs::recording {

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

  /// An image as the file of labels states it.
  struct Picture {
    std::optional<int> number;  ///< counts from `first`
    std::string name;           ///< of its file, perhaps with folders; "": not given
    Boxes boxes;
  };

  /// An image of the recording.
  struct Recorded {
    int number;                             ///< among all images of the recording, from 0
    std::string name;                       ///< of its file, with its folders; "" if it has no file
    std::optional<std::size_t> named = {};  ///< number in its name, if those of all images count
  };

  std::vector<Picture> pictures;
  std::optional<int> first;          ///< number of the recording's first image; absent: not stated
  std::vector<std::string> remarks;  ///< remarks on the file, a line each

  /// Joins the labels with the images of a recording: by their names, with those folders that find
  /// most; by these without endings; or by their numbers. The first of these that finds an image
  /// decides. Without numbers in their names, images are numbered by their order. Where `first` is
  /// not stated, labels count from 1 if the least is 1 and the greatest the count of images, or if
  /// the names do and there is no 0; else from 0.
  /// \param images count in the whole recording, with missing ones; 0: up to the last of
  /// `recorded`. \param named_first number in the name of the first image; absent: the numbers are
  /// the labels'. \return lines: how many labelled images and boxes belong to the recording, and by
  /// which rule. \throws std::invalid_argument if none does, if two labelled images have the name
  /// of one, or if images are numbered by their order and labels go beyond the last.
  std::vector<std::string> join(const std::vector<Recorded>& recorded, std::size_t images = 0,
                                std::optional<std::size_t> named_first = {});

  /// \return the boxes of an image of the recording; null if it was not labelled. \pre joined
  const Boxes* of(int number) const;

 private:
  std::map<int, std::size_t> picture_of_;  ///< by number in the recording
};

/// Reads one of three formats, recognised by the first line:
///
/// MOTChallenge: rows FRAME,ID,LEFT,TOP,WIDTH,HEIGHT[,CONSIDERED[,...]], frames and pixels from 1;
/// frames from 0 if there is a 0. A row with 0 for CONSIDERED is ignored. An image without a row
/// was not labelled.
///
/// COCO: `images` with `id`, `file_name` and, for videos, `frame_id` and `video_id`; `annotations`
/// with `image_id`, `bbox` and, where objects are tracked, `track_id`. Boxes with `iscrowd` are
/// ignored, those without an area are left out and counted. Every listed image was labelled.
///
/// KITTI tracking: rows "FRAME ID TYPE TRUNCATED OCCLUDED ALPHA LEFT TOP RIGHT BOTTOM ...", frames
/// and pixels from 0. DontCare is ignored. These are boxes of all objects, also of those at rest.
///
/// \param video of several in a COCO file, by its name; "": the only one.
/// \throws input::Error with file and line (COCO: the entry), and the remedy.
Labels read_labels(const std::filesystem::path& file, const std::string& video = "");

}  // namespace lcs::recording
