/// The two hypotheses of an edge, each alone: a static point, and a motion of its own. The loops of
/// the filter are compared with them in track_loops_test.cpp.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstddef>
#include <vector>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/kinematics/motion_field.h"
#include "tests/filter/hypotheses_support.h"
#include "tests/filter/scalar_track.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector3d;
using testing::density;
using testing::depth_bounds;
using testing::DepthBounds;
using testing::kDt_s;
using testing::kNoise2_px2;
using testing::kUsual;
using testing::OwnMotion;
using testing::Random;
using testing::StaticPoint;
using testing::steady_motion;
using testing::vga;
using testing::World;

/// Images of a point in each frame, px, and its 1/Z in the last frame.
struct Seen {
  std::vector<Vec2> places;
  double inverse_depth_pm = 0;
};
Seen watch(const Vec2& px, double depth, const EgoMotion& motion, int frames) {
  World world;
  world.add(px, depth);
  Seen seen;
  for (int k = 0; k < frames; ++k) {
    if (k > 0) world.advance(motion);
    seen.places.push_back(testing::project(world.camera, world.points[0].x_C));
  }
  seen.inverse_depth_pm = 1 / world.points[0].x_C.z();
  return seen;
}

template <int N>
void expect_covariance(const Eigen::Matrix<double, N, N>& C) {
  EXPECT_TRUE(C.isApprox(C.transpose(), 1e-9)) << C;
  // The axes differ in scale by orders of magnitude, so the correlations are checked.
  const Eigen::Matrix<double, N, 1> scale = C.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix<double, N, N> correlations = scale.asDiagonal() * C * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(correlations);
  EXPECT_GT(solver.eigenvalues().minCoeff(), 0) << C;
}

// ---- A static point

TEST(StaticPoint, LearnsTheDepthOfWhatItSeesWhateverTheMotion) {
  struct Drive {
    Vector3d v_mps, w_radps;
  };
  for (const Drive& drive :
       {Drive{{0.5, 0, 0}, {0, 0, 0}}, Drive{{0, 0, 0.8}, {0, 0, 0}},
        Drive{{0, 0, -0.8}, {0, 0, 0}}, Drive{{0.1, -0.3, 0.6}, {0, 0, 0}},
        Drive{{0.1, 0, 0.8}, {0.02, -0.05, 0.1}}, Drive{{0.2, 0, 0.4}, {0, -0.3, 0}}}) {
    const EgoMotion motion = steady_motion(drive.v_mps, drive.w_radps, kDt_s);
    const MotionField field(vga(), motion, {});
    for (const Vec2& px : {Vec2(180, 130), Vec2(430, 330)}) {
      for (const double depth : {2.5, 3.5, 6.0}) {
        SCOPED_TRACE(::testing::Message()
                     << "v " << drive.v_mps.transpose() << ", w " << drive.w_radps.transpose()
                     << ", from " << px.transpose() << ", " << depth << " m");
        const Seen seen = watch(px, depth, motion, 12);
        StaticPoint point;
        double last_miss = 0;
        for (std::size_t k = 1; k < seen.places.size(); ++k) {
          const Vec2& x = seen.places[k];
          point = k == 1 ? StaticPoint::seen_once(field.rotated(px), vga(), field,
                                                  field.displacement_C_m(), kNoise2_px2)
                         : point.predicted(vga(), field, kUsual.ego_share);
          last_miss = (point.place_px - x).norm();
          point.update(x, kNoise2_px2, depth_bounds(field, x));
          expect_covariance<3>(point.covariance);
        }
        // Half a standard deviation of the filter's own uncertainty: the rest comes from the
        // first guess, the middle of the bounds, which the sightings outweigh.
        EXPECT_NEAR(point.inverse_depth_pm, seen.inverse_depth_pm,
                    0.5 * std::sqrt(point.covariance(2, 2)));
        EXPECT_LT(std::sqrt(point.covariance(2, 2)), 0.15) << "it has learnt";
        EXPECT_LT((point.place_px - seen.places.back()).norm(), 0.2);
        EXPECT_LT(last_miss, 0.5) << "px, before it was seen";
      }
    }
  }
}

