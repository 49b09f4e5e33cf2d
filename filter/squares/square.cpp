#include "filter/squares/square.h"

#include <algorithm>
#include <cmath>

#include "filter/kinematics/geometry.h"
#include "filter/matching/refill.h"
#include "filter/paper/tangent.h"

namespace lcs {
namespace {

/// A square with rebels is carried by its own motion; how its size changes is not known before the
/// circles say so.
void carry_on(Square& square, const MotionField& field) {
  square.angle = field.turned(square.angle, square.location, square.origin);
  square.origin = field.rotated(square.origin);
  const Vec2 location =
      field.rotated(square.location) + square.speed * field.dt_s() * unit_vector(square.angle);
  place(square, location, square.half_size);
}

/// A static square moves away from the focus of expansion, and grows about it.
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

SquareExpert::SquareExpert(const Intrinsics& camera, const SquareParameters& parameters)
    : camera_(camera), parameters_(parameters), paper_(camera, parameters) {}

void SquareExpert::predict(Layers& layers, const MotionField& field) const {
  for (Square& square : layers.squares) {
    if (square.rebel_circles > 0) {
      carry_on(square, field);
    } else {
      expand(square, field);
    }
  }
}

void SquareExpert::feed_back(const Layers& layers, std::vector<IgnoreRegion>& psi) const {
  for (const Square& square : layers.squares) {
    if (square.ignoring) {
      psi.push_back({IgnoreRegion::Shape::rectangle, square.location, square.half_size});
    }
  }
}

/// Where the edges of circles are, and what follows them, circle by circle.
void SquareExpert::gather(const std::vector<Edge>& edges, std::span<const Follower> followers) {
  places_.clear();
  make_room(places_, edges.size() + followers.size());
  for (const Edge& edge : edges) {
    if (edge.circle >= 0) places_.push_back({edge.circle, edge.location});
  }
  for (const Follower& follower : followers) {
    // Ids rise in the lists of edges.
    const auto edge = std::lower_bound(edges.begin(), edges.end(), follower.edge,
                                       [](const Edge& before, Id id) { return before.id < id; });
    if (edge == edges.end() || edge->id != follower.edge || edge->circle < 0) continue;
    places_.push_back({edge->circle, follower.location});
  }
  std::sort(places_.begin(), places_.end(),
            [](const Place& a, const Place& b) { return a.circle < b.circle; });
}

/// Whether a circle is an object's, of the size that its box in `square` has.
bool SquareExpert::is_object(const Circle& circle, const Square& square,
                             const MotionField& field) const {
  const Vec2 size = 2 * square.half_size;
  if (size.prod() < parameters_.min_area) return false;
  const double w = circle.depth_ratio / field.reference_depth_m();
  return circle.rebel || size.maxCoeff() <= parameters_.max_size * camera_.focal_px * w;
}

/// The squares of circles of one kind.
void SquareExpert::box(const std::vector<Circle>& circles, const std::vector<Square>& before,
                       const MotionField& field) {
  auto place = places_.begin();
  for (std::size_t c = 0; c < circles.size(); ++c) {
    const Circle& circle = circles[c];
    if (circle.members == 0) {  // nobody looks, and its square goes on as it was expected to
      const auto was = std::find_if(before.begin(), before.end(),
                                    [&](const Square& square) { return square.id == circle.id; });
      if (was == before.end()) continue;
      squares_.push_back(*was);
      squares_.back().circles = squares_.back().rebel_circles = 0;
      squares_.back().age = circle.age;
      squares_.back().ignoring = circle.ignoring;
      continue;
    }
    hull_.clear();
    for (; place != places_.end() && place->circle == static_cast<int>(c); ++place) {
      hull_.add(place->location);
    }
    const auto [low, high] = hull_.box();
    Square square;
    square.location = 0.5 * (low + high);
    square.half_size = 0.5 * (high - low);
    if (!is_object(circle, square, field)) continue;
    square.outline = hull_.outline();
    square.origin = circle.origin;
    square.speed = circle.speed;
    square.depth_ratio = circle.depth_ratio;
    square.angle = circle.angle;
    square.circles = 1;
    square.rebel_circles = circle.rebel;
    square.id = circle.id;
    square.trust = circle.trust;
    square.age = circle.age;
    square.ignoring = circle.ignoring;
    squares_.push_back(square);
  }
}

void SquareExpert::update(Layers& layers, const MotionField& field,
                          std::span<const Follower> followers) {
  if (parameters_.layer_rule == LayerRule::couples) {
    paper_.update(layers, field);
    return;
  }
  squares_.clear();
  make_room(squares_, layers.normal_circles.size() + layers.rebel_circles.size());
  gather(layers.normal_edges, {});
  box(layers.normal_circles, layers.squares, field);
  gather(layers.rebel_edges, followers);
  box(layers.rebel_circles, layers.squares, field);
  copy_over(squares_, layers.squares);
}

void SquareExpert::update_ignorance(Layers& layers) const {
  if (parameters_.layer_rule == LayerRule::circles) return;  // a square is ignored with its circle
  for (Square& square : layers.squares) {
    square.ignoring = square.trust >= parameters_.trust.maximum && square.rebel_circles == 0;
    if (square.ignoring) square.trust = parameters_.trust.after_ignoring();
  }
}

}  // namespace lcs
