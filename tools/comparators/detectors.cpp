#include "tools/comparators/detectors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

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

constexpr std::array<Detector, 3> kDetectors{{
    {"lcs", "the Line-Circle-Square filter", true, false, make_lcs},
    {"klt", "Lucas-Kanade, and distance to the epipolar segment that the IMU gives", false, true,
     make_klt},
    {"homography", "Lucas-Kanade, and distance to one homography by RANSAC", false, true,
     make_homography},
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

void require_corners_suffice(const Detector& detector) {
  if (!detector.sees_pictures) return;
  throw std::invalid_argument(
      fmt::format("{} looks at the pictures, and a recording has corners; leave out --recorded",
                  detector.name));
}

}  // namespace lcs::comparators