/// For a camera that moves sideways, places are linear in 1/Z, so the fit to all sightings at once
/// equals the sequential result.
TEST(StaticPoint, IsTheLeastSquaresFitWhereThatIsLinear) {
  const double d = 0.05;
  const EgoMotion motion = steady_motion({d / kDt_s, 0, 0}, Vector3d::Zero(), kDt_s);
  const MotionField field(vga(), motion, {});
  const Seen seen = watch({400, 200}, 2.5, motion, 8);
  Random random(4);
  const Vec2 start = seen.places[0];
  const DepthBounds bounds = depth_bounds(field, start);
  StaticPoint point = StaticPoint::seen_once(field.rotated(start), vga(), field,
                                             field.displacement_C_m(), kNoise2_px2);
  const double middle = point.inverse_depth_pm, variance = point.covariance(2, 2);
  EXPECT_NEAR(middle, 0.5 * (bounds.least_pm + bounds.most_pm), 1e-12);
  // Sums of the slope s of x over 1/Z, and of x, weighted by 1/variance.
  double n = 1, s = 0, ss = 0, x = start.x(), sx = 0;
  for (std::size_t k = 1; k < seen.places.size(); ++k) {
    const Vec2 noisy = seen.places[k] + random.vector(0.6).head<2>();
    if (k > 1) point = point.predicted(vga(), field, 0);
    point.update(noisy, kNoise2_px2, bounds);
    const double slope = -vga().focal_px * d * static_cast<double>(k);
    n += 1, s += slope, ss += slope * slope, x += noisy.x(), sx += slope * noisy.x();
  }
  const double information = (ss - s * s / n) / kNoise2_px2 + 1 / variance;
  const double expected = ((sx - s * x / n) / kNoise2_px2 + middle / variance) / information;
  EXPECT_NEAR(point.inverse_depth_pm, expected, 1e-9);
  EXPECT_NEAR(point.covariance(2, 2), 1 / information, 1e-12);
}

TEST(StaticPoint, IsLikeliestWhereItIsExpected) {
  const MotionField field(vga(), steady_motion({0.1, 0, 0.6}, {0, 0.05, 0}, kDt_s), {});
  const StaticPoint point = StaticPoint::seen_once(field.rotated({200, 150}), vga(), field,
                                                   field.displacement_C_m(), kNoise2_px2);
  const double there = density(point, point.place_px, kNoise2_px2);
  for (int i = 0; i < 16; ++i) {
    const Vec2 aside(std::cos(i * 0.4), std::sin(i * 0.4));
    const double near = density(point, point.place_px + aside, kNoise2_px2);
    EXPECT_LT(near, there);
    EXPECT_LT(density(point, point.place_px + 2 * aside, kNoise2_px2), near);
  }
  // A density sums to one. Steps of 1 px suffice because the noise is no finer.
  double sum = 0;
  for (int v = -80; v <= 80; ++v) {
    for (int u = -80; u <= 80; ++u) sum += density(point, point.place_px + Vec2(u, v), kNoise2_px2);
  }
  EXPECT_NEAR(sum, 1, 0.01);
}

