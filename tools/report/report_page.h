/// \file
/// The report page of a suite: the verdict, the worst scenarios with their reasons, a table of all
/// scenarios with the changes against a baseline, and for each scenario its criteria, plots over
/// time, misses and false alarms with pictures and reasons. The page of a single run also has its
/// video. A page is one file with HTML, CSS, script, figures and pictures. It opens from disk
/// without network access.
///
/// The page of a suite's worlds, by family: a contact sheet of each world with the figures of all
/// detectors. Plain HTML; there may be thousands of pictures, so they are in a separate folder.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "tools/suite/comparison.h"
#include "tools/suite/suite_result.h"
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
/// \param others results of other detectors on the same scenarios, each with a scatter plot of F1.
/// \throws files::OutputError; std::runtime_error that names an unreadable frames.csv or
///   events.json of the suite. The page itself reports unreadable files of the baseline.
void write_report(const std::filesystem::path& file, const suite::SuiteInFolder& suite,
                  const suite::SuiteVerdict& verdict, const Against* against,
                  std::span<const suite::SuiteResult> others = {});

/// Writes the page of the one run in `suite`. A video larger than `kVideoBudget` is only named.
/// \param explained `explain::explained_views`, or null. \throws as `write_report`.
void write_run_report(const std::filesystem::path& file, const suite::SuiteInFolder& suite,
                      const nlohmann::ordered_json& explained);

/// Limit of a page's pictures in bytes; the costliest events have priority.
inline constexpr std::size_t kPictureBudget = 6'000'000;
/// Size limit of a page's video in bytes.
inline constexpr std::uintmax_t kVideoBudget = 64'000'000;

/// The JSON text of a suite. \throws std::runtime_error as `write_report`.
std::string report_data(const suite::SuiteInFolder& suite, const suite::SuiteVerdict& verdict,
                        const Against* against, std::size_t picture_budget = kPictureBudget,
                        std::span<const suite::SuiteResult> others = {});

/// The JSON text of a single run, with its video if its folder has one.
std::string run_report_data(const suite::SuiteInFolder& suite,
                            const nlohmann::ordered_json& explained);

inline constexpr const char* kWorldsFile = "worlds.html";
inline constexpr const char* kSheetsFolder = "worlds";

/// The path of a scenario's contact sheet, relative to the suite's folder.
std::filesystem::path sheet_path(const suite::ScenarioResult& scenario);

/// \param about a line that describes these worlds to the reader.
/// \param others results of other detectors on the same worlds.
/// \param suite_folder receives the page, which shows the sheets that exist there.
/// \throws files::OutputError
void write_worlds_page(const std::filesystem::path& suite_folder, const std::string& about,
                       const suite::SuiteResult& suite, std::span<const suite::SuiteResult> others);

}  // namespace lcs::report
