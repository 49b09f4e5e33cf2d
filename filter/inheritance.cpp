#include "filter/inheritance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "filter/geometry.h"

namespace lcs {
namespace {

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

double rebel_log_odds(const InheritanceParameters& weights, const Surroundings& around,
                      const OwnPast& own) {
  double odds = weights.bias;
  odds +=
      weights.nearness * std::log((kClose_px + around.normal_px) / (kClose_px + around.rebel_px));
  odds += weights.gap * around.gap_rad;
  odds += weights.crowd * std::log1p(around.rebels);
  if (around.unfounded) odds += weights.unfounded;
  if (own.confirms) odds += weights.confirms;
  if (own.stands_once) odds += weights.stands_once;
  if (own.has_normal) odds += weights.normal;
  if (own.has_trusted) odds += weights.trusted;
  return odds;
}

}  // namespace lcs
