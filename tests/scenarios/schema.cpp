#include "tests/scenarios/schema.h"

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

/// In the schema, a number is in the base unit; a text may have any unit of the dimension.
Json schema_of(const input::Quantity& quantity, double) {
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
  return {{"anyOf", {number, {{"type", "string"}, {"pattern", pattern}}}}};
}

Json schema_of(const Whole& form, std::integral auto) {
  return {{"type", "integer"}, {"minimum", form.low}, {"maximum", form.high}};
}

Json schema_of(Plain, std::uint64_t) {
  return {{"type", "integer"}, {"minimum", 0}};
}

Json schema_of(Plain, bool) {
  return {{"type", "boolean"}};
}

Json schema_of(const auto&, const std::string&) {
  return {{"type", "string"}, {"minLength", 1}};
}

Json schema_of(const Words& form, const std::string&) {
  return {{"enum", form.words}};
}

Json schema_of(const Words& form, Enumeration auto) {
  return schema_of(form, std::string());
}

Json schema_of(const OwnFileOr& form, Enumeration auto) {
  const Json words = schema_of(Words{form.words}, std::string());
  return {{"anyOf", {words, {{"type", "string"}, {"pattern", "[.]xml$"}}}}};
}

Json schema_of(const auto&, const std::filesystem::path&) {
  return {{"type", "string"}, {"minLength", 1}};
}

Json schema_of(const FramesBefore&, int) {
  return schema_of(kDuration, 0.0);
}

Json array_of(const Json& item, std::size_t least, std::size_t most = 0) {
  Json schema{{"type", "array"}, {"items", item}, {"minItems", least}};
  if (most > 0) schema["maxItems"] = most;
  return schema;
}

template <class Number, int N, class Form>
Json schema_of(const Form& form, const Eigen::Matrix<Number, N, 1>&) {
  return array_of(schema_of(form, Number{}), N, N);
}

Json schema_of(const input::Quantity& quantity, const Eigen::Matrix3d&) {
  return array_of(schema_of(quantity, Eigen::Vector3d()), 3, 3);
}

Json schema_of(Plain, const HasFields auto& object);

Json schema_of(const OneOrTwo& form, const Eigen::Vector2d& pair) {
  return {{"anyOf", {schema_of(form.quantity, 0.0), schema_of(form.quantity, pair)}}};
}

Json schema_of(Plain, const Distortion&) {
  const Json number = schema_of(kCoefficient, 0.0);
  const Json fisheye{{"type", "object"},
                     {"additionalProperties", false},
                     {"properties", {{"equidistant", array_of(number, 4, 4)}}},
                     {"required", {"equidistant"}}};
  return {{"anyOf", {array_of(number, 5, 5), fisheye}}};
}

/// Two or more lists, each of one number of each of these quantities.
Json path_of(const std::vector<input::Quantity>& quantities) {
  Json items = Json::array();
  for (const input::Quantity& quantity : quantities) items.push_back(schema_of(quantity, 0.0));
  const std::size_t count = items.size();
  const Json point{{"type", "array"}, {"items", items}, {"minItems", count}, {"maxItems", count}};
  return array_of(point, 2);
}

Json schema_of(Plain, const TimeSpan&) {
  return array_of(schema_of(kDuration, 0.0), 2, 2);
}

Json schema_of(Plain, const std::vector<Waypoint>&) {
  return path_of({kTime, kPosition, kPosition});
}

Json schema_of(Plain, const std::vector<PathPose>&) {
  return path_of({kTime, kPosition, kPosition, kPosition, kAngle, kAngle, kAngle});
}

Json schema_of(GroupNames, const std::vector<std::string>&) {
  const Json name{{"type", "string"}, {"pattern", "^[a-z0-9_-]+$"}};
  return {{"type", "array"}, {"items", name}, {"minItems", 1}, {"uniqueItems", true}};
}

Json schema_of(GroupList, const std::vector<int>&) {
  Json groups = array_of(schema_of(Whole{0, 5}, 0), 1, 6);
  groups["uniqueItems"] = true;
  return groups;
}

Json schema_of(const FilterParameters&, const std::vector<FilterSetting>&) {
  return {{"type", "object"},
          {"additionalProperties", {{"type", {"number", "string", "boolean"}}}}};
}

Json schema_of(Plain, const std::vector<SweptKey>&) {
  return {{"type", "object"},
          {"minProperties", 1},
          {"additionalProperties", {{"type", "array"}, {"minItems", 1}, {"uniqueItems", true}}}};
}

Json schema_of(Plain, const std::vector<JointMotion>&) {
  const Json value{{"anyOf", {schema_of(kJointAngle, 0.0), schema_of(kPosition, 0.0)}}};
  const Json point{{"type", "array"},
                   {"items", {schema_of(kTime, 0.0), value}},
                   {"minItems", 2},
                   {"maxItems", 2}};
  return {{"type", "object"}, {"minProperties", 1}, {"additionalProperties", array_of(point, 2)}};
}

Json schema_of(Plain, const std::vector<Actor>&) {
  return {{"type", "object"},
          {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}, {"not", {{"const", "ego"}}}}},
          {"additionalProperties", schema_of(Plain{}, Actor{})}};
}

Json schema_of(Plain, const std::vector<RigCamera>&) {
  return {{"type", "object"},
          {"minProperties", 1},
          {"maxProperties", kMostCameras},
          {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}}},
          {"additionalProperties", schema_of(Plain{}, default_scenario().camera)}};
}

template <class Form, class T>
Json schema_of(const Form& form, const std::optional<T>&) {
  return schema_of(form, T{});
}

template <class Form, class T>
Json schema_of(const OrWord<Form>& form, const std::optional<T>&) {
  return {{"anyOf", {{{"const", form.word}}, schema_of(form.form, T{})}}};
}

template <class Form, class T>
Json schema_of(const Form& form, const std::vector<T>&) {
  const auto usual = std::make_unique<T>();  // GCC 12 warns of a temporary's destructor
  return array_of(schema_of(form, *usual), 0);
}

Json given(std::string_view key) {
  return {{"required", Json::array({key})}};
}

/// Collects the keys of a map.
struct DescribeFields {
  const input::Value& defaults;
  Json properties = Json::object();
  Names required = {};
  std::vector<Names> exactly_one = {};
  Json rules = Json::array();

  template <class T, class Form = Plain>
  void operator()(const Key& key, const T& member, const Form& form = {}) {
    const std::string name(key.name), absent = default_text(key, defaults);
    if (key.without == kRequired) required.push_back(key.name);
    std::string description(key.meaning);
    if (!absent.empty() && key.without != kRequired && key.without != kOneOfThese) {
      description += fmt::format(". Default: {}", absent);
    }
    properties[name] = {{"description", description}};
    properties[name].update(schema_of(form, member));
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

Json schema_of(Plain, const HasFields auto& object) {
  const input::Value defaults = all_keys(object);
  auto visited = object;
  DescribeFields describe{.defaults = defaults};
  fields(visited, describe);
  return describe.schema();
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

std::string schema_text() {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "LCS scenario"}};
  schema.update(schema_of(Plain{}, default_scenario()));
  std::string text;
  print(schema, 0, text);
  text += "\n";
  return text;
}

}  // namespace lcs::scenario
