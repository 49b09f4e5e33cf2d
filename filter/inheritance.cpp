#include "filter/inheritance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "filter/geometry.h"

namespace lcs {
namespace {

/// Weights of evidence in natural logarithms: logistic regression over the corners near rebels in
/// the suite's recordings, rounded; EQUATIONS.md says how, and what each is worth.
constexpr double kBias = 2.62;
constexpr double kNearness = 1.1;    // of ln of the nearest normal's distance over the rebel's
constexpr double kPerRadian = -0.5;  // of the widest gap
constexpr double kCrowd = -0.55;     // of ln of how many rebels there are, and one
constexpr double kUnfounded = 0.2;
constexpr double kConfirms = 0.8;
constexpr double kStandsOnce = -0.7;
constexpr double kHasNormal = -0.9;
constexpr double kHasTrusted = -1.4;  // and this besides

/// Nearer than about this, distances say no more, px: corners lie as close on one body.
constexpr double kClose_px = 6;

/// Of a direction, counted from x to y.
int sector(Vec2 way) {
  int sector = 0;
  if (way.y() < 0) {
    way = -way;
    sector += 8;
  }
  if (way.x() < 0) {
    way = {way.y(), -way.x()};
    sector += 4;
  }
  if (way.y() > way.x()) {
    way = {way.x() + way.y(), way.y() - way.x()};
    sector += 2;
  }
  const double slope = std::numbers::sqrt2 - 1;  // tan of half of 45 deg
  return sector + (way.y() > slope * way.x());
}

}  // namespace

void Bearings::add(const Vec2& way) {
  taken_ |= 1u << sector(way);
}

double Bearings::widest_gap_rad() const {
  int widest = 0, run = 0;
  for (int i = 0; i < 2 * kSectors && widest < kSectors - 1; ++i) {
    run = (taken_ >> (i % kSectors)) & 1u ? 0 : run + 1;
    widest = std::max(widest, run);
  }
  return (widest + 1) * 2 * kPi / kSectors;
}

double rebel_log_odds(const Surroundings& around, const OwnPast& own) {
  double odds = kBias;
  odds += kNearness * std::log((kClose_px + around.normal_px) / (kClose_px + around.rebel_px));
  odds += kPerRadian * around.gap_rad;
  odds += kCrowd * std::log1p(around.rebels);
  if (around.unfounded) odds += kUnfounded;
  if (own.confirms) odds += kConfirms;
  if (own.stands_once) odds += kStandsOnce;
  if (own.has_normal) odds += kHasNormal;
  if (own.has_trusted) odds += kHasTrusted;
  return odds;
}

}  // namespace lcs
