#include "tools/suite/suite_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string_view>

#include "tools/bench/output_file.h"

namespace lcs::suite {
namespace {

using Json = nlohmann::ordered_json;

/// Of the file's form; another number is another form.
constexpr int kFormat = 1;
constexpr std::array<std::string_view, 3> kOutcomes{"passed", "failed", "error"};

// ---- Writing

Json to_json(std::optional<double> figure) {
  return figure && std::isfinite(*figure) ? Json(*figure) : Json(nullptr);
}

Json to_json(const CriterionResult& criterion) {
  return {{"metric", criterion.metric},     {"min", to_json(criterion.min)},
          {"max", to_json(criterion.max)},  {"value", to_json(criterion.value)},
          {"required", criterion.required}, {"met", criterion.met},
          {"message", criterion.message}};
}

Json to_json(const RunResult& run) {
  Json metrics = Json::object();
  for (const auto& [name, figure] : run.metrics) metrics[name] = to_json(figure);
  Json criteria = Json::array();
  for (const CriterionResult& criterion : run.criteria) criteria.push_back(to_json(criterion));
  return {{"seed", run.seed},
          {"outcome", kOutcomes.at(static_cast<std::size_t>(run.outcome))},
          {"error", run.error},
          {"folder", run.folder.generic_string()},
          {"wall_s", to_json(run.wall_s)},
          {"criteria", criteria},
          {"metrics", metrics}};
}

Json to_json(const ScenarioResult& scenario) {
  Json point = Json::array();  // of pairs: an object would be one key short where a key comes twice
  for (const auto& [key, value] : scenario.point) point.push_back(Json::array({key, value}));
  Json runs = Json::array();
  for (const RunResult& run : scenario.runs) runs.push_back(to_json(run));
  return {{"name", scenario.name},
          {"purpose", scenario.purpose},
          {"file", scenario.file.generic_string()},
          {"groups", scenario.groups},
          {"point", point},
          {"runs", runs}};
}

// ---- Reading

/// A value that knows where in the file it is.
class Node {
 public:
  Node(const Json& json, std::string path) : json_(json), path_(std::move(path)) {}

  Node operator[](const char* key) const {
    require(json_.is_object(), "an object");
    const auto found = json_.find(key);
    const std::string path = path_.empty() ? key : path_ + "." + key;
    if (found == json_.end()) throw std::runtime_error(path + " is missing");
    return {*found, path};
  }

  bool has(const char* key) const { return json_.is_object() && json_.contains(key); }

  /// Calls `use(node)` for every item.
  template <class Use>
  void each(const Use& use) const {
    require(json_.is_array(), "a list");
    for (std::size_t i = 0; i < json_.size(); ++i) {
      use(Node(json_[i], fmt::format("{}[{}]", path_, i)));
    }
  }
  /// Calls `use(key, node)` for every entry, in the order of the file.
  template <class Use>
  void each_entry(const Use& use) const {
    require(json_.is_object(), "an object");
    for (const auto& [key, value] : json_.items()) use(key, Node(value, path_ + "." + key));
  }

  std::string text() const {
    require(json_.is_string(), "a text");
    return json_.get<std::string>();
  }
  bool flag() const {
    require(json_.is_boolean(), "true or false");
    return json_.get<bool>();
  }
  std::uint64_t natural() const {
    require(json_.is_number_unsigned(), "a whole number from 0");
    return json_.get<std::uint64_t>();
  }
  std::optional<double> figure() const {
    require(json_.is_number() || json_.is_null(), "a number or null");
    return json_.is_null() ? std::nullopt : std::optional(json_.get<double>());
  }
  Outcome outcome() const {
    const auto found = std::find(kOutcomes.begin(), kOutcomes.end(), text());
    require(found != kOutcomes.end(), "passed, failed or error");
    return static_cast<Outcome>(found - kOutcomes.begin());
  }
  std::vector<std::string> texts() const {
    std::vector<std::string> all;
    each([&](const Node& item) { all.push_back(item.text()); });
    return all;
  }
  std::pair<std::string, std::string> pair() const {
    const std::vector<std::string> both = texts();
    require(both.size() == 2, "a key and a value");
    return {both[0], both[1]};
  }

