/// \file
/// Converts values of a scenario to YAML, by type and form. `document_of` (keys.h) converts a whole
/// scenario.
#pragma once

#include <algorithm>

#include "scenarios/fields.h"
#include "scenarios/input/document.h"

namespace lcs::scenario {

inline input::Value scalar(std::string text) {
  return {input::Value::Kind::scalar, {}, std::move(text)};
}
inline input::Value list(std::vector<input::Value> items) {
  input::Value value(input::Value::Kind::list, {});
  value.items = std::move(items);
  return value;
}
/// A list of what `write` makes of each item.
input::Value list_of(const auto& all, const auto& write) {
  input::Value value = list({});
  for (const auto& one : all) value.items.push_back(write(one));
  return value;
}
inline input::Value map() {
  return {input::Value::Kind::map, {}};
}
/// Adds a key to a map.
inline void put(input::Value& map, std::string_view key, const input::Value& value) {
  map.entries.push_back({std::string(key), value.where, value});
}

/// \name A value by its type and form; null if there is nothing to write. Numbers have 12 digits.
/// Paths are unchanged; a reader resolves relative paths against the file's folder.
///@{
inline input::Value written(const input::Quantity& quantity, double number) {
  return scalar(input::quantity_text(number, quantity.dimension));
}
inline input::Value written(const In& form, double number) {
  return scalar(input::quantity_text(number, form.dimension, form.unit));
}
input::Value written(const auto&, std::integral auto number) {
  return scalar(std::to_string(number));
}
inline input::Value written(Plain, bool value) {
  return scalar(value ? "true" : "false");
}
input::Value written(const auto&, const std::string& text) {
  return text.empty() ? input::Value{} : scalar(text);
}
input::Value written(const auto&, const std::filesystem::path& path) {
  return written(Plain{}, path.string());
}
input::Value written(const Words& form, Enumeration auto value) {
  return scalar(form.words[static_cast<std::size_t>(value)]);
}
template <Enumeration Enum>
input::Value written(const OwnFileOr& form, Enum value) {
  return value == Enum::own ? scalar(form.file.string()) : written(Words{form.words}, value);
}
inline input::Value written(const FramesBefore&, int) {
  return {};  // `frames` has the value
}
template <class Form, class Number, int N>
input::Value written(const Form& form, const Eigen::Matrix<Number, N, 1>& vector) {
  return list_of(vector, [&](Number number) { return written(form, number); });
}
inline input::Value written(const input::Quantity& quantity, const Eigen::Matrix3d& matrix) {
  return list_of(matrix.transpose().colwise(),
                 [&](const Eigen::Vector3d& row) { return written(quantity, row); });
}
inline input::Value written(const OneOrTwo& form, const Eigen::Vector2d& pair) {
  return pair.x() == pair.y() ? written(form.quantity, pair.x()) : written(form.quantity, pair);
}
inline input::Value written(Plain, const Distortion& distortion) {
  const input::Value numbers =
      list_of(distortion.coefficients, [](double k) { return written(kCoefficient, k); });
  if (!distortion.equidistant) return numbers;
  input::Value fisheye = map();
  put(fisheye, "equidistant", numbers);
  return fisheye;
}
inline input::Value written(Plain, const Waypoint& point) {
  return list({written(kTime, point.at_s), written(kPosition, point.position_m.x()),
               written(kPosition, point.position_m.y())});
}
inline input::Value written(Plain, const PathPose& pose) {
  input::Value items = list({written(kTime, pose.at_s)});
  for (const double m : pose.position_m) items.items.push_back(written(kPosition, m));
  for (const double rad : pose.rpy_rad) items.items.push_back(written(kAngle, rad));
  return items;
}
inline input::Value written(Plain, const TimeSpan& span) {
  return list({written(kTime, span.from_s), written(kTime, span.to_s)});
}
template <class T>
input::Value written(const auto& form, const std::vector<T>& values) {
  if (values.empty()) return {};
  return list_of(values, [&](const T& value) { return written(form, value); });
}
template <class T>
input::Value written(const auto& form, const std::optional<T>& value) {
  if (!value) return {};
  input::Value inner = written(form, *value);
  return inner.kind == input::Value::Kind::null ? map() : inner;
}
template <class Form, class T>
input::Value written(const OrWord<Form>& form, const std::optional<T>& value) {
  return value ? written(form.form, value) : scalar(std::string(form.word));
}
///@}

/// Collects the keys of a map.
struct WriteFields {
  input::Value& keys;
  bool is_default = false;  ///< omit required keys, which have no default

