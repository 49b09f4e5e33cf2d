/// \file
/// The paper's layers ("Geometric Layering", "Mean Square"): the furthest couple of similar
/// circles, and the circles inside it.
#pragma once

#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/paper/parameters.h"

namespace lcs::paper {

/// Whether a circle separates the couple a, b: it is slower (farther away), lies between them and
/// crosses the segment between their centres.
bool parts(const Circle& between, const Circle& a, const Circle& b);

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

}  // namespace lcs::paper
