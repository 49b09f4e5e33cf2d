/// What a corner is taken for by what is round it: each piece of evidence weighs as it should.
#include "filter/inheritance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "filter/geometry.h"

namespace lcs {
namespace {

constexpr double kSector_rad = 2 * kPi / Bearings::kSectors;

Bearings towards(std::initializer_list<double> angles_rad) {
  Bearings bearings;
  for (const double angle : angles_rad) bearings.add(10 * unit_vector(angle));
  return bearings;
}

TEST(Bearings, OfOneDirectionOrNoneTheGapIsAllRound) {
  EXPECT_DOUBLE_EQ(Bearings().widest_gap_rad(), 2 * kPi);
  for (int i = 0; i < 32; ++i) EXPECT_DOUBLE_EQ(towards({0.2 * i}).widest_gap_rad(), 2 * kPi);
}

TEST(Bearings, TheWidestGapIsThatOfTheAnglesToASector) {
  // Against the gap between the angles themselves, which may lie anywhere in their sectors.
  for (int i = 0; i < 100; ++i) {
    const double first = 0.063 * i, second = first + 2.1 + 0.01 * i;
    const double exact = std::max(second - first, 2 * kPi - (second - first));
    EXPECT_NEAR(towards({first, second}).widest_gap_rad(), exact, kSector_rad) << first;
  }
}

TEST(Bearings, InsideOfAHullItIsLessThanHalfATurnAndOutsideMore) {
  EXPECT_LT(towards({0.1, 1.7, 3.3, 4.9}).widest_gap_rad(), kPi);
  EXPECT_GT(towards({0.1, 0.9, 1.7}).widest_gap_rad(), kPi);
}

TEST(Bearings, AQuarterTurnOfAllChangesNothing) {
  for (int i = 0; i < 50; ++i) {
    const double a = 0.05 + 0.13 * i, b = a + 0.7, c = a + 2.9;
    EXPECT_DOUBLE_EQ(towards({a, b, c}).widest_gap_rad(),
                     towards({a + kPi / 2, b + kPi / 2, c + kPi / 2}).widest_gap_rad());
  }
}

double odds_of(const Surroundings& around, const OwnPast& own) {
  return rebel_log_odds(preset("default").circle.inheritance, around, own);
}

Surroundings beside_rebels() {
  Surroundings around;
  around.rebel_px = 8;
  around.normal_px = 20;
  around.rebels = 10;
  around.gap_rad = kPi;
  return around;
}

TEST(RebelLogOdds, ARebelThatIsNearerSaysMoreAndANormalThatIsNearerLess) {
  Surroundings around = beside_rebels();
  const double odds = odds_of(around, {});
  around.rebel_px = 4;
  EXPECT_GT(odds_of(around, {}), odds);
  around = beside_rebels();
  around.normal_px = 4;
  EXPECT_LT(odds_of(around, {}), odds);
}

TEST(RebelLogOdds, OutsideOfTheRebelsACornerIsLessLikelyOne) {
  Surroundings around = beside_rebels();
  const double odds = odds_of(around, {});
  around.gap_rad = 5;
  EXPECT_LT(odds_of(around, {}), odds);
}

TEST(RebelLogOdds, WhatTheCornersOwnPastShowsWeighsAsItSpeaks) {
  const Surroundings around = beside_rebels();
  const double odds = odds_of(around, {});
  OwnPast moves, stands, taken, trusted;
  moves.confirms = true;
  stands.stands_once = true;
  taken.has_normal = true;
  trusted.has_normal = trusted.has_trusted = true;
  EXPECT_GT(odds_of(around, moves), odds);
  EXPECT_LT(odds_of(around, stands), odds);
  EXPECT_LT(odds_of(around, taken), odds);
  EXPECT_LT(odds_of(around, trusted), odds_of(around, taken));
}

TEST(RebelLogOdds, ATrustedNormalEdgeBesideOthersStandsAgainstOneRebelFarOff) {
  Surroundings around;
  around.rebel_px = 50;
  around.normal_px = 10;
  around.rebels = 1;
  around.gap_rad = 2 * kPi;
  OwnPast own;
  own.has_normal = own.has_trusted = true;
  EXPECT_LT(odds_of(around, own), std::log(0.05 / 0.95));
}

TEST(RebelLogOdds, ANewCornerAmongRebelsIsOneMoreLikelyThanNot) {
  Surroundings around;
  around.rebel_px = 7;
  around.normal_px = 60;
  around.rebels = 5;
  around.gap_rad = 2;
  EXPECT_GT(odds_of(around, {}), 0);
}

}  // namespace
}  // namespace lcs
