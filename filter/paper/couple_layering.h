/// \file
/// Layers as the paper makes them ("Geometric Layering", "Mean Square"): the furthest couple of
/// like circles, and what lies inside it.
#pragma once

#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/paper/parameters.h"

namespace lcs::paper {

/// What parts the couple a, b: a slower circle (farther away) that the segment between their
/// centres crosses and that lies between them.
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

  // Of the current frame; kept for their memory.
  std::vector<Circle> circles_;  // C_n and C_r
  std::vector<char> used_;
  std::vector<std::size_t> partners_;  // C_b of the couple at hand
  std::vector<Square> means_;          // S_m
};

}  // namespace lcs::paper
