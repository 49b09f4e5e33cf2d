#include "tools/suite/parts.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/tools/refusal.h"
#include "tests/tools/suites.h"

namespace lcs::suite {
namespace {

using test::refusal_of;

TEST(Shard, IsAPartOfAll) {
  EXPECT_EQ(shard_of("3/16").part, 3);
  EXPECT_EQ(shard_of("3/16").parts, 16);
  for (const char* text : {"", "3", "0/2", "3/2", "1/x", "-1/2", "1/2/3"}) {
    EXPECT_THROW(shard_of(text), std::invalid_argument) << text;
  }
}

TEST(Parts, TakeAboutEquallyLong) {
  const std::vector<double> seconds{1, 9, 1, 4, 5, 1, 1, 2};
  const std::vector<int> parts = parts_of(seconds, 3);
  std::vector<double> load(4, 0);
  for (std::size_t i = 0; i < seconds.size(); ++i) load.at(parts[i]) += seconds[i];
  EXPECT_EQ(load, (std::vector<double>{0, 9, 8, 7}));
}

/// A part with one run of each of the seeds.
SuiteResult part(int number, const std::vector<std::uint64_t>& seeds) {
  ScenarioResult scenario = scenario_with("near", "rebel.f1", {});
  for (const std::uint64_t seed : seeds) scenario.runs.push_back(run_with(seed, {{"frames", 4}}));
  SuiteResult suite = suite_with({scenario});
  suite.part_of = PartOf{{number, 2}, {{"near", {1, 2, 3}}}};
  return suite;
}

std::string refusal(const SuiteResult& a, const SuiteResult& b) {
  const SuiteInFolder parts[] = {{a, "a"}, {b, "b"}};
  return refusal_of<std::runtime_error>([&] { merge(parts); });
}

TEST(Merge, HasTheRunsInTheOrderOfTheWhole) {
  const SuiteResult a = part(1, {3, 1}), b = part(2, {2});
  const SuiteInFolder parts[] = {{b, "b"}, {a, "a"}};
  const SuiteResult whole = merge(parts);
  EXPECT_FALSE(whole.part_of);
  ASSERT_EQ(whole.scenarios.size(), 1u);
  std::vector<std::uint64_t> seeds;
  for (const RunResult& run : whole.scenarios[0].runs) seeds.push_back(run.seed);
  EXPECT_EQ(seeds, (std::vector<std::uint64_t>{1, 2, 3}));
}

TEST(Merge, PartsThatDoNotFitAreNamed) {
  EXPECT_EQ(refusal(part(1, {1}), part(2, {2, 1})),
            "a and b both have near seed 1; the parts of one suite have the same --times, or none");
  EXPECT_EQ(refusal(part(1, {1}), part(2, {2})),
            "the parts lack 1 of the runs of the whole suite: the parts were made with different "
            "--times");
  EXPECT_EQ(refusal(part(1, {1}), part(1, {2})),
            "the parts lack 1 of the runs of the whole suite: there is no part 2 of 2");
  SuiteResult other = part(2, {2, 3});
  other.part_of->shard.parts = 3;
  EXPECT_EQ(refusal(part(1, {1}), other),
            "a and b are no parts of one suite: the scenarios, seeds or numbers of parts differ");
  other.part_of.reset();
  EXPECT_EQ(refusal(part(1, {1}), other),
            "b is a whole suite, no part of one; lcs suite --shard I/N makes parts");
}

}  // namespace
}  // namespace lcs::suite
