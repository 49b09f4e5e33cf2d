/// \file
/// Whether a run met what its scenario asks for.
#pragma once

#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/bench/scoring.h"

namespace lcs::bench {

/// \throws scenario::Error at the line of the first criterion on a metric that does not exist,
/// naming
///   the nearest one that does.
void require_known_metrics(const std::vector<scenario::Criterion>& criteria);

struct FailedCriterion {
  bool required = true;
  std::string message;  ///< as "crossing.yaml:31: rebel.f1 is 0.41, must be at least 0.6"
};

/// Those not met, in the scenario's order. An undefined figure meets no bound.
std::vector<FailedCriterion> failed_criteria(const std::vector<scenario::Criterion>& criteria,
                                             const Metrics& metrics);

}  // namespace lcs::bench
