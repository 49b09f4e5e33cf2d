#include "filter/paper/paper_squares.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "filter/kinematics/geometry.h"
#include "filter/line/line.h"
#include "filter/matching/refill.h"
#include "filter/paper/estimate.h"
#include "filter/paper/tangent.h"
#include "filter/squares/convex_hull.h"

namespace lcs::paper {
namespace {

double side_overlap(double a, double half_a, double b, double half_b) {
  return std::max(0.0, std::min(a + half_a, b + half_b) - std::max(a - half_a, b - half_b));
}

/// Moves a square with rebels by its own motion; its size changes only by measurement.
void carry_on(Square& square, const MotionField& field) {
  square.angle = field.turned(square.angle, square.location, square.origin);
  square.origin = field.rotated(square.origin);
  const Vec2 location =
      field.rotated(square.location) + square.speed * field.dt_s() * unit_vector(square.angle);
  place(square, location, square.half_size);
}

/// Moves a static square away from the focus of expansion, and scales it about that.
void expand(Square& square, const MotionField& field) {
  const Vec2 rotated = field.rotated(square.location);
  place(square, rotated, square.half_size);
  square.origin = field.origin(rotated);
  if (!field.moving()) return;
  square.depth_ratio = field.advanced_ratio(square.depth_ratio);
  square.speed = square.depth_ratio * field.reference_speed(rotated);
  const Vec2 outwards = rotated - square.origin;
  const double distance = outwards.norm();
  if (distance <= 0) return;
  const Vec2 moved = field.translated(rotated, square.depth_ratio);
  const double travelled = (moved - rotated).dot(outwards) / distance;  // Delta r
  const Extent extent{rotated, square.half_size};
  const Extent next = predict_by_tangents(extent, square.origin, travelled)
                          .value_or(predict_by_homothety(extent, square.origin, travelled));
  place(square, next.location, next.half_size);
  square.angle = angle_of(field.direction(square.location));
}

}  // namespace

double overlap_percent(const Square& a, const Square& b) {
  const double smaller =
      4 * std::min(a.half_size.x() * a.half_size.y(), b.half_size.x() * b.half_size.y());
  if (!(smaller > 0)) return 0;
  const double common =
      side_overlap(a.location.x(), a.half_size.x(), b.location.x(), b.half_size.x()) *
      side_overlap(a.location.y(), a.half_size.y(), b.location.y(), b.half_size.y());
  return std::min(100.0, 100 * common / smaller);
}

const std::vector<Square>& PaperSquares::predict(const std::vector<Square>& before,
                                                 const MotionField& field) {
  copy_over(before, predicted_);
  for (Square& square : predicted_) {
    if (square.rebel_circles > 0) {
      carry_on(square, field);
    } else {
      expand(square, field);
    }
  }
  return predicted_;
}

const std::vector<Square>& PaperSquares::update(const BothKinds<Circle>& circles,
                                                const std::vector<Square>& predicted,
                                                std::span<const IgnoreRegion> psi,
                                                const MotionField& field) {
  copy_over(predicted, squares_);
  copy_over(couples_.layer(circles, field), means_);
  pairs_.clear();
  for (std::size_t s = 0; s < squares_.size(); ++s) {
    const Square& square = squares_[s];
    for (std::size_t m = 0; m < means_.size(); ++m) {
      const double rho_s = overlap_percent(square, means_[m]);
      if (rho_s <= parameters_.rho_c) continue;
      if (std::abs(square.depth_ratio - means_[m].depth_ratio) > parameters_.epsilon_v_s) continue;
      const bool aligned =
          angle_between(square.angle, means_[m].angle) <= parameters_.epsilon_beta_s;
      pairs_.push_back({rho_s, (square.location - means_[m].location).norm(), s, m, aligned});
    }
  }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tuple(!a.aligned, a.distance, -a.overlap, a.square, a.mean) <
           std::tuple(!b.aligned, b.distance, -b.overlap, b.square, b.mean);
  });
  refill(matched_, squares_.size());
  refill(mean_used_, means_.size());
  const TrustRanks& ranks = parameters_.trust;
  for (const Pair& pair : pairs_) {
    if (matched_[pair.square] || mean_used_[pair.mean]) continue;
    matched_[pair.square] = mean_used_[pair.mean] = 1;
    Square& square = squares_[pair.square];
    const Square& mean = means_[pair.mean];
    // Circles that coast in psi keep their square alive, but are no evidence.
    const bool unseen = inside_any(psi, square.location);
    square.location = estimate(square.trust, ranks, square.location, mean.location);
    square.half_size = estimate(square.trust, ranks, square.half_size, mean.half_size);
    square.speed = mean.speed;
    square.depth_ratio = mean.depth_ratio;
    square.angle = mean.angle;
    square.origin = mean.origin;
    square.circles = mean.circles;
    square.rebel_circles = mean.rebel_circles;
    ++square.age;
    if (!unseen) square.trust = pair.aligned ? ranks.raised(square.trust) : square.trust - 1;
  }
  for (std::size_t s = 0; s < squares_.size(); ++s) {
    if (matched_[s]) continue;
    Square& square = squares_[s];
    ++square.age;
    square.circles = 0;
    if (!inside_any(psi, square.location)) --square.trust;
  }
  for (std::size_t m = 0; m < means_.size(); ++m) {
    if (mean_used_[m]) continue;
    Square square = means_[m];
    square.id = next_id_++;
    square.trust = ranks.initial_square();
    squares_.push_back(square);
  }
  std::erase_if(squares_, [&](const Square& square) {
    const Vec2& x = square.location;
    return !ranks.alive(square.trust) || x.x() < 0 || x.y() < 0 || x.x() > camera_.width_px ||
           x.y() > camera_.height_px;
  });
  if (!ignore_) return squares_;
  for (Square& square : squares_) {
    square.ignoring = square.trust >= ranks.maximum && square.rebel_circles == 0;
    if (square.ignoring) square.trust = ranks.after_ignoring();
  }
  return squares_;
}

}  // namespace lcs::paper
