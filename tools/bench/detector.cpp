#include "tools/bench/detector.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "scenarios/input/spelling.h"

namespace lcs::bench {

Intrinsics intrinsics(const sim::Pinhole& camera) {
  return {.focal_px = camera.focal_px,
          .centre_px = camera.centre_px,
          .width_px = camera.width_px,
          .height_px = camera.height_px};
}

std::optional<double> StoredGaps::evidence(const Gap& gap) {
  const auto box = [](const Gap& of) {
    const Vec2 a = of.at(0, 0), b = of.at(of.columns, of.rows);
    return cv::Rect2d(cv::Point2d(a.x(), a.y()), cv::Point2d(b.x(), b.y()));
  };
  constexpr double kShared = 0.5;  // least overlap of two gaps with one answer, over their union
  double most = kShared;
  std::optional<double> answer;
  for (const GapSeen& seen : *gaps_) {
    const double both = (box(seen.gap) & box(gap)).area();
    const double share = both / (box(seen.gap).area() + box(gap).area() - both);
    if (share <= most) continue;
    most = share;
    answer = seen.evidence;
  }
  return answer;
}

namespace {

std::vector<std::string> keys_of(const AnyParameters& parameters) {
  std::vector<std::string> keys;
  for (const ParameterInfo& info : describe(parameters)) keys.push_back(info.key);
  return keys;
}

/// Error message for a key that the preset's filter lacks, with a suggestion.
std::string unknown_key(const std::string& key, const std::string& own_preset,
                        const std::vector<std::string>& known) {
  std::string others;
  for (const std::string& name : preset_names()) {
    if (std::ranges::count(keys_of(preset(name)), key) == 0) continue;
    others += (others.empty() ? "" : ", ") + name;
  }
  if (others.empty()) {
    return fmt::format("the filter has no parameter '{}'; the nearest is '{}'", key,
                       input::nearest_first(key, known).front());
  }
  return fmt::format(
      "the filter of preset {} has no parameter '{}', which is of {}; choose one of these by "
      "filter.preset, or leave it out",
      own_preset, key, others);
}

}  // namespace

AnyParameters filter_parameters(const scenario::Scenario& scenario) {
  const auto at = [](const input::Source& source, auto&& use) {
    try {
      return use();
    } catch (const std::invalid_argument& error) {
      throw input::Error(source, error.what());
    }
  };
  const std::string name = scenario.filter_preset.empty() ? "default" : scenario.filter_preset;
  AnyParameters parameters = at(scenario.filter_preset_source, [&] { return preset(name); });
  const std::vector<std::string> known = keys_of(parameters);
  for (const scenario::FilterSetting& setting : scenario.filter) {
    if (std::ranges::find(known, setting.key) == known.end()) {
      throw input::Error(setting.source, unknown_key(setting.key, name, known));
    }
    at(setting.source, [&] { set(parameters, setting.key, setting.value); });
  }
  // Each value is in its range here; combinations may still be invalid.
  const input::Source& last =
      scenario.filter.empty() ? scenario.filter_preset_source : scenario.filter.back().source;
  at(last, [&] { validate(parameters); });
  return parameters;
}

}  // namespace lcs::bench
