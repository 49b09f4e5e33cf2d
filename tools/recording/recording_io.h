/// \file
/// A recording on disk, without its times: `layers.jsonl` holds the detector's input and output,
/// `truth.jsonl` the truth. Each frame is a JSON object on its own line; `truth.jsonl` begins with
/// a header line on the run. Both may be compressed (`layers.jsonl.gz`). `detector.json` names the
/// detector, so that the truth of several detectors is the same file. `told_motion` in the first
/// file is the motion given to the detector, `true_motion` in the second the exact one. Lists of
/// items are stored by column, as {"id": [1, 2], "x": [3.5, 4]}.
///
/// If the detector was given signatures, `layers.jsonl` has "signatures": 32 bytes for each corner
/// in corner order and ORB's bit order, as hexadecimal digits (Python:
/// `bytes.fromhex(frame["signatures"])`).
///
/// The mask of an object or square is COCO's run-length string of the pixels in its box: decode it
/// with pycocotools' `decode` of {"size": [bottom - top, right - left], "counts": word}.
/// `layers.jsonl` has "masks" if the detector provided some.
///
/// Numbers are written in the shortest form that reads back to the same bits, so that a stored
/// recording scores the same. JSON has no infinity: null represents +inf (the depth of the sky).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/files/output_file.h"
#include "tools/recording/recording.h"

namespace lcs::recording {

inline constexpr const char* kLayersFile = "layers.jsonl";
inline constexpr const char* kTruthFile = "truth.jsonl";
inline constexpr const char* kCameraFile = "camera.json";
inline constexpr const char* kDetectorFile = "detector.json";

/// \name The run lengths of a mask (`sim/truth/mask.h`) as a string, in pycocotools' format.
///@{
std::string packed_runs(const sim::PixelRuns& runs);
/// \return the run lengths, unchecked: they may be negative or have a wrong sum.
/// \throws std::invalid_argument for a malformed string.
std::vector<std::int64_t> unpacked_runs(std::string_view word);
///@}

/// The path of a file in the folder of a run: NAME, or NAME.gz if only that is there.
std::filesystem::path stored(const std::filesystem::path& folder, const char* name);

/// JSON lines of one frame, without line end. \throws std::invalid_argument for any other
/// non-finite number, with frame and field.
std::string layers_line(const FrameRecord& frame);
std::string truth_line(const FrameRecord& frame);

/// A frame's input to the detector except its image, in the format of `layers_line`.
/// \param motion the part of `frame.motion` that the detector uses; null: nothing.
std::string given_line(const FrameRecord& frame, const EgoMotion* motion);

/// \name The truth of frames without a detector (`lcs generate`): a line of objects, then one line
/// a frame with positions and truth of its corners and the truth of its objects.
///@{
std::string objects_line(const std::vector<sim::Object>& objects);
std::string seen_line(const FrameRecord& frame);
/// Reads such a file frame by frame.
class SeenReader {
 public:
  /// \throws std::runtime_error with file and line.
  explicit SeenReader(const std::filesystem::path& file);
  ~SeenReader();
  SeenReader(SeenReader&&) noexcept;

  const std::vector<sim::Object>& objects() const { return objects_; }

  /// The frame of this time; null if there is none. The times of successive calls must grow.
  /// \throws std::runtime_error with file and line, also for times in the file that do not grow.
  const FrameRecord* at(std::int64_t t_ns);

 private:
  std::unique_ptr<class LineReader> lines_;
  std::vector<sim::Object> objects_;
  std::optional<FrameRecord> frame_;  ///< last one read
};
///@}

/// {"model": "pinhole", "focal_px": f, "centre_px": [x, y], "width_px": w, "height_px": h}
std::string camera_json(const Intrinsics& camera);

/// Writes both files frame by frame into an existing folder, and `camera.json`: the camera as given
/// to detectors, and `detector.json`.
class RecordingWriter {
 public:
  /// \throws OutputError
  RecordingWriter(const std::filesystem::path& folder, const RunInfo& run, bool compressed = false,
                  bool with_truth = true);

  /// \throws OutputError; std::invalid_argument as `layers_line`.
  void write(const FrameRecord& frame);
  /// \throws OutputError
  void close();

 private:
  files::TextFile layers_;
  std::optional<files::TextFile> truth_;
};

/// Reads both files frame by frame, and the warnings beside them if present.
class RecordingReader {
 public:
  /// \throws std::runtime_error with file and line.
  explicit RecordingReader(const std::filesystem::path& folder);
  ~RecordingReader();

  const RunInfo& run() const { return run_; }

  /// \return false after the last frame. \throws std::runtime_error with file and line.
  bool next(FrameRecord& frame);
  /// As `next`, without parsing the frame.
  bool skip();
  /// The number of frames that are left, by the truth; none can be read afterwards.
  int count_left();

 private:
  RunInfo run_;
  std::unique_ptr<class LineReader> layers_, truth_;
};

/// The whole recording. \throws as `RecordingReader`.
Recording read_recording(const std::filesystem::path& folder);

/// Reads only the header line of `truth.jsonl`: scenario, seed, origin and detector of a run.
/// \throws std::runtime_error with file and line.
RunInfo read_run_info(const std::filesystem::path& folder);

/// Reads the object truth of single frames without parsing the others: in milliseconds.
/// \param frames indices from 0, not decreasing; repetitions are allowed.
/// \throws std::runtime_error with file and line.
std::vector<std::vector<sim::ObjectTruth>> read_object_truth(const std::filesystem::path& folder,
                                                             std::span<const int> frames);

}  // namespace lcs::recording
