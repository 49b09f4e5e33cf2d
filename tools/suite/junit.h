/// \file
/// Writes a suite's result as JUnit XML, for Jenkins, GitLab and others.
#pragma once

#include <filesystem>
#include <span>

#include "tools/suite/suite_result.h"

namespace lcs::suite {

inline constexpr const char* kJunitFile = "junit.xml";

/// Writes one test suite per scenario and one test case per judged criterion (`judgements_of`). A
/// `failure` is a required criterion that is not met, `skipped` one that is not required, an
/// `error` a run without figures. Each of these names its place in report.html. \param others
/// results of other detectors on the same scenarios. \throws files::OutputError
void write_junit(const std::filesystem::path& file, const SuiteResult& suite,
                 std::span<const SuiteResult> others = {});

}  // namespace lcs::suite
