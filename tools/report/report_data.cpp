#include "tools/report/report_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "scenarios/input_file.h"
#include "tools/bench/csv.h"
#include "tools/bench/events.h"
#include "tools/bench/report.h"
#include "tools/suite/metric_traits.h"
#include "tools/suite/summary.h"

namespace lcs::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using suite::RunResult;
using suite::ScenarioResult;
using suite::SuiteResult;

constexpr std::array<const char*, 3> kOutcomes{"passed", "failed", "error"};
constexpr std::array<const char*, 3> kDirections{"higher", "lower", "neutral"};

/// Columns of frames.csv that are plotted.
constexpr std::array<const char*, 10> kColumns{
    "t_s",           "precision", "recall",    "normal_edges", "rebel_edges", "normal_circles",
    "rebel_circles", "squares",   "dimension", "corners"};

Json json_of(std::optional<double> figure) {
  return figure && std::isfinite(*figure) ? Json(*figure) : Json(nullptr);
}

// ---- Figures

std::vector<std::string> figure_names() {
  std::vector<std::string> names;
  for (const suite::MetricTraits& traits : suite::metric_traits()) names.emplace_back(traits.name);
  names.emplace_back(suite::kSizeShare);
  return names;
}

Json figure_traits() {
  Json all = Json::object();
  for (const std::string& name : figure_names()) {
    const bool is_size = name == suite::kSizeShare;
    const suite::MetricTraits traits = suite::traits_of(is_size ? "dimension.mean" : name);
    all[name] = {{"direction", kDirections[static_cast<std::size_t>(traits.direction)]},
                 {"least_change", is_size ? 0.01 : traits.least_change},
                 {"least_share", traits.least_share}};
  }
  return all;
}

/// The suite beside a baseline, as far as both have the same scenarios and seeds: with others, a
/// change would be of what was run and not of the filter.
struct Baseline {
  Baseline(const SuiteResult& suite, const SuiteResult& baseline)
      : before(suite::in_common(baseline, suite)), after(suite::in_common(suite, baseline)) {}
  SuiteResult before, after;
};

/// What a figure was, and by how much it changed, where that is known.
void add_change(Json& figure, std::optional<double> before, std::optional<double> after) {
  if (before) figure["before"] = *before;
  if (before && after) figure["change"] = *after - *before;
}

Json figures_of(const ScenarioResult& scenario, const Baseline* baseline) {
  Json figures = Json::object();
  for (const std::string& name : figure_names()) {
    const auto now = suite::over_seeds(scenario, name);
    const auto before =
        baseline ? suite::mean_over_seeds(baseline->before, scenario.name, name) : std::nullopt;
    if (!now && !before) continue;
    Json& figure = figures[name] = Json::object();
    figure["mean"] = now ? Json(now->mean) : Json(nullptr);
    if (now && now->count > 1) figure["spread"] = now->half;
    if (baseline)
      add_change(figure, before, suite::mean_over_seeds(baseline->after, scenario.name, name));
  }
  return figures;
}

Json groups_of(const SuiteResult& suite, const Baseline* baseline) {
  Json groups = Json::array();
  for (const std::string& group : suite::groups_of(suite)) {
    const std::int64_t members = suite::count_in(suite, group);
    Json figures = Json::object();
    for (const std::string& name : figure_names()) {
      const auto now = suite::over_group(suite, group, name);
      const auto before =
          baseline ? suite::over_group(baseline->before, group, name) : std::nullopt;
      if (!now && !before) continue;
      figures[name] = {{"mean", json_of(now)}};
      if (baseline) {
        add_change(figures[name], before, suite::over_group(baseline->after, group, name));
      }
    }
    groups.push_back({{"name", group}, {"scenarios", members}, {"figures", figures}});
  }
  return groups;
}

// ---- Runs

Json criteria_of(const RunResult& run) {
  Json criteria = Json::array();
  for (const suite::CriterionResult& criterion : run.criteria) {
    criteria.push_back({{"metric", criterion.metric},
                        {"min", json_of(criterion.min)},
                        {"max", json_of(criterion.max)},
                        {"value", json_of(criterion.value)},
                        {"required", criterion.required},
                        {"met", criterion.met}});
  }
  return criteria;
}

/// To five digits, as the plots have fewer pixels than that; none for an empty cell.
Json number_of(std::string_view cell) {
  if (cell.empty()) return nullptr;
  const std::optional<double> number = bench::number_in<double>(cell);
  if (!number) throw std::invalid_argument(fmt::format("'{}' is not a number", cell));
  return Json::parse(fmt::format("{:.5g}", *number));
}

Json frames_of(const fs::path& file) {
  // Some 200 bytes a frame.
  constexpr scenario::FileKind kFramesTable{scenario::kGibibyte, "run the suite again"};
  scenario::InputFile input(file, kFramesTable);
  std::string line;
  input.next_line(line);
  const std::string header_line = line;
  const std::vector<std::string_view> header = bench::fields_of(header_line);
  Json columns = Json::object();
  for (const char* name : kColumns) {
    if (std::find(header.begin(), header.end(), name) == header.end()) {
      throw scenario::Error({file.string(), 1},
                            fmt::format("has no column {}; {}", name, kFramesTable.remedy));
    }
    columns[name] = Json::array();
  }
  while (input.next_line(line)) {
    std::vector<std::string_view> cells = bench::fields_of(line);
    cells.resize(std::max(cells.size(), header.size()));
    for (std::size_t i = 0; i < header.size(); ++i) {
      const auto column = columns.find(std::string(header[i]));
      if (column == columns.end()) continue;
      try {
        column->push_back(number_of(cells[i]));
      } catch (const std::invalid_argument& error) {
        throw scenario::Error(input.here(),
                              fmt::format("{}; {}", error.what(), kFramesTable.remedy));
      }
    }
  }
  return columns;
}

