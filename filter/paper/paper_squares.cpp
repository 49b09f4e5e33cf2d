#include "filter/paper/paper_squares.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "filter/kinematics/geometry.h"
#include "filter/line/line.h"
#include "filter/paper/estimate.h"
#include "filter/squares/convex_hull.h"
#include "filter/vectors/refill.h"

namespace lcs::paper {
namespace {

/// Denominators below this, in units of the square's size, are treated as singular.
constexpr double kSingular = 1e-3;

/// Half sizes of the axis-parallel ellipse about `centre` that touches the line from O at `touch`.
std::optional<Vec2> touching_ellipse(const Vec2& centre, const Vec2& touch, const Vec2& origin,
                                     double scale) {
  const Vec2 o = origin - touch;  // O - L~_t
  const Vec2 c = touch - centre;  // L~_t - L~_s
  const double least = kSingular * scale;
  if (std::abs(o.x()) < least || std::abs(o.y()) < least || std::abs(c.x()) < least ||
      std::abs(c.y()) < least) {
    return std::nullopt;
  }
  const double ry2 = std::abs((o.x() * c.y() * c.y() - o.y() * c.x() * c.y()) / o.x());
  const double rx2 = std::abs(ry2 * o.x() * c.x() / (o.y() * c.y()));
  return Vec2(std::sqrt(rx2), std::sqrt(ry2));
}

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

std::optional<std::pair<Vec2, Vec2>> tangent_points(const Extent& ellipse, const Vec2& origin) {
  if (ellipse.half_size.minCoeff() <= 0) return std::nullopt;
  // On the unit circle: the chord of contact is the polar of o.
  const Vec2 o = (origin - ellipse.location).cwiseQuotient(ellipse.half_size);
  const double o2 = o.squaredNorm();
  if (o2 <= 1) return std::nullopt;
  const Vec2 foot = o / o2;
  const Vec2 half_chord = std::sqrt(o2 - 1) / o2 * Vec2(-o.y(), o.x());
  return std::pair{Vec2(ellipse.location + ellipse.half_size.cwiseProduct(foot + half_chord)),
                   Vec2(ellipse.location + ellipse.half_size.cwiseProduct(foot - half_chord))};
}

std::optional<Extent> predict_by_tangents(const Extent& square, const Vec2& origin,
                                          double travelled_px) {
  const auto points = tangent_points(square, origin);
  if (!points) return std::nullopt;
  const double to_centre = (square.location - origin).norm();
  Extent predicted;
  predicted.location = square.location + travelled_px * (square.location - origin) / to_centre;
  if (to_centre + travelled_px <= 0) return std::nullopt;
  // Uses the touching point that is farther from the axes, as it is better conditioned.
  const auto conditioning = [&](const Vec2& t) {
    return (t - square.location).cwiseAbs().minCoeff();
  };
  const Vec2 touch =
      conditioning(points->first) >= conditioning(points->second) ? points->first : points->second;
  const double to_touch = (touch - origin).norm();
  const double d_r = (to_centre + travelled_px) * to_touch / to_centre - to_touch;
  // Equals m_t and the two printed equations for L~_t, with the sign that leads away from O.
  const Vec2 moved = touch + d_r * (touch - origin) / to_touch;
  const auto half_size =
      touching_ellipse(predicted.location, moved, origin, square.half_size.maxCoeff());
  if (!half_size) return std::nullopt;
  predicted.half_size = *half_size;
  return predicted;
}

Extent predict_by_homothety(const Extent& square, const Vec2& origin, double travelled_px) {
  const Vec2 ray = square.location - origin;
  const double distance = ray.norm();
  if (distance <= 0) return square;
  const double s = std::max(0.0, (distance + travelled_px) / distance);
  return {origin + s * ray, s * square.half_size};
}

double overlap_percent(const Square& a, const Square& b) {
  const double smaller =
      4 * std::min(a.half_size.x() * a.half_size.y(), b.half_size.x() * b.half_size.y());
  if (!(smaller > 0)) return 0;
  const double common =
      side_overlap(a.location.x(), a.half_size.x(), b.location.x(), b.half_size.x()) *
      side_overlap(a.location.y(), a.half_size.y(), b.location.y(), b.half_size.y());
  return std::min(100.0, 100 * common / smaller);
}

void PaperSquares::predict(std::vector<Square>& squares, const MotionField& field) {
  for (Square& square : squares) {
    if (square.rebel_circles > 0) {
      carry_on(square, field);
    } else {
      expand(square, field);
    }
  }
}

void PaperSquares::update(const BothKinds<Circle>& circles, std::span<const IgnoreRegion> psi,
                          const MotionField& field, std::vector<Square>& squares) {
  layer(circles, field);
  pairs_.clear();
  for (std::size_t s = 0; s < squares.size(); ++s) {
    const Square& square = squares[s];
    for (std::size_t m = 0; m < means_.size(); ++m) {
      const double rho_s = overlap_percent(square, means_[m]);
      if (rho_s <= parameters_.rho_c) continue;
      if (std::abs(square.depth_ratio - means_[m].depth_ratio) > parameters_.epsilon_v_s) continue;
      const bool aligned =
          angle_between(square.angle, means_[m].angle) <= parameters_.epsilon_beta_s;
      pairs_.push_back({rho_s, (square.location - means_[m].location).norm(), s, m, aligned});
    }
  }
  std::ranges::sort(pairs_, {}, [](const Pair& pair) {
    return std::tuple(!pair.aligned, pair.distance, -pair.overlap, pair.square, pair.mean);
  });
  refill(matched_, squares.size());
  refill(mean_used_, means_.size());
  const TrustRanks& ranks = parameters_.trust;
  for (const Pair& pair : pairs_) {
    if (matched_[pair.square] || mean_used_[pair.mean]) continue;
    matched_[pair.square] = mean_used_[pair.mean] = 1;
    Square& square = squares[pair.square];
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
  for (std::size_t s = 0; s < squares.size(); ++s) {
    if (matched_[s]) continue;
    Square& square = squares[s];
    ++square.age;
    square.circles = 0;
    if (!inside_any(psi, square.location)) --square.trust;
  }
  for (std::size_t m = 0; m < means_.size(); ++m) {
    if (mean_used_[m]) continue;
    Square square = means_[m];
    square.id = next_id_++;
    square.trust = ranks.initial_square();
    squares.push_back(square);
  }
  std::erase_if(squares, [&](const Square& square) {
    const Vec2& x = square.location;
    return !ranks.alive(square.trust) || x.x() < 0 || x.y() < 0 || x.x() > camera_.width_px ||
           x.y() > camera_.height_px;
  });
  if (!ignore_) return;
  for (Square& square : squares) {
    square.ignoring = square.trust >= ranks.maximum && square.rebel_circles == 0;
    if (square.ignoring) square.trust = ranks.after_ignoring();
  }
}

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
bool PaperSquares::like_speed(const Circle& a, const Circle& b) const {
  return std::abs(a.depth_ratio - b.depth_ratio) <= parameters_.epsilon_v;
}

/// Case 1: directions at a right angle (the corners of a square about O). Case 2: aligned.
bool PaperSquares::couple(const Circle& a, const Circle& b) const {
  if (!like_speed(a, b)) return false;
  if (!parameters_.mix_kinds && a.rebel != b.rebel) return false;
  const double turn = angle_between(a.angle, b.angle);
  return std::abs(turn - parameters_.delta_beta_1) <= parameters_.epsilon_beta_1 ||
         turn <= parameters_.delta_beta_2 + parameters_.epsilon_beta_2;
}

int PaperSquares::furthest_partner(std::size_t a, double d_t) const {
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

Square PaperSquares::mean_square(std::size_t a, const MotionField& field) const {
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
void PaperSquares::add_minor_circles(std::size_t a, double d_t, const MotionField& field) {
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

/// Forms couples of similar circles, furthest first, with the circles inside them. A circle without
/// a partner is a layer by itself.
void PaperSquares::layer(const BothKinds<Circle>& circles, const MotionField& field) {
  circles_.clear();
  for (const auto* kind : {&circles.normal, &circles.rebel}) {
    for (const Circle& circle : *kind) {
      if (circle.members > 0) circles_.push_back(circle);
    }
  }
  std::ranges::stable_sort(circles_, {},
                           [](const Circle& c) { return std::tuple(-c.trust, -c.members); });
  refill(used_, circles_.size());
  means_.clear();
  const double diagonal = std::hypot(camera_.width_px, camera_.height_px);
  for (std::size_t a = 0; a < circles_.size(); ++a) {
    if (used_[a]) continue;
    partners_.clear();
    double d_t = parameters_.d_t * diagonal;
    for (int b = furthest_partner(a, d_t); b >= 0; b = furthest_partner(a, d_t)) {
      const Circle& far = circles_[b];
      const auto parting = std::ranges::find_if(circles_, [&](const Circle& c) {
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
}

}  // namespace lcs::paper
