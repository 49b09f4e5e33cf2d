/// \file
/// The layers that the steps of a filter return, put together as the result of a frame.
#pragma once

#include <vector>

#include "filter/circles/circle_expert.h"
#include "filter/types/layers.h"
#include "filter/vectors/refill.h"

namespace lcs {

/// Sets all of `layers`.
inline void set_layers(const BothKinds<Edge>& edges, const CircleExpert::Result& circles,
                       const std::vector<Square>& squares, Layers& layers) {
  const auto set_edges = [](const std::vector<Edge>& from, const std::vector<int>& circle_of_edge,
                            std::vector<Edge>& to) {
    copy_over(from, to);
    for (std::size_t i = 0; i < to.size(); ++i) to[i].circle = circle_of_edge[i];
  };
  set_edges(edges.normal, circles.of_edges.normal, layers.normal_edges);
  set_edges(edges.rebel, circles.of_edges.rebel, layers.rebel_edges);
  copy_over(circles.circles.normal, layers.normal_circles);
  copy_over(circles.circles.rebel, layers.rebel_circles);
  copy_over(squares, layers.squares);
}

}  // namespace lcs
