/// \file
/// The report of a benchmark run: the measurements, their ratios, the targets, and the machine. One
/// self-contained HTML page.
#pragma once

#include <benchmark/benchmark.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace lcs::test {

/// Prints like Google Benchmark and keeps the results for the page.
class PageReporter : public benchmark::ConsoleReporter {
 public:
  PageReporter() : ConsoleReporter(OO_Tabular) {}

  void ReportRuns(const std::vector<Run>& runs) override;

  bool any() const { return !measured_.empty(); }

  /// \throws OutputError
  void write(const std::filesystem::path& page) const;

 private:
  /// The fastest repetition of a benchmark: other load on the machine only adds time.
  struct Measured {
    double ms = 0;
    std::map<std::string, double> counters;
  };

  /// Whether any measured name begins with `prefix`.
  bool any(const std::string& prefix) const;
  std::optional<double> ms(const std::string& name) const;
  std::optional<double> counter(const std::string& name, const char* key) const;
  /// Appends the filter's targets to `targets`.
  std::string filter_table(const std::string& scene, std::string& targets) const;
  std::string simulation_table(const std::string& scene) const;
  std::string settings_table(const std::string& scene) const;

  std::map<std::string, Measured> measured_;  // "filter/lab/700"
};

}  // namespace lcs::test
