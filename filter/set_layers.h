/// \file
/// The layers that the steps of a filter return, put together as the result of a frame.
#pragma once

#include <vector>

#include "filter/types/layers.h"

namespace lcs {

/// Sets the edges, circles and squares of `layers`; the rest of them stays.
/// \param circle_of_edges index of each edge's circle among its kind, -1: in no circle.
void set_layers(const BothKinds<Edge>& edges, const BothKinds<Circle>& circles,
                const BothKinds<int>& circle_of_edges, const std::vector<Square>& squares,
                Layers& layers);

}  // namespace lcs
