/// \file
/// The detectors that a run can be made with, by name.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/bench/detector.h"
#include "tools/comparators/program.h"

namespace lcs::comparators {

struct DetectorKind {
  std::string_view name;
  std::string_view purpose;    ///< one line for people
  bool layered = false;        ///< as in `bench::DetectorInfo`
  bool sees_pictures = false;  ///< beside corners and motion
  /// Null for a detector that is not part of this program. \throws scenario::Error for parameters
  /// that the detector does not take.
  std::unique_ptr<bench::Detector> (*make)(const Intrinsics& camera,
                                           const scenario::Scenario& scenario);
};

/// All there are, the filter first.
std::span<const DetectorKind> detectors();

/// \throws std::invalid_argument naming those that there are.
const DetectorKind& detector(std::string_view name);

/// A detector as it is asked for: "klt", the filter with one of its presets, "lcs:lab", any
/// program, or what somebody's has written to a file.
struct DetectorSpec {
  std::string name;  ///< as it was asked for
  const DetectorKind& detector;
  std::string preset;  ///< replaces all settings of the filter in a scenario; "": none
  std::optional<Program> program = {};         ///< to be run
  std::filesystem::path detections_file = {};  ///< to be read
};

/// \throws std::invalid_argument for an unknown detector or preset, naming those that there are,
///   and for a preset of what has none.
DetectorSpec spec_of(const std::string& name);

/// A detector of the user's. \param name "": taken from the program or the file.
/// \throws std::invalid_argument for a name that is taken, or no name of a folder.
DetectorSpec spec_of_program(const std::string& name, const Program& program);
DetectorSpec spec_of_file(const std::string& name, const std::filesystem::path& detections_file);

/// What a detector is made for.
struct DetectorContext {
  const Intrinsics& camera;
  const scenario::Scenario& scenario;
  const bench::Recording* recorded = nullptr;  ///< the frames that will come, where they are known
  std::function<void()> on_wait = {};          ///< as `DetectorProcess` has it
};

/// \throws scenario::Error, DetectorError, std::runtime_error.
std::unique_ptr<bench::Detector> make(const DetectorSpec& spec, const DetectorContext& context);

/// Replaces a scenario's settings of the filter by its preset, if it has one: what others
/// are compared with must not change with them. \return a line for each `--set` that has no effect
/// because of the preset. \throws as `bench::filter_parameters`.
std::vector<std::string> apply_preset(const DetectorSpec& spec, scenario::Scenario& scenario);

/// For frames of an earlier run, which kept its corners, but its pictures compressed at best.
/// \throws std::invalid_argument for a detector that looks at pictures; not for a program, which is
///   told that they are compressed.
void require_corners_suffice(const DetectorSpec& spec);

}  // namespace lcs::comparators
