/// \file
/// Square expert: each circle of plausible object size becomes a square.
#pragma once

#include <vector>

#include "filter/circles/circle_expert.h"
#include "filter/kinematics/motion_field.h"
#include "filter/matching/members.h"
#include "filter/squares/convex_hull.h"
#include "filter/types/layers.h"

namespace lcs {

struct SquareParameters {
  double max_size = 5;  ///< m: larger static bodies are background
};

class SquareExpert {
 public:
  SquareExpert(const Intrinsics& camera, const SquareParameters& parameters)
      : camera_(camera), parameters_(parameters) {}

  /// The squares of the circles of both kinds, each with its circle's id, trust and age.
  /// \return valid until the next call.
  const std::vector<Square>& step(const BothKinds<Edge>& edges, const CircleExpert::Result& circles,
                                  const MotionField& field);

 private:
  void box(const std::vector<Edge>& edges, const std::vector<Circle>& circles,
           const std::vector<int>& circle_of_edge, const MotionField& field);

  Intrinsics camera_;
  SquareParameters parameters_;
  std::vector<Square> squares_;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  Members members_;
  ConvexHull hull_;
};

}  // namespace lcs
