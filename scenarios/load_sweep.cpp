#include "scenarios/load_sweep.h"

#include <algorithm>
#include <array>

#include "scenarios/reader.h"

namespace lcs::scenario {
namespace {

/// What says nothing about the run, or is not the scenario's to vary.
constexpr std::array<std::string_view, 5> not_to_be_swept = {"sweep", "groups", "purpose", "origin",
                                                             "seed"};

SweptKey read_key(const Entry& entry) {
  const std::string path = "sweep." + entry.key;
  if (std::count(not_to_be_swept.begin(), not_to_be_swept.end(), entry.key) > 0) {
    throw Error(entry.where, path + " cannot be swept; " +
                                 (entry.key == "seed" ? "the number of seeds is the suite's option"
                                                      : "remove it"));
  }
  SweptKey swept{entry.key, {}, entry.where};
  for (const Value& value : as_list(entry.value, path)) {
    const std::string index = std::to_string(swept.values.size());
    if (value.kind == Value::Kind::null) {
      throw Error(value.where, path + "." + index + " is nothing; give a value");
    }
    const std::string text = line_of(value);
    const auto same = [&](const SweptKey::Value& other) { return other.text == text; };
    if (std::any_of(swept.values.begin(), swept.values.end(), same)) {
      throw Error(value.where, path + " has '" + text + "' twice; remove one");
    }
    swept.values.push_back({text, value.where});
  }
  if (swept.values.empty()) {
    throw Error(entry.where, path + " is an empty list; give one or more values");
  }
  return swept;
}

bool is_name(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

}  // namespace

std::vector<std::string> read_groups(const Value& value) {
  std::vector<std::string> groups;
  for (const Value& item : as_list(value, "groups")) {
    const std::string& group = as_text(item, "groups." + std::to_string(groups.size()));
    if (!is_name(group)) {
      throw Error(item.where, "the group '" + group +
                                  "' has other characters than a-z, 0-9, '_' and '-'; rename it");
    }
    if (std::find(groups.begin(), groups.end(), group) != groups.end()) {
      throw Error(item.where, "groups has '" + group + "' twice; remove one");
    }
    groups.push_back(group);
  }
  if (groups.empty()) {
    throw Error(value.where, "groups is an empty list; give one or more, or remove the key");
  }
  return groups;
}

std::vector<SweptKey> read_sweep(const Value& value) {
  const Reader keys(value, "sweep");
  std::vector<SweptKey> sweep;
  for (const Entry& entry : value.entries) sweep.push_back(read_key(entry));
  if (sweep.empty()) {
    throw Error(value.where, "sweep is an empty map; give keys, as in {ego.speed: [0.2, 0.4]}");
  }
  return sweep;
}

}  // namespace lcs::scenario
