#include "sim/base/shutter.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lcs::sim {

Shutter::Shutter(const scenario::Camera& camera)
    : height_px_(camera.height_px),
      readout_s_(camera.rolling_shutter_s),
      exposure_s_(camera.exposure_s),
      window_s_(readout_s_ + exposure_s_) {
  if (is_instant()) return;
  for (int i = 0; i <= 2 * kMostDrawings; ++i) {
    const double after_s = -exposure_s_ / 2 + window_s_ * i / (2 * kMostDrawings);
    instants_ns_.push_back(std::llround(1e9 * after_s));
  }
}

int Shutter::drawings_for(double shift_px) {
  const double cells = std::clamp(std::ceil(shift_px / kMostShift_px), 1.0, double{kMostDrawings});
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(cells)));
}

double Shutter::share(int row, int i, int n) const {
  if (!smears()) return i == drawing_of(row, n) ? 1 : 0;
  const double cell_s = window_s_ / n;
  const double begin_s = time_of(row);  // counted from the start of the window
  const double both_s =
      std::min((i + 1) * cell_s, begin_s + exposure_s_) - std::max(i * cell_s, begin_s);
  return std::max(both_s, 0.0) / exposure_s_;
}

int Shutter::drawing_of(int row, int n) const {
  const double after_s = exposure_s_ / 2 + time_of(row);
  return std::min(n - 1, static_cast<int>(n * after_s / window_s_));
}

double Shutter::row_at(std::size_t instant) const {
  const double after_s =
      -exposure_s_ / 2 + window_s_ * static_cast<double>(instant) / (2 * kMostDrawings);
  return height_px_ * after_s / readout_s_;
}

}  // namespace lcs::sim
