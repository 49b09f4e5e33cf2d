/// \file
/// How the camera turned while its gyro was not heard, from the corners.
///
/// The estimator goes on with the last rate that it heard, which may be off by many pixels a frame:
/// all of the static world would look like rebels. But nearly every edge that is established as
/// static has a corner where it should be, once the turn is right. So each of them votes, with
/// every corner near its prediction, for the pan and the tilt between the two; from where most
/// votes agree least squares go on to all three angles, held to what is told by its standard
/// deviation.
#pragma once

#include <span>
#include <vector>

#include "filter/ego_motion/ego_motion.h"
#include "filter/kinematics/camera.h"
#include "filter/layers.h"
#include "filter/matching/point_grid.h"
#include "filter/parameters.h"
#include "filter/trust.h"

namespace lcs {

class UnseenTurn {
 public:
  UnseenTurn(const Intrinsics& camera, const FieldParameters& parameters, const TrustRanks& trust);

  /// \param told with how far its rotation may be off, `unseen_turn_rad` > 0.
  /// \param normals of the frame before, as that left them.
  /// \param corners_px of this frame; finite.
  /// \return `told` with the rotation that the corners show; as it is where they show none: where
  ///   too few edges are established, or too few of them agree.
  EgoMotion seen(const EgoMotion& told, std::span<const Edge> normals,
                 std::span<const Vec2> corners_px);

 private:
  void choose(std::span<const Edge> normals);
  /// Where the chosen edges are expected, of those that stay in the picture.
  void predict(const EgoMotion& motion);
  Eigen::Vector3d vote(double reach_rad, std::span<const Vec2> corners_px);
  /// \return how many expected places have a corner within `gate_px`; `turn` is what is left.
  int fit(double gate_px, double sigma_rad, const Eigen::Vector3d& so_far_rad,
          std::span<const Vec2> corners_px, Eigen::Vector3d& turn_rad);

  Intrinsics camera_;
  FieldParameters parameters_;
  int established_;  ///< trust of edges that are asked
  PointGrid grid_;   ///< of the corners
  std::vector<const Edge*> chosen_;
  std::vector<Vec2> expected_;
  std::vector<int> votes_;
  std::vector<Neighbour> near_;
};

}  // namespace lcs
