/// \file
/// Writes a suite's result as JUnit XML, for Jenkins, GitLab and others.
#pragma once

#include <filesystem>
#include <span>

#include "tools/suite/suite_result.h"

namespace lcs::suite {

inline constexpr const char* kJunitFile = "junit.xml";

/// Writes one test suite per scenario and one test case per criterion and seed. A run without
/// criteria or without figures is one case, "runs". A `failure` is a required criterion that is not
/// met, an `error` is a run without figures.
/// \param others results of other detectors on the same scenarios. The names of their cases begin
///   with the detector, such as "klt: rebel.f1 min, seed 1".
/// \throws bench::OutputError
void write_junit(const std::filesystem::path& file, const SuiteResult& suite,
                 std::span<const SuiteResult> others = {});

}  // namespace lcs::suite
