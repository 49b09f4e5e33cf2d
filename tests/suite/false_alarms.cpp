/// \file
/// Counts how often two suites of the same detector, which differ in their seeds alone, are called
/// different, and how often a loss of F1 is found. Draws pairs of suites from one suite with many
/// seeds.

#include <fmt/format.h>

#include <cstdlib>
#include <random>
#include <stdexcept>

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
  int regressed = 0, improved = 0, single = 0, means = 0;
  for (int i = 0; i < kPairs; ++i) {
    const auto [before, after] = draw(pool, seeds, random);
    const Comparison comparison = compare(before, after, [](std::string_view) { return true; });
    regressed += comparison.has_regressed();
    improved += comparison.count_means(Change::improved) > 0;
    single += !comparison.with(Change::regressed).empty();
    means = comparison.judged_means;
  }
  std::string found;
  for (const double loss : {0.02, 0.03, 0.05, 0.1}) {
    int alarms = 0;
    for (int i = 0; i < kPairs / 4; ++i) {
      auto [before, after] = draw(pool, seeds, random);
      lose(after, loss);
      alarms += compare(before, after, [](std::string_view) { return true; }).has_regressed();
    }
    found += fmt::format(" of {}: {} times in {};", loss, alarms, kPairs / 4);
  }
  fmt::print("a loss of F1 is found,{}\n", found);
  fmt::print(
      "{} scenarios, seeds {}, {} means, {} pairs: regressed {}, improved {}; with a single "
      "scenario that regressed {}\n",
      pool.scenarios.size(), seeds, means, kPairs, regressed, improved, single);
  return regressed <= kPairs / 20 ? 0 : 1;
}
