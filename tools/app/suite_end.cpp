#include "tools/app/suite_end.h"

#include <fmt/format.h>

#include <utility>

#include "scenes/worlds/worlds.h"
#include "tools/files/output_file.h"
#include "tools/report/report_page.h"
#include "tools/suite/junit.h"
#include "tools/suite/tables.h"

namespace lcs::app {
namespace fs = std::filesystem;

std::optional<suite::SuiteResult> baseline_of(const SuitePlace& place) {
  if (place.baseline.empty()) return std::nullopt;
  return suite::read_suite(place.baseline);
}

std::vector<std::string> other_inputs(const fs::path& before, const fs::path& after) {
  for (const fs::path& suite : {before, after}) {
    if (!fs::exists(suite / files::kHowMadeFile)) return {};
  }
  const auto read_by = [](const fs::path& suite) {
    return files::Provenance{.facts = {}, .read = files::read_how_made(suite).read};
  };
  const std::string what = files::difference(read_by(before), read_by(after));
  if (what.empty()) return {};
  return {fmt::format("{} and {} were not made of the same files: {}", before.string(),
                      after.string(), what)};
}

fs::path part_of(const std::string& detector, const std::string& own) {
  return detector == own ? fs::path() : fs::path("beside") / detector;
}

void add_part(files::Json& facts, const std::string& shard, const suite::SuiteRuns& runs) {
  std::size_t count = 0;
  files::Json scenarios = files::Json::array();
  for (const auto& [name, seeds] : runs) {
    scenarios.push_back({{"name", name}, {"seeds", seeds}});
    count += seeds.size();
  }
  facts["shard"] = shard;
  facts["runs"] = count;
  facts["scenarios"] = std::move(scenarios);
}

SuiteMade finish_suite(files::Output& folder, const SuitePlace& place, suite::SuiteResult result,
                       std::vector<suite::SuiteResult> others,
                       const std::optional<suite::SuiteResult>& baseline, Caller& caller) {
  for (const suite::SuiteResult& other : others) {
    suite::write_suite(
        folder.staging() / part_of(other.detector, result.detector) / suite::kSuiteFile, other);
  }
  suite::write_suite(folder.staging() / suite::kSuiteFile, result);
  if (!others.empty()) {
    files::write_file(folder.staging() / suite::kStandingFile,
                      suite::standing_table(result, others));
  }
  const suite::SuiteInFolder made{result, folder.staging()};
  std::optional<suite::SuiteInFolder> before;
  std::optional<suite::Comparison> comparison;
  std::optional<report::Against> against;
  if (baseline) {
    before.emplace(suite::SuiteInFolder{*baseline, suite::folder_of(place.baseline)});
    caller.warn(other_inputs(before->folder, folder.staging()));
    comparison = suite::compare(*baseline, result, [](std::string_view) { return true; });
    if (place.allow_missing) comparison->missing.clear();
    against.emplace(report::Against{*before, *comparison});
  }
  const suite::SuiteVerdict verdict = suite::verdict_of(
      made, before ? &*before : nullptr, comparison ? &*comparison : nullptr, others);
  suite::write_junit(folder.staging() / suite::kJunitFile, result, others, verdict);
  report::write_report(folder.staging() / report::kReportFile, made, verdict,
                       against ? &*against : nullptr);
  if (!result.split.empty()) {
    const worlds::Split& split = worlds::split(result.split);
    report::write_worlds_page(folder.staging(),
                              fmt::format("The split {} is {}.", split.name, split.purpose), result,
                              others);
  }
  caller.check();
  folder.commit();

  return {.result = std::move(result),
          .others = std::move(others),
          .comparison = std::move(comparison),
          .verdict = verdict,
          .folder = folder.target()};
}

}  // namespace lcs::app
