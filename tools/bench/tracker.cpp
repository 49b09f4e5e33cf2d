#include "tools/bench/tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "scenarios/spelling.h"

namespace lcs::bench {

Intrinsics intrinsics(const sim::Pinhole& camera) {
  return {.focal_px = camera.focal_px,
          .centre_px = camera.centre_px,
          .width_px = camera.width_px,
          .height_px = camera.height_px};
}

LcsTracker::LcsTracker(const Intrinsics& camera, const Parameters& parameters)
    : filter_(camera, parameters) {}

const FrameResult& LcsTracker::step(const TrackerInput& input) {
  if (input.signatures.empty()) return filter_.step(input.corners_px, input.motion);
  return filter_.step(input.corners_px, input.signatures, input.motion);
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
  std::vector<std::string> known;
  for (const ParameterInfo& info : describe(parameters)) known.push_back(info.key);
  for (const scenario::FilterSetting& setting : scenario.filter) {
    if (std::find(known.begin(), known.end(), setting.key) == known.end()) {
      throw scenario::Error(
          setting.source,
          fmt::format("the filter has no parameter '{}'; the nearest is '{}'", setting.key,
                      scenario::nearest_first(setting.key, known).front()));
    }
    at(setting.source, [&] { set(parameters, setting.key, setting.value); });
  }
  // Each value is in its range by now; together they may still make no sense.
  const scenario::Source& last =
      scenario.filter.empty() ? scenario.filter_preset_source : scenario.filter.back().source;
  at(last, [&] { validate(parameters); });
  return parameters;
}

std::vector<std::string> idle_settings(const scenario::Scenario& scenario) {
  const Parameters parameters = filter_parameters(scenario);
  const std::string preset = scenario.filter_preset.empty() ? "default" : scenario.filter_preset;
  std::vector<std::string> lines;
  for (const scenario::FilterSetting& setting : scenario.filter) {
    const std::optional<Idle> why = idle(parameters, setting.key);
    if (!why) continue;
    std::string rules, presets;
    for (const Rule& rule : why->rules) {
      rules += fmt::format("{}{}={}", rules.empty() ? "" : " or ", rule.key, rule.value);
    }
    for (const std::string& name : why->presets) presets += (presets.empty() ? "" : ", ") + name;
    std::string line =
        fmt::format("the filter's {} has no effect with preset {}: only {} asks for it, as in {}",
                    setting.key, preset, rules, presets);
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
  }
  return lines;
}

}  // namespace lcs::bench
