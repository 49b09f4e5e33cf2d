#include "filter/parameter_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "filter/kinematics/geometry.h"
#include "filter/types/learnt.h"

namespace lcs {
namespace {

/// In the order of `RotationModel`.
constexpr std::array<const char*, 3> kRotations = {"first_order", "homography", "as_printed"};

std::string number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

double parse(const ParameterEntry& entry, std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
  while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  if (error != std::errc() || (!rest.empty() && rest != entry.unit) || !std::isfinite(value)) {
    throw std::invalid_argument("'" + entry.key + "' takes a number" +
                                (entry.unit.empty() ? "" : " in " + entry.unit) + ", not '" +
                                std::string(text) + "'");
  }
  return value;
}

std::string range(const ParameterEntry& entry) {
  return number(entry.min) + " to " + number(entry.max);
}

void check(const ParameterEntry& entry, double value) {
  if (value >= entry.min && value <= entry.max) return;
  throw std::invalid_argument("'" + entry.key + "' is " + number(value) + "; it may be " +
                              range(entry) + (entry.unit.empty() ? "" : " " + entry.unit));
}

double scale(const ParameterEntry& entry) {
  return entry.unit == "deg" ? kDegree : 1.0;
}

std::string joined(std::span<const char* const> words) {
  std::string text;
  for (const std::string word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// In the format of `set`.
std::string value_text(const ParameterEntry& entry) {
  if (const auto* real = std::get_if<double*>(&entry.value)) return number(**real / scale(entry));
  if (const auto* whole = std::get_if<int*>(&entry.value)) return number(**whole);
  if (const auto* flag = std::get_if<bool*>(&entry.value)) return **flag ? "true" : "false";
  return kRotations[static_cast<std::size_t>(*std::get<RotationModel*>(entry.value))];
}

/// The allowed values, human-readable.
std::string range_text(const ParameterEntry& entry) {
  if (std::holds_alternative<bool*>(entry.value)) return "true, false";
  if (std::holds_alternative<RotationModel*>(entry.value)) return joined(kRotations);
  return range(entry);
}

bool is_learnt(std::string_view key) {
  return std::ranges::any_of(kLearnt, [&](const auto& learnt) { return learnt.first == key; });
}

}  // namespace

void set(std::span<const ParameterEntry> entries, std::string_view key, std::string_view value) {
  const auto found = std::ranges::find(entries, key, &ParameterEntry::key);
  if (found == entries.end()) {
    throw std::invalid_argument("the filter has no parameter '" + std::string(key) + "'");
  }
  const ParameterEntry& entry = *found;
  const auto refuse = [&](const std::string& wanted) {
    throw std::invalid_argument("'" + entry.key + "' takes " + wanted + ", not '" +
                                std::string(value) + "'");
  };
  if (const auto* flag = std::get_if<bool*>(&entry.value)) {
    if (value != "true" && value != "false") refuse("true or false");
    **flag = value == "true";
    return;
  }
  if (const auto* rotation = std::get_if<RotationModel*>(&entry.value)) {
    const auto* word = std::ranges::find(kRotations, value);
    if (word == kRotations.end()) refuse("one of " + joined(kRotations));
    **rotation = static_cast<RotationModel>(word - kRotations.begin());
    return;
  }
  const double parsed = parse(entry, value);
  check(entry, parsed);
  if (const auto* real = std::get_if<double*>(&entry.value)) {
    **real = parsed * scale(entry);
    return;
  }
  if (parsed != std::floor(parsed)) refuse("a whole number");
  *std::get<int*>(entry.value) = static_cast<int>(parsed);
}

void validate(std::span<const ParameterEntry> entries) {
  for (const ParameterEntry& entry : entries) {
    if (const auto* real = std::get_if<double*>(&entry.value)) {
      // The conversion through radians may exceed a bound by one unit in the last place.
      const double value = **real / scale(entry);
      check(entry, std::abs(value - entry.max) < 1e-9 ? entry.max : value);
    } else if (const auto* whole = std::get_if<int*>(&entry.value)) {
      check(entry, **whole);
    } else if (const auto* rotation = std::get_if<RotationModel*>(&entry.value)) {
      if (static_cast<std::size_t>(**rotation) < kRotations.size()) continue;
      throw std::invalid_argument("'" + entry.key + "' takes one of " + joined(kRotations));
    }
  }
}

void validate(const TrustRanks& ranks, const std::string& expert) {
  if (ranks.critical <= ranks.standard && ranks.standard <= ranks.maximum) return;
  throw std::invalid_argument("the ranks of trust of '" + expert +
                              "' must be Tr_c <= Tr_s <= Tr_m");
}

std::vector<ParameterInfo> describe(std::span<const ParameterEntry> entries) {
  std::vector<ParameterInfo> infos;
  for (const ParameterEntry& entry : entries) {
    infos.push_back({entry.key, value_text(entry), entry.unit, range_text(entry), entry.symbol,
                     is_learnt(entry.key)});
  }
  return infos;
}

std::vector<ParameterEntry> entries_of(FieldParameters& field) {
  return {
      {"field.rotation", "", "", 0, 0, &field.rotation},
      {"field.reference_depth", "Z_ref", "m", 1e-3, 1e4, &field.reference_depth_m},
      {"field.nearest_depth", "z_min", "m", 1e-3, 1e4, &field.nearest_depth_m},
      {"field.still_speed", "", "m/s", 0, 10, &field.still_speed_mps},
  };
}

}  // namespace lcs
