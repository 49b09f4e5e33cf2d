/// \file
/// The end of a suite: its files, tables and exit code. `lcs suite` and `lcs merge` share it.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/files/output.h"
#include "tools/lcs/exit_codes.h"
#include "tools/suite/suite_result.h"

namespace lcs::tools {

struct SuiteEndOptions {
  static constexpr const char* kPlace = "out/suite";
  std::string out = kPlace;         ///< folder
  std::string baseline;             ///< suite.json or its folder; "": none
  bool fail_on_regression = false;  ///< exit with kRegressed if worse than the baseline
  bool worst_first = false;
  bool quiet = false;

  bool is_named() const { return out != kPlace; }
};

/// Adds `--out`, `--baseline`, `--fail-on-regression`, `--worst-first` and `--quiet`.
void add_suite_end_options(CLI::App& command, SuiteEndOptions& options);

/// The baseline of the options. \throws std::runtime_error if it cannot be read.
std::optional<suite::SuiteResult> baseline_of(const SuiteEndOptions& options);

/// The folder of a detector's results, relative to the suite's folder.
std::filesystem::path part_of(const std::string& detector, const std::string& own);

/// Writes suite.json, junit.xml, the report and so on, commits the folder and prints the tables.
/// \param folder has the runs, and for worlds their pictures.
/// \param others the results of the detectors of `--beside`.
/// \throws bench::OutputError, Interrupted, std::runtime_error
ExitCode finish_suite(bench::Output& folder, const SuiteEndOptions& options,
                      const suite::SuiteResult& result,
                      const std::vector<suite::SuiteResult>& others,
                      const std::optional<suite::SuiteResult>& baseline);

}  // namespace lcs::tools
