#include "tools/suite/suite_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "scenarios/input/inputs_read.h"
#include "tools/files/json_node.h"
#include "tools/files/output_file.h"

namespace lcs::suite {
namespace {

/// Version of the file format.
constexpr int kFormat = 1;
constexpr std::array<const char*, 3> kOutcomes{"passed", "failed", "error"};

// ---- Writing

files::Json to_json(const RunResult& run) {
  files::Json metrics = files::Json::object();
  for (const auto& [name, figure] : run.metrics) metrics[name] = files::number_or_null(figure);
  files::Json warnings = files::Json::object();
  for (const recording::Warned& warned : run.warnings) {
    warnings[warned.word] = {{"count", warned.count.value_or(0)}, {"first", warned.text}};
  }
  return {{"seed", run.seed},
          {"outcome", word_of(run.outcome)},
          {"command", run.command},
          {"error", run.error},
          {"folder", run.folder.generic_string()},
          {"wall_s", files::number_or_null(run.wall_s)},
          {"criteria", criteria_json(run)},
          {"warnings", warnings},
          {"metrics", metrics}};
}

files::Json to_json(const ScenarioResult& scenario) {
  files::Json runs = files::Json::array();
  for (const RunResult& run : scenario.runs) runs.push_back(to_json(run));
  files::Json json{{"name", scenario.name},
                   {"purpose", scenario.purpose},
                   {"file", scenario.file.generic_string()},
                   {"groups", scenario.groups},
                   {"point", scenario.point},  // a list of pairs, because a key may occur twice
                   {"runs", runs}};
  if (scenario.drawn) {
    json["drawn"] = {{"family", scenario.drawn->family},
                     {"again", scenario.drawn->again},
                     {"features", scenario.drawn->features}};
  }
  return json;
}

files::Json to_json(const PartOf& part) {
  files::Json whole = files::Json::array();
  for (const auto& [name, seeds] : part.whole) whole.push_back({{"name", name}, {"seeds", seeds}});
  return {{"part", part.shard.part}, {"parts", part.shard.parts}, {"whole", whole}};
}

// ---- Reading

using Node = files::JsonNode;

/// A text that names a folder or file of the suite.
std::string name_of(const Node& node) {
  std::string name = node.text();
  node.require(files::is_inner(name) && name.find('/') == name.npos, "a name without '/'");
  return name;
}

Outcome outcome_of(const Node& node) {
  const auto found = std::find(kOutcomes.begin(), kOutcomes.end(), node.text());
  node.require(found != kOutcomes.end(), "passed, failed or error");
  return static_cast<Outcome>(found - kOutcomes.begin());
}

std::pair<std::string, std::string> pair_of(const Node& node) {
  const std::vector<std::string> both = node.texts();
  node.require(both.size() == 2, "a key and a value");
  return {both[0], both[1]};
}

scoring::JudgedCriterion criterion_of(const Node& node) {
  return {.metric = node["metric"].text(),
          .min = node["min"].figure(),
          .max = node["max"].figure(),
          .value = node["value"].figure(),
          .required = node["required"].flag(),
          .met = node["met"].flag(),
          .over = node.has("over") ? node["over"].text() : "seed",
          .place = node.has("place") ? node["place"].text() : "",
          .message = node["message"].text()};
}

RunResult run_of(const Node& node) {
  RunResult run;
  run.seed = node["seed"].natural();
  run.outcome = outcome_of(node["outcome"]);
  if (node.has("command")) run.command = node["command"].text();
  run.error = node["error"].text();
  run.folder = node["folder"].text();
  node["folder"].require(run.folder.empty() || files::is_inner(run.folder),
                         "a folder inside of the suite's");
  run.wall_s = node["wall_s"].figure().value_or(0);
  node["criteria"].each([&](const Node& item) { run.criteria.push_back(criterion_of(item)); });
  if (node.has("warnings")) {
    node["warnings"].each_entry([&](const std::string& word, const Node& warned) {
      run.warnings.push_back(
          {word, static_cast<std::int64_t>(warned["count"].natural()), warned["first"].text()});
    });
  }
  node["metrics"].each_entry([&](const std::string& name, const Node& figure) {
    run.metrics.emplace_back(name, figure.figure());
  });
  return run;
}

ScenarioResult scenario_of(const Node& node) {
  ScenarioResult scenario;
  scenario.name = name_of(node["name"]);
  scenario.purpose = node["purpose"].text();
  scenario.file = node["file"].text();
  scenario.groups = node["groups"].texts();
  node["point"].each([&](const Node& item) { scenario.point.push_back(pair_of(item)); });
  if (node.has("drawn")) {
    const Node drawn = node["drawn"];
    scenario.drawn = {drawn["family"].text(), drawn["again"].natural(), drawn["features"].texts()};
  }
  std::set<std::uint64_t> seeds;
  node["runs"].each([&](const Node& item) {
    scenario.runs.push_back(run_of(item));
    const std::uint64_t seed = scenario.runs.back().seed;
    if (!seeds.insert(seed).second) {
      throw Node::Error(fmt::format("{} has two runs of seed {}", scenario.name, seed));
    }
  });
  return scenario;
}

PartOf part_of(const Node& node) {
  PartOf part;
  const std::uint64_t number = node["part"].natural(), parts = node["parts"].natural();
  node.require(1 <= number && number <= parts && parts <= 1'000'000, "a part of its parts");
  part.shard = {static_cast<int>(number), static_cast<int>(parts)};
  node["whole"].each([&](const Node& item) {
    std::vector<std::uint64_t>& seeds = part.whole.emplace_back(item["name"].text(), 0).second;
    item["seeds"].each([&](const Node& seed) { seeds.push_back(seed.natural()); });
  });
  return part;
}

SuiteResult suite_of(const Node& node) {
  const std::uint64_t format = node["format"].natural();
  if (format != kFormat) {
    throw Node::Error(fmt::format("its format is {}, this program reads {}", format, kFormat));
  }
  SuiteResult suite;
  suite.detector = node["detector"].text();
  suite.sets = node["sets"].texts();
  suite.version = node["version"].text();
  if (node.has("recorded")) suite.recorded = node["recorded"].text();
  if (node.has("beside")) {
    node["beside"].each([&](const Node& name) { suite.beside.push_back(name_of(name)); });
  }
  if (node.has("split")) suite.split = node["split"].text();
  if (node.has("part_of")) suite.part_of = part_of(node["part_of"]);
  if (node.has("sequential")) {
    const Node looked = node["sequential"];
    const double level = looked["level"].number();
    looked["level"].require(level > 0 && level < 1, "a probability");
    suite.sequential = {{looked["runs"].natural(), level}, looked["planned"].natural()};
  }
  std::set<std::string> names;
  node["scenarios"].each([&](const Node& item) {
    suite.scenarios.push_back(scenario_of(item));
    const std::string& name = suite.scenarios.back().name;
    if (!names.insert(name).second) throw Node::Error("two scenarios are called " + name);
  });
  return suite;
}

}  // namespace

const char* word_of(Outcome outcome) {
  return kOutcomes.at(static_cast<std::size_t>(outcome));
}

files::Json criteria_json(const RunResult& run) {
  files::Json criteria = files::Json::array();
  for (const scoring::JudgedCriterion& criterion : run.criteria) {
    criteria.push_back({{"metric", criterion.metric},
                        {"min", files::number_or_null(criterion.min)},
                        {"max", files::number_or_null(criterion.max)},
                        {"value", files::number_or_null(criterion.value)},
                        {"required", criterion.required},
                        {"met", criterion.met},
                        {"over", criterion.over},
                        {"place", criterion.place},
                        {"message", criterion.message}});
  }
  return criteria;
}

void write_suite(const std::filesystem::path& file, const SuiteResult& suite) {
  files::Json scenarios = files::Json::array();
  for (const ScenarioResult& scenario : suite.scenarios) scenarios.push_back(to_json(scenario));
  files::Json json{{"format", kFormat},
                   {"detector", suite.detector},
                   {"sets", suite.sets},
                   {"version", suite.version},
                   {"recorded", suite.recorded}};
  if (!suite.beside.empty()) json["beside"] = suite.beside;
  if (!suite.split.empty()) json["split"] = suite.split;
  if (suite.part_of) json["part_of"] = to_json(*suite.part_of);
  if (suite.sequential) {
    json["sequential"] = {{"runs", suite.sequential->look.runs},
                          {"planned", suite.sequential->planned},
                          {"level", suite.sequential->look.level}};
  }
  json["scenarios"] = std::move(scenarios);
  // A child's stderr may be invalid UTF-8, which JSON forbids.
  files::write_file(file, files::json_text(json, 1) + '\n');
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return path;
  return path.has_parent_path() ? path.parent_path() : ".";
}

SuiteResult read_suite(const std::filesystem::path& path) {
  constexpr input::FileKind kSuiteDocument{
      files::kMostJsonBytes, "name the folder of a suite, or its suite.json; lcs suite makes one"};
  std::error_code error;
  const bool is_folder = std::filesystem::is_directory(path, error);
  if (is_folder) input::note_input(path);
  return files::read_json(is_folder ? path / kSuiteFile : path, kSuiteDocument, suite_of);
}

}  // namespace lcs::suite