 private:
  void require(bool condition, const char* what) const {
    if (condition) return;
    const std::string_view place = path_.empty() ? "the file" : std::string_view(path_);
    throw std::runtime_error(fmt::format("{} is not {}", place, what));
  }

  const Json& json_;
  std::string path_;
};

CriterionResult criterion_of(const Node& node) {
  return {.metric = node["metric"].text(),
          .min = node["min"].figure(),
          .max = node["max"].figure(),
          .value = node["value"].figure(),
          .required = node["required"].flag(),
          .met = node["met"].flag(),
          .message = node["message"].text()};
}

RunResult run_of(const Node& node) {
  RunResult run;
  run.seed = node["seed"].natural();
  run.outcome = node["outcome"].outcome();
  run.error = node["error"].text();
  run.folder = node["folder"].text();
  run.wall_s = node["wall_s"].figure().value_or(0);
  node["criteria"].each([&](const Node& item) { run.criteria.push_back(criterion_of(item)); });
  node["metrics"].each_entry([&](const std::string& name, const Node& figure) {
    run.metrics.emplace_back(name, figure.figure());
  });
  return run;
}

ScenarioResult scenario_of(const Node& node) {
  ScenarioResult scenario;
  scenario.name = node["name"].text();
  scenario.purpose = node["purpose"].text();
  scenario.file = node["file"].text();
  scenario.groups = node["groups"].texts();
  node["point"].each([&](const Node& item) { scenario.point.push_back(item.pair()); });
  node["runs"].each([&](const Node& item) { scenario.runs.push_back(run_of(item)); });
  return scenario;
}

SuiteResult suite_of(const Node& node) {
  const std::uint64_t format = node["format"].natural();
  if (format != kFormat) {
    throw std::runtime_error(fmt::format(
        "its format is {}, this program reads {}; run the suite again", format, kFormat));
  }
  SuiteResult suite;
  suite.detector = node["detector"].text();
  suite.sets = node["sets"].texts();
  suite.version = node["version"].text();
  if (node.has("recorded")) suite.recorded = node["recorded"].text();
  std::set<std::string> names;
  node["scenarios"].each([&](const Node& item) {
    suite.scenarios.push_back(scenario_of(item));
    const std::string& name = suite.scenarios.back().name;
    if (!names.insert(name).second) throw std::runtime_error("two scenarios are called " + name);
  });
  return suite;
}

}  // namespace

void write_suite(const std::filesystem::path& file, const SuiteResult& suite) {
  Json scenarios = Json::array();
  for (const ScenarioResult& scenario : suite.scenarios) scenarios.push_back(to_json(scenario));
  const Json json{{"format", kFormat},          {"detector", suite.detector},
                  {"sets", suite.sets},         {"version", suite.version},
                  {"recorded", suite.recorded}, {"scenarios", scenarios}};
  bench::OutputFile output(file);
  // What a child wrote to stderr need not be UTF-8; JSON is.
  output.write(json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
  output.close();
}

SuiteResult read_suite(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path file =
      std::filesystem::is_directory(path, error) ? path / kSuiteFile : path;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw std::runtime_error(fmt::format("there is no file {}", file.string()));
  }
  std::ifstream input(file);
  if (!input) throw std::runtime_error(fmt::format("cannot read {}", file.string()));
  try {
    const Json json = Json::parse(input);
    return suite_of({json, ""});
  } catch (const Json::parse_error& failure) {
    throw std::runtime_error(fmt::format("{}: not JSON at byte {}", file.string(), failure.byte));
  } catch (const std::exception& failure) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), failure.what()));
  }
}

}  // namespace lcs::suite
