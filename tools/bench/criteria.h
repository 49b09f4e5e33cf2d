/// \file
/// Whether a run met what its scenario asks for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/bench/scoring.h"

namespace lcs::bench {

/// \throws scenario::Error at the line of the first criterion on a metric that does not exist,
/// naming
///   the nearest one that does.
void require_known_metrics(const std::vector<scenario::Criterion>& criteria);

struct JudgedCriterion {
  std::optional<double> figure;  ///< none: undefined, which meets no bound
  bool met = false;
  std::string message;  ///< of a failure, as "crossing.yaml:31: rebel.f1 is 0.41, must be at least
                        ///< 0.6"; empty where met
};

/// All of them, in the scenario's order.
std::vector<JudgedCriterion> judge(const std::vector<scenario::Criterion>& criteria,
                                   const Metrics& metrics);

struct FailedCriterion {
  bool required = true;
  std::string message;  ///< as `JudgedCriterion::message`
};

/// Those not met, in the scenario's order.
std::vector<FailedCriterion> failed_criteria(const std::vector<scenario::Criterion>& criteria,
                                             const Metrics& metrics);

}  // namespace lcs::bench
