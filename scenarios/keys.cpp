#include "scenarios/keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/written.h"

namespace lcs::scenario {
namespace {

using Json = nlohmann::ordered_json;
using Names = std::vector<std::string_view>;

struct Row {
  std::string key;
  std::string_view meaning;
  std::string without;
  std::string takes;
};

/// The accepted values of a key, in words and as a schema, and the keys of its map, if it is a map.
struct Kind {
  std::string takes;
  Json schema;
  std::vector<Row> rows = {};
};

/// In the schema, a number is in the base unit; a text may have any unit of the dimension.
Kind kind_of(const input::Quantity& quantity, double) {
  const auto [low, high, low_open, high_open] = quantity.range;
  Json number{{"type", "number"}};
  if (std::isfinite(low)) number[low_open ? "exclusiveMinimum" : "minimum"] = low;
  if (std::isfinite(high)) number[high_open ? "exclusiveMaximum" : "maximum"] = high;
  std::string units;
  for (const char c : fmt::format("{}", fmt::join(input::units_of(quantity.dimension), "|"))) {
    if (c == '^') units += '\\';
    units += c;
  }
  const std::string pattern =
      fmt::format("^ *{}([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][+-]?[0-9]+)?{} *$", low < 0 ? "-?" : "",
                  units.empty() ? "" : fmt::format(" *({})?", units));
  return {input::range_text(quantity),
          {{"anyOf", {number, {{"type", "string"}, {"pattern", pattern}}}}}};
}

Kind kind_of(const Whole& form, std::integral auto) {
  return {fmt::format("{} to {}", form.low, form.high),
          {{"type", "integer"}, {"minimum", form.low}, {"maximum", form.high}}};
}

Kind kind_of(Plain, std::uint64_t) {
  return {"0 to 2^64-1", {{"type", "integer"}, {"minimum", 0}}};
}

Kind kind_of(Plain, bool) {
  return {"false or true", {{"type", "boolean"}}};
}

Kind kind_of(const auto&, const std::string&) {
  return {"a text", {{"type", "string"}, {"minLength", 1}}};
}

Kind kind_of(const Words& form, const std::string&) {
  return {fmt::format("{}", fmt::join(form.words, ", ")), {{"enum", form.words}}};
}

Kind kind_of(const Words& form, Enumeration auto) {
  return kind_of(form, std::string());
}

Kind kind_of(const OwnFileOr& form, Enumeration auto) {
  const Kind words = kind_of(Words{form.words}, std::string());
  return {fmt::format("{}, a path", words.takes),
          {{"anyOf", {words.schema, {{"type", "string"}, {"pattern", "[.]xml$"}}}}}};
}

Kind kind_of(const auto&, const std::filesystem::path&) {
  return {"must exist", {{"type", "string"}, {"minLength", 1}}};
}

Kind kind_of(const FramesBefore&, int) {
  return kind_of(kDuration, 0.0);
}

Kind array_of(const Kind& item, std::size_t least, std::size_t most = 0) {
  Json schema{{"type", "array"}, {"items", item.schema}, {"minItems", least}};
  if (most > 0) schema["maxItems"] = most;
  return {fmt::format("each {}", item.takes), schema};
}

template <class Number, int N, class Form>
Kind kind_of(const Form& form, const Eigen::Matrix<Number, N, 1>&) {
  return array_of(kind_of(form, Number{}), N, N);
}

Kind kind_of(const input::Quantity& quantity, const Eigen::Matrix3d&) {
  return array_of(kind_of(quantity, Eigen::Vector3d()), 3, 3);
}

Kind kind_of(Plain, const HasFields auto& object);

/// The rows with the name of their place in a list, for example "phases.N.at".
std::vector<Row> rows_in(const std::vector<Row>& rows, std::string_view place) {
  std::vector<Row> all;
  for (Row row : rows) {
    row.key = fmt::format("{}.{}", place, row.key);
    all.push_back(row);
  }
  return all;
}

Kind kind_of(const OneOrTwo& form, const Eigen::Vector2d& pair) {
  Kind kind = kind_of(form.quantity, 0.0);
  kind.schema = {{"anyOf", {kind.schema, kind_of(form.quantity, pair).schema}}};
  return kind;
}

Kind kind_of(Plain, const Distortion&) {
  const Kind number = kind_of(kCoefficient, 0.0);
  const Json fisheye{{"type", "object"},
                     {"additionalProperties", false},
                     {"properties", {{"equidistant", array_of(number, 4, 4).schema}}},
                     {"required", {"equidistant"}}};
  return {fmt::format("each {}", number.takes),
          {{"anyOf", {array_of(number, 5, 5).schema, fisheye}}}};
}

/// Two or more lists, each of one number of each of these quantities.
Kind path_of(const std::vector<input::Quantity>& quantities) {
  Json items = Json::array();
  for (const input::Quantity& quantity : quantities) items.push_back(kind_of(quantity, 0.0).schema);
  const std::size_t count = items.size();
  const Json point{{"type", "array"}, {"items", items}, {"minItems", count}, {"maxItems", count}};
  return {"a list", array_of({"", point}, 2).schema};
}

Kind kind_of(Plain, const TimeSpan&) {
  return array_of(kind_of(kDuration, 0.0), 2, 2);
}

Kind kind_of(Plain, const std::vector<Waypoint>&) {
  return path_of({kTime, kPosition, kPosition});
}

Kind kind_of(Plain, const std::vector<PathPose>&) {
  return path_of({kTime, kPosition, kPosition, kPosition, kAngle, kAngle, kAngle});
}

Kind kind_of(Plain, const Waypoints& waypoints) {
  return kind_of(Plain{}, waypoints.points);
}

Kind kind_of(GroupNames, const std::vector<std::string>&) {
  const Json name{{"type", "string"}, {"pattern", "^[a-z0-9_-]+$"}};
  return {"a-z, 0-9, _, -",
          {{"type", "array"}, {"items", name}, {"minItems", 1}, {"uniqueItems", true}}};
}

Kind kind_of(GroupList, const std::vector<int>&) {
  Kind groups = array_of(kind_of(Whole{0, 5}, 0), 1, 6);
  groups.schema["uniqueItems"] = true;
  return groups;
}

Kind kind_of(const FilterParameters&, const std::vector<FilterSetting>&) {
  return {
      "a map",
      {{"type", "object"}, {"additionalProperties", {{"type", {"number", "string", "boolean"}}}}}};
}

Kind kind_of(Plain, const std::vector<SweptKey>&) {
  return {"a map of lists",
          {{"type", "object"},
           {"minProperties", 1},
           {"additionalProperties", {{"type", "array"}, {"minItems", 1}, {"uniqueItems", true}}}}};
}

Kind kind_of(Plain, const std::vector<Actor>&) {
  const Kind actor = kind_of(Plain{}, Actor{});
  return {"a map",
          {{"type", "object"},
           {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}, {"not", {{"const", "ego"}}}}},
           {"additionalProperties", actor.schema}},
          rows_in(actor.rows, "NAME")};
}

