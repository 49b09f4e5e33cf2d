/// \file
/// What a detector finds in one frame, in the format of `tools/recording/DETECTIONS.md`, whether it
/// comes from a file or from a running program.
#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/recording/recording.h"

namespace lcs::bench {

/// A verdict by place counts for a corner within this distance. Other corner detectors place the
/// same corner up to so far from where FAST does (SCORING.md).
inline constexpr double kCornerReach_px = 2;

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

class FrameDetections {
 public:
  /// \param frame with its corners, which all get the verdict `normal`, and nothing else.
  explicit FrameDetections(FrameRecord& frame);

  /// \param type a verdict, "box", "mask", "square" or "circle". \param values its fields, as text.
  /// \throws std::invalid_argument saying what to give instead.
  void add(std::string_view type, std::span<const std::string_view> values);

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
  void put(const Square& square);
  void add_circle(std::span<const std::string_view> values);

  FrameRecord* frame_;
  std::vector<char> named_;  ///< corners that have a verdict
  std::vector<Placed> placed_;
  std::set<Id> boxes_;
  bool gives_circles_ = false;
  VerdictCounts counts_;
};

}  // namespace lcs::bench
