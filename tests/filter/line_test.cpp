#include "filter/line/line.h"
#include "filter/paper/paper_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "tests/filter/world.h"

namespace lcs {
namespace {

using testing::Random;

IgnoreRegion disc(const Vec2& at, double radius) {
  return {IgnoreRegion::Shape::circle, at, {radius, radius}};
}
IgnoreRegion rectangle(const Vec2& at, const Vec2& half) {
  return {IgnoreRegion::Shape::rectangle, at, half};
}

LineExpert line_expert(int most = 1000) {
  return {testing::vga(), {.max_corners = most}};
}

Chi collected(const std::vector<Eigen::Vector2f>& corners, const std::vector<IgnoreRegion>& psi,
              std::vector<Verdict>& verdicts, int most = 1000) {
  LineExpert line = line_expert(most);
  const Chi& chi = line.collect(corners, {}, psi);
  FrameResult result;
  assign_verdicts(chi, std::vector<Verdict>(chi.size(), Verdict::pending),
                  std::vector<Reason>(chi.size()), {}, result);
  verdicts = result.verdicts;
  return chi;
}

TEST(LineExpert, HandsOnTheSignaturesOfTheCornersItLooksAtInTheirOrder) {
  Random random(11);
  std::vector<Eigen::Vector2f> corners;
  std::vector<Signature> signatures;
  for (std::uint64_t i = 0; i < 60; ++i) {
    // Some lie outside of the picture, and some inside of psi.
    corners.emplace_back(random.uniform(-60, 639), random.uniform(0, 479));
    signatures.push_back({i, i << 40, ~i, 7});
  }
  corners.emplace_back(std::numeric_limits<float>::quiet_NaN(), 10.F);
  signatures.push_back({});
  const std::vector<IgnoreRegion> psi = {disc({100, 100}, 90)};
  LineExpert line = line_expert(40);
  const Chi& chi = line.collect(corners, signatures, psi);
  ASSERT_EQ(chi.size(), 40U);
  ASSERT_EQ(chi.signatures.size(), chi.size());
  for (std::size_t c = 0; c < chi.size(); ++c) {
    EXPECT_EQ(chi.signatures[c], signatures[static_cast<std::size_t>(chi.sources[c])]) << c;
  }
  line.collect(corners, {}, psi);
  EXPECT_EQ(chi.size(), 40U);
  EXPECT_TRUE(chi.signatures.empty()) << "of the frame before";
}

TEST(LineExpert, OfCornersAtOnePlaceTakesTheSameSignatureInWhateverOrderTheyCome) {
  const std::vector<Eigen::Vector2f> corners(3, {200, 100});
  const std::vector<Signature> one = {Signature{5}, Signature{3}, Signature{4}},
                               other = {Signature{3}, Signature{4}, Signature{5}};
  for (const std::vector<Signature>& signatures : {one, other}) {
    LineExpert line = line_expert();
    const Chi& chi = line.collect(corners, signatures, {});
    EXPECT_EQ(chi.signatures, std::vector{Signature{3}});
    EXPECT_EQ(chi.repeats.size(), 2U);
  }
}

TEST(LineExpert, LooksAtTheNearestToTheCentreOfTooManyCorners) {
  Random random(9);
  std::vector<Eigen::Vector2f> corners;
  for (int i = 0; i < 100; ++i) {
    corners.emplace_back(random.uniform(0, 639), random.uniform(0, 479));
  }
  std::vector<Verdict> verdicts;
  const std::vector<int> all = collected(corners, {}, verdicts).sources;
  const std::vector<int> kept = collected(corners, {}, verdicts, 30).sources;
  ASSERT_EQ(all.size(), 100U);
  EXPECT_EQ(kept, std::vector<int>(all.begin(), all.begin() + 30));
  EXPECT_EQ(std::count(verdicts.begin(), verdicts.end(), Verdict::pending), 100);
}

TEST(Lambda, GroupsByTheNearestCollectorAndOfEqualsTheFirst) {
  Random random(10);
  std::vector<Eigen::Vector2f> corners;
  std::vector<Collector> lambda;
  for (int i = 0; i < 400; ++i) {
    corners.emplace_back(random.uniform(0, 639), random.uniform(0, 479));
    if (i % 8 == 0) lambda.push_back({corners.back().cast<double>(), random.uniform(0, 90), 1});
  }
  lambda.push_back(lambda.front());
  std::vector<Verdict> verdicts;
  const Chi chi = collected(corners, {}, verdicts);
  const std::vector<int> groups = paper::Feedback({}).group(lambda, chi);
  for (std::size_t i = 0; i < chi.size(); ++i) {
    int expected = -1;
    double nearest = 0;
    for (std::size_t c = 0; c < lambda.size(); ++c) {
      const double distance = (chi.locations[i] - lambda[c].location).norm();
      if (distance > lambda[c].radius || (expected >= 0 && distance >= nearest)) continue;
      expected = static_cast<int>(c);
      nearest = distance;
    }
    EXPECT_EQ(groups[i], expected);
  }
}

TEST(LineExpert, RemovesExactlyTheCornersInsidePsi) {
  Random random(1);
  const std::vector<IgnoreRegion> psi = {disc({100, 100}, 60), rectangle({400, 300}, {120, 40})};
  std::vector<Eigen::Vector2f> corners;
  for (int i = 0; i < 500; ++i) {
    corners.emplace_back(random.uniform(0, 639), random.uniform(0, 479));
  }
  std::vector<Verdict> verdicts;
  const Chi chi = collected(corners, psi, verdicts);
  std::size_t outside = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 x = corners[i].cast<double>();
    const bool in_disc = (x - Vec2(100, 100)).norm() <= 60;
    const bool in_rectangle = std::abs(x.x() - 400) <= 120 && std::abs(x.y() - 300) <= 40;
    EXPECT_EQ(verdicts[i] == Verdict::ignored, in_disc || in_rectangle);
    outside += !in_disc && !in_rectangle;
  }
  EXPECT_EQ(chi.size(), outside);
}

TEST(Lambda, GroupsByTheNearestCollectorAndLeavesTheRestSingle) {
  const std::vector<Collector> lambda = {{{100, 100}, 50}, {{160, 100}, 50}};
  const std::vector<Eigen::Vector2f> corners = {{90, 100}, {140, 100}, {300, 300}};
  std::vector<Verdict> verdicts;
  const Chi chi = collected(corners, {}, verdicts);
  const std::vector<int> groups = paper::Feedback({}).group(lambda, chi);
  std::vector<int> group(3, -2);
  for (std::size_t c = 0; c < chi.size(); ++c) group[chi.sources[c]] = groups[c];
  EXPECT_EQ(group, (std::vector<int>{0, 1, -1}));  // 140 is within both, and nearer to 160
}

TEST(LineExpert, OrderOfTheCornersMakesNoDifference) {
  Random random(2);
  std::vector<Eigen::Vector2f> corners;
  for (int i = 0; i < 100; ++i) {
    corners.emplace_back(random.uniform(0, 639), random.uniform(0, 479));
  }
  std::vector<Verdict> verdicts;
  const std::vector<Vec2> forward = collected(corners, {}, verdicts).locations;
  std::reverse(corners.begin(), corners.end());
  const std::vector<Vec2> backward = collected(corners, {}, verdicts).locations;
  EXPECT_EQ(forward, backward);
}

TEST(LineExpert, CornersThatAreNotFiniteStayPendingAndGoNoFurther) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<Eigen::Vector2f> corners = {{nan, 3}, {4, inf}, {5, 5}};
  std::vector<Verdict> verdicts;
  EXPECT_EQ(collected(corners, {}, verdicts).size(), 1u);
  EXPECT_EQ(verdicts, (std::vector<Verdict>(3, Verdict::pending)));
}

TEST(LineExpert, NothingOrEverythingIgnoredIsAnEmptyChi) {
  std::vector<Verdict> verdicts;
  EXPECT_EQ(collected({}, {}, verdicts).size(), 0u);
  const std::vector<Eigen::Vector2f> corners = {{10, 10}, {20, 20}};
  const std::vector<IgnoreRegion> psi = {rectangle({0, 0}, {100, 100})};
  EXPECT_EQ(collected(corners, psi, verdicts).size(), 0u);
  EXPECT_EQ(verdicts, (std::vector<Verdict>(2, Verdict::ignored)));
}

}  // namespace
}  // namespace lcs