  template <class T, class Form = Plain>
  void operator()(const Key& key, const T& member, const Form& form = {}) const {
    const bool is_required = key.without == kRequired;
    if (is_default && (is_required || key.without == kOneOfThese)) return;
    input::Value value = written(form, member);
    if (value.kind == input::Value::Kind::null && is_required) value = map();
    if (value.kind != input::Value::Kind::null) put(keys, key.name, value);
  }
  void at_most_one_of(std::initializer_list<std::string_view>) const {}
  void exactly_one_of(std::initializer_list<std::string_view>) const {}
  void in_place_of(std::string_view key, std::initializer_list<std::string_view> others) const {
    const bool is_given = std::ranges::any_of(
        keys.entries, [&](const input::Entry& entry) { return entry.key == key; });
    if (!is_given) return;
    std::erase_if(keys.entries, [&](const input::Entry& entry) {
      return std::ranges::find(others, entry.key) != others.end();
    });
  }
};

/// All keys that have a value.
input::Value all_keys(HasFields auto object, bool is_default = false) {
  input::Value keys = map();
  fields(object, WriteFields{keys, is_default});
  return keys;
}

/// The effect of omitting a key, such as its default. \param defaults all keys of its map.
inline std::string default_text(const Key& key, const input::Value& defaults) {
  if (!key.without.empty()) return std::string(key.without);
  for (const input::Entry& entry : defaults.entries) {
    if (entry.key == key.name && entry.value.kind != input::Value::Kind::map) {
      return std::string("`").append(input::line_of(entry.value)).append("`");
    }
  }
  return "";
}

/// The default of the struct, given its other values: the noise of an IMU depends on its preset.
template <class T>
T default_beside(const T&) {
  T standard;
  return standard;
}
inline Imu default_beside(const Imu& imu) {
  Imu standard;
  standard.noise = imu_preset(imu.preset).value_or(ImuNoise{});
  return standard;
}

/// The keys that differ from their defaults.
input::Value written(Plain, const HasFields auto& object) {
  input::Value keys = all_keys(object);
  const input::Value standard = all_keys(default_beside(object), true);
  std::erase_if(keys.entries, [&](const input::Entry& entry) {
    return std::ranges::any_of(standard.entries, [&](const input::Entry& other) {
      return other.key == entry.key && input::line_of(other.value) == input::line_of(entry.value);
    });
  });
  return keys.entries.empty() ? input::Value{} : keys;
}

/// The phases after the first one, which the ego's own keys define. All keys are written, because
/// each phase inherits the keys of the phase before.
inline input::Value written(Plain, const std::vector<EgoPhase>& phases) {
  input::Value items = list({});
  for (std::size_t i = 1; i < phases.size(); ++i) items.items.push_back(all_keys(phases[i]));
  return items.items.empty() ? input::Value{} : items;
}
/// A map of what `write` makes of each, by name; null without any.
input::Value map_of(const auto& all, const auto& write) {
  input::Value names = all.empty() ? input::Value{} : map();
  for (const auto& one : all) put(names, one.name, write(one));
  return names;
}
inline input::Value written(Plain, const std::vector<Actor>& actors) {
  return map_of(actors, [](const Actor& actor) { return written(Plain{}, actor); });
}
inline input::Value written(Plain, const std::vector<JointMotion>& joints) {
  return map_of(joints, [](const JointMotion& joint) {
    return list_of(joint.points, [](const JointPoint& point) {
      return list({written(kTime, point.at_s),
                   written(point.is_angle ? kJointAngle : kPosition, point.value)});
    });
  });
}
inline input::Value written(Plain, const std::vector<RigCamera>& cameras) {
  return map_of(cameras, [](const RigCamera& one) {
    const input::Value keys = written(Plain{}, one.camera);
    return keys.kind == input::Value::Kind::null ? map() : keys;
  });
}
inline input::Value written(const FilterParameters& form,
                            const std::vector<FilterSetting>& settings) {
  input::Value keys = map();
  if (!form.preset.empty()) put(keys, "preset", scalar(form.preset));
  for (const FilterSetting& setting : settings) put(keys, setting.key, scalar(setting.value));
  return keys.entries.empty() ? input::Value{} : keys;
}
inline input::Value written(Plain, const std::vector<SweptKey>& sweep) {
  input::Value keys = map();
  for (const SweptKey& swept : sweep) {
    put(keys, swept.key, list_of(swept.values, [](const SweptKey::Value& value) {
          return input::parse_text(value.text, value.source);
        }));
  }
  return sweep.empty() ? input::Value{} : keys;
}

}  // namespace lcs::scenario
