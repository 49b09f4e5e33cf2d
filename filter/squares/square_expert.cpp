#include "filter/squares/square_expert.h"

#include <algorithm>

#include "filter/vectors/refill.h"

namespace lcs {
namespace {

/// Expected size of a body over the range of its corners: `count` uniform samples of an interval
/// span (count - 1) / (count + 1) of it on average.
double beyond(std::ptrdiff_t count) {
  return static_cast<double>(count + 1) /
         static_cast<double>(std::max<std::ptrdiff_t>(count - 1, 1));
}

}  // namespace

/// Sorts the places of edges by circle.
void SquareExpert::gather(const std::vector<Edge>& edges, const std::vector<int>& circle_of_edge) {
  places_.clear();
  make_room(places_, edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (circle_of_edge[i] >= 0) places_.push_back({circle_of_edge[i], edges[i].location});
  }
  std::ranges::sort(places_, {}, &Place::circle);
}

/// Appends the squares of circles of one kind.
void SquareExpert::box(const std::vector<Circle>& circles, const MotionField& field) {
  auto place = places_.begin();
  for (std::size_t c = 0; c < circles.size(); ++c) {
    const Circle& circle = circles[c];
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
    const double size_m = 2 * half_size.maxCoeff() * field.reference_depth_m() /
                          (circle.depth_ratio * camera_.focal_px);
    if (!circle.rebel && size_m > parameters_.max_size) continue;
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
    squares_.push_back(square);
  }
}

const std::vector<Square>& SquareExpert::step(const BothKinds<Edge>& edges,
                                              const CircleExpert::Result& circles,
                                              const MotionField& field) {
  squares_.clear();
  make_room(squares_, circles.circles.normal.size() + circles.circles.rebel.size());
  gather(edges.normal, circles.of_edges.normal);
  box(circles.circles.normal, field);
  gather(edges.rebel, circles.of_edges.rebel);
  box(circles.circles.rebel, field);
  return squares_;
}

}  // namespace lcs
