/// \file
/// Goers: bodies that go away or keep pace. Seen as static, such a body is farther than the ground
/// on which it stands. Its lower edges are below the ground's bound (3) and become rebels; its
/// upper ones move as distant static points do. They join the circle of the lower ones
/// (filter/MODEL.md, "Goers").
#pragma once

#include <span>
#include <vector>

#include "filter/circles/circle_expert.h"
#include "filter/edges/edge_parameters.h"
#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/radial/ground_view.h"

namespace lcs {

class Goers {
 public:
  Goers(const Intrinsics& camera, const CircleParameters& circle, const EdgeParameters& edge)
      : camera_(camera), circle_(circle), edge_(edge) {}

  struct Result {
    std::vector<int> circle;   ///< of each normal edge: the rebel circle that it joins, or -1
    std::vector<double> odds;  ///< of those that join one: log odds that it goes
  };

  /// \param seen the normal edges. \return valid until the next call.
  const Result& step(const BothKinds<Edge>& edges, std::span<const GroundEdge> seen,
                     const CircleExpert::Result& circles, const MotionField& field,
                     const GroundView& ground);

 private:
  /// A place on a body, in coordinates of the ground's view.
  using Place = Vec2;

  void join(int circle, const std::vector<Edge>& rebels, const std::vector<int>& circle_of_rebel,
            std::span<const GroundEdge> seen, const MotionField& field, const GroundView& ground);

  Intrinsics camera_;
  CircleParameters circle_;
  EdgeParameters edge_;
  Result result_;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<double> apparent_pm_, across_px_, sorted_;
  std::vector<Place> front_, next_;
  std::vector<int> near_;
};

}  // namespace lcs
