/// \file
/// A suite's result as JUnit XML, which Jenkins, GitLab and others show.
#pragma once

#include <filesystem>

#include "tools/suite/suite_result.h"

namespace lcs::suite {

inline constexpr const char* kJunitFile = "junit.xml";

/// A test suite a scenario, a test case a criterion and seed. A run that has no criteria, or failed
/// before they could be judged, is one case, "runs". `failure` is a criterion that is not met,
/// `error` a run without figures; a criterion that is not required never fails.
/// \throws bench::OutputError
void write_junit(const std::filesystem::path& file, const SuiteResult& suite);

}  // namespace lcs::suite
