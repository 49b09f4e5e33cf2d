/// \file
/// Any detector's verdicts and boxes in the format of `tools/recording/DETECTIONS.md`: those of a
/// frame from a file, a running program or Python, and a CSV file of those of a sequence. All of
/// them are checked here against the image size and fixed limits.
#pragma once

#include <cstddef>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/files/output_file.h"
#include "tools/recording/box.h"
#include "tools/recording/recording.h"

namespace lcs::recording {

/// Largest distance between a verdict given by position and its corner. Other corner detectors
/// place the same corner up to this far from FAST's position (SCORING.md).
inline constexpr double kCornerReach_px = 2;

/// \name Limits per frame.
///@{
inline constexpr std::size_t kMostBoxes = 1000;  ///< each is compared with all objects, by pixels
inline constexpr std::size_t kMostCircles = 10000;  ///< each is compared with all objects
inline constexpr std::size_t kMostPlaces = 20000;   ///< each is compared with all corners
///@}

/// The largest id: JSON readers keep integers exactly up to this value.
inline constexpr Id kMostId = (Id{1} << 53) - 1;

/// The longest side of a mask if the camera is unknown.
inline constexpr int kMostSide_px = 1 << 14;

/// The number of verdicts, and of those by position that were dropped because they match no corner.
struct VerdictCounts {
  int verdicts = 0;
  int without_corner = 0;  ///< no corner within reach
  int repeated = 0;        ///< all corners within reach have a verdict already
  int corners() const { return verdicts - without_corner - repeated; }
  VerdictCounts& operator+=(const VerdictCounts& other);
};

/// One readable line for each kind of dropped verdict.
std::vector<std::string> lines_of(const VerdictCounts& counts);

/// Each `add` function throws std::invalid_argument for an item that cannot be in the frame. The
/// message says how to correct it, and nothing is added.
class FrameDetections {
 public:
  /// \param frame contains its corners only; all of them get the verdict `normal`.
  /// \param camera of the frame; absent if unknown.
  FrameDetections(FrameRecord& frame, const std::optional<Intrinsics>& camera);

  /// \param type a verdict, "box", "mask", "square" or "circle". \param values its text fields.
  void add(std::string_view type, std::span<const std::string_view> values);

  /// \param corner left, top; \param size width, height: pixel edges, in pixels.
  void add_box(Id id, const Vec2& corner, const Vec2& size);
  /// \param mask within an image of `size_px`.
  void add_mask(Id id, sim::Mask mask, const cv::Size& size_px);
  void add_square(const Square& square);
  void add_circle(const Vec2& location, double radius);

  /// Assigns verdicts by position to corners, one to one, nearest pair first. Call it once, last.
  VerdictCounts finish();

  /// Whether a "circle" row was given, also one that reports a frame without circles.
  bool gives_circles() const { return gives_circles_; }

 private:
  struct Placed {
    Verdict verdict;
    Vec2 place_px;
  };

  void add_verdict(Verdict verdict, std::span<const std::string_view> values);
  void require_picture(const cv::Size& size_px) const;
  void require_in_picture(const char* what, const Box& shape, double margin_px) const;

  FrameRecord* frame_;
  std::optional<cv::Size> picture_px_;
  std::vector<char> named_;  ///< corners that have a verdict
  std::vector<Placed> placed_;
  std::set<Id> boxes_;
  bool gives_circles_ = false;
  VerdictCounts counts_;
};

struct Detections {
  /// The sequence with the file's verdicts and boxes instead of its own; without times.
  Recording recording;
  VerdictCounts counts;
};

/// \param sequence provides corners and truth; its camera is used to check the detections.
/// \throws input::Error with file and line.
Detections read_detections(const std::filesystem::path& csv, Recording sequence);

/// Writes a run's verdicts and boxes in the same format, frame by frame. Reading them back
/// reproduces the metrics of rebels and squares to the last bit, except average precision: the
/// format has no log odds. It does not tell which squares move, so that all do (`mover.*`).
class DetectionsWriter {
 public:
  /// \throws OutputError
  DetectionsWriter(const std::filesystem::path& csv, const RunInfo& run);
  /// \throws OutputError
  void write(const FrameRecord& frame);
  /// \throws OutputError
  void close() { file_.close(); }

 private:
  files::OutputFile file_;
  std::optional<Intrinsics> camera_;
  bool states_circles_;  ///< before the next frame, as it may have none
};

}  // namespace lcs::recording
