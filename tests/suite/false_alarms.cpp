/// \file
/// Counts how often two suites of the same detector, which differ in their seeds alone, are called
/// different, and how often a loss of F1 is found. Draws pairs of suites from one suite with many
/// seeds.

#include <fmt/format.h>

#include <cstdlib>
#include <random>
#include <stdexcept>

#include "tests/tools/suites.h"
#include "tools/suite/comparison.h"
#include "tools/suite/suite_result.h"

namespace {

using namespace lcs::suite;

/// Takes `seeds` other runs of each scenario for each side, numbered from 1.
std::pair<SuiteResult, SuiteResult> draw(const SuiteResult& pool, std::size_t seeds,
                                         std::mt19937& random) {
  SuiteResult before = pool, after = pool;
  for (std::size_t i = 0; i < pool.scenarios.size(); ++i) {
    std::vector<RunResult> runs = pool.scenarios[i].runs;
    std::shuffle(runs.begin(), runs.end(), random);
    if (runs.size() < 2 * seeds) throw std::runtime_error("too few seeds for two suites");
    for (SuiteResult* side : {&before, &after}) {
      std::vector<RunResult>& own = side->scenarios[i].runs;
      own.assign(runs.end() - static_cast<std::ptrdiff_t>(seeds), runs.end());
      runs.resize(runs.size() - seeds);
      for (std::size_t k = 0; k < seeds; ++k) own[k].seed = k + 1;
    }
  }
  return {before, after};
}

void lose(SuiteResult& suite, double loss) {
  for (ScenarioResult& scenario : suite.scenarios) {
    for (RunResult& run : scenario.runs) {
      for (auto& [name, figure] : run.metrics) {
        if (name == "rebel.f1" && figure) *figure -= loss;
      }
    }
  }
}

/// How a sequential comparison ended.
struct Ended {
  bool regressed = false;
  double share = 1;  ///< of the runs that it made
};

/// Compares as `lcs suite --baseline` does, on runs that are all there.
Ended sequential(const SuiteResult& before, const SuiteResult& after) {
  const std::vector<RunName> order = order_of(planned(after), before);
  const std::vector<Look> looks = looks_of(order.size());
  for (std::size_t k = 0;; ++k) {
    const SuiteResult made = at_look(after, order, looks[k]);
    const Comparison comparison = compare(before, made, [](std::string_view) { return true; });
    if (k + 1 < looks.size() && !is_certain(comparison, looks, k)) continue;
    return {comparison.has_regressed(),
            static_cast<double>(looks[k].runs) / static_cast<double>(order.size())};
  }
}

/// Counts over pairs of suites of which the later one has lost so much F1.
void try_pairs(const SuiteResult& pool, std::size_t seeds, double loss, int pairs,
               std::mt19937& random, int& alarms_of_all, int& alarms) {
  double share = 0;
  alarms_of_all = alarms = 0;
  for (int i = 0; i < pairs; ++i) {
    auto [before, after] = draw(pool, seeds, random);
    lose(after, loss);
    alarms_of_all += compare(before, after, [](std::string_view) { return true; }).has_regressed();
    const Ended ended = sequential(before, after);
    alarms += ended.regressed;
    share += ended.share / pairs;
  }
  fmt::print("| {:.2f} | {} of {} | {} | {:.2f} |\n", loss, alarms_of_all, pairs, alarms, share);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr,
               "usage: false_alarms SUITE SEEDS   (SUITE has twice as many seeds or more)\n");
    return 2;
  }
  constexpr int kPairs = 200;
  const SuiteResult pool = read_suite(argv[1]);
  const auto seeds = static_cast<std::size_t>(std::strtoul(argv[2], nullptr, 10));
  std::mt19937 random(1);
  fmt::print(
      "{} scenarios, {} seeds\n| loss of F1 | regressed by all runs | by looks | share of "
      "runs made |\n|---|---|---|---|\n",
      pool.scenarios.size(), seeds);
  int of_all = 0, of_looks = 0, more = 0, more_of_all = 0;
  try_pairs(pool, seeds, 0, kPairs, random, of_all, of_looks);
  for (const double loss : {0.01, 0.02, 0.03, 0.05, 0.1, 0.2}) {
    try_pairs(pool, seeds, loss, kPairs / 4, random, more_of_all, more);
  }
  return of_all <= kPairs / 20 && of_looks <= kPairs / 20 ? 0 : 1;
}
