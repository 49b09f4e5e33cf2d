/// \file
/// The paper's squares: groups of circles ("Geometric Layering", "Mean Square"), matched to the
/// predicted squares by overlap ("Square Estimation").
#pragma once

#include <span>
#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/paper/parameters.h"
#include "filter/types/layers.h"

namespace lcs::paper {

/// Whether a circle separates the couple a, b: it is slower (farther away), lies between them and
/// crosses the segment between their centres.
bool parts(const Circle& between, const Circle& a, const Circle& b);

/// Overlap rho_s of two rectangles: common area in % of the smaller one. Symmetric; 0 if disjoint,
/// 100 if one contains the other, 0 if one has no area.
double overlap_percent(const Square& a, const Square& b);

class PaperSquares {
 public:
  /// \param ignore squares that reach Tr_m make regions of psi (transition IV).
  PaperSquares(const Intrinsics& camera, const PaperSquareParameters& parameters, bool ignore)
      : camera_(camera), parameters_(parameters), ignore_(ignore) {}

  /// Predicts the squares of the last frame to this one.
  static void predict(std::vector<Square>& squares, const MotionField& field);

  /// Layers the circles. Matches, estimates, creates and deletes predicted squares.
  void update(const BothKinds<Circle>& circles, std::span<const IgnoreRegion> psi,
              const MotionField& field, std::vector<Square>& squares);

 private:
  /// A candidate match of a predicted and a mean square.
  struct Pair {
    double overlap, distance;
    std::size_t square, mean;
    bool aligned;
  };

  void layer(const BothKinds<Circle>& circles, const MotionField& field);
  bool like_speed(const Circle& a, const Circle& b) const;
  bool couple(const Circle& a, const Circle& b) const;
  int furthest_partner(std::size_t a, double d_t) const;
  void add_minor_circles(std::size_t a, double d_t, const MotionField& field);
  Square mean_square(std::size_t a, const MotionField& field) const;

  Intrinsics camera_;
  PaperSquareParameters parameters_;
  bool ignore_;
  Id next_id_ = 1;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<Circle> circles_;        // C_n and C_r
  std::vector<char> used_;             // of these
  std::vector<std::size_t> partners_;  // C_b of the current couple
  std::vector<Square> means_;          // S_m
  std::vector<Pair> pairs_;
  std::vector<char> matched_, mean_used_;  // squares, means
};

}  // namespace lcs::paper
