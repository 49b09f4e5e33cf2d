/// \file
/// The paper's squares: circles that belong together ("Geometric Layering", "Mean Square"), matched
/// to the predicted ones by overlap ("Square Estimation").
#pragma once

#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/paper/couple_layering.h"
#include "filter/parameters.h"

namespace lcs {

/// Overlap rho_s of two rectangles: the common area in % of the smaller one. Symmetric; 0 for
/// disjoint ones, 100 where one contains the other, 0 where one has no area.
double overlap_percent(const Square& a, const Square& b);

class PaperSquares {
 public:
  PaperSquares(const Intrinsics& camera, const SquareParameters& parameters);

  /// Moves the squares to where this frame should show them.
  void predict(Layers& layers, const MotionField& field) const;

  /// Layers the circles and matches, estimates, makes and deletes squares.
  void update(Layers& layers, const MotionField& field);

  /// Transition IV: squares that reached Tr_m will be ignored in the next frame.
  void update_ignorance(Layers& layers) const;

 private:
  /// A predicted square and a mean one that may be it.
  struct Pair {
    double overlap, distance;
    std::size_t square, mean;
    bool aligned;
  };

  Intrinsics camera_;
  SquareParameters parameters_;
  Id next_id_ = 1;

  // Of the current frame; kept for their memory.
  std::vector<Square> means_;  // S_m
  std::vector<Pair> pairs_;
  std::vector<char> matched_, mean_used_;  // squares, means
  CoupleLayering couples_;
};

}  // namespace lcs
