/// \file
/// Square expert: circles that belong together become rectangles, which are matched to the
/// predicted ones ("Geometric Layering", "Mean Square", "Square Estimation").
#pragma once

#include <span>
#include <vector>

#include "filter/layers.h"
#include "filter/links.h"
#include "filter/motion_field.h"
#include "filter/parameters.h"

namespace lcs {

/// Overlap rho_s of two rectangles: the common area in % of the smaller one. Symmetric; 0 for
/// disjoint ones, 100 where one contains the other, 0 where one has no area.
double overlap_percent(const Square& a, const Square& b);

/// What parts the couple a, b: a slower circle (farther away) that the segment between their
/// centres crosses and that lies between them.
bool parts(const Circle& between, const Circle& a, const Circle& b);

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

  bool like_speed(const Circle& a, const Circle& b) const;
  bool couple(const Circle& a, const Circle& b) const;
  void layer_circles(const Layers& layers, const MotionField& field);
  int furthest_partner(std::size_t a, double d_t) const;
  void add_minor_circles(std::size_t a, double d_t, const MotionField& field);
  Square mean_square(std::size_t a, const MotionField& field) const;
  void match(Layers& layers);

  Intrinsics camera_;
  SquareParameters parameters_;
  Id next_id_ = 1;

  // Of the current frame; kept for their memory.
  std::vector<Circle> circles_;  // C_n and C_r
  std::vector<char> used_;
  std::vector<std::size_t> partners_;  // C_b of the couple at hand
  std::vector<Square> means_;          // S_m
  std::vector<Pair> pairs_;
  std::vector<char> matched_, mean_used_;  // squares, means
  LinkLayering links_;
};

}  // namespace lcs
