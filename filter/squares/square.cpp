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

/// Where the edges of circles are, circle by circle.
void SquareExpert::gather(const std::vector<Edge>& edges) {
  places_.clear();
  make_room(places_, edges.size());
  for (const Edge& edge : edges) {
    if (edge.circle >= 0) places_.push_back({edge.circle, edge.location});
  }
  std::sort(places_.begin(), places_.end(),
            [](const Place& a, const Place& b) { return a.circle < b.circle; });
}

/// The squares of circles of one kind. What stands and is larger than an object is the setting.
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
    square.ignoring = circle.ignoring;
    squares_.push_back(square);
  }
}

void SquareExpert::update(Layers& layers, const MotionField& field) {
  if (parameters_.layer_rule == LayerRule::couples) {
    paper_.update(layers, field);
    return;
  }
  squares_.clear();
  make_room(squares_, layers.normal_circles.size() + layers.rebel_circles.size());
  gather(layers.normal_edges);
  box(layers.normal_circles, layers.squares, field);
  gather(layers.rebel_edges);
  box(layers.rebel_circles, layers.squares, field);
  copy_over(squares_, layers.squares);
}

void SquareExpert::update_ignorance(Layers& layers) const {
  // By circles, a square is ignored with its circle.
  if (parameters_.layer_rule == LayerRule::couples) paper_.update_ignorance(layers);
}

}  // namespace lcs
