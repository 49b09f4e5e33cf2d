#include "tools/report/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <ranges>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/input/input_file.h"
#include "tools/files/csv.h"
#include "tools/files/json_node.h"
#include "tools/output/video.h"
#include "tools/recording/recording_io.h"
#include "tools/report/page_writer.h"
#include "tools/scoring/events.h"
#include "tools/scoring/figures_file.h"
#include "tools/scoring/metrics.h"
#include "tools/suite/judgement.h"
#include "tools/suite/summary.h"

namespace lcs::report {

/// `page.js` of this folder, embedded in the program: the script that lays out a suite's data.
extern const std::string_view kReportJs;

namespace {

using suite::RunResult;
using suite::ScenarioResult;
using suite::SuiteInFolder;
using suite::SuiteResult;

constexpr std::array<const char*, 3> kFamilies{"rebels", "circles", "squares"};

/// So many scenarios are shown as a whole, with curves and events; the others with the figures of
/// the table and a link to their files.
constexpr std::size_t kMostWhole = 60;
constexpr std::ptrdiff_t kMostRemarks = 300;

/// The plotted columns of frames.csv.
constexpr std::array<const char*, 10> kCurves{
    "t_s",           "precision", "recall",    "normal_edges", "rebel_edges", "normal_circles",
    "rebel_circles", "squares",   "dimension", "corners"};

// ---- Figures

/// Label and tooltip of each metric for the page.
files::Json metrics_json() {
  files::Json all = files::Json::object();
  for (const scoring::Metric& metric : scoring::metrics()) {
    all[metric.key] = {{"label", metric.heading()}, {"title", metric.tooltip()}};
  }
  return all;
}

/// Differences by the scenario's or group's name and the metric.
using DifferenceOf = std::map<std::pair<std::string, std::string>, const suite::Difference*>;

DifferenceOf by_name(const std::vector<suite::Difference>& differences) {
  DifferenceOf all;
  for (const suite::Difference& one : differences) all[{one.scenario, one.metric}] = &one;
  return all;
}

/// Adds the figure's value before, its change and the verdict on it, if both suites have the
/// figure.
void add_change(files::Json& figure, const DifferenceOf& differences, const std::string& owner,
                const std::string& name) {
  const auto found = differences.find({owner, name});
  if (found == differences.end()) return;
  const suite::Difference& difference = *found->second;
  figure["before"] = difference.before;
  figure["change"] = difference.change.mean;
  figure["half"] = files::number_or_null(difference.change.half);
  figure["verdict"] = suite::word_of(difference.verdict);
}

/// \param whole all figures; else only the table's figures.
files::Json figures_of(const ScenarioResult& scenario, const DifferenceOf& differences,
                       bool whole) {
  files::Json figures = files::Json::object();
  for (const scoring::Metric& metric : scoring::metrics()) {
    if (!whole && std::ranges::find(metric.shown, scoring::Table::report) == metric.shown.end())
      continue;
    const auto now = suite::over_seeds(scenario, metric.key);
    if (!now) continue;
    files::Json& figure = figures[metric.key] = {{"mean", now->mean}};
    if (now->count > 1) figure["spread"] = now->half;
    add_change(figure, differences, scenario.name, metric.key);
  }
  return figures;
}

files::Json groups_of(const SuiteResult& suite, const DifferenceOf& differences) {
  files::Json groups = files::Json::array();
  for (const std::string& group : suite::groups_of(suite)) {
    files::Json figures = files::Json::object();
    for (const scoring::Metric& metric : scoring::metrics()) {
      const auto now = suite::over_group(suite, group, metric.key);
      if (!now) continue;
      figures[metric.key] = {{"mean", files::number_or_null(now)}};
      add_change(figures[metric.key], differences, group, metric.key);
    }
    groups.push_back({{"label", suite::counted_group(suite, group)}, {"figures", figures}});
  }
  return groups;
}

// ---- Runs

/// A cell's number with five digits, enough for the pixels of a plot; null for an empty cell.
files::Json number_of(std::string_view cell) {
  if (cell.empty()) return nullptr;
  const std::optional<double> number = files::number_in<double>(cell);
  if (!number) throw std::invalid_argument(fmt::format("'{}' is not a number", cell));
  return files::parse_json<files::Json>(fmt::format("{:.5g}", *number));
}

/// The plotted columns of a run's frames.csv; null if there is no such file.
files::Json frames_in(const fs::path& folder) {
  const fs::path file = folder / scoring::kFramesFile;
  if (!fs::exists(file)) return nullptr;
  // A frame takes some 200 bytes.
  constexpr input::FileKind kFramesTable{input::kGibibyte, "run the suite again"};
  input::InputFile input(file, kFramesTable);
  std::string line;
  input.next_line(line);
  const std::string header_line = line;
  const std::vector<std::string_view> header = files::fields_of(header_line);
  files::Json columns = files::Json::object();
  for (const char* name : kCurves) {
    if (std::ranges::find(header, name) == header.end()) {
      throw input::Error({file.string(), 1}, "has no column {}; {}", name, kFramesTable.remedy);
    }
    columns[name] = files::Json::array();
  }
  while (input.next_line(line)) {
    std::vector<std::string_view> cells = files::fields_of(line);
    cells.resize(std::max(cells.size(), header.size()));
    for (std::size_t i = 0; i < header.size(); ++i) {
      const auto column = columns.find(std::string(header[i]));
      if (column == columns.end()) continue;
      try {
        column->push_back(number_of(cells[i]));
      } catch (const std::invalid_argument& error) {
        throw input::Error(input.here(), "{}; {}", error.what(), kFramesTable.remedy);
      }
    }
  }
  return columns;
}

/// As in events.json, with meanings.
files::Json event_json(const scoring::ScoredEvent& event) {
  files::Json json = scoring::json_of(event);
  json["meaning"] = text_of(event.kind).meaning;
  json["family"] = kFamilies[static_cast<std::size_t>(family_of(event.kind))];
  files::Json& reasons = json["reasons"] = files::Json::array();
  const auto add_reasons = [&](const auto& of_corners) {
    for (const auto& [reason, corners] : of_corners) {
      const auto& [word, meaning] = text_of(reason);
      reasons.push_back({{"word", word}, {"meaning", meaning}, {"corners", corners}});
    }
  };
  add_reasons(event.reasons);
  add_reasons(event.steps);
  return json;
}

using Events = std::optional<std::vector<scoring::ScoredEvent>>;

Events events_in(const fs::path& folder) {
  const fs::path file = folder / scoring::kEventsFile;
  return fs::exists(file) ? Events(scoring::read_events(file)) : std::nullopt;
}

/// Whether any of the events may be the same: both missed or both false, same family, same object,
/// and overlapping frames.
bool has_like(const std::vector<scoring::ScoredEvent>& events, const scoring::ScoredEvent& a) {
  return std::ranges::any_of(events, [&](const scoring::ScoredEvent& b) {
    return family_of(a.kind) == family_of(b.kind) &&
           (a.counted_corners > 0) == (b.counted_corners > 0) && a.object_name == b.object_name &&
           a.first_frame <= b.last_frame && b.first_frame <= a.last_frame;
  });
}

/// The baseline's curves and its vanished events, without pictures. Marks new ones in `events_now`.
files::Json before_json(const fs::path& folder, const Events& events, files::Json& events_now) {
  files::Json before = {{"frames", nullptr}, {"gone", files::Json::array()}, {"error", ""}};
  try {
    before["frames"] = frames_in(folder);
    const Events former = events_in(folder);
    if (!events || !former) return before;
    for (std::size_t i = 0; i < events->size(); ++i) {
      events_now[i]["is_new"] = !has_like(*former, (*events)[i]);
    }
    for (const scoring::ScoredEvent& event : *former) {
      if (has_like(*events, event)) continue;
      before["gone"].push_back(event_json(event));
      before["gone"].back()["views"] = files::Json::array();
    }
  } catch (const std::exception& error) {
    before["error"] = error.what();
  }
  return before;
}

/// \param whole with figures, curves and events.
files::Json run_json(const SuiteInFolder& suite, const SuiteInFolder* baseline,
                     const ScenarioResult& scenario, const RunResult& run, bool whole) {
  files::Json json = {{"seed", run.seed},
                      {"outcome", suite::word_of(run.outcome)},
                      {"error", run.error},
                      {"command", run.command},
                      {"criteria", suite::criteria_json(run)},
                      {"warnings", recording::lines_of(run.warnings)},
                      {"folder", run.folder.generic_string()},
                      {"has_frames", false},
                      {"metrics", files::Json::object()},
                      {"frames", nullptr},
                      {"events", nullptr},
                      {"before", nullptr}};
  if (!whole) return json;
  for (const scoring::Metric& metric : scoring::metrics()) {
    const auto figure = suite::figure_of(run, metric.key);
    if (figure) json["metrics"][metric.key] = *figure;
  }
  if (run.folder.empty()) return json;
  const fs::path folder = suite.folder / run.folder;
  json["has_frames"] = fs::exists(recording::stored(folder, recording::kLayersFile));
  json["frames"] = frames_in(folder);
  const Events events = events_in(folder);
  if (events) {
    json["events"] = files::Json::array();
    for (const scoring::ScoredEvent& event : *events) json["events"].push_back(event_json(event));
  }
  const ScenarioResult* other = baseline ? suite::find(baseline->suite, scenario.name) : nullptr;
  const RunResult* former = other ? suite::find(*other, run.seed) : nullptr;
  if (former && !former->folder.empty()) {
    json["before"] = before_json(baseline->folder / former->folder, events, json["events"]);
  }
  return json;
}

/// Removes pictures until the rest fits the budget. Pictures of cheap events and later seeds go
/// first, evenly over the families.
void keep_to_budget(files::Json& scenarios, std::size_t budget) {
  struct Strip {
    std::size_t turn;  // rank of the event in its run plus twice the index of the run
    files::Json* event;
  };
  std::vector<Strip> strips;
  for (files::Json& scenario : scenarios) {
    for (std::size_t r = 0; r < scenario["runs"].size(); ++r) {
      files::Json& events = scenario["runs"][r]["events"];
      std::map<std::string, std::size_t> rank;  // by family
      for (files::Json& event : events) {
        strips.push_back({rank[event["family"]]++ + 2 * r, &event});
      }
    }
  }
  std::ranges::stable_sort(strips, {}, &Strip::turn);
  std::size_t used = 0;
  for (const Strip& strip : strips) {
    std::size_t size = 0;
    for (const files::Json& view : (*strip.event)["views"]) {
      size += view["jpeg_base64"].get_ref<const std::string&>().size();
    }
    if (used + size <= budget) {
      used += size;
      continue;
    }
    for (files::Json& view : (*strip.event)["views"]) view["jpeg_base64"] = "";
    (*strip.event)["left_out"] = true;
  }
}

files::Json scenario_json(const SuiteInFolder& suite, const SuiteInFolder* baseline,
                          const DifferenceOf& differences, const ScenarioResult& scenario,
                          bool whole) {
  files::Json json = {{"name", scenario.name},
                      {"purpose", scenario.purpose},
                      {"file", scenario.file.generic_string()},
                      {"groups", scenario.groups},
                      {"point", files::Json::array()},
                      {"outcome", suite::word_of(suite::outcome_of(scenario))},
                      {"figures", figures_of(scenario, differences, whole)},
                      {"is_whole", whole},
                      {"runs", files::Json::array()}};
  for (const auto& [key, value] : scenario.point) {
    json["point"].push_back(files::Json::array({key, value}));
  }
  for (const RunResult& run : scenario.runs) {
    json["runs"].push_back(run_json(suite, baseline, scenario, run, whole));
  }
  return json;
}

files::Json words_of(const std::vector<suite::Standing>& standings) {
  files::Json words = files::Json::array();
  for (const suite::Standing standing : standings) words.push_back(suite::word_of(standing));
  return words;
}

files::Json remarks_of(const suite::SuiteVerdict& verdict) {
  files::Json remarks = files::Json::array();
  for (const suite::Remark& remark : verdict.remarks | std::views::take(kMostRemarks)) {
    remarks.push_back({{"scenario", remark.scenario},
                       {"standings", words_of(remark.standings)},
                       {"reasons", remark.reasons}});
  }
  return remarks;
}

/// The names of the scenarios that the page shows as a whole: those with remarks, worst first, then
/// those with the lowest F1.
std::set<std::string> shown_whole(const SuiteResult& suite, const suite::SuiteVerdict& verdict) {
  std::vector<std::pair<double, std::string>> order;
  for (const ScenarioResult& scenario : suite.scenarios) {
    const auto remark = std::ranges::find(verdict.remarks, scenario.name, &suite::Remark::scenario);
    const auto f1 = suite::over_seeds(scenario, scoring::kF1);
    const auto rank = static_cast<double>(remark - verdict.remarks.end());
    const double place = rank < 0 ? rank : f1 ? f1->mean : 2;  // no F1 is below 0
    order.emplace_back(place, scenario.name);
  }
  std::ranges::stable_sort(order, {}, &std::pair<double, std::string>::first);
  std::set<std::string> names;
  for (const auto& [place, name] : order) {
    if (names.size() < kMostWhole) names.insert(name);
  }
  return names;
}

/// The mean F1 of each scenario by other detectors.
files::Json beside_json(std::span<const SuiteResult> others) {
  files::Json all = files::Json::array();
  for (const SuiteResult& other : others) {
    files::Json f1 = files::Json::object();
    for (const ScenarioResult& scenario : other.scenarios) {
      if (const auto spread = suite::over_seeds(scenario, scoring::kF1))
        f1[scenario.name] = spread->mean;
    }
    all.push_back({{"detector", other.detector}, {"f1", f1}});
  }
  return all;
}

/// The page's data. The budget limits only the pictures.
files::Json data_of(const SuiteInFolder& suite, const suite::SuiteVerdict& verdict,
                    const Against* against, std::size_t budget) {
  const SuiteInFolder* baseline = against ? &against->baseline : nullptr;
  const suite::Comparison* comparison = against ? &against->comparison : nullptr;
  const DifferenceOf of_groups = comparison ? by_name(comparison->groups) : DifferenceOf{};
  const DifferenceOf of_scenarios = comparison ? by_name(comparison->differences) : DifferenceOf{};
  files::Json data = {
      {"verdict", verdict.line},
      {"light", suite::word_of(verdict.light)},
      {"run_counts", suite::run_counts(suite.suite)},
      {"note", verdict.note},
      {"remarks", remarks_of(verdict)},
      {"more_remarks", std::max<std::ptrdiff_t>(0, std::ssize(verdict.remarks) - kMostRemarks)},
      {"not_compared", files::Json::array()},
      {"detector", suite.suite.detector},
      {"version", suite.suite.version},
      {"sets", suite.suite.sets},
      {"recorded", suite.suite.recorded},
      {"baseline", nullptr},
      {"is_run", false},
      {"metrics", metrics_json()},
      {"columns", scoring::keys_in(scoring::Table::report)},
      {"groups", groups_of(suite.suite, of_groups)},
      {"scenarios", files::Json::array()}};
  if (baseline) {
    data["not_compared"] = comparison->incomparable;
    data["baseline"] = {{"detector", baseline->suite.detector},
                        {"version", baseline->suite.version},
                        {"sets", baseline->suite.sets},
                        {"level", comparison->level},
                        {"folder", baseline->folder.generic_string()}};
  }
  const std::set<std::string> whole = shown_whole(suite.suite, verdict);
  for (const ScenarioResult& scenario : suite.suite.scenarios) {
    data["scenarios"].push_back(
        scenario_json(suite, baseline, of_scenarios, scenario, whole.contains(scenario.name)));
    data["scenarios"].back()["standings"] = words_of(suite::standings_of(scenario, comparison));
  }
  keep_to_budget(data["scenarios"], budget);
  return data;
}

}  // namespace

std::string report_data(const SuiteInFolder& suite, const suite::SuiteVerdict& verdict,
                        const Against* against, std::size_t picture_budget,
                        std::span<const SuiteResult> others) {
  files::Json data = data_of(suite, verdict, against, picture_budget);
  data["beside"] = beside_json(others);
  return files::json_text(data);
}

std::string run_report_data(const SuiteInFolder& suite, const files::Json& explained) {
  files::Json data =
      data_of(suite, suite::verdict_of(suite, nullptr, nullptr), nullptr, kPictureBudget);
  data["is_run"] = true;
  data["explained"] = explained;
  const fs::path video = suite.folder / output::kVideoFile;
  if (fs::exists(video) && fs::file_size(video) > kVideoBudget) {
    data["video_left_out_mb"] = fs::file_size(video) / 1'000'000;
  } else if (fs::exists(video)) {
    constexpr input::FileKind kVideo{kVideoBudget, "run the scenario again"};
    data["video"] = scoring::base64(input::read_file(video, kVideo));
  }
  return files::json_text(data);
}

void write_report(const std::filesystem::path& file, const suite::SuiteInFolder& suite,
                  const suite::SuiteVerdict& verdict, const Against* against,
                  std::span<const SuiteResult> others) {
  const std::string title = "lcs suite: " + suite.suite.detector;
  const std::string data = report_data(suite, verdict, against, kPictureBudget, others);
  write_page(file,
             {.title = title, .data = data, .script = kReportJs, .where_else = suite::kSuiteFile});
}

void write_run_report(const std::filesystem::path& file, const suite::SuiteInFolder& suite,
                      const files::Json& explained) {
  const std::string title = "lcs run: " + suite.suite.scenarios.at(0).name;
  const std::string data = run_report_data(suite, explained);
  write_page(
      file,
      {.title = title, .data = data, .script = kReportJs, .where_else = scoring::kMetricsFile});
}

}  // namespace lcs::report
