#include "filter/set_layers.h"

#include "filter/vectors/refill.h"

namespace lcs {
namespace {

void set_edges(const std::vector<Edge>& from, const std::vector<int>& circle_of_edge,
               std::vector<Edge>& to) {
  copy_over(from, to);
  for (std::size_t i = 0; i < to.size(); ++i) to[i].circle = circle_of_edge[i];
}

}  // namespace

void set_layers(const BothKinds<Edge>& edges, const BothKinds<Circle>& circles,
                const BothKinds<int>& circle_of_edges, const std::vector<Square>& squares,
                Layers& layers) {
  set_edges(edges.normal, circle_of_edges.normal, layers.normal_edges);
  set_edges(edges.rebel, circle_of_edges.rebel, layers.rebel_edges);
  copy_over(circles.normal, layers.normal_circles);
  copy_over(circles.rebel, layers.rebel_circles);
  copy_over(squares, layers.squares);
}

}  // namespace lcs