Json event_json(const bench::Event& event) {
  Json reasons = Json::array();
  for (const auto& [reason, corners] : event.reasons) {
    reasons.push_back({{"word", text_of(reason).word},
                       {"meaning", text_of(reason).meaning},
                       {"corners", corners}});
  }
  Json views = Json::array();
  for (const bench::EventView& view : event.views) {
    views.push_back({{"frame", view.frame}, {"t_s", view.t_s}, {"jpeg", view.jpeg_base64}});
  }
  return {{"kind", text_of(event.kind).word},
          {"meaning", text_of(event.kind).meaning},
          {"first", event.first_frame},
          {"last", event.last_frame},
          {"object", event.object_name},
          {"corners", event.corners},
          {"of", event.of},
          {"circles", event.circles},
          {"reasons", reasons},
          {"views", views}};
}

Json run_json(const RunResult& run, const fs::path& suite_folder) {
  Json json = {{"seed", run.seed},
               {"outcome", kOutcomes[static_cast<std::size_t>(run.outcome)]},
               {"error", run.error},
               {"wall_s", json_of(run.wall_s)},
               {"command", run.command},
               {"criteria", criteria_of(run)},
               {"warnings", bench::lines_of(run.warnings)},
               {"metrics", Json::object()},
               {"frames", nullptr},
               {"events", nullptr}};
  for (const std::string& name : figure_names()) {
    if (const auto figure = suite::figure_of(run, name)) json["metrics"][name] = *figure;
  }
  if (run.folder.empty()) return json;
  const fs::path folder = suite_folder / run.folder;
  if (fs::exists(folder / bench::kFramesFile)) {
    json["frames"] = frames_of(folder / bench::kFramesFile);
  }
  if (fs::exists(folder / bench::kEventsFile)) {
    json["events"] = Json::array();
    for (const bench::Event& event : bench::read_events(folder / bench::kEventsFile)) {
      json["events"].push_back(event_json(event));
    }
  }
  return json;
}

/// Takes pictures away until the rest fits: first those of the least costly events of later seeds.
void keep_to_budget(Json& scenarios, std::size_t budget) {
  struct Strip {
    std::size_t turn;  // of its event in its run, and of the run in its scenario
    Json* event;
  };
  std::vector<Strip> strips;
  for (Json& scenario : scenarios) {
    for (std::size_t r = 0; r < scenario["runs"].size(); ++r) {
      Json& events = scenario["runs"][r]["events"];
      for (std::size_t e = 0; e < events.size(); ++e) strips.push_back({e + 2 * r, &events[e]});
    }
  }
  std::stable_sort(strips.begin(), strips.end(),
                   [](const Strip& a, const Strip& b) { return a.turn < b.turn; });
  std::size_t used = 0;
  for (const Strip& strip : strips) {
    std::size_t size = 0;
    for (const Json& view : (*strip.event)["views"]) {
      size += view["jpeg"].get_ref<const std::string&>().size();
    }
    if (used + size <= budget) {
      used += size;
      continue;
    }
    for (Json& view : (*strip.event)["views"]) view["jpeg"] = "";
    (*strip.event)["left_out"] = true;
  }
}

Json scenario_json(const ScenarioResult& scenario, const Baseline* baseline,
                   const fs::path& suite_folder) {
  Json json = {{"name", scenario.name},
               {"purpose", scenario.purpose},
               {"file", scenario.file.generic_string()},
               {"groups", scenario.groups},
               {"point", Json::array()},
               {"outcome", kOutcomes[static_cast<std::size_t>(suite::outcome_of(scenario))]},
               {"figures", figures_of(scenario, baseline)},
               {"runs", Json::array()}};
  for (const auto& [key, value] : scenario.point) {
    json["point"].push_back(Json::array({key, value}));
  }
  for (const RunResult& run : scenario.runs) {
    json["runs"].push_back(run_json(run, suite_folder));
  }
  return json;
}

}  // namespace

std::string report_data(const SuiteResult& suite, const SuiteResult* baseline,
                        const fs::path& suite_folder, std::size_t picture_budget) {
  std::optional<Baseline> both;
  if (baseline) both.emplace(suite, *baseline);
  const Baseline* beside = both ? &*both : nullptr;
  Json data = {{"detector", suite.detector},
               {"version", suite.version},
               {"sets", suite.sets},
               {"recorded", suite.recorded},
               {"baseline", nullptr},
               {"traits", figure_traits()},
               {"groups", groups_of(suite, beside)},
               {"scenarios", Json::array()}};
  if (baseline) {
    data["baseline"] = {
        {"detector", baseline->detector}, {"version", baseline->version}, {"sets", baseline->sets}};
  }
  for (const ScenarioResult& scenario : suite.scenarios) {
    data["scenarios"].push_back(scenario_json(scenario, beside, suite_folder));
  }
  keep_to_budget(data["scenarios"], picture_budget);

  // Names and messages may hold any bytes, JSON only UTF-8.
  return data.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace lcs::report
