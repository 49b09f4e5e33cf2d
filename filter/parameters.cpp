#include "filter/parameters.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "filter/learnt.h"
#include "filter/paper/presets.h"
#include "filter/parameter_table.h"

namespace lcs {
namespace {

std::vector<Entry> own_entries() {
  const AskedBy kHypotheses{{"circle.edge_rule", "hypotheses"}};
  const AskedBy kBodies{{"square.layer_rule", "circles"}};
  return {
      {"field.rotation", "", "", 0, 0,
       LCS_CHOICE(RotationModel, field.rotation, "first_order", "homography", "as_printed")},
      {"field.reference_depth", "Z_ref", "m", 1e-3, 1e4, LCS_REAL(field.reference_depth_m)},
      {"field.nearest_depth", "z_min", "m", 1e-3, 1e4, LCS_REAL(field.nearest_depth_m)},
      {"field.ground", "", "", 0, 0, LCS_FIELD(bool, field.ground), kHypotheses},
      {"field.ground_tilt", "", "deg", 0, 90, LCS_REAL(field.ground_tilt_rad), kHypotheses},
      {"field.still_speed", "", "m/s", 0, 10, LCS_REAL(field.still_speed_mps)},
      {"line.ignore", "psi", "", 0, 0, LCS_FIELD(bool, line.ignore)},
      {"line.max_corners", "", "", 1, 10000000, LCS_FIELD(int, line.max_corners)},
      {"circle.Tr_c", "Tr^c_c", "", 0, 1000, LCS_FIELD(int, circle.trust.critical)},
      {"circle.Tr_s", "Tr^c_s", "", 0, 1000, LCS_FIELD(int, circle.trust.standard)},
      {"circle.Tr_m", "Tr^c_m", "", 0, 1000, LCS_FIELD(int, circle.trust.maximum)},
      {"circle.edge_rule", "", "", 0, 0,
       LCS_CHOICE(EdgeRule, circle.edge_rule, "paper", "hypotheses")},
      {"hypotheses.noise", "", "px", 0.01, 100, LCS_REAL(circle.hypotheses.noise_px), kHypotheses},
      {"hypotheses.prior", "", "", 1e-06, 0.5, LCS_REAL(circle.hypotheses.prior), kHypotheses},
      {"hypotheses.newcomer", "", "", 0, 10, LCS_REAL(circle.hypotheses.newcomer), kHypotheses},
      {"hypotheses.turnover", "", "1/s", 0.001, 1000, LCS_REAL(circle.hypotheses.turnover_ps),
       kHypotheses},
      {"hypotheses.ego_share", "", "", 0, 10, LCS_REAL(circle.hypotheses.ego_share), kHypotheses},
      {"hypotheses.max_speed", "", "px/s", 1, 100000, LCS_REAL(circle.hypotheses.max_speed_pxps),
       kHypotheses},
      {"hypotheses.coast", "", "", 0, 100, LCS_FIELD(int, circle.hypotheses.coast), kHypotheses},
      {"hypotheses.bits_even", "", "", 0, 256, LCS_REAL(circle.hypotheses.bits_even), kHypotheses},
      {"hypotheses.bits_weight", "", "", 0, 100, LCS_REAL(circle.hypotheses.bits_weight),
       kHypotheses},
      {"hypotheses.step_share", "", "", 0, 10, LCS_REAL(circle.hypotheses.step_share), kHypotheses},
      {"hypotheses.neighbours", "", "", 0, 1000, LCS_FIELD(int, circle.hypotheses.neighbours),
       kHypotheses},
      {"hypotheses.coupling", "", "", 0, 1000, LCS_REAL(circle.hypotheses.coupling), kHypotheses},
      {"hypotheses.neighbour_reach", "", "px", 1, 1000,
       LCS_REAL(circle.hypotheses.neighbour_reach_px), kHypotheses},
      {"circle.min_members", "", "", 1, 1000, LCS_FIELD(int, circle.min_members)},
      {"circle.gap", "", "m", 0.001, 1000, LCS_REAL(circle.gap_m), kHypotheses},
      {"circle.upward", "", "", 0.01, 100, LCS_REAL(circle.upward), kHypotheses},
      {"circle.roughness", "", "", 0, 10, LCS_REAL(circle.roughness), kHypotheses},
      {"circle.min_width", "", "px", 0, 1000, LCS_REAL(circle.min_width), kHypotheses},
      {"square.layer_rule", "", "", 0, 0,
       LCS_CHOICE(LayerRule, square.layer_rule, "couples", "circles")},
      {"square.max_size", "", "m", 0, 10000, LCS_REAL(square.max_size), kBodies},
  };
}

const std::vector<Entry>& entries() {
  static const std::vector<Entry> table = [] {
    std::vector<Entry> all = own_entries();
    const std::vector<Entry> of_paper = paper_entries();
    all.insert(all.end(), of_paper.begin(), of_paper.end());
    return all;
  }();
  return table;
}

const Entry& find(std::string_view key) {
  const auto& all = entries();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Entry& e) { return e.key == key; });
  if (found != all.end()) return *found;
  throw std::invalid_argument("the filter has no parameter '" + std::string(key) + "'");
}

