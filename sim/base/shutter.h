/// \file
/// The times at which the rows of a frame collect light, and the instants at which the world is
/// drawn for them.
///
/// Row y of h collects light during exposure_s. The middle of this interval is the row's time: the
/// frame's time plus y / h of rolling_shutter_s. The window of a frame, from the first light to the
/// last, has n equal cells. The world is drawn once in each cell, as it is in the cell's middle. A
/// row is the mean of the drawings, in linear light, weighted by the time of its light in each
/// cell; without an exposure it is the drawing of the cell at its time. n is the least power of two
/// with which nothing shifts by more than `kMostShift_px` within a cell, at most `kMostDrawings`.
/// A drawing then differs from the scene at the row's time by at most half of this shift.
#pragma once

#include <cstdint>
#include <vector>

#include "scenarios/scenario.h"

namespace lcs::sim {

class Shutter {
 public:
  static constexpr double kMostShift_px = 0.25;
  static constexpr int kMostDrawings = 64;

  Shutter() = default;
  explicit Shutter(const scenario::Camera& camera);

  /// All rows show one instant, the time of the frame.
  bool is_instant() const { return window_s_ == 0; }
  bool rolls() const { return readout_s_ > 0; }
  bool smears() const { return exposure_s_ > 0; }

  /// The instants at which the world may be drawn, from the start of the window to its end, at
  /// equal steps, ns after the time of the frame. There are 2 `kMostDrawings` + 1.
  const std::vector<std::int64_t>& instants_ns() const { return instants_ns_; }
  /// Index of the instant of drawing i of n.
  static std::size_t instant_of(int i, int n) {
    return static_cast<std::size_t>((2 * i + 1) * kMostDrawings / n);
  }
  /// Index of the time of the frame if the shutter does not roll.
  static constexpr std::size_t kMiddle = kMostDrawings;

  /// The number of drawings by which nothing shifts too far. \param shift_px within the window.
  static int drawings_for(double shift_px);
  /// The share of drawing i of n in a row. The shares of a row add up to 1.
  double share(int row, int i, int n) const;
  /// The drawing of n whose cell has the time of a row.
  int drawing_of(int row, int n) const;
  /// The row whose time an instant is; below 0 or beyond the last row in an exposure's margin.
  double row_at(std::size_t instant) const;

 private:
  double time_of(int row) const { return readout_s_ * row / height_px_; }

  int height_px_ = 1;
  double readout_s_ = 0, exposure_s_ = 0, window_s_ = 0;
  std::vector<std::int64_t> instants_ns_;
};

}  // namespace lcs::sim
