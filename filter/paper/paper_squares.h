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

/// The paper's layers ("Geometric Layering", "Mean Square"): the furthest couple of similar
/// circles, and the circles inside it.
class CoupleLayering {
 public:
  CoupleLayering(const Intrinsics& camera, const PaperSquareParameters& parameters)
      : camera_(camera), parameters_(parameters) {}

  /// Mean squares S_m of this frame, valid until the next call.
  const std::vector<Square>& layer(const BothKinds<Circle>& circles, const MotionField& field);

 private:
  bool like_speed(const Circle& a, const Circle& b) const;
  bool couple(const Circle& a, const Circle& b) const;
  int furthest_partner(std::size_t a, double d_t) const;
  void add_minor_circles(std::size_t a, double d_t, const MotionField& field);
  Square mean_square(std::size_t a, const MotionField& field) const;

  Intrinsics camera_;
  PaperSquareParameters parameters_;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<Circle> circles_;  // C_n and C_r
  std::vector<char> used_;
  std::vector<std::size_t> partners_;  // C_b of the current couple
  std::vector<Square> means_;          // S_m
};

/// Overlap rho_s of two rectangles: common area in % of the smaller one. Symmetric; 0 if disjoint,
/// 100 if one contains the other, 0 if one has no area.
double overlap_percent(const Square& a, const Square& b);

class PaperSquares {
 public:
  /// \param ignore squares that reach Tr_m make regions of psi (transition IV).
  PaperSquares(const Intrinsics& camera, const PaperSquareParameters& parameters, bool ignore)
      : camera_(camera), parameters_(parameters), ignore_(ignore), couples_(camera, parameters) {}

  /// Predicts the squares of the last frame to this one.
  /// \return valid until the next call.
  const std::vector<Square>& predict(const std::vector<Square>& before, const MotionField& field);

  /// Layers the circles. Matches, estimates, creates and deletes squares.
  /// \return valid until the next call.
  const std::vector<Square>& update(const BothKinds<Circle>& circles,
                                    const std::vector<Square>& predicted,
                                    std::span<const IgnoreRegion> psi, const MotionField& field);

  /// The result of the last update; empty before the first.
  const std::vector<Square>& last() const { return squares_; }

  /// Empties the result of the last update.
  void forget() { squares_.clear(); }

 private:
  /// A candidate match of a predicted and a mean square.
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

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<Square> means_;  // S_m
  std::vector<Pair> pairs_;
  std::vector<char> matched_, mean_used_;  // squares, means
  CoupleLayering couples_;
};

}  // namespace lcs::paper
