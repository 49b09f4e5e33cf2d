/// \file
/// Square expert: circles that are objects become rectangles, by default each as wide as its body
/// and going on as it does; the paper's are `PaperSquares`.
#pragma once

#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/paper/paper_squares.h"
#include "filter/parameters.h"
#include "filter/squares/convex_hull.h"

namespace lcs {

class SquareExpert {
 public:
  SquareExpert(const Intrinsics& camera, const SquareParameters& parameters);

  /// Moves the squares to where this frame should show them.
  void predict(Layers& layers, const MotionField& field) const;

  /// The regions of psi from the predicted squares that reached Tr_m.
  void feed_back(const Layers& layers, std::vector<IgnoreRegion>& psi) const;

  /// Layers the circles and matches, estimates, makes and deletes squares.
  void update(Layers& layers, const MotionField& field);

  /// Squares that reached Tr_m will be ignored in the next frame, as circles are (transition IV).
  void update_ignorance(Layers& layers) const;

 private:
  /// Of an edge of a circle, which is given by its index.
  struct Place {
    int circle;
    Vec2 location;
  };

  void gather(const std::vector<Edge>& edges);
  void box(const std::vector<Circle>& circles, const std::vector<Square>& before,
           const MotionField& field);

  Intrinsics camera_;
  SquareParameters parameters_;
  PaperSquares paper_;

  // Of the current frame; kept for their memory.
  std::vector<Place> places_;
  ConvexHull hull_;
  std::vector<Square> squares_;
};

}  // namespace lcs
