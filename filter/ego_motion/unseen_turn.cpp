#include "filter/ego_motion/unseen_turn.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "filter/kinematics/motion_field.h"
#include "filter/kinematics/pixels.h"
#include "filter/kinematics/rotation.h"
#include "filter/matching/refill.h"

namespace lcs {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Edges that are asked, the oldest: more would not tell it better.
constexpr std::size_t kAsked = 300;

/// Of the turn that is told: as far as it is looked for, in standard deviations and at the most.
constexpr double kReach = 3, kMostReach_rad = 0.2;

/// A vote counts for as much of a turn, and for what is beside it.
constexpr double kBin_px = 1.5;

/// Of the fits, one after the other: how far a corner may lie from where its edge is expected.
constexpr double kGates_px[] = {5, 3, 2};

/// What a corner errs by.
constexpr double kCorner_px = 0.7;

/// Edges, and their share, that must have a corner within the last gate. By chance it is one in
/// twenty, and of what is static three in four are found again.
constexpr int kLeastFound = 8;
constexpr double kLeastShare = 0.4;

constexpr double kCell_px = 16;

}  // namespace

UnseenTurn::UnseenTurn(const Intrinsics& camera, const FieldParameters& parameters,
                       const TrustRanks& trust)
    : camera_(camera), parameters_(parameters), established_(trust.standard + 1) {}

void UnseenTurn::choose(std::span<const Edge> normals) {
  chosen_.clear();
  for (const Edge& edge : normals) {  // by their ids, and so by their age
    if (chosen_.size() == kAsked) return;
    if (edge.trust >= established_) chosen_.push_back(&edge);
  }
}

void UnseenTurn::predict(const EgoMotion& motion) {
  const MotionField field(camera_, motion, parameters_);
  const Pixels picture{camera_.width_px, camera_.height_px};
  expected_.clear();
  for (const Edge* edge : chosen_) {
    const double ratio =
        field.moving() ? field.advanced_ratio(edge->depth_ratio) : edge->depth_ratio;
    const Vec2 x = field.translated(field.rotated(edge->location), ratio);
    if (picture.contain(x)) expected_.push_back(x);
  }
}

/// The pan and the tilt on which most pairs of an expected place and a corner agree.
Vector3d UnseenTurn::vote(double reach_rad, std::span<const Vec2> corners_px) {
  const auto bearing = [&](const Vec2& x_px) {
    const Vec2 x = (x_px - camera_.centre_px) / camera_.focal_px;
    return Vec2(std::atan(x.x()), std::atan(x.y() / std::hypot(1, x.x())));
  };
  const double bin_rad = kBin_px / camera_.focal_px;
  const int reach = static_cast<int>(reach_rad / bin_rad);
  const int side = 2 * reach + 3;  // with an empty border
  refill(votes_, static_cast<std::size_t>(side) * side);
  // Towards the border of the picture a turn moves the image farther.
  const double half_px = 0.5 * std::hypot(camera_.width_px, camera_.height_px);
  const double stretch = 1 + half_px * half_px / (camera_.focal_px * camera_.focal_px);
  const double reach_px = reach_rad * camera_.focal_px * std::min(stretch, 2.0);
  for (const Vec2& x : expected_) {
    const Vec2 from = bearing(x);
    grid_.visit_within(x, reach_px, [&](int corner, double) {
      const Vec2 turn = (bearing(corners_px[corner]) - from) / bin_rad;
      const auto pan = std::lround(turn.x()), tilt = std::lround(turn.y());
      if (std::abs(pan) > reach || std::abs(tilt) > reach) return;
      ++votes_[static_cast<std::size_t>((tilt + reach + 1) * side + pan + reach + 1)];
    });
  }
  int most = -1, nearest = 0;
  Vector3d best = Vector3d::Zero();
  for (int tilt = -reach; tilt <= reach; ++tilt) {
    for (int pan = -reach; pan <= reach; ++pan) {
      int agree = 0;
      for (int row = tilt + reach; row <= tilt + reach + 2; ++row) {
        const int* first = votes_.data() + row * side + pan + reach;
        agree += first[0] + first[1] + first[2];
      }
      // Of equals the least turn.
      const int far = pan * pan + tilt * tilt;
      if (agree < most || (agree == most && far >= nearest)) continue;
      most = agree;
      nearest = far;
      best = Vector3d(-tilt, pan, 0) * bin_rad;
    }
  }
  return best;
}

int UnseenTurn::fit(double gate_px, double sigma_rad, const Vector3d& so_far_rad,
                    std::span<const Vec2> corners_px, Vector3d& turn_rad) {
  // What is told counts as one more measurement, of which a pixel is as good as any other.
  const double held = kCorner_px * kCorner_px / (sigma_rad * sigma_rad);
  Matrix3d A = held * Matrix3d::Identity();
  Vector3d b = -held * so_far_rad;
  int found = 0;
  for (const Vec2& expected : expected_) {
    grid_.nearest(
        expected, gate_px, 1, [](int) { return true; }, near_);
    if (near_.empty()) continue;
    ++found;
    const Vec2 x = (expected - camera_.centre_px) / camera_.focal_px;
    Eigen::Matrix<double, 2, 3> J;                   // of the image by a small turn, f [x cross]
    J << -x.x() * x.y(), 1 + x.x() * x.x(), -x.y(),  //
        -1 - x.y() * x.y(), x.x() * x.y(), x.x();
    J *= camera_.focal_px;
    A += J.transpose() * J;
    b += J.transpose() * (corners_px[near_.front().index] - expected);
  }
  turn_rad = A.ldlt().solve(b);
  return found;
}

EgoMotion UnseenTurn::seen(const EgoMotion& told, std::span<const Edge> normals,
                           std::span<const Vec2> corners_px) {
  choose(normals);
  predict(told);
  if (static_cast<int>(expected_.size()) < kLeastFound) return told;
  grid_.build(corners_px, kCell_px);

  EgoMotion motion = told;
  const double sigma = told.unseen_turn_rad;
  Vector3d turn = vote(std::min(kReach * sigma, kMostReach_rad), corners_px);
  motion.R_cur_prev = exponential(turn) * told.R_cur_prev;
  int found = 0;
  for (const double gate_px : kGates_px) {
    predict(motion);
    const Vector3d so_far = logarithm(motion.R_cur_prev * told.R_cur_prev.transpose());
    found = fit(gate_px, sigma, so_far, corners_px, turn);
    motion.R_cur_prev = exponential(turn) * motion.R_cur_prev;
  }
  const bool agreed =
      found >= kLeastFound && found >= kLeastShare * static_cast<double>(expected_.size());
  if (!agreed || !turn.allFinite()) return told;
  motion.w_C_radps = -logarithm(motion.R_cur_prev) / motion.dt_s;
  return motion;
}

}  // namespace lcs
