/// \file
/// The detectors that a run can be made with, by name.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

/// A detector as it is asked for: "klt", or the filter with one of its presets, "lcs:lab".
struct Wanted {
  std::string name;  ///< as it was asked for
  const Detector& detector;
  std::string preset;  ///< in place of all that a scenario says of the filter; "" for none
};

/// \throws std::invalid_argument for an unknown detector or preset, naming those that there are,
/// and
///   for a preset of what has none.
Wanted wanted(const std::string& name);

/// Gives a scenario the preset that is wanted, if any, alone: a yardstick does not move with what
/// is measured. \return a line for each setting that has no effect: with a preset each `--set`,
/// else as `bench::idle_settings` has it. \throws as that one.
std::vector<std::string> apply_preset(const Wanted& wanted, scenario::Scenario& scenario);

/// For frames of an earlier run, of which there are corners and no pictures as they were.
/// \throws std::invalid_argument for a detector that looks at pictures.
void require_corners_suffice(const Detector& detector);

}  // namespace lcs::comparators
