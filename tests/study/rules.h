/// \file
/// The rules of the default filter that a step of the study has in place of the paper's. Each step
/// adds one to the steps before.
#pragma once

#include <stdexcept>

namespace lcs::study {

/// The last step; it has all rules of the default filter. Step 0 has the paper's, preset `lab`.
inline constexpr int kLastStep = 12;

/// Numbers in brackets are formulas of filter/MODEL.md.
struct Rules {
  bool no_psi = false;         ///< 1: each corner is looked at in each frame
  bool velocity = false;       ///< 2: the depth of an edge is a Kalman filter (2), (12)
  bool gate = false;           ///< 3: an edge's corner is within three deviations (6)
  bool signatures = false;     ///< 4: a pair needs similar signatures (7)
  bool two_sightings = false;  ///< 5: two sightings off the static images make a rebel (13)
  bool hypotheses = false;     ///< 6: log odds of two hypotheses (4)-(7), (12)-(17)
  bool votes = false;          ///< 7: neighbours vote for a pair (7)
  bool coupling = false;       ///< 8: neighbours share their beliefs (18)-(20), (34)
  bool bounds = false;         ///< 9: the ground and z_min bound the depth (3)
  bool correction = false;     ///< 10: the told motion is corrected (8)-(11)
  bool groups = false;         ///< 11: circles and squares (21)-(25), (31)-(33)
  bool radial = false;         ///< 12: movers along the line of sight (27)-(30)
};

/// \throws std::invalid_argument unless 0 <= step <= kLastStep.
inline Rules rules_of(int step) {
  if (step < 0 || step > kLastStep) throw std::invalid_argument("the study has no such step");
  Rules rules;
  int number = 0;
  for (bool Rules::*rule :
       {&Rules::no_psi, &Rules::velocity, &Rules::gate, &Rules::signatures, &Rules::two_sightings,
        &Rules::hypotheses, &Rules::votes, &Rules::coupling, &Rules::bounds, &Rules::correction,
        &Rules::groups, &Rules::radial}) {
    rules.*rule = ++number <= step;
  }
  return rules;
}

}  // namespace lcs::study
