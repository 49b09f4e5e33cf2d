#include "sim/world/path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "sim/base/rotation.h"

namespace lcs::sim {
namespace {

using Eigen::Matrix3d;

constexpr std::size_t kDegree = 3;

Matrix3d exp_of(const Vector3d& turn_rad) {
  const double angle = turn_rad.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, turn_rad / angle).toRotationMatrix()
                   : Matrix3d::Identity().eval();
}

Vector3d log_of(const Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

Pose pose_of(const scenario::PathPose& pose) {
  return {rotation_of_rpy(pose.rpy_rad), pose.position_m};
}

}  // namespace

Path::Path(const scenario::Ego& ego) {
  const std::vector<scenario::PathPose>& poses = ego.path;
  knots_s_.assign(kDegree, poses.front().at_s);
  control_.assign(1, pose_of(poses.front()));
  for (const scenario::PathPose& pose : poses) {
    knots_s_.push_back(pose.at_s);
    control_.push_back(pose_of(pose));
  }
  knots_s_.insert(knots_s_.end(), kDegree, poses.back().at_s);
  control_.push_back(control_.back());  // two equal control poses at each end: it is at rest there

  constexpr int kMostRounds = 200;
  constexpr double kClose = 1e-12;          // m and rad
  constexpr double kLargestTurn_rad = 0.3;  // in a round: small turns add like vectors
  std::vector<Basis> at_poses;
  for (const scenario::PathPose& pose : poses) at_poses.push_back(basis_at(pose.at_s));
  double worst = 1, worst_before = 1, share = 1;
  std::size_t worst_pose = 0;
  for (int round = 0; round < kMostRounds && worst > kClose; ++round) {
    worst = 0;
    std::vector<Off> off(poses.size(), Off::Zero());
    for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
      const Pose goal = pose_of(poses[i]), here = motion(at_poses[i]).T_WB;
      off[i] << goal.p - here.p, log_of(goal.R * here.R.transpose());
      if (const double most = std::max(off[i].head<3>().norm(), off[i].tail<3>().norm());
          !(most <= worst)) {  // also if it is not a number
        worst = most;
        worst_pose = i;
      }
    }
    const std::vector<Off> change = solve(at_poses, std::move(off));
    if (worst > worst_before) share = std::max(0.7 * share, 0.1);  // it overshot
    worst_before = worst;
    double largest_rad = kLargestTurn_rad;
    for (const Off& one : change) largest_rad = std::max(largest_rad, one.tail<3>().norm());
    const double step = share * kLargestTurn_rad / largest_rad;
    for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
      control_[i + 1].p += step * change[i].head<3>();
      control_[i + 1].R = exp_of(step * change[i].tail<3>()) * control_[i + 1].R;
    }
  }
  if (!(worst <= 1e-9)) {
    throw input::Error(ego.source,
                       "ego.path: no smooth path leads through these poses: near {:g} s it would "
                       "swing by more than half a turn; add poses in between, or give them more "
                       "even times",
                       poses[worst_pose].at_s);
  }
  for (Pose& pose : control_) pose.R = Eigen::Quaterniond(pose.R).normalized().toRotationMatrix();
}

/// The change of each control pose that moves the path by `off` at each pose, to the first order:
/// at a pose three basis functions are not 0, so that the equations have three diagonals. They are
/// totally positive, so that elimination needs no pivots.
std::vector<Path::Off> Path::solve(const std::vector<Basis>& at_poses, std::vector<Off> off) {
  std::vector<double> next(off.size(), 0);  // of the row, once it is eliminated
  for (std::size_t i = 1; i + 1 < off.size(); ++i) {
    const auto& [before, own, after, none] = at_poses[i].of_order[0];
    const double pivot = own - before * next[i - 1];
    next[i] = after / pivot;
    off[i] = (off[i] - before * off[i - 1]) / pivot;
  }
  for (std::size_t i = off.size() - 1; i-- > 1;) off[i] -= next[i] * off[i + 1];
  return off;
}

/// Cox and de Boor's recursion. \param k the basis function; its support begins at knot k.
double Path::basis(std::size_t k, int degree, int derivative, double t_s) const {
  if (degree == 0) return derivative == 0 && knots_s_[k] <= t_s && t_s < knots_s_[k + 1] ? 1 : 0;
  const auto p = static_cast<std::size_t>(degree);
  const auto share = [](double part, double whole) { return whole > 0 ? part / whole : 0; };
  const double left_s = knots_s_[k + p] - knots_s_[k];
  const double right_s = knots_s_[k + p + 1] - knots_s_[k + 1];
  if (derivative > 0) {
    return share(degree * basis(k, degree - 1, derivative - 1, t_s), left_s) -
           share(degree * basis(k + 1, degree - 1, derivative - 1, t_s), right_s);
  }
  return share((t_s - knots_s_[k]) * basis(k, degree - 1, 0, t_s), left_s) +
         share((knots_s_[k + p + 1] - t_s) * basis(k + 1, degree - 1, 0, t_s), right_s);
}

Path::Basis Path::basis_at(double t_s) const {
  const auto later = std::upper_bound(knots_s_.begin(), knots_s_.end() - kDegree - 1, t_s);
  Basis all;
  all.first = static_cast<std::size_t>(later - knots_s_.begin()) - 1 - kDegree;
  for (std::size_t derivative = 0; derivative < all.of_order.size(); ++derivative) {
    for (std::size_t j = 0; j <= kDegree; ++j) {
      all.of_order[derivative][j] =
          basis(all.first + j, kDegree, static_cast<int>(derivative), t_s);
    }
  }
  return all;
}

Path::Motion Path::motion(const Basis& basis) const {
  const auto& [N, dN, ddN] = basis.of_order;
  Motion m{.T_WB = {control_[basis.first].R, Vector3d::Zero()}};
  double M = 1, dM = 0, ddM = 0;  // cumulative
  for (std::size_t j = 0; j <= kDegree; ++j) {
    const Pose& control = control_[basis.first + j];
    m.T_WB.p += N[j] * control.p;
    m.v_WB_mps += dN[j] * control.p;
    m.a_WB_mps2 += ddN[j] * control.p;
    if (j > 0) {
      const Vector3d turn = log_of(control_[basis.first + j - 1].R.transpose() * control.R);
      const Matrix3d A = exp_of(M * turn);
      const Vector3d w = A.transpose() * m.w_B_radps;
      m.T_WB.R *= A;
      m.dw_B_radps2 = A.transpose() * m.dw_B_radps2 + ddM * turn + w.cross(dM * turn);
      m.w_B_radps = w + dM * turn;
    }
    M -= N[j];
    dM -= dN[j];
    ddM -= ddN[j];
  }
  return m;
}

Path::Motion Path::at(double t_s) const {
  if (t_s < knots_s_.front()) return {.T_WB = control_.front()};
  if (t_s >= knots_s_.back()) return {.T_WB = control_.back()};
  return motion(basis_at(t_s));
}

}  // namespace lcs::sim
