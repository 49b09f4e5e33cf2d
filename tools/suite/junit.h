/// \file
/// Writes a suite's result as JUnit XML, for Jenkins, GitLab and others.
#pragma once

#include <filesystem>
#include <span>

#include "tools/suite/suite_result.h"
#include "tools/suite/verdict.h"

namespace lcs::suite {

inline constexpr const char* kJunitFile = "junit.xml";

/// Writes one test suite per scenario and one test case per judged criterion (`judgements_of`). A
/// `failure` is a required criterion that is not met, `skipped` one that is not required, an
/// `error` a run without figures. Each of these names its place in report.html. Against a baseline
/// a further test suite, `baseline`, has one test case: a `failure` if it regressed, an `error` if
/// nothing was judged. \param others results of other detectors on the same scenarios. \param
/// verdict of the suite. \throws files::OutputError
void write_junit(const std::filesystem::path& file, const SuiteResult& suite,
                 std::span<const SuiteResult> others, const SuiteVerdict& verdict);

}  // namespace lcs::suite
