/// \file
/// Judges a run's figures by the criteria of its scenario.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/scoring/scoring.h"

namespace lcs::scoring {

/// \throws input::Error at the line of the first criterion with an unknown metric; the message
///   names the most similar known one.
void require_known_metrics(const std::vector<scenario::Criterion>& criteria);

/// The criteria that apply to a detector of a run. \param is_own whether it is the run's own
/// detector; criteria that name no detector apply to it.
std::vector<scenario::Criterion> asked_of(const std::string& detector, bool is_own,
                                          const std::vector<scenario::Criterion>& criteria);

/// A line for each detector of the criteria that the run lacks, such as "not asked: criteria of klt
/// (crossing.yaml:31, the first of 2); let it watch, by --beside".
std::vector<std::string> not_asked(const std::vector<scenario::Criterion>& criteria,
                                   const std::set<std::string>& detectors);

/// A line if there are criteria over seeds, which a single run cannot judge.
std::vector<std::string> not_judged(const std::vector<scenario::Criterion>& criteria);

struct JudgedCriterion {
  std::string metric;
  std::optional<double> min, max;
  std::optional<double> value;  ///< absent: undefined, which meets no bound
  bool required = true;
  bool met = false;
  std::string over = "seed";  ///< as `scenario::Criterion::over`; if not "seed", a suite judges it
  std::string place = {};     ///< such as "crossing.yaml:31"
  std::string message = {};   ///< such as "crossing.yaml:31: rebel.f1 is 0.41, must be at least
                              ///< 0.6"; empty if met
};

/// "at least 0.6 and at most 0.9".
std::string bounds(std::optional<double> min, std::optional<double> max);

/// Judges all criteria of single runs, in the scenario's order. Those over seeds are not judged.
std::vector<JudgedCriterion> judge(const std::vector<scenario::Criterion>& criteria,
                                   const Metrics& metrics);

}  // namespace lcs::scoring