/// Bounds apply in addition to the normal distribution of the place.
TEST(StaticPoint, IsNotNearerThanItMayBeNorBehindTheGround) {
  EgoMotion motion = steady_motion({1, 0, 0}, Vector3d::Zero(), kDt_s);
  motion.ground = Ground{.up_C = {0, -1, 0}, .height_m = 0.8};
  const MotionField field(vga(), motion, {});
  const Vec2 px(420, 330);
  const DepthBounds bounds = depth_bounds(field, px);
  const double ground = (px.y() - vga().centre_px.y()) / vga().focal_px / 0.8;
  EXPECT_NEAR(bounds.most_pm, 1 / FieldParameters{}.nearest_depth_m, 1e-12) << "at z_min";
  EXPECT_NEAR(bounds.ground_pm, ground, 1e-12);
  // The ground may slope by 0.015 rad, and the height may be wrong by a tenth.
  const double sigma = std::hypot(0.015 / 0.8, 0.1 * ground);
  EXPECT_NEAR(bounds.ground_sigma_pm, sigma, 1e-12);
  EXPECT_NEAR(bounds.least_pm, ground - 2 * sigma, 1e-12);
  const auto share = [&](double inverse_depth_pm) {
    StaticPoint point =
        StaticPoint::seen_once(px, vga(), field, field.displacement_C_m(), kNoise2_px2);
    const Vec2 x = px - Vec2(vga().focal_px * 0.1 * inverse_depth_pm, 0);
    const double unbounded = density(point, x, kNoise2_px2);
    const double bounded = point.update(x, kNoise2_px2, bounds);
    EXPECT_GE(point.inverse_depth_pm, bounds.least_pm);
    EXPECT_LE(point.inverse_depth_pm, bounds.most_pm);
    return bounded / unbounded;
  };
  EXPECT_GT(share(0.5 * (bounds.least_pm + bounds.most_pm)), 0.99);
  // One frame gives 1/Z to 0.6 px of 42 px m, and the bounds' place to the same: 0.02 1/m.
  EXPECT_GT(share(bounds.most_pm - 0.1), 0.99);
  EXPECT_LT(share(bounds.most_pm + 0.1), 1e-3);
  EXPECT_LT(share(3 * bounds.most_pm), 1e-3);
  EXPECT_GT(share(ground + 0.1), 0.99);
  EXPECT_LT(share(ground - 4 * sigma), 1e-3);
  EXPECT_LT(share(0), 1e-3);
}

/// Z is measured along the optical axis, so it changes when the camera turns.
TEST(StaticPoint, AStandingCameraSaysNothingOfDepth) {
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(0.02, -0.1, 0.05)}) {
    const EgoMotion motion = steady_motion(Vector3d::Zero(), turn, kDt_s);
    const MotionField field(vga(), motion, {});
    Random random(6);
    const Vec2 start(180, 300);
    const DepthBounds bounds = depth_bounds(field, start);
    StaticPoint point = StaticPoint::seen_once(field.rotated(start), vga(), field,
                                               field.displacement_C_m(), kNoise2_px2);
    World world;
    world.add(field.rotated(start), 1 / point.inverse_depth_pm);
    const double sigma = std::sqrt(point.covariance(2, 2)) / point.inverse_depth_pm;
    for (int k = 0; k < 40; ++k) {
      if (k > 0) world.advance(motion);
      const Vector3d& x_C = world.points[0].x_C;
      const Vec2 x = testing::project(world.camera, x_C);
      if (k > 0) point = point.predicted(vga(), field, kUsual.ego_share);
      point.update(x + random.vector(1).head<2>(), kNoise2_px2, bounds);
      // The depth error follows the axis error: 1 px of 400, of 0.01 rad per frame.
      EXPECT_NEAR(point.inverse_depth_pm * x_C.z(), 1, 1e-3);
      EXPECT_NEAR(std::sqrt(point.covariance(2, 2)) / point.inverse_depth_pm, sigma, 1e-9);
      EXPECT_TRUE(point.covariance.topRightCorner(2, 1).isZero(0));
      EXPECT_LT((point.place_px - x).norm(), 2) << "it is where it is seen";
    }
    EXPECT_LT(point.covariance(0, 0), kNoise2_px2 / 40 * 1.01) << "a mean of 41";
  }
}

TEST(StaticPoint, IsFiniteWhereTheCameraGoesThroughIt) {
  const MotionField field(vga(), steady_motion({0, 0, 30}, Vector3d::Zero(), kDt_s), {});
  const Vec2 x(250, 200);
  StaticPoint point =
      StaticPoint::seen_once(field.rotated(x), vga(), field, field.displacement_C_m(), kNoise2_px2);
  for (int k = 0; k < 5; ++k) {
    if (k > 0) point = point.predicted(vga(), field, kUsual.ego_share);
    const double density = point.update(x, kNoise2_px2, depth_bounds(field, x));
    EXPECT_TRUE(std::isfinite(density));
    EXPECT_TRUE(point.place_px.allFinite() && point.covariance.allFinite());
  }
}

