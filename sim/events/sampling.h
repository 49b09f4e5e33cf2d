/// \file
/// Chooses the instants at which event pixels see the world, as ESIM does: so many that nothing
/// moves by more than a pixel from one picture to the next, in between which light is interpolated.
#pragma once

#include <cstddef>
#include <vector>

namespace lcs::sim {

/// The time from a frame to the next has this many equal cells, at whose ends the world may be
/// drawn; so many drawings are the most.
inline constexpr int kEventCells = 128;
/// Equal parts of that time, for each of which motion is measured; a part has several cells.
inline constexpr std::size_t kEventParts = 16;
inline constexpr double kMostEventShift_px = 1;

struct EventSampling {
  std::vector<std::size_t> cells;  ///< those at whose ends there is a picture; the last is always
  double most_shift_px = 0;        ///< from one picture to the next
};

/// \param parts_px the longest way of a point through the picture in each of `kEventParts`; within
///   a part motion is taken as even.
EventSampling sample_events(const std::vector<double>& parts_px);

}  // namespace lcs::sim
