/// \file
/// The result of a suite as one page: a table of all scenarios with the change against a baseline,
/// and for each scenario its criteria, its plots over time, and its misses and false alarms with
/// pictures and reasons. HTML, CSS, script, figures and pictures are all in the one file: it opens
/// from disk and asks the network for nothing.
#pragma once

#include <filesystem>

#include "tools/suite/suite_result.h"

namespace lcs::report {

inline constexpr const char* kReportFile = "report.html";

/// Written beside its place, then renamed: the file appears whole or not at all.
/// \param baseline may be null.
/// \param suite_folder where the folders of the runs are: of each, frames.csv and events.json are
///   shown where they are there.
/// \throws bench::OutputError; std::runtime_error for a frames.csv or events.json that cannot be
///   read, naming it.
void write_report(const std::filesystem::path& file, const suite::SuiteResult& suite,
                  const suite::SuiteResult* baseline, const std::filesystem::path& suite_folder);

}  // namespace lcs::report
