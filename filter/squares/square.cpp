#include "filter/squares/square.h"

#include <algorithm>

#include "filter/matching/refill.h"

namespace lcs {
namespace {

/// By how much a body is larger than what its corners span: of numbers drawn evenly from an
/// interval the range is, in the mean, (count - 1) / (count + 1) of it.
double beyond(std::ptrdiff_t count) {
  return static_cast<double>(count + 1) /
         static_cast<double>(std::max<std::ptrdiff_t>(count - 1, 1));
}

}  // namespace

SquareExpert::SquareExpert(const Intrinsics& camera, const SquareParameters& parameters)
    : camera_(camera), parameters_(parameters), paper_(camera, parameters) {}

void SquareExpert::predict(Layers& layers, const MotionField& field) const {
  if (parameters_.layer_rule == LayerRule::couples) paper_.predict(layers, field);
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

/// Whether a circle is an object's whose box is as large.
bool SquareExpert::is_object(const Circle& circle, const Vec2& half_size,
                             const MotionField& field) const {
  const double w = circle.depth_ratio / field.reference_depth_m();
  return circle.rebel || 2 * half_size.maxCoeff() <= parameters_.max_size * camera_.focal_px * w;
}

/// The squares of circles of one kind.
void SquareExpert::box(const std::vector<Circle>& circles, const std::vector<Square>& before,
                       const MotionField& field) {
  auto place = places_.begin();
  for (std::size_t c = 0; c < circles.size(); ++c) {
    const Circle& circle = circles[c];
    if (circle.members == 0) {  // nobody looks, and its square goes with it
      const auto was = std::find_if(before.begin(), before.end(),
                                    [&](const Square& square) { return square.id == circle.id; });
      if (was == before.end()) continue;
      Square& square = squares_.emplace_back(*was);
      lcs::place(square, circle.location, square.half_size);
      square.circles = square.rebel_circles = 0;
      square.age = circle.age;
      square.ignoring = circle.ignoring;
      continue;
    }
    hull_.clear();
    const auto first = place;
    for (; place != places_.end() && place->circle == static_cast<int>(c); ++place) {
      hull_.add(place->location);
    }
    const auto [low, high] = hull_.box();
    Square square;
    square.location = 0.5 * (low + high);
    square.half_size = 0.5 * (high - low);
    const Vec2 half_size = beyond(place - first) * square.half_size;
    if (!is_object(circle, half_size, field)) continue;
    square.outline = hull_.outline();
    lcs::place(square, square.location, half_size);
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
  // By circles, a square is ignored with its circle.
  if (parameters_.layer_rule == LayerRule::couples) paper_.update_ignorance(layers);
}

}  // namespace lcs
