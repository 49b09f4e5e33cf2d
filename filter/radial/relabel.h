/// \file
/// Makes rebels of normal edges that belong to radial movers, and of their circles.
#pragma once

#include <span>
#include <vector>

#include "filter/circles/circle_expert.h"
#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"

namespace lcs {

class Relabel {
 public:
  struct Result {
    BothKinds<Edge> edges;  ///< by rising id
    CircleExpert::Result circles;
    /// Corners of the edges that became rebels, with their circle, or by joining another circle.
    std::vector<int> came, went;
  };

  /// \param odds of each normal edge: log odds that it moves. Those above 0 become rebels. The
  ///   edges of a normal circle agree, unless they join another circle.
  /// \param joined of each normal edge: the rebel circle that it joins, or -1.
  /// \return valid until the next call.
  const Result& step(const BothKinds<Edge>& edges, const CircleExpert::Result& circles,
                     std::span<const double> odds, std::span<const int> joined,
                     const MotionField& field, const TrustRanks& trust);

 private:
  Result result_;
  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<int> left_, moved_, place_, members_;
};

}  // namespace lcs
