/// \file
/// The detectors available to a run, by name.
#pragma once

#include <filesystem>
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
  std::string_view purpose;    ///< one human-readable line
  bool layered = false;        ///< as `recording::DetectorInfo::layered`
  bool sees_pictures = false;  ///< uses pictures besides corners and motion
  /// Null for an external detector. \throws input::Error for parameters that the detector does
  /// not accept.
  std::unique_ptr<bench::Detector> (*make)(const Intrinsics& camera,
                                           const scenario::Scenario& scenario);
};

/// All detectors, the filter first.
std::span<const DetectorKind> detectors();

/// \throws std::invalid_argument listing the known names.
const DetectorKind& detector(std::string_view name);

/// A requested detector: "klt", the filter with a preset such as "lcs:lab", an external program, or
/// a file with detections.
struct DetectorSpec {
  std::string name;  ///< as requested
  const DetectorKind& detector;
  std::string preset;                   ///< replaces all filter settings of a scenario; "": none
  std::optional<Program> program = {};  ///< external program to run
  std::filesystem::path detections_file = {};  ///< file with detections to read
};

/// \throws std::invalid_argument for an unknown detector or preset, listing the known ones, and for
///   a preset of a detector without presets.
DetectorSpec spec_of(const std::string& name);

/// An external detector. \param name "": taken from the program or the file.
/// \throws std::invalid_argument for a name in use, or invalid as a folder's name.
DetectorSpec spec_of_program(const std::string& name, const Program& program);
DetectorSpec spec_of_file(const std::string& name, const std::filesystem::path& detections_file);

/// \throws input::Error, DetectorError, std::runtime_error.
std::unique_ptr<bench::Detector> make(const DetectorSpec& spec, const DetectorContext& context);

/// Replaces the scenario's filter settings by the spec's preset, if it has one. A preset for
/// comparison must not change with them. \return a line for each `--set` without effect because of
/// the preset. \throws like `bench::filter_parameters`.
std::vector<std::string> apply_preset(const DetectorSpec& spec, scenario::Scenario& scenario);

/// Checks a detector for an earlier run, which keeps corners, and pictures at best compressed.
/// \throws std::invalid_argument for a detector that uses pictures; not for a program, as it is
/// informed that they are compressed.
void require_corners_suffice(const DetectorSpec& spec);

}  // namespace lcs::comparators
