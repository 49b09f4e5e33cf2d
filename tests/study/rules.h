/// \file
/// The rules of the default filter that a step of the study has in place of the paper's. Each step
/// adds one to the steps before.
#pragma once

#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace lcs::study {

/// Numbers in brackets are formulas of filter/MODEL.md.
struct Rules {
  bool no_psi = false;         ///< each corner is looked at in each frame
  bool velocity = false;       ///< the depth of an edge is a Kalman filter (2), (12)
  bool gate = false;           ///< an edge's corner is within three deviations (6)
  bool signatures = false;     ///< a pair needs similar signatures (7)
  bool coupling = false;       ///< neighbours share their beliefs (18)-(20)
  bool two_sightings = false;  ///< two sightings off the static images make a rebel (13)
  bool hypotheses = false;     ///< log odds of two hypotheses (4)-(7), (12)-(17)
  bool votes = false;          ///< neighbours vote for a pair (7)
  bool scene = false;          ///< static scenes: bounds of the depth (3), crossings (34)
  bool correction = false;     ///< the told motion is corrected (8)-(11)
  bool groups = false;         ///< circles and squares (21)-(25), (31)-(33)
  bool radial = false;         ///< movers along the line of sight (27)-(30)
};

/// The rules by name, in the order of the steps.
inline constexpr std::array<std::pair<std::string_view, bool Rules::*>, 12> kRules{{
    {"no_psi", &Rules::no_psi},
    {"velocity", &Rules::velocity},
    {"gate", &Rules::gate},
    {"signatures", &Rules::signatures},
    {"coupling", &Rules::coupling},
    {"two_sightings", &Rules::two_sightings},
    {"hypotheses", &Rules::hypotheses},
    {"votes", &Rules::votes},
    {"scene", &Rules::scene},
    {"correction", &Rules::correction},
    {"groups", &Rules::groups},
    {"radial", &Rules::radial},
}};

/// The last step; it has all rules of the default filter. Step 0 has the paper's, preset `lab`.
inline constexpr int kLastStep = static_cast<int>(kRules.size());

/// \throws std::invalid_argument unless 0 <= step <= kLastStep.
inline Rules rules_of(int step) {
  if (step < 0 || step > kLastStep) throw std::invalid_argument("the study has no such step");
  Rules rules;
  for (std::size_t i = 0; i < static_cast<std::size_t>(step); ++i)
    rules.*kRules.at(i).second = true;
  return rules;
}

/// \param names of rules, each followed by a comma.
/// \throws std::invalid_argument for an unknown name, and for `gate` without `velocity`, whose
///   deviation it needs.
inline Rules rules_named(std::string_view names) {
  Rules rules;
  for (std::size_t end; (end = names.find(',')) != names.npos; names.remove_prefix(end + 1)) {
    bool is_known = false;
    for (const auto& [name, rule] : kRules) {
      if (name != names.substr(0, end)) continue;
      rules.*rule = is_known = true;
    }
    if (!is_known) throw std::invalid_argument("the study has no such rule");
  }
  if (rules.gate && !rules.velocity) throw std::invalid_argument("gate needs velocity");
  return rules;
}

}  // namespace lcs::study
