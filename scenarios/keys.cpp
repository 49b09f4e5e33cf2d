#include "scenarios/keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <type_traits>

#include "scenarios/written.h"

namespace lcs::scenario {
namespace {

struct Row {
  std::string key;
  std::string_view meaning;
  std::string without;
  std::string takes;
};

/// The accepted values of a key, and the keys of its map, if it is a map.
struct Kind {
  std::string takes;
  std::vector<Row> rows = {};
};

Kind kind_of(const input::Quantity& quantity, double) {
  return {input::range_text(quantity)};
}

Kind kind_of(const Whole& form, std::integral auto) {
  return {fmt::format("{} to {}", form.low, form.high)};
}

Kind kind_of(Plain, std::uint64_t) {
  return {"0 to 2^64-1"};
}

Kind kind_of(Plain, bool) {
  return {"false or true"};
}

Kind kind_of(const auto&, const std::string&) {
  return {"a text"};
}

Kind kind_of(const Words& form, const std::string&) {
  return {fmt::format("{}", fmt::join(form.words, ", "))};
}

Kind kind_of(const Words& form, Enumeration auto) {
  return kind_of(form, std::string());
}

Kind kind_of(const OwnFileOr& form, Enumeration auto) {
  return {fmt::format("{}, a path", fmt::join(form.words, ", "))};
}

Kind kind_of(const auto&, const std::filesystem::path&) {
  return {"must exist"};
}

Kind kind_of(const FramesBefore&, int) {
  return kind_of(kDuration, 0.0);
}

Kind each(const Kind& item) {
  return {fmt::format("each {}", item.takes)};
}

template <class Number, int N, class Form>
Kind kind_of(const Form& form, const Eigen::Matrix<Number, N, 1>&) {
  return each(kind_of(form, Number{}));
}

Kind kind_of(const input::Quantity& quantity, const Eigen::Matrix3d&) {
  return each(kind_of(quantity, Eigen::Vector3d()));
}

Kind kind_of(const OneOrTwo& form, const Eigen::Vector2d&) {
  return kind_of(form.quantity, 0.0);
}

Kind kind_of(Plain, const Distortion&) {
  return each(kind_of(kCoefficient, 0.0));
}

Kind kind_of(Plain, const TimeSpan&) {
  return each(kind_of(kDuration, 0.0));
}

template <class T, class... Others>
constexpr bool is_one_of = (std::is_same_v<T, Others> || ...);

Kind kind_of(GroupNames, const std::vector<std::string>&) {
  return {"a-z, 0-9, _, -"};
}

Kind kind_of(GroupList, const std::vector<int>&) {
  return each(kind_of(Whole{0, 5}, 0));
}

Kind kind_of(Plain, const HasFields auto& object);

/// The rows with the name of their place in a list, for example "phases.N.at".
std::vector<Row> rows_in(std::vector<Row> rows, std::string_view place) {
  for (Row& row : rows) row.key = fmt::format("{}.{}", place, row.key);
  return rows;
}

Kind kind_of(Plain, const std::vector<Actor>&) {
  return {"a map", rows_in(kind_of(Plain{}, Actor{}).rows, "NAME")};
}

template <class Form, class T>
Kind kind_of([[maybe_unused]] const Form& form, const std::vector<T>&) {
  if constexpr (is_one_of<T, FilterSetting, RigCamera, SweptKey, JointMotion>) {
    return {is_one_of<T, SweptKey, JointMotion> ? "a map of lists" : "a map"};
  } else if constexpr (is_one_of<T, Waypoint, PathPose>) {
    return {"a list"};
  } else {
    const auto usual = std::make_unique<T>();  // GCC 12 warns of a temporary's destructor
    return {"a list", rows_in(kind_of(form, *usual).rows, "N")};
  }
}

template <class Form, class T>
Kind kind_of(const Form& form, const std::optional<T>&) {
  return kind_of(form, T{});
}

template <class Form, class T>
Kind kind_of(const OrWord<Form>& form, const std::optional<T>&) {
  Kind kind = kind_of(form.form, T{});
  kind.takes += fmt::format(" or {}", form.word);
  return kind;
}

/// Collects the keys of a map.
struct DescribeFields {
  const input::Value& defaults;
  std::vector<Row>& rows;

  template <class T, class Form = Plain>
  void operator()(const Key& key, const T& member, const Form& form = {}) const {
    const Kind value = kind_of(form, member);
    const std::string name(key.name);
    rows.push_back({name, key.meaning, default_text(key, defaults), value.takes});
    for (const Row& row : rows_in(value.rows, name)) rows.push_back(row);
  }
  void at_most_one_of(std::initializer_list<std::string_view>) const {}
  void exactly_one_of(std::initializer_list<std::string_view>) const {}
  void in_place_of(std::string_view, std::initializer_list<std::string_view>) const {}
};

Kind kind_of(Plain, const HasFields auto& object) {
  Kind kind{"a map"};
  const input::Value defaults = all_keys(object);
  auto visited = object;
  fields(visited, DescribeFields{defaults, kind.rows});
  return kind;
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

input::Value document_of(const Scenario& scenario) {
  return written(Plain{}, scenario);
}

}  // namespace lcs::scenario
