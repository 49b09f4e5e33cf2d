/// \file
/// The paper's squares: circles that belong together ("Geometric Layering", "Mean Square"), matched
/// to the predicted squares by overlap ("Square Estimation").
#pragma once

#include <span>
#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/paper/couple_layering.h"
#include "filter/paper/parameters.h"

namespace lcs::paper {

/// Overlap rho_s of two rectangles: the common area in % of the smaller one. Symmetric; 0 for
/// disjoint ones, 100 where one contains the other, 0 where one has no area.
double overlap_percent(const Square& a, const Square& b);

class PaperSquares {
 public:
  /// \param ignore squares that reach Tr_m make regions of psi (transition IV).
  PaperSquares(const Intrinsics& camera, const PaperSquareParameters& parameters, bool ignore)
      : camera_(camera), parameters_(parameters), ignore_(ignore), couples_(camera, parameters) {}

  /// Squares of the frame before, moved to where this frame should show them.
  /// \return valid until the next call.
  const std::vector<Square>& predict(const std::vector<Square>& before, const MotionField& field);

  /// Layers the circles and matches, estimates, makes and deletes squares.
  /// \return valid until the next call.
  const std::vector<Square>& update(const BothKinds<Circle>& circles,
                                    const std::vector<Square>& predicted,
                                    std::span<const IgnoreRegion> psi, const MotionField& field);

 private:
  /// A predicted square and a mean one that may be it.
  struct Pair {
    double overlap, distance;
    std::size_t square, mean;
    bool aligned;
  };

  Intrinsics camera_;
  PaperSquareParameters parameters_;
  bool ignore_;
  Id next_id_ = 1;
  std::vector<Square> predicted_, squares_;

  // Of the current frame; kept for their memory.
  std::vector<Square> means_;  // S_m
  std::vector<Pair> pairs_;
  std::vector<char> matched_, mean_used_;  // squares, means
  CoupleLayering couples_;
};

}  // namespace lcs::paper
