#include "tools/suite/sequential.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <map>
#include <tuple>

#include "scenarios/input/sha256.h"
#include "tools/scoring/metrics.h"
#include "tools/scoring/statistics.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

constexpr std::size_t kMostLooks = 6;
constexpr std::size_t kLeastRuns = 5;  ///< between two looks

std::map<std::string, double> f1_of_families(const SuiteResult& suite) {
  std::map<std::string, std::vector<double>> all;
  for (const ScenarioResult& scenario : suite.scenarios) {
    if (!scenario.drawn) continue;
    for (const RunResult& run : scenario.runs) {
      if (const auto f1 = figure_of(run, scoring::kF1)) all[scenario.drawn->family].push_back(*f1);
    }
  }
  std::map<std::string, double> means;
  for (const auto& [family, values] : all) means[family] = *scoring::mean(values);
  return means;
}

}  // namespace

std::vector<RunName> order_of(std::span<const Planned> plan, const SuiteResult& baseline) {
  const std::map<std::string, double> f1 = f1_of_families(baseline);
  std::vector<const Planned*> mixed;
  for (const Planned& one : plan) mixed.push_back(&one);
  std::ranges::stable_sort(mixed, {}, [](const Planned* one) {
    return one->family.empty() ? input::sha256(one->name) : "";
  });
  // By place of the seed, turn of the family, and F1 of the family.
  std::vector<std::tuple<std::size_t, std::size_t, double, RunName>> runs;
  std::map<std::string, std::size_t> turns;
  for (const Planned* one : mixed) {
    const std::size_t turn = turns[one->family]++;
    const auto known = f1.find(one->family);
    for (std::size_t k = 0; k < one->seeds.size(); ++k) {
      runs.emplace_back(k, turn, known == f1.end() ? 0 : known->second,
                        RunName{one->name, one->seeds[k]});
    }
  }
  std::ranges::stable_sort(runs, {}, [](const auto& run) {
    return std::tuple(std::get<0>(run), std::get<1>(run), std::get<2>(run));
  });
  std::vector<RunName> order;
  for (const auto& run : runs) order.push_back(std::get<RunName>(run));
  return order;
}

std::vector<Look> looks_of(std::size_t runs) {
  const std::size_t count = std::clamp<std::size_t>(runs / kLeastRuns, 1, kMostLooks);
  std::vector<Look> looks;
  for (std::size_t k = 1; k <= count; ++k) {
    looks.push_back({runs * k / count, kFalseAlarms * static_cast<double>(2 * k - 1) /
                                           static_cast<double>(count * count)});
  }
  return looks;
}

SuiteResult with_runs(const SuiteResult& suite, const std::set<RunName>& runs) {
  SuiteResult part = suite;
  for (ScenarioResult& scenario : part.scenarios) {
    std::erase_if(scenario.runs, [&](const RunResult& run) {
      return !runs.contains({scenario.name, run.seed});
    });
  }
  std::erase_if(part.scenarios, [](const ScenarioResult& one) { return one.runs.empty(); });
  return part;
}

bool is_certain(const Comparison& comparison, std::span<const Look> looks, std::size_t look) {
  if (comparison.has_regressed()) return true;
  const double share =
      static_cast<double>(looks[look].runs) / static_cast<double>(looks.back().runs);
  // A change of rare situations leaves most runs as they were, to the last bit.
  constexpr double kLeastShare = 0.5;
  if (share < kLeastShare - 1e-9) return false;
  if (comparison.finding(0) == Finding::equal) return true;
  const auto mains = std::ranges::count_if(comparison.groups, &Difference::is_main);
  if (mains == 0) return false;
  const double needed = quantile(
      complement(boost::math::normal(), looks.back().level / (2.0 * static_cast<double>(mains))));
  return std::ranges::none_of(comparison.groups, [&](const Difference& mean) {
    if (!mean.is_main) return false;
    if (!mean.change.half) return true;
    const double error = mean.change.error;
    const double at_end = mean.loss() + (1 - share) * error - mean.margin() / 2;
    return at_end > needed * error * std::sqrt(share);
  });
}

}  // namespace lcs::suite
