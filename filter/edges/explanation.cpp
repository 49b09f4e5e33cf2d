#include "filter/edges/explanation.h"

#include <cmath>
#include <limits>
#include <tuple>

namespace lcs {

double Explanation::miss_px(TrackColumn x) const {
  const bool is_there = predicted[kSightings] >= (x == kMovingX ? 2 : 1);
  return is_there ? (place_px() - predicted_px(x)).norm()
                  : std::numeric_limits<double>::quiet_NaN();
}

std::vector<ExplainedNumber> numbers_of(const Explanation& why) {
  const auto& [was, is] = std::tie(why.predicted, why.seen);
  std::vector<ExplainedNumber> all;
  const auto add = [&](const char* equation, const char* name, double value) {
    all.push_back({equation, name, {value}});
  };
  const auto add_xy = [&](const char* equation, const char* name, const Vec2& value) {
    all.push_back({equation, name, {value.x(), value.y()}});
  };
  if (why.assigned != 0) {
    add_xy("(1)", "x_r, px", why.predicted_px(kPlaceX));
    add_xy("(2), (4)", "x', px", why.predicted_px(kStaticX));
    add("(2), (4)", "w, 1/m", was[kInverseDepth_pm]);
    add_xy("(12)", "deviation from x', px", why.static_spread_px2.diagonal().cwiseSqrt());
    add("(12)", "miss of x', px", why.miss_px(kStaticX));
    if (was[kSightings] >= 2) {
      add_xy("(5)", "x'_M, px", why.predicted_px(kMovingX));
      add("(13)", "deviation from x'_M, px", std::sqrt(was[kMovingXx] + is[kSeenNoise2]));
      add("(13)", "miss of x'_M, px", why.miss_px(kMovingX));
    }
    add("(17)", "sigma, px", std::sqrt(is[kSeenNoise2]));
    add("(12)", "p_S, 1/px^2", is[kStaticDensity]);
    add("(13)", "p_M, 1/px^2", is[kMovingDensity]);
    add("(15)", "phi, 1/px^2", is[kWrongDensity]);
    add("(15)", "L'", is[kLogOddsBefore]);
  }
  if (is[kSightings] >= 2) {
    add("(15)", "L", is[kLogOdds]);
    add("(34)", "L_C", why.shown);
    double all_k = 0, pull = 0;
    for (const Voice& voice : why.voices) {
      all_k += double{voice.weight};
      pull += double{voice.weight} * double{voice.said};
    }
    add("(18)", "sum of k", all_k);
    add("(18)", "sum of k tanh(m/2)", pull);
    add("(18)", "m - L_C", is[kBelief] - why.shown);
  }
  add("(18)", "m", is[kBelief]);
  return all;
}

}  // namespace lcs
