#include "filter/paper/couple_layering.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "filter/kinematics/geometry.h"
#include "filter/matching/refill.h"

namespace lcs::paper {
namespace {

bool contains(const Square& square, const Vec2& x) {
  return ((x - square.location).cwiseAbs() - square.half_size).maxCoeff() <= 0;
}

}  // namespace

bool parts(const Circle& between, const Circle& a, const Circle& b) {
  if (between.depth_ratio > a.depth_ratio) return false;
  const Vec2 ab = b.location - a.location;
  const Vec2 ac = between.location - a.location;
  const double d_ab = ab.norm(), d_ac = ac.norm();
  if (d_ab <= 0 || d_ac <= 0) return false;
  const double advance = ac.dot(ab) / d_ab;
  if (advance <= 0 || advance >= d_ab) return false;
  // asin(R / d) >= beta_m, the angle between the lines from a to b and from a to b'.
  return std::asin(std::min(1.0, between.radius / d_ac)) >=
         angle_between(angle_of(ab), angle_of(ac));
}

/// V_b - eps_v <= V_a <= V_b + eps_v, on ratios V / V_v, which are equal at equal depth.
bool CoupleLayering::like_speed(const Circle& a, const Circle& b) const {
  return std::abs(a.depth_ratio - b.depth_ratio) <= parameters_.epsilon_v;
}

/// Case 1: directions at a right angle (the corners of a square about O). Case 2: aligned.
bool CoupleLayering::couple(const Circle& a, const Circle& b) const {
  if (!like_speed(a, b)) return false;
  if (!parameters_.mix_kinds && a.rebel != b.rebel) return false;
  const double turn = angle_between(a.angle, b.angle);
  return std::abs(turn - parameters_.delta_beta_1) <= parameters_.epsilon_beta_1 ||
         turn <= parameters_.delta_beta_2 + parameters_.epsilon_beta_2;
}

int CoupleLayering::furthest_partner(std::size_t a, double d_t) const {
  int best = -1;
  double furthest = -1;
  for (std::size_t b = 0; b < circles_.size(); ++b) {
    if (b == a || used_[b]) continue;
    const double d = (circles_[b].location - circles_[a].location).norm();
    if (d < d_t && d > furthest && couple(circles_[a], circles_[b])) {
      best = static_cast<int>(b);
      furthest = d;
    }
  }
  return best;
}

Square CoupleLayering::mean_square(std::size_t a, const MotionField& field) const {
  const Circle& circle = circles_[a];
  Square square;
  Vec2 low = circle.location.array() - circle.radius;
  Vec2 high = circle.location.array() + circle.radius;
  Vec2 origin = Vec2::Zero(), step = unit_vector(circle.angle) * circle.speed;
  double speed = 0, ratio = 0;
  square.circles = 1 + static_cast<int>(partners_.size());
  square.rebel_circles = circle.rebel;
  for (const std::size_t b : partners_) {
    const Circle& other = circles_[b];
    low = low.cwiseMin(Vec2(other.location.array() - other.radius));
    high = high.cwiseMax(Vec2(other.location.array() + other.radius));
    origin += other.origin;
    speed += other.speed;
    ratio += other.depth_ratio;
    step += unit_vector(other.angle) * other.speed;
    square.rebel_circles += other.rebel;
  }
  // C_a has the same weight as all of C_b together.
  const double n = static_cast<double>(partners_.size());
  square.origin = n > 0 ? Vec2(0.5 * (circle.origin + origin / n)) : circle.origin;
  square.speed = n > 0 ? 0.5 * (circle.speed + speed / n) : circle.speed;
  square.depth_ratio = n > 0 ? 0.5 * (circle.depth_ratio + ratio / n) : circle.depth_ratio;
  square.location = 0.5 * (low + high);
  square.half_size = 0.5 * (high - low);
  const Vec2 along = square.rebel_circles > 0 ? step : field.direction(square.location);
  square.angle = angle_of(along.isZero() ? Vec2(square.location - square.origin) : along);
  return square;
}

/// Adds to C_b the circles inside the couple's square with similar motion.
void CoupleLayering::add_minor_circles(std::size_t a, double d_t, const MotionField& field) {
  const Square square = mean_square(a, field);
  for (std::size_t c = 0; c < circles_.size(); ++c) {
    if (used_[c] || c == a || c == partners_.front()) continue;
    const Circle& minor = circles_[c];
    if (!contains(square, minor.location)) continue;
    if ((minor.location - circles_[a].location).norm() >= d_t) continue;
    if (!parameters_.mix_kinds && minor.rebel != circles_[a].rebel) continue;
    if (std::abs(minor.depth_ratio - square.depth_ratio) > parameters_.epsilon_v) continue;
    if (angle_between(minor.angle, square.angle) <= parameters_.epsilon_beta)
      partners_.push_back(c);
  }
}

/// Forms couples of circles, furthest first, with the circles inside them. A circle without a
/// partner is a layer by itself.
const std::vector<Square>& CoupleLayering::layer(const BothKinds<Circle>& circles,
                                                 const MotionField& field) {
  circles_.clear();
  for (const auto* kind : {&circles.normal, &circles.rebel}) {
    for (const Circle& circle : *kind) {
      if (circle.members > 0) circles_.push_back(circle);
    }
  }
  std::stable_sort(circles_.begin(), circles_.end(), [](const Circle& a, const Circle& b) {
    return std::tuple(-a.trust, -a.members) < std::tuple(-b.trust, -b.members);
  });
  refill(used_, circles_.size());
  means_.clear();
  const double diagonal = std::hypot(camera_.width_px, camera_.height_px);
  for (std::size_t a = 0; a < circles_.size(); ++a) {
    if (used_[a]) continue;
    partners_.clear();
    double d_t = parameters_.d_t * diagonal;
    for (int b = furthest_partner(a, d_t); b >= 0; b = furthest_partner(a, d_t)) {
      const Circle& far = circles_[b];
      const auto parting = std::find_if(circles_.begin(), circles_.end(), [&](const Circle& c) {
        return &c != &circles_[a] && &c != &far && !like_speed(c, circles_[a]) &&
               parts(c, circles_[a], far);
      });
      if (parting == circles_.end()) {
        partners_.push_back(static_cast<std::size_t>(b));
        add_minor_circles(a, d_t, field);
        break;
      }
      // d_t = d_t - d_bb', limited to the distance of b, so that the search ends.
      const double d_ab = (far.location - circles_[a].location).norm();
      d_t = std::min(d_t - (far.location - parting->location).norm(), d_ab);
    }
    means_.push_back(mean_square(a, field));
    used_[a] = 1;
    for (const std::size_t b : partners_) used_[b] = 1;
  }
  return means_;
}

}  // namespace lcs::paper
