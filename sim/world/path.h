/// \file
/// The motion of a camera that is carried or flies: a smooth path through poses.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/base/pose.h"

namespace lcs::sim {

/// A cumulative cubic B-spline on R^3 x SO(3), whose knots are the times of the poses:
///
///     p(t) = sum_j N_j(t) c_j,   R(t) = R_i prod_{j=1..3} Exp(M_j(t) Log(R_{i+j-1}^T R_{i+j}))
///
/// with N_j the cubic basis functions and M_j = sum_{k>=j} N_k over the span (Kim, Kim, Shin,
/// "A general construction scheme for unit quaternion curves", SIGGRAPH 1995; derivatives: Sommer
/// et al., "Efficient derivative computation for cumulative B-splines on Lie groups", CVPR 2020,
/// with position and rotation split). Velocity and acceleration are continuous between the first
/// pose and the last; the acceleration may jump at both ends, where the velocity is 0. The path
/// passes through the poses: a few rounds of the linear equations of a spline in R^6 find the
/// control poses, as small turns add like vectors.
class Path {
 public:
  /// \param ego must have a path.
  /// \throws input::Error if the poses turn too far from one to the next, or too fast beside a
  /// pause.
  explicit Path(const scenario::Ego& ego);

  /// Motion of the rover's frame B.
  struct Motion {
    Pose T_WB;
    Eigen::Vector3d v_WB_mps = Eigen::Vector3d::Zero();     ///< in W
    Eigen::Vector3d a_WB_mps2 = Eigen::Vector3d::Zero();    ///< in W
    Eigen::Vector3d w_B_radps = Eigen::Vector3d::Zero();    ///< body rate, in B
    Eigen::Vector3d dw_B_radps2 = Eigen::Vector3d::Zero();  ///< its derivative, in B
  };
  /// At rest before the first pose and from the last on.
  Motion at(double t_s) const;

 private:
  /// The four basis functions of a span, and their first and second derivatives.
  struct Basis {
    std::size_t first = 0;  ///< control pose of the first of them
    std::array<std::array<double, 4>, 3> of_order{};
  };
  Basis basis_at(double t_s) const;
  double basis(std::size_t k, int degree, int derivative, double t_s) const;
  Motion motion(const Basis& basis) const;
  using Off = Eigen::Matrix<double, 6, 1>;  ///< a change of position and a turn, both in W
  static std::vector<Off> solve(const std::vector<Basis>& at_poses, std::vector<Off> off);

  std::vector<double> knots_s_;
  std::vector<Pose> control_;
};

}  // namespace lcs::sim
