#include "tools/bench/tracker.h"

#include <stdexcept>

namespace lcs::bench {

Intrinsics intrinsics(const sim::Pinhole& camera) {
  return {.focal_px = camera.focal_px,
          .centre_px = camera.centre_px,
          .width_px = camera.width_px,
          .height_px = camera.height_px};
}

LcsTracker::LcsTracker(const sim::Pinhole& camera, const Parameters& parameters)
    : filter_(intrinsics(camera), parameters) {}

const FrameResult& LcsTracker::step(const TrackerInput& input) {
  return filter_.step(input.corners_px, input.motion);
}

Parameters filter_parameters(const scenario::Scenario& scenario) {
  const auto at = [](const scenario::Source& source, auto&& use) {
    try {
      return use();
    } catch (const std::invalid_argument& error) {
      throw scenario::Error(source, error.what());
    }
  };
  Parameters parameters = at(scenario.filter_preset_source, [&] {
    return preset(scenario.filter_preset.empty() ? "default" : scenario.filter_preset);
  });
  for (const scenario::FilterSetting& setting : scenario.filter) {
    at(setting.source, [&] { set(parameters, setting.key, setting.value); });
  }
  // Each value is in its range by now; together they may still make no sense.
  const scenario::Source& last =
      scenario.filter.empty() ? scenario.filter_preset_source : scenario.filter.back().source;
  at(last, [&] { validate(parameters); });
  return parameters;
}

}  // namespace lcs::bench
