#include "tools/comparators/detectors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "tools/comparators/dis.h"
#include "tools/comparators/homography.h"
#include "tools/comparators/klt.h"

namespace lcs::comparators {
namespace {

using Made = std::unique_ptr<bench::Tracker>;

Made make_lcs(const sim::Pinhole& camera, const scenario::Scenario& scenario) {
  return std::make_unique<bench::LcsTracker>(camera, bench::filter_parameters(scenario));
}

Made make_klt(const sim::Pinhole& camera, const scenario::Scenario&) {
  return std::make_unique<KltTracker>(camera);
}

Made make_homography(const sim::Pinhole&, const scenario::Scenario&) {
  return std::make_unique<HomographyTracker>();
}

Made make_dis(const sim::Pinhole& camera, const scenario::Scenario&) {
  return std::make_unique<DisTracker>(camera);
}

constexpr std::array<Detector, 4> kDetectors{{
    {"lcs", "the Line-Circle-Square filter", true, false, make_lcs},
    {"klt", "Lucas-Kanade, and distance to the epipolar segment that the IMU gives", false, true,
     make_klt},
    {"homography", "Lucas-Kanade, and distance to one homography by RANSAC", false, true,
     make_homography},
    {"dis", "dense flow, and distance to the epipolar segment", false, true, make_dis},
}};

}  // namespace

std::span<const Detector> detectors() {
  return kDetectors;
}

const Detector& detector(std::string_view name) {
  const auto found = std::find_if(kDetectors.begin(), kDetectors.end(),
                                  [&](const Detector& each) { return each.name == name; });
  if (found != kDetectors.end()) return *found;
  std::string names;
  for (const Detector& each : kDetectors) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", each.name);
  }
  throw std::invalid_argument(fmt::format("no detector is called '{}'; there are {}", name, names));
}

Wanted wanted(const std::string& name) {
  const std::size_t colon = name.find(':');
  const Detector& found = detector(name.substr(0, colon));
  if (colon == std::string::npos) return {name, found, ""};
  if (!found.layered) {
    throw std::invalid_argument(fmt::format(
        "detector {}: {} has no presets, which are the filter's; give {} alone, or lcs:{}", name,
        found.name, found.name, name.substr(colon + 1)));
  }
  const std::string preset = name.substr(colon + 1);
  lcs::preset(preset);  // is there one?
  return {name, found, preset};
}

std::vector<std::string> apply_preset(const Wanted& wanted, scenario::Scenario& scenario) {
  std::vector<std::string> lines = bench::idle_settings(scenario);
  if (wanted.preset.empty()) return lines;
  lines.clear();
  const auto leave_out = [&](std::string_view key, const scenario::Source& where) {
    if (!where.file.starts_with("--set ")) return;
    lines.push_back(fmt::format("filter.{} has no effect with {}, which is the preset alone", key,
                                wanted.name));
  };
  leave_out("preset", scenario.filter_preset_source);
  for (const scenario::FilterSetting& setting : scenario.filter) {
    leave_out(setting.key, setting.source);
  }
  scenario.filter_preset = wanted.preset;
  scenario.filter.clear();
  return lines;
}

void require_corners_suffice(const Detector& detector) {
  if (!detector.sees_pictures) return;
  throw std::invalid_argument(
      fmt::format("{} looks at the pictures, and a recording has corners; leave out --recorded",
                  detector.name));
}

}  // namespace lcs::comparators