TEST(StaticPoint, IsFiniteWhereTheCameraTurnsAway) {
  const MotionField field(vga(), steady_motion({0.1, 0, 0.5}, {0, 20, 0}, kDt_s), {});
  for (const double inverse_depth_pm : {0.0, 1e-300, 0.5}) {
    for (const double x_px : {-1e4, 0.0, 250.0, 1e4}) {
      StaticPoint point;
      point.place_px = {x_px, 200};
      point.inverse_depth_pm = inverse_depth_pm;
      point.covariance.setIdentity();
      for (int k = 0; k < 5; ++k) point = point.predicted(vga(), field, kUsual.ego_share);
      EXPECT_TRUE(std::isfinite(point.inverse_depth_pm)) << inverse_depth_pm << " at " << x_px;
      EXPECT_TRUE(point.place_px.allFinite() && point.covariance.allFinite());
    }
  }
}

// ---- A motion of its own

/// Without acceleration the fit is the line through all sightings.
TEST(OwnMotion, IsTheLeastSquaresFitOfAConstantVelocity) {
  const MotionField field(vga(), steady_motion(Vector3d::Zero(), Vector3d::Zero(), kDt_s), {});
  Random random(3);
  std::vector<Vec2> places;
  for (int k = 0; k < 9; ++k) {
    places.push_back(Vec2(100, 200) + k * kDt_s * Vec2(80, -25) + random.vector(0.6).head<2>());
  }
  OwnMotion motion = OwnMotion::first(places[0], places[1], kNoise2_px2, kDt_s);
  for (std::size_t k = 2; k < places.size(); ++k) {
    motion = motion.predicted(field, 0);
    motion.update(places[k], kNoise2_px2);
    const double last = static_cast<double>(k), mean = last / 2;
    double tt = 0;
    Vec2 tx = Vec2::Zero(), x = Vec2::Zero();
    for (std::size_t i = 0; i <= k; ++i) {
      const double t = (static_cast<double>(i) - mean) * kDt_s;
      tt += t * t, tx += t * places[i], x += places[i] / (last + 1);
    }
    const Vec2 slope = tx / tt, end = x + slope * (last - mean) * kDt_s;
    EXPECT_LT((motion.velocity_pxps - slope).norm(), 1e-9);
    EXPECT_LT((motion.place_px - end).norm(), 1e-9);
    EXPECT_NEAR(motion.covariance(1, 1), kNoise2_px2 / tt, 1e-9);
    EXPECT_NEAR(motion.step_variance_px2(kDt_s), kNoise2_px2 / tt * kDt_s * kDt_s, 1e-9);
  }
}

TEST(OwnMotion, FollowsAVelocityUnderARotationAndGrowsSurer) {
  const MotionField field(vga(), steady_motion({0, 0, 0.5}, {0.02, -0.2, 0.1}, kDt_s), {});
  const Vec2 velocity(60, 30);
  std::vector<Vec2> places = {{200, 150}};
  for (int k = 1; k < 15; ++k) places.push_back(field.rotated(places.back()) + velocity * kDt_s);
  OwnMotion motion = OwnMotion::first(field.rotated(places[0]), places[1], kNoise2_px2, kDt_s);
  double variance = motion.covariance(1, 1);
  for (std::size_t k = 2; k < places.size(); ++k) {
    motion = motion.predicted(field, kUsual.turnover_ps);
    EXPECT_LT((motion.place_px - places[k]).norm(), 1e-9);
    const double there = motion.density(places[k], kNoise2_px2);
    EXPECT_GT(there, motion.density(places[k] + Vec2(1, 0), kNoise2_px2));
    EXPECT_EQ(motion.density(places[k] + Vec2(1, 0), kNoise2_px2),
              motion.density(places[k] - Vec2(1, 0), kNoise2_px2));
    motion.update(places[k], kNoise2_px2);
    expect_covariance<2>(motion.covariance);
    // Process noise is added in each frame: the variance falls to a steady state and oscillates
    // about it by less than 1 %.
    EXPECT_LT(motion.covariance(1, 1), variance * 1.01);
    variance = motion.covariance(1, 1);
  }
  // The velocity variance grows by q = 45 px^2/s^2 per frame, and a step measures it with r = 72:
  // the steady state lies below r.
  EXPECT_LT(variance, kNoise2_px2 * 2 / (kDt_s * kDt_s));
  EXPECT_LT(motion.covariance(0, 0), kNoise2_px2) << "more than a sighting tells";
  EXPECT_LT((motion.velocity_pxps - velocity).norm(), 1e-9);
}

}  // namespace
}  // namespace lcs
