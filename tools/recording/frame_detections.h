/// \file
/// What a detector finds in one frame, in the format of `tools/recording/DETECTIONS.md`, whether it
/// comes from a file, from a running program or from Python. All of it is checked here, against the
/// camera's picture and against limits.
#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/recording/box.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

/// A verdict by place counts for a corner within this distance. Other corner detectors place the
/// same corner up to so far from where FAST does (SCORING.md).
inline constexpr double kCornerReach_px = 2;

/// \name Limits of what one frame has.
///@{
inline constexpr std::size_t kMostBoxes = 1000;  ///< each is compared with all objects, by pixels
inline constexpr std::size_t kMostCircles = 10000;  ///< each is compared with all objects
inline constexpr std::size_t kMostPlaces = 20000;   ///< each is compared with all corners
///@}

/// The largest id: JSON's readers keep whole numbers up to this one.
inline constexpr Id kMostId = (Id{1} << 53) - 1;

/// The longest side of a mask where the camera is not known.
inline constexpr int kMostSide_px = 1 << 14;

/// How many verdicts there were, and how many of those by place were left out, as they belong to no
/// corner.
struct VerdictCounts {
  int verdicts = 0;
  int without_corner = 0;  ///< no corner within reach
  int repeated = 0;        ///< only corners that have a verdict already
  int corners() const { return verdicts - without_corner - repeated; }
  VerdictCounts& operator+=(const VerdictCounts& other);
};

/// A line for people for each kind that was left out.
std::vector<std::string> lines_of(const VerdictCounts& counts);

/// Each way to add something throws std::invalid_argument, saying what to give instead, for what
/// cannot be in the frame; nothing was added then.
class FrameDetections {
 public:
  /// \param frame with its corners, which all get the verdict `normal`, and nothing else.
  /// \param camera of the frame; none where it is not known.
  FrameDetections(FrameRecord& frame, const std::optional<Intrinsics>& camera);

  /// \param type a verdict, "box", "mask", "square" or "circle". \param values its fields, as text.
  void add(std::string_view type, std::span<const std::string_view> values);

  /// \param corner left, top; \param size width, height: pixel edges.
  void add_box(Id id, const Vec2& corner, const Vec2& size);
  /// \param mask of a picture of `size_px`.
  void add_mask(Id id, sim::Mask mask, const cv::Size& size_px);
  void add_square(const Square& square);
  void add_circle(const Vec2& location, double radius);

  /// Assigns the verdicts by place to corners, one to one, nearest pair first. To be called once,
  /// last.
  VerdictCounts finish();

  /// Whether "circle" came up, even for a frame without circles.
  bool gives_circles() const { return gives_circles_; }

 private:
  struct Placed {
    Verdict verdict;
    Vec2 place_px;
  };

  void add_verdict(Verdict verdict, std::span<const std::string_view> values);
  std::size_t corner_by_index(std::string_view text) const;
  void add_box(std::span<const std::string_view> values);
  void add_mask(std::span<const std::string_view> values);
  void add_square(std::span<const std::string_view> values);
  void add_circle(std::span<const std::string_view> values);
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

}  // namespace lcs::bench
