/// \file
/// What a detector says of one frame, in the words of `tools/recording/DETECTIONS.md`, whether they
/// come from a file or from a program that is asked.
#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/recording/recording.h"

namespace lcs::bench {

/// A verdict that gives a place is one on a corner no farther off. Other detectors of corners than
/// FAST put the same corner up to so far from it (SCORING.md).
inline constexpr double kCornerReach_px = 2;

/// Verdicts, and those by place that name no corner, and so were left out.
struct VerdictCounts {
  int verdicts = 0;
  int without_corner = 0;  ///< no corner within reach
  int repeated = 0;        ///< only corners that another verdict names
  int corners() const { return verdicts - without_corner - repeated; }
  VerdictCounts& operator+=(const VerdictCounts& other);
};

/// In words, a line for each kind that was left out.
std::vector<std::string> lines_of(const VerdictCounts& counts);

class FrameDetections {
 public:
  /// \param frame with its corners, which all get the verdict `normal`; nothing else was said of
  /// it.
  explicit FrameDetections(FrameRecord& frame);

  /// \param type a verdict, "box", "mask", "square" or "circle". \param values its fields, as text.
  /// \throws std::invalid_argument saying what to give instead.
  void add(std::string_view type, std::span<const std::string_view> values);

  /// Takes verdicts by place to corners, one to one, nearest pair first. To be called once, last.
  VerdictCounts finish();

  /// Whether "circle" was said, be it of none.
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
