/// \file
/// What the page shows, as one JSON value: the script of the page lays it out.
#pragma once

#include <filesystem>
#include <string>

#include "tools/suite/suite_result.h"

namespace lcs::report {

/// Bytes of pictures that a page holds; those of the costliest events come first.
inline constexpr std::size_t kPictureBudget = 10'000'000;

/// Text of a JSON object, fit to stand inside a script element: it has no "<".
/// \throws std::runtime_error as `write_report`.
std::string report_data(const suite::SuiteResult& suite, const suite::SuiteResult* baseline,
                        const std::filesystem::path& suite_folder,
                        std::size_t picture_budget = kPictureBudget);

}  // namespace lcs::report
