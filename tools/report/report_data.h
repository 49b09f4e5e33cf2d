/// \file
/// The data of a report page as one JSON value, which the page's script lays out.
#pragma once

#include <cstdint>
#include <string>

#include "tools/report/report_page.h"

namespace lcs::report {

/// Limit of a page's pictures in bytes; the costliest events have priority.
inline constexpr std::size_t kPictureBudget = 6'000'000;
/// Size limit of a page's video in bytes.
inline constexpr std::uintmax_t kVideoBudget = 64'000'000;

/// The JSON text of a suite. \throws std::runtime_error as `write_report`.
std::string report_data(const suite::SuiteInFolder& suite, const suite::Verdict& verdict,
                        const Against* against, std::size_t picture_budget = kPictureBudget);

/// The JSON text of a single run, with its video if its folder has one.
std::string run_report_data(const suite::SuiteInFolder& suite);

}  // namespace lcs::report
