/// \file
/// The report page of a suite: the verdict, the worst scenarios with their reasons, a table of all
/// scenarios with the changes against a baseline, and for each scenario its criteria, plots over
/// time, misses and false alarms with pictures and reasons. The page of a single run also has its
/// video. A page is one file with HTML, CSS, script, figures and pictures. It opens from disk
/// without network access.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tools/suite/comparison.h"
#include "tools/suite/verdict.h"

namespace lcs::report {

inline constexpr const char* kReportFile = "report.html";

/// The baseline of a suite, and the comparison with it.
struct Against {
  const suite::SuiteInFolder& baseline;
  const suite::Comparison& comparison;
};

/// Writes the page. It shows the frames.csv and events.json of each run that has them.
/// \param against null without a baseline.
/// \throws files::OutputError; std::runtime_error that names an unreadable frames.csv or
///   events.json of the suite. The page itself reports unreadable files of the baseline.
void write_report(const std::filesystem::path& file, const suite::SuiteInFolder& suite,
                  const suite::SuiteVerdict& verdict, const Against* against);

/// Writes the page of the one run in `suite`. A video larger than `kVideoBudget` is only named.
/// \throws as `write_report`.
void write_run_report(const std::filesystem::path& file, const suite::SuiteInFolder& suite);

/// Limit of a page's pictures in bytes; the costliest events have priority.
inline constexpr std::size_t kPictureBudget = 6'000'000;
/// Size limit of a page's video in bytes.
inline constexpr std::uintmax_t kVideoBudget = 64'000'000;

/// The JSON text of a suite. \throws std::runtime_error as `write_report`.
std::string report_data(const suite::SuiteInFolder& suite, const suite::SuiteVerdict& verdict,
                        const Against* against, std::size_t picture_budget = kPictureBudget);

/// The JSON text of a single run, with its video if its folder has one.
std::string run_report_data(const suite::SuiteInFolder& suite);

}  // namespace lcs::report
