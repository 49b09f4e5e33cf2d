/// \file
/// The detectors that a run can be made with, by name.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "scenarios/scenario.h"
#include "sim/pose.h"
#include "tools/bench/tracker.h"

namespace lcs::comparators {

struct Detector {
  std::string_view name;
  std::string_view purpose;    ///< one line for people
  bool layered = false;        ///< as in `bench::Speaker`
  bool sees_pictures = false;  ///< beside corners and motion
  /// \throws scenario::Error for parameters that the detector does not take.
  std::unique_ptr<bench::Tracker> (*make)(const sim::Pinhole& camera,
                                          const scenario::Scenario& scenario);
};

/// All there are, the filter first.
std::span<const Detector> detectors();

/// \throws std::invalid_argument naming those that there are.
const Detector& detector(std::string_view name);

/// For frames of an earlier run, of which there are corners and no pictures as they were.
/// \throws std::invalid_argument for a detector that looks at pictures.
void require_corners_suffice(const Detector& detector);

}  // namespace lcs::comparators
