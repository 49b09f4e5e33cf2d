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
  struct Result {
    /// The edges and circles with those of radial movers among the rebels; null: there are none.
    const Relabel::Result* moved = nullptr;
    const Comers::Result* came = nullptr;  ///< null: comers were not searched for
  };

  RadialMovers(const Intrinsics& camera, const ComerParameters& comers,
               const CircleParameters& circle, const EdgeParameters& edge)
      : camera_(camera),
        circle_(circle),
        comers_(camera, comers, circle, edge),
        goers_(camera, circle, edge) {}

  /// \param corners_px,reasons of the frame, in the caller's order.
  /// \param view null: comers are not searched for.
  /// \return valid until the next call. Nothing is found without a ground, or while the camera
  ///   stands still or looks straight down.
  Result step(const BothKinds<Edge>& edges, const CircleExpert::Result& circles,
              std::span<const Eigen::Vector2f> corners_px, std::span<const Reason> reasons,
              const MotionField& field, GapView* view);

  /// Drops what is known of earlier frames.
  void forget() { comers_.forget(); }

 private:
  Intrinsics camera_;
  CircleParameters circle_;
  Comers comers_;
  Goers goers_;
  Relabel relabel_;
  std::vector<GroundEdge> seen_;
  std::vector<double> odds_;
  std::vector<int> joined_;
};

}  // namespace lcs