std::string number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

double parse(const Entry& entry, std::string_view text) {
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

std::string range(const Entry& entry) {
  return number(entry.min) + " to " + number(entry.max);
}

void check(const Entry& entry, double value) {
  if (value >= entry.min && value <= entry.max) return;
  throw std::invalid_argument("'" + entry.key + "' is " + number(value) + "; it may be " +
                              range(entry) + (entry.unit.empty() ? "" : " " + entry.unit));
}

double scale(const Entry& entry) {
  return entry.unit == "deg" ? kDegree : 1.0;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// As `set` takes it.
std::string value_text(const Parameters& parameters, const Entry& entry) {
  Parameters copy = parameters;  // the table's accessors are not const
  if (const auto* real = std::get_if<Field<double>>(&entry.field)) {
    return number((*real)(copy) / scale(entry));
  }
  if (const auto* whole = std::get_if<Field<int>>(&entry.field)) return number((*whole)(copy));
  if (const auto* flag = std::get_if<Field<bool>>(&entry.field)) {
    return (*flag)(copy) ? "true" : "false";
  }
  const auto& choice = std::get<Choice>(entry.field);
  return choice.words[static_cast<std::size_t>(choice.get(parameters))];
}

void set_entry(Parameters& parameters, const Entry& entry, std::string_view value) {
  if (const auto* real = std::get_if<Field<double>>(&entry.field)) {
    const double parsed = parse(entry, value);
    check(entry, parsed);
    (*real)(parameters) = parsed * scale(entry);
  } else if (const auto* whole = std::get_if<Field<int>>(&entry.field)) {
    const double parsed = parse(entry, value);
    check(entry, parsed);
    if (parsed != std::floor(parsed)) {
      throw std::invalid_argument("'" + entry.key + "' takes a whole number, not '" +
                                  std::string(value) + "'");
    }
    (*whole)(parameters) = static_cast<int>(parsed);
  } else if (const auto* flag = std::get_if<Field<bool>>(&entry.field)) {
    if (value != "true" && value != "false") {
      throw std::invalid_argument("'" + entry.key + "' takes true or false, not '" +
                                  std::string(value) + "'");
    }
    (*flag)(parameters) = value == "true";
  } else {
    const auto& choice = std::get<Choice>(entry.field);
    const auto word = std::find(choice.words.begin(), choice.words.end(), value);
    if (word == choice.words.end()) {
      throw std::invalid_argument("'" + entry.key + "' takes one of " + joined(choice.words) +
                                  ", not '" + std::string(value) + "'");
    }
    choice.put(parameters, static_cast<int>(word - choice.words.begin()));
  }
}

bool is_learnt(std::string_view key) {
  return std::any_of(kLearnt.begin(), kLearnt.end(),
                     [&](const auto& learnt) { return learnt.first == key; });
}

void check_ranks(const TrustRanks& ranks, const std::string& expert) {
  if (ranks.critical <= ranks.standard && ranks.standard <= ranks.maximum) return;
  throw std::invalid_argument("the ranks of trust of '" + expert +
                              "' must be Tr_c <= Tr_s <= Tr_m");
}

Parameters project_default() {
  Parameters p;
  p.field.nearest_depth_m = 0.4;
  p.circle.trust = {2, 3, 7};
  p.circle.min_members = 7;
  // An outline's crossings, and the stairs that a slanting line is drawn in, slide along it.
  p.circle.min_width = 1.5;
  p.line.ignore = false;
  for (const auto& [key, value] : kLearnt) set_entry(p, find(key), value);
  return p;
}

}  // namespace

std::vector<std::string> preset_names() {
  return {"default", "lab", "cars"};
}

Parameters preset(std::string_view name) {
  if (name == "default") return project_default();
  if (name == "lab") return lab_preset();
  if (name == "cars") return cars_preset();
  throw std::invalid_argument("the filter has no preset '" + std::string(name) + "'; there are " +
                              joined(preset_names()));
}

void set(Parameters& parameters, std::string_view key, std::string_view value) {
  set_entry(parameters, find(key), value);
}

void validate(const Parameters& parameters) {
  Parameters copy = parameters;  // the table's accessors are not const
  for (const Entry& entry : entries()) {
    if (const auto* real = std::get_if<Field<double>>(&entry.field)) {
      // The round trip through radians may leave a bound by one unit in the last place.
      const double value = (*real)(copy) / scale(entry);
      check(entry, std::abs(value - entry.max) < 1e-9 ? entry.max : value);
    } else if (const auto* whole = std::get_if<Field<int>>(&entry.field)) {
      check(entry, (*whole)(copy));
    } else if (const auto* choice = std::get_if<Choice>(&entry.field)) {
      const int chosen = choice->get(copy);
      if (chosen < 0 || chosen >= static_cast<int>(choice->words.size())) {
        throw std::invalid_argument("'" + entry.key + "' takes one of " + joined(choice->words));
      }
    }
  }
  check_ranks(parameters.circle.trust, "circle");
  check_ranks(parameters.square.trust, "square");
  if (parameters.circle.mu_min > parameters.circle.mu_max) {
    throw std::invalid_argument("'circle.mu_min' is above 'circle.mu_max'");
  }
}

std::optional<Idle> idle(const Parameters& parameters, std::string_view key) {
  const Entry& entry = find(key);
  const auto is_asked_for = [&](const Parameters& p) {
    return entry.asked_by.empty() ||
           std::any_of(entry.asked_by.begin(), entry.asked_by.end(), [&](const Rule& rule) {
             return value_text(p, find(rule.key)) == rule.value;
           });
  };
  if (is_asked_for(parameters)) return std::nullopt;
  Idle idle{entry.asked_by, {}};
  for (const std::string& name : preset_names()) {
    if (is_asked_for(preset(name))) idle.presets.push_back(name);
  }
  return idle;
}

std::vector<ParameterInfo> describe(const Parameters& parameters) {
  std::vector<ParameterInfo> infos;
  for (const Entry& entry : entries()) {
    ParameterInfo info{entry.key,    value_text(parameters, entry), entry.unit, "",
                       entry.symbol, is_learnt(entry.key)};
    if (std::holds_alternative<Field<bool>>(entry.field)) {
      info.range = "true, false";
    } else if (const auto* choice = std::get_if<Choice>(&entry.field)) {
      info.range = joined(choice->words);
    } else {
      info.range = range(entry);
    }
    infos.push_back(std::move(info));
  }
  return infos;
}

}  // namespace lcs