Kind kind_of(Plain, const std::vector<RigCamera>&) {
  const Kind camera = kind_of(Plain{}, default_scenario().camera);
  return {"a map",
          {{"type", "object"},
           {"minProperties", 1},
           {"maxProperties", kMostCameras},
           {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}}},
           {"additionalProperties", camera.schema}}};
}

template <class Form, class T>
Kind kind_of(const Form& form, const std::optional<T>&) {
  return kind_of(form, T{});
}

template <class Form, class T>
Kind kind_of(const OrWord<Form>& form, const std::optional<T>&) {
  Kind kind = kind_of(form.form, T{});
  kind.takes += fmt::format(" or {}", form.word);
  kind.schema = {{"anyOf", {{{"const", form.word}}, kind.schema}}};
  return kind;
}

template <class Form, class T>
Kind kind_of(const Form& form, const std::vector<T>&) {
  const auto usual = std::make_unique<T>();  // GCC 12 warns of a temporary's destructor
  const Kind item = kind_of(form, *usual);
  return {"a list", array_of(item, 0).schema, rows_in(item.rows, "N")};
}

Json given(std::string_view key) {
  return {{"required", Json::array({key})}};
}

/// Collects the keys of a map.
struct DescribeFields {
  const input::Value& defaults;
  Kind& kind;
  Json properties = Json::object();
  Names required = {};
  std::vector<Names> exactly_one = {};
  Json rules = Json::array();

  std::string without(const Key& key) const {
    if (!key.without.empty()) return std::string(key.without);
    for (const input::Entry& entry : defaults.entries) {
      if (entry.key == key.name && entry.value.kind != input::Value::Kind::map) {
        return fmt::format("`{}`", input::line_of(entry.value));
      }
    }
    return "";
  }

