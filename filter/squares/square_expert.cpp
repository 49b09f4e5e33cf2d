#include "filter/squares/square_expert.h"

#include "filter/vectors/refill.h"

namespace lcs {

/// Appends the squares of circles of one kind.
void SquareExpert::box(const std::vector<Edge>& edges, const std::vector<Circle>& circles,
                       const std::vector<int>& circle_of_edge, const MotionField& field) {
  members_.collect(circle_of_edge, circles.size());
  for (std::size_t c = 0; c < circles.size(); ++c) {
    const Circle& circle = circles[c];
    hull_.clear();
    const std::span<const int> members = members_.of(c);
    for (const int i : members) hull_.add(edges[i].location);
    const auto [low, high] = hull_.box();
    Square square;
    square.location = 0.5 * (low + high);
    square.half_size = 0.5 * (high - low);
    const Vec2 half_size = beyond(members.size()) * square.half_size;
    const double size_m = 2 * half_size.maxCoeff() * field.reference_depth_m() /
                          (circle.depth_ratio * camera_.focal_px);
    if (!circle.rebel && size_m > parameters_.max_size) continue;
    square.outline = hull_.outline();
    place(square, square.location, half_size);
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
  const auto& [all, of_edges] = circles;
  squares_.clear();
  make_room(squares_, all.normal.size() + all.rebel.size());
  box(edges.normal, all.normal, of_edges.normal, field);
  box(edges.rebel, all.rebel, of_edges.rebel, field);
  return squares_;
}

}  // namespace lcs
