/// \file
/// A suite's result as JUnit XML, which Jenkins, GitLab and others show.
#pragma once

#include <filesystem>
#include <span>

#include "tools/suite/suite_result.h"

namespace lcs::suite {

inline constexpr const char* kJunitFile = "junit.xml";

/// A test suite a scenario, a test case a criterion and seed. A run that has no criteria, or failed
/// before they could be judged, is one case, "runs". `failure` is a criterion that is not met,
/// `error` a run without figures; a criterion that is not required never fails.
/// \param others of the same scenarios by other detectors: criteria that ask one are cases with
///   its name before theirs, as "klt: rebel.f1 min, seed 1".
/// \throws bench::OutputError
void write_junit(const std::filesystem::path& file, const SuiteResult& suite,
                 std::span<const SuiteResult> others = {});

}  // namespace lcs::suite
