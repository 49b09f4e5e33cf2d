/// \file
/// The report of a run of benchmarks: what was measured, in which ratios, whether the targets are
/// met, and with what. One HTML page that needs nothing beside it.
#pragma once

#include <benchmark/benchmark.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace lcs::bench {

/// Prints as Google Benchmark does, and keeps what is printed for the page.
class PageReporter : public benchmark::ConsoleReporter {
 public:
  PageReporter() : ConsoleReporter(OO_Tabular) {}

  void ReportRuns(const std::vector<Run>& runs) override;

  bool any() const { return !measured_.empty(); }

  /// \throws OutputError
  void write(const std::filesystem::path& page) const;

 private:
  /// The quickest of a benchmark's repetitions: what else runs on the machine only adds.
  struct Measured {
    double ms = 0;
    std::map<std::string, double> counters;
  };

  /// Whether anything was measured whose name begins so.
  bool any(const std::string& prefix) const;
  std::optional<double> ms(const std::string& name) const;
  std::optional<double> counter(const std::string& name, const char* key) const;
  /// Appends what the filter should reach to `targets`.
  std::string filter_table(const std::string& scene, std::string& targets) const;
  std::string simulation_table(const std::string& scene) const;
  std::string settings_table(const std::string& scene) const;

  std::map<std::string, Measured> measured_;  // "filter/lab/700"
};

}  // namespace lcs::bench
