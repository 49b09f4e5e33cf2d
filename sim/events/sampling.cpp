#include "sim/events/sampling.h"

#include <algorithm>

namespace lcs::sim {

EventSampling sample_events(const std::vector<double>& parts_px) {
  constexpr std::size_t kCells = kEventCells, kCellsInPart = kCells / kEventParts;
  const auto shift_px = [&](std::size_t cell) {
    return parts_px[cell / kCellsInPart] / kCellsInPart;
  };
  EventSampling sampling;
  double since_px = 0;  // the last picture, up to the end of the cell
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    since_px += shift_px(cell);
    if (cell + 1 < kCells && since_px + shift_px(cell + 1) <= kMostEventShift_px) continue;
    sampling.cells.push_back(cell);
    sampling.most_shift_px = std::max(sampling.most_shift_px, since_px);
    since_px = 0;
  }
  return sampling;
}

}  // namespace lcs::sim
