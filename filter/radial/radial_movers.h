/// \file
/// Movers along the line of sight, which the edges alone cannot tell from static points: comers and
/// goers. Works on the edges and circles of a frame, after the circle expert.
#pragma once

#include <span>
#include <vector>

#include "filter/radial/comers.h"
#include "filter/radial/goers.h"
#include "filter/radial/relabel.h"

namespace lcs {

class RadialMovers {
 public:
  RadialMovers(const Intrinsics& camera, const ComerParameters& comers,
               const CircleParameters& circle, const EdgeParameters& edge)
      : camera_(camera),
        circle_(circle),
        comers_(camera, comers, circle, edge),
        goers_(camera, circle, edge) {}

  /// \param corners_px,reasons of the frame, in the caller's order.
  /// \param view null: comers are not searched for.
  /// \return the edges and circles with those of radial movers among the rebels; valid until the
  ///   next call. Null without a ground, or while the camera stands still or looks straight down.
  const Relabel::Result* step(const BothKinds<Edge>& edges, const CircleExpert::Result& circles,
                              std::span<const Eigen::Vector2f> corners_px,
                              std::span<const Reason> reasons, const MotionField& field,
                              GapView* view);

  /// Of the last step.
  const Comers::Result& comers() const { return came_; }

  void forget() { comers_.forget(); }

 private:
  Intrinsics camera_;
  CircleParameters circle_;
  Comers comers_;
  Goers goers_;
  Relabel relabel_;
  Comers::Result came_;
  std::vector<GroundEdge> seen_;
  std::vector<double> odds_;
  std::vector<int> joined_;
};

}  // namespace lcs
