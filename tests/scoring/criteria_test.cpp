#include "tools/scoring/criteria.h"

#include <gtest/gtest.h>

#include "tests/tools/refusal.h"

namespace lcs::scoring {
namespace {

scenario::Criterion criterion(const std::string& metric, std::optional<double> min,
                              std::optional<double> max, bool required = true) {
  return {metric, min, max, required, {"crossing.yaml", 31}};
}

const Metrics kMetrics{{"rebel.f1", 0.5}, {"square.recall_50", std::nullopt}};

TEST(Criteria, BoundsAreInclusive) {
  EXPECT_TRUE(judge({criterion("rebel.f1", 0.5, 0.5)}, kMetrics)[0].met);
  EXPECT_FALSE(judge({criterion("rebel.f1", 0.51, {})}, kMetrics)[0].met);
  EXPECT_FALSE(judge({criterion("rebel.f1", {}, 0.49)}, kMetrics)[0].met);
}

TEST(Criteria, AnUndefinedFigureMeetsNoBound) {
  const auto failed = judge({criterion("square.recall_50", 0, {})}, kMetrics);
  EXPECT_FALSE(failed[0].met);
  EXPECT_EQ(failed[0].message,
            "crossing.yaml:31: square.recall_50 is undefined, must be at least 0");
}

TEST(Criteria, AFailureNamesMetricValueBoundsAndLine) {
  const auto failed = judge({criterion("rebel.f1", 0.6, 0.9, false)}, kMetrics);
  EXPECT_EQ(failed[0].message,
            "crossing.yaml:31: rebel.f1 is 0.5, must be at least 0.6 and at most 0.9");
  EXPECT_FALSE(failed[0].required);
}

TEST(Criteria, ThoseThatAreMetAreJudgedToo) {
  const auto judged =
      judge({criterion("rebel.f1", 0.4, {}), criterion("rebel.f1", 0.6, {})}, kMetrics);
  ASSERT_EQ(judged.size(), 2u);
  EXPECT_TRUE(judged[0].met);
  EXPECT_EQ(judged[0].value, 0.5);
  EXPECT_EQ(judged[0].message, "");
  EXPECT_FALSE(judged[1].met);
  EXPECT_NE(judged[1].message, "");
}

TEST(Criteria, AnUnknownMetricIsRefusedAtItsLineWithTheNearestOne) {
  EXPECT_NO_THROW(require_known_metrics({criterion("rebel.f1", 0.6, {})}));
  const std::vector<scenario::Criterion> criteria{criterion("rebel.f1", 0.6, {}),
                                                  criterion("rebel.recal", 0.6, {})};
  EXPECT_EQ(test::refusal_of<input::Error>([&] { require_known_metrics(criteria); }),
            "crossing.yaml:31: no metric is called 'rebel.recal'; did you mean 'rebel.recall'?");
}

}  // namespace
}  // namespace lcs::scoring
