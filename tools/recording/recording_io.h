/// \file
/// A recording on disk, without its times: `layers.jsonl` holds what the detector was given and
/// what it found, `truth.jsonl` the truth. Each frame is a JSON object on a line of its own;
/// `truth.jsonl` begins with a further line about the run and its detector. `told_motion` in the
/// first file is the motion that the detector was told, `true_motion` in the second the exact one.
/// Lists of items are stored by column, as {"id": [1, 2], "x": [3.5, 4]}.
///
/// Where the detector was given signatures, `layers.jsonl` has "signatures": 32 bytes for each
/// corner, in the order of the corners, as ORB has them, in hexadecimal digits (Python:
/// `bytes.fromhex(frame["signatures"])`).
///
/// The mask of an object or a square is COCO's word of the pixels in its box: pycocotools' `decode`
/// of {"size": [bottom - top, right - left], "counts": word} gives them. `layers.jsonl` has "masks"
/// where a detector gave some.
///
/// Numbers are written in the shortest form that reads back to the same bits, so that scoring a
/// recording that was stored gives the same figures. JSON knows no infinity: null stands for +inf
/// (the depth of the sky).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tools/files/output_file.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

inline constexpr const char* kLayersFile = "layers.jsonl";
inline constexpr const char* kTruthFile = "truth.jsonl";
inline constexpr const char* kCameraFile = "camera.json";

/// Lines of one frame, without the line end. \throws std::invalid_argument for any other number
/// that is not finite, naming frame and field.
std::string layers_line(const FrameRecord& frame);
std::string truth_line(const FrameRecord& frame);

/// What a detector is given of a frame beside the picture, in the format of `layers_line`.
/// \param motion what it can use of `frame.motion`; null: nothing.
std::string given_line(const FrameRecord& frame, const EgoMotion* motion);

/// \name The truth of frames that no detector has seen (`lcs generate`): a line of the objects,
/// then one a frame, with places and truth of its corners and the truth of its objects.
///@{
std::string objects_line(const std::vector<sim::Object>& objects);
std::string seen_line(const FrameRecord& frame);
/// \return objects and frames. \throws std::runtime_error naming file and line.
Recording read_seen(const std::filesystem::path& file);
///@}

/// {"model": "pinhole", "focal_px": f, "centre_px": [x, y], "width_px": w, "height_px": h}
std::string camera_json(const Intrinsics& camera);

/// Writes both files into a folder that exists, frame by frame, and `camera.json`: the camera as
/// detectors are told of it.
class RecordingWriter {
 public:
  /// \param run whose frames are not written here. \throws OutputError
  RecordingWriter(const std::filesystem::path& folder, const Recording& run);

  /// \throws OutputError; std::invalid_argument as `layers_line`.
  void write(const FrameRecord& frame);
  /// \throws OutputError
  void close();

 private:
  OutputFile layers_;
  OutputFile truth_;
};

/// Reads both files back, and the warnings beside them if there are any. \throws std::runtime_error
/// naming file and line.
Recording read_recording(const std::filesystem::path& folder);

/// What `truth.jsonl` begins with: scenario, seed, origin and detector of a run.
/// \throws std::runtime_error naming file and line.
Recording read_without_frames(const std::filesystem::path& folder);

/// The truth of objects in single frames, without reading the rest: in milliseconds.
/// \param frames from 0, in rising order; one may come again.
/// \throws std::runtime_error naming file and line.
std::vector<std::vector<sim::ObjectTruth>> read_object_truth(const std::filesystem::path& folder,
                                                             std::span<const int> frames);

}  // namespace lcs::bench
