// Smooth paths against numerical derivatives, and the IMU that is carried along them.
#include "sim/world/path.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/drive.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

scenario::Ego ego() {
  scenario::Ego ego;
  ego.source = {"test.yaml", 4};
  constexpr double kStep = 10 * test::kDegree;
  ego.path = {{0, {0, 0, 1}, {0, 0, 0}},
              {0.5, {0.3, 0.1, 1.2}, {kStep, 0, kStep}},
              {0.8, {0.4, 0.3, 1.1}, {0, 2 * kStep, 3 * kStep}},
              {1.6, {1, 0, 1.5}, {-kStep, kStep, 9 * kStep}},
              {2, {1.2, -0.2, 1.4}, {0, 5 * kStep, 9 * kStep}},
              {3, {1.5, 0, 1}, {0, 0, 12 * kStep}}};
  return ego;
}

Matrix3d rotation(const Vector3d& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

Vector3d log_of(const Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

TEST(Path, LeadsThroughItsPosesAtTheirTimes) {
  const Path path(ego());
  for (const scenario::PathPose& pose : ego().path) {
    const Path::Motion m = path.at(pose.at_s);
    EXPECT_LT((m.T_WB.p - pose.position_m).norm(), 1e-8) << pose.at_s;
    EXPECT_LT(log_of(m.T_WB.R.transpose() * rotation(pose.rpy_rad)).norm(), 1e-8) << pose.at_s;
  }
}

TEST(Path, IsAtRestAtBothEnds) {
  const Path path(ego());
  for (const double t_s : {-1.0, 0.0, 3.0 - 1e-9, 3.0, 100.0}) {
    EXPECT_LT(path.at(t_s).v_WB_mps.norm(), 1e-7) << t_s;
    EXPECT_LT(path.at(t_s).w_B_radps.norm(), 1e-7) << t_s;
  }
  EXPECT_EQ(path.at(100).T_WB.p, path.at(3).T_WB.p);
}

/// Central differences over 1e-4 s have errors of that squared times the third derivative, and
/// rounding of 1e-16 / 1e-4.
TEST(Path, HasTheDerivativesOfItsPoses) {
  const Path path(ego());
  constexpr double kStep_s = 1e-4;
  for (double t_s = 0.013; t_s < 2.99; t_s += 0.0317) {
    const Path::Motion m = path.at(t_s), before = path.at(t_s - kStep_s),
                       after = path.at(t_s + kStep_s);
    EXPECT_LT(((after.T_WB.p - before.T_WB.p) / (2 * kStep_s) - m.v_WB_mps).norm(), 1e-5);
    EXPECT_LT(((after.v_WB_mps - before.v_WB_mps) / (2 * kStep_s) - m.a_WB_mps2).norm(), 5e-3);
    const Vector3d turn = log_of(before.T_WB.R.transpose() * after.T_WB.R);
    EXPECT_LT((turn / (2 * kStep_s) - m.w_B_radps).norm(), 1e-5);
    EXPECT_LT(((after.w_B_radps - before.w_B_radps) / (2 * kStep_s) - m.dw_B_radps2).norm(), 2e-2);
  }
}

TEST(Path, RefusesPosesThatTurnTooFar) {
  scenario::Ego far = ego();
  far.path[4].rpy_rad.y() = 80 * test::kDegree;  // up and down by 100 deg in half a second
  EXPECT_NE(test::scenario_error([&] { Path{far}; }).find("test.yaml:4: ego.path: no smooth path"),
            std::string::npos);
}

TEST(Path, PausesForLongAmongPosesThatAreDense) {
  scenario::Ego paused = ego();
  paused.path.clear();
  for (int i = 0; i < 200; ++i) {
    paused.path.push_back(
        {0.05 * i + (i > 100 ? 5 : 0), {0.01 * i, 0, 1}, {0, 0, test::kDegree * i}});
  }
  const Path path(paused);
  for (const scenario::PathPose& pose : paused.path) {
    const Path::Motion m = path.at(pose.at_s);
    EXPECT_LT((m.T_WB.p - pose.position_m).norm(), 1e-8) << pose.at_s;
    EXPECT_LT(log_of(m.T_WB.R.transpose() * rotation(pose.rpy_rad)).norm(), 1e-8) << pose.at_s;
  }
}

TEST(Path, NamesThePlaceAtWhichTimesAreTooUneven) {
  scenario::Ego uneven = ego();
  uneven.path.clear();
  for (int i = 0; i < 2000; ++i) {
    const double yaw = i < 1001 ? 0 : 20 * test::kDegree;  // in 0.1 ms, among poses each 20 ms
    uneven.path.push_back({0.02 * i - (i >= 1001 ? 0.0199 : 0), {0.01 * i, 0, 1}, {0, 0, yaw}});
  }
  const std::string said = test::scenario_error([&] { Path{uneven}; });
  EXPECT_NE(said.find("test.yaml:4: ego.path: no smooth path leads through these poses: near 20 s "
                      "it would swing by more than half a turn; add poses in between, or give them "
                      "more even times"),
            std::string::npos)
      << said;
}

scenario::Scenario carried() {
  scenario::Scenario s = test::scenario_in("lab", 0, 30);
  s.ego = ego();
  s.ego.start_m = {0, 0};
  s.camera.mount_position_m = {0.03, 0.02, -0.01};
  return s;
}

TEST(CarriedCamera, IsWhereItsPathIs) {
  const scenario::Scenario s = carried();
  const Path path(s.ego);
  for (const Observation& frame : drive(s).frames) {
    const Path::Motion m = path.at(1e-9 * static_cast<double>(frame.t_ns));
    const Vector3d arm = m.T_WB.R * s.camera.mount_position_m;
    EXPECT_LT((frame.truth.now.T_WC.p - m.T_WB.p - arm).norm(), 1e-12);
    const Vector3d w_W = m.T_WB.R * m.w_B_radps;
    EXPECT_LT((frame.truth.v_WC_mps - m.v_WB_mps - w_W.cross(arm)).norm(), 1e-9);
  }
  EXPECT_FALSE(drive(s).calibration.on_ground);
}

/// A reading is the mean over 5 ms. It differs from the path's rate in the middle by 1 / 24 of the
/// second derivative times (5 ms)^2.
TEST(CarriedCamera, HasTheImuOfItsPath) {
  const scenario::Scenario s = carried();
  const Path path(s.ego);
  Vector3d p = path.at(0).T_WB.p, v = Vector3d::Zero();
  Matrix3d R = path.at(0).T_WB.R;
  std::int64_t last_ns = -1;
  for (const Observation& frame : drive(s).frames) {
    for (const ImuSample& sample : frame.imu) {
      if (last_ns < 0) {  // of the instant
        const Path::Motion m = path.at(0);
        EXPECT_LT(
            (sample.accel_mps2 - m.T_WB.R.transpose() * (m.a_WB_mps2 + 9.81 * Vector3d::UnitZ()))
                .norm(),
            1e-6);
      } else {
        const double dt_s = 1e-9 * static_cast<double>(sample.t_ns - last_ns);
        const Path::Motion m = path.at(1e-9 * static_cast<double>(last_ns) + dt_s / 2);
        EXPECT_LT((sample.gyro_radps - m.w_B_radps).norm(), 2e-2);
        EXPECT_LT(
            (sample.accel_mps2 - m.T_WB.R.transpose() * (m.a_WB_mps2 + 9.81 * Vector3d::UnitZ()))
                .norm(),
            2e-2);
        // integration by the mean rates returns to the path
        const auto turned = [&](double share) {
          const Vector3d turn = share * dt_s * sample.gyro_radps;
          return turn.norm() > 0
                     ? Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix()
                     : Matrix3d::Identity().eval();
        };
        const Vector3d a = R * turned(0.5) * sample.accel_mps2 - 9.81 * Vector3d::UnitZ();
        p += dt_s * v + dt_s * dt_s / 2 * a;
        v += dt_s * a;
        R *= turned(1);
      }
      last_ns = sample.t_ns;
    }
  }
  const Path::Motion m = path.at(1e-9 * static_cast<double>(last_ns));
  EXPECT_LT((v - m.v_WB_mps).norm(), 1e-7);
  EXPECT_LT(log_of(R.transpose() * m.T_WB.R).norm(), 1e-7);
  EXPECT_LT((p - m.T_WB.p).norm(), 1e-4) << "the trapezoidal rule at 200 Hz";
}

/// At r in the body a point is accelerated by a + w' x r + w x (w x r).
TEST(CarriedCamera, HasTheImuOfItsPlaceOnTheRover) {
  scenario::Scenario s = carried();
  const Vector3d arm(0.3, -0.2, 0.5), rpy(0.3, -0.4, 1.2);
  s.imu.position_m = arm;
  s.imu.rpy_rad = rpy;
  const Matrix3d R_BS = rotation(rpy);
  const Drive driven = drive(s);
  EXPECT_LT((driven.calibration.T_BS.p - arm).norm(), 1e-12);
  EXPECT_LT((driven.calibration.T_BS.R - R_BS).norm(), 1e-12);
  const Path path(s.ego);
  std::int64_t last_ns = -1;
  double largest = 0;
  for (const Observation& frame : driven.frames) {
    for (const ImuSample& sample : frame.imu) {
      if (last_ns >= 0) {
        const Path::Motion m = path.at(0.5e-9 * static_cast<double>(sample.t_ns + last_ns));
        const Vector3d lever = m.dw_B_radps2.cross(arm) + m.w_B_radps.cross(m.w_B_radps.cross(arm));
        const Vector3d force_B =
            m.T_WB.R.transpose() * (m.a_WB_mps2 + 9.81 * Vector3d::UnitZ()) + lever;
        // as without the arm; at the knots of the path w' is not smooth
        EXPECT_LT((sample.accel_mps2 - R_BS.transpose() * force_B).norm(), 4e-2);
        EXPECT_LT((sample.gyro_radps - R_BS.transpose() * m.w_B_radps).norm(), 2e-2);
        largest = std::max(largest, lever.norm());
      }
      last_ns = sample.t_ns;
    }
  }
  EXPECT_GT(largest, 1) << "the arm makes a difference";
}

TEST(CarriedCamera, HasNoWheels) {
  scenario::Scenario s = carried();
  s.odometry.enabled = true;
  EXPECT_NE(test::scenario_error([&] { drive(s); }).find("odometry measures wheels"),
            std::string::npos);
}

}  // namespace
}  // namespace lcs::sim
