/// \file
/// What the page shows, as one JSON value: the script of the page lays it out.
#pragma once

#include <cstdint>
#include <string>

#include "tools/report/report_page.h"

namespace lcs::report {

/// Bytes of pictures that a page holds; those of the costliest events come first.
inline constexpr std::size_t kPictureBudget = 6'000'000;
/// Bytes of the largest video that a page holds.
inline constexpr std::uintmax_t kVideoBudget = 64'000'000;

/// Text of a JSON object. \throws std::runtime_error as `write_report`.
std::string report_data(const suite::SuiteInFolder& suite, const suite::Verdict& verdict,
                        const Against* against, std::size_t picture_budget = kPictureBudget);

/// The JSON object of a single run, with its video where its folder has one.
std::string run_report_data(const suite::SuiteInFolder& suite);

}  // namespace lcs::report
