#include "tools/scoring/metrics.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "tests/tools/files.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/scoring.h"

namespace lcs::scoring {
namespace {

TEST(Metrics, HaveAKeyOfTheirOwn) {
  std::set<std::string> keys;
  for (const Metric& metric : metrics()) EXPECT_TRUE(keys.insert(metric.key).second) << metric.key;
}

TEST(Metrics, AreOneForEachWarning) {
  std::vector<std::string> known, given;
  for (const Metric& metric : metrics()) {
    if (metric.key.starts_with("warnings.")) known.push_back(metric.key);
  }
  for (const recording::Warned& warned : recording::WarningWatch(recording::Truth::all).warned({}))
    given.push_back("warnings." + warned.word);
  EXPECT_EQ(known, given);
}

TEST(Metrics, HaveNoBetterDirectionWhereTheyAreTimesOrTruths) {
  for (const Metric& metric : metrics()) {
    const bool is_given = metric.is_time() || metric.key.starts_with("truth.");
    EXPECT_TRUE(!is_given || metric.scale.better == Direction::neutral) << metric.key;
  }
}

TEST(Metrics, SayWhichWayIsBetter) {
  EXPECT_EQ(metric("rebel.f1").scale.better, Direction::higher);
  EXPECT_EQ(metric("rebel.latency_frames_median").scale.better, Direction::lower);
  EXPECT_THROW(metric("no.such_figure"), std::out_of_range);
  EXPECT_EQ(sign_of_change(Direction::higher, 0.5, 0.6), 1);
  EXPECT_EQ(sign_of_change(Direction::higher, 0.6, 0.5), -1);
  EXPECT_EQ(sign_of_change(Direction::lower, 0.5, 0.6), -1);
  EXPECT_EQ(sign_of_change(Direction::lower, 0.6, 0.5), 1);
  EXPECT_EQ(sign_of_change(Direction::higher, 0.5, 0.5), 0);
  EXPECT_EQ(sign_of_change(Direction::neutral, 0.5, 0.6), 0);
}

TEST(Metrics, TheLeastChangeIsAbsoluteForSharesAndRelativeForLargeCounts) {
  EXPECT_DOUBLE_EQ(least_change(metric("rebel.f1").scale, 0.9), 0.01);
  const Scale& false_objects = metric("rebel.false_objects_per_100_frames").scale;
  EXPECT_DOUBLE_EQ(least_change(false_objects, 0), 1);
  EXPECT_DOUBLE_EQ(least_change(false_objects, 200), 10);
}

/// "(per frame, ↓ 0.1)", "(↑)": unit, better direction, and the least change unless it is 0.01;
/// empty without any.
std::string scale_text(const Scale& scale) {
  std::string text(scale.unit);
  if (scale.better != Direction::neutral) {
    if (!text.empty()) text += ", ";
    text += scale.better == Direction::higher ? "↑" : "↓";
    if (scale.least_change != 0.01) text += fmt::format(" {:g}", scale.least_change);
  }
  return text.empty() ? "" : " (" + text + ")";
}

/// SCORING.md states these amounts once.
TEST(Metrics, OfOneDirectionHaveTheSameShareAsLeastChange) {
  for (const Metric& metric : metrics()) {
    const Scale& scale = metric.scale;
    if (scale.better == Direction::neutral) continue;
    EXPECT_EQ(scale.least_share, scale.better == Direction::lower ? 0.05 : 0) << metric.key;
  }
}

/// The list in Markdown. Metrics of the same meaning share an entry.
std::string markdown() {
  using Entry = std::pair<std::string, std::string>;
  std::vector<Entry> entries;
  std::map<Entry, std::string> keys;
  for (const Metric& metric : metrics()) {
    const Entry entry{scale_text(metric.scale), metric.meaning};
    std::string& shared = keys[entry];
    if (shared.empty()) entries.push_back(entry);
    if (!shared.empty()) shared += ", ";
    shared += fmt::format("`{}`", metric.key);
    if (!metric.label.empty()) shared += fmt::format(" \"{}\"", metric.label);
  }
  std::string text;
  for (const Entry& entry : entries) {
    text += fmt::format("* {}{}: {}\n", keys[entry], entry.first, entry.second);
  }
  return text;
}

TEST(Metrics, AreAllInTheListOfScoringMd) {
  std::string document = test::read(LCS_SCORING_MD);
  const std::string begin = "<!-- metrics -->\n", end = "<!-- end of metrics -->";
  const std::size_t first = document.find(begin) + begin.size();
  const std::size_t size = document.find(end) - first;
  ASSERT_LT(first + size, document.size());
  const std::string written = document.substr(first, size);
  if (std::getenv("LCS_WRITE_DOCUMENTS") && written != markdown()) {
    std::ofstream(LCS_SCORING_MD) << document.replace(first, size, markdown());
  } else {
    EXPECT_EQ(written, markdown()) << "LCS_WRITE_DOCUMENTS=1 makes this test write it";
  }
}

}  // namespace
}  // namespace lcs::scoring