  template <class T, class Form = Plain>
  void operator()(const Key& key, const T& member, const Form& form = {}) {
    const Kind value = kind_of(form, member);
    const std::string name(key.name), absent = without(key);
    if (key.without == kRequired) required.push_back(key.name);
    std::string description(key.meaning);
    if (!absent.empty() && key.without != kRequired && key.without != kOneOfThese) {
      description += fmt::format(". Default: {}", absent);
    }
    properties[name] = {{"description", description}};
    properties[name].update(value.schema);
    kind.rows.push_back({name, key.meaning, absent, value.takes});
    for (Row& row : rows_in(value.rows, name)) kind.rows.push_back(row);
  }
  void at_most_one_of(const Names& keys) { rules.push_back({{"not", {{"required", keys}}}}); }
  void exactly_one_of(const Names& keys) { exactly_one.push_back(keys); }
  /// If the key is given, the others are forbidden, and none of them is required.
  void in_place_of(std::string_view key, const Names& others) {
    const auto is_other = [&](std::string_view name) {
      return std::ranges::find(others, name) != others.end();
    };
    Json without_it = Json::array(), with_it = Json::array();
    for (const std::string_view other : others) with_it.push_back(given(other));
    std::erase_if(required, [&](std::string_view name) {
      if (is_other(name)) without_it.push_back(given(name));
      return is_other(name);
    });
    std::erase_if(exactly_one, [&](const Names& names) {
      const bool is_replaced = std::ranges::any_of(names, is_other);
      if (is_replaced) without_it.push_back(one_of(names));
      return is_replaced;
    });
    Json rule{{"if", given(key)}, {"then", {{"not", {{"anyOf", with_it}}}}}};
    if (!without_it.empty()) rule["else"] = {{"allOf", without_it}};
    rules.push_back(rule);
  }

  static Json one_of(const Names& names) {
    Json choices = Json::array();
    for (const std::string_view name : names) choices.push_back(given(name));
    return {{"oneOf", choices}};
  }
  Json schema() const {
    Json all{{"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
    if (!required.empty()) all["required"] = required;
    Json conditions = rules;
    for (const Names& names : exactly_one) conditions.push_back(one_of(names));
    if (!conditions.empty()) all["allOf"] = conditions;
    return all;
  }
};

Kind kind_of(Plain, const HasFields auto& object) {
  Kind kind{"a map", {}};
  const input::Value defaults = all_keys(object);
  auto visited = object;
  DescribeFields describe{.defaults = defaults, .kind = kind};
  fields(visited, describe);
  kind.schema = describe.schema();
  return kind;
}

/// Prints in one line if it fits.
void print(const Json& json, std::size_t indent, std::string& text) {
  const std::string line = json.dump();
  if (json.is_primitive() || json.empty() || indent + line.size() <= 110) {
    text += line;
    return;
  }
  const std::string begin = fmt::format("\n{:{}}", "", indent + 1);
  std::string_view separator = "";
  text += json.is_array() ? "[" : "{";
  for (const auto& [key, value] : json.items()) {
    text.append(separator).append(begin);
    if (json.is_object()) text.append(Json(key).dump()).append(": ");
    print(value, indent + 1, text);
    separator = ",";
  }
  text += fmt::format("\n{:{}}{}", "", indent, json.is_array() ? "]" : "}");
}

}  // namespace

std::string keys_text() {
  std::string text;
  for (const Row& row : kind_of(Plain{}, default_scenario()).rows) {
    text += fmt::format("{}: {}\n", row.key, row.meaning);
    if (!row.without.empty()) text += fmt::format("    default: {}\n", row.without);
    if (!row.takes.empty()) text += fmt::format("    values: {}\n", row.takes);
  }
  return text;
}

std::string schema_text() {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "LCS scenario"}};
  schema.update(kind_of(Plain{}, default_scenario()).schema);
  std::string text;
  print(schema, 0, text);
  text += "\n";
  return text;
}

void put(input::Value& map, std::string_view key, const input::Value& value) {
  input::Entry& entry = map.entries.emplace_back();
  entry.key = key;
  entry.value = value;
}

input::Value document_of(const Scenario& scenario) {
  return written(Plain{}, scenario);
}

}  // namespace lcs::scenario
