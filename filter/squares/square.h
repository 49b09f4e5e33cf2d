/// \file
/// Square expert: circles that belong together become rectangles, which are matched to the
/// predicted ones ("Geometric Layering", "Mean Square", "Square Estimation").
#pragma once

#include <span>
#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/paper/couple_layering.h"
#include "filter/parameters.h"
#include "filter/squares/links.h"

namespace lcs {

/// Overlap rho_s of two rectangles: the common area in % of the smaller one. Symmetric; 0 for
/// disjoint ones, 100 where one contains the other, 0 where one has no area.
double overlap_percent(const Square& a, const Square& b);

class SquareExpert {
 public:
  SquareExpert(const Intrinsics& camera, const SquareParameters& parameters);

  /// Moves the squares to where this frame should show them.
  void predict(Layers& layers, const MotionField& field) const;

  /// The regions of psi from the predicted squares that reached Tr_m.
  void feed_back(const Layers& layers, std::vector<IgnoreRegion>& psi) const;

  /// Layers the circles and matches, estimates, makes and deletes squares.
  /// \param followers of rebel edges, which belong to their squares.
  void update(Layers& layers, const MotionField& field, std::span<const Follower> followers = {});

  /// Squares that reached Tr_m will be ignored in the next frame, as circles are (transition IV).
  void update_ignorance(Layers& layers) const;

 private:
  /// A predicted square and a mean one that may be it.
  struct Pair {
    double overlap, distance;
    std::size_t square, mean;
    bool aligned;
  };

  void match(Layers& layers);

  Intrinsics camera_;
  SquareParameters parameters_;
  Id next_id_ = 1;

  // Of the current frame; kept for their memory.
  std::vector<Square> means_;  // S_m
  std::vector<Pair> pairs_;
  std::vector<char> matched_, mean_used_;  // squares, means
  CoupleLayering couples_;
  LinkLayering links_;
};

}  // namespace lcs
