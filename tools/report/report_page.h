/// \file
/// The result of a suite as one page: the verdict and what is worst with its reasons, a table of
/// all scenarios with the change against a baseline, and for each scenario its criteria, its plots
/// over time, and its misses and false alarms with pictures and reasons. Of a single run likewise,
/// with its video. HTML, CSS, script, figures and pictures are all in the one file: it opens from
/// disk and asks the network for nothing.
#pragma once

#include <filesystem>

#include "tools/suite/comparison.h"
#include "tools/suite/verdict.h"

namespace lcs::report {

inline constexpr const char* kReportFile = "report.html";

/// What a suite was compared with, and what came of it.
struct Against {
  const suite::SuiteInFolder& baseline;
  const suite::Comparison& comparison;
};

/// Written beside its place, then renamed: the file appears whole or not at all. Of each run
/// frames.csv and events.json are shown where they are there.
/// \param against null without a baseline.
/// \throws bench::OutputError; std::runtime_error for a frames.csv or events.json of the suite that
///   cannot be read, naming it. What is wrong with one of the baseline is told on the page.
void write_report(const std::filesystem::path& file, const suite::SuiteInFolder& suite,
                  const suite::Verdict& verdict, const Against* against);

/// Writes the page of the one run in `suite`. A video larger than `kVideoBudget` is only named.
/// \throws likewise.
void write_run_report(const std::filesystem::path& file, const suite::SuiteInFolder& suite);

}  // namespace lcs::report
