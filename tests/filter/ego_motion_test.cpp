#include "filter/ego_motion/estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::Random;
using testing::rotation;

constexpr double kGravity = 9.81;
constexpr std::int64_t kImuStep_ns = 5'000'000;

/// A rover whose pose is known in closed form.
struct Path {
  std::function<Matrix3d(double)> R_WB;
  std::function<Vector3d(double)> p_WB;
};

Vector3d derivative(const std::function<Vector3d(double)>& f, double t) {
  const double h = 1e-4;
  return (f(t + h) - f(t - h)) / (2 * h);
}

struct Reading {
  Vector3d rate, force;
};

/// The means over (t - dt, t] in S, as a unit reads that integrates its rates.
Reading reading(const Path& path, const Mounting& m, double t) {
  const double dt = 1e-9 * kImuStep_ns;
  const auto R_WS = [&](double s) -> Matrix3d { return path.R_WB(s) * m.R_BS; };
  const auto p_WS = [&](double s) -> Vector3d { return path.p_WB(s) + path.R_WB(s) * m.p_BS_m; };
  const Eigen::AngleAxisd turn(Matrix3d(R_WS(t - dt).transpose() * R_WS(t)));
  const Matrix3d R_middle = R_WS(t - dt) * Eigen::AngleAxisd(turn.angle() / 2, turn.axis());
  const Vector3d change = derivative(p_WS, t) - derivative(p_WS, t - dt);
  return {turn.axis() * turn.angle() / dt,
          R_middle.transpose() * (change / dt + Vector3d(0, 0, kGravity))};
}

Mounting mounting() {
  Mounting m;
  m.R_BC << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // the camera looks along B's x
  m.p_BC_m = {0.2, 0.03, 0.4};
  m.R_BS = rotation({0.1, -0.2, 0.3});
  m.p_BS_m = {-0.1, 0.05, 0.1};
  return m;
}

EgoMotionEstimator start(const Path& path, const Mounting& m) {
  return {m, {}, {0, path.R_WB(0), derivative(path.p_WB, 0), kGravity}};
}

struct Camera {
  Matrix3d R;
  Vector3d p;
};
Camera camera(const Path& path, const Mounting& m, double t) {
  return {path.R_WB(t) * m.R_BC, path.p_WB(t) + path.R_WB(t) * m.p_BC_m};
}

/// Runs the exact readings of a path through the estimator and compares every frame's motion.
void expect_exact(const Path& path, double frame_hz, double rotation_rad, double displacement_m) {
  const Mounting m = mounting();
  EgoMotionEstimator estimator = start(path, m);
  std::int64_t t_ns = 0;
  for (int k = 0; k <= static_cast<int>(2 * frame_hz); ++k) {
    const auto frame_ns = static_cast<std::int64_t>(std::llround(k * 1e9 / frame_hz));
    for (; t_ns <= frame_ns; t_ns += kImuStep_ns) {
      const double t = static_cast<double>(t_ns) * 1e-9;
      const auto [rate, force] = reading(path, m, t);
      estimator.add_imu(t_ns, rate, force);
    }
    const EgoMotion motion = estimator.frame(frame_ns);
    if (k == 0) continue;
    const double now = static_cast<double>(frame_ns) * 1e-9;
    const Camera before = camera(path, m, now - 1 / frame_hz), after = camera(path, m, now);
    const Matrix3d R_cur_prev = after.R.transpose() * before.R;
    EXPECT_LT(Eigen::AngleAxisd(motion.R_cur_prev * R_cur_prev.transpose()).angle(), rotation_rad);
    const Vector3d displacement = after.R.transpose() * (after.p - before.p);
    EXPECT_LT((motion.v_C_mps * motion.dt_s - displacement).norm(), displacement_m)
        << "frame " << k;
    EXPECT_NEAR(motion.dt_s, 1 / frame_hz, 1e-9);
    // The mean body rate and the rotation agree.
    EXPECT_TRUE(rotation(-motion.w_C_radps * motion.dt_s).isApprox(motion.R_cur_prev, 1e-9));
  }
}

// Tolerances: the trapezoid over 5 ms errs by its third-order term. For these paths that is below
// 1e-6 of the motion per frame, and over 2 s it adds up to less than 0.1 mm per frame.

TEST(EgoMotion, StraightAndAcceleratingIsExact) {
  expect_exact({[](double) { return Matrix3d::Identity(); },
                [](double t) { return Vector3d(0.5 * t + 0.3 * t * t, 0.1 * t, 0); }},
               10, 1e-6, 1e-5);
}

TEST(EgoMotion, TurningOnTheSpotMovesTheLeveredCamera) {
  expect_exact({[](double t) {
                  return rotation({0, 0, 0.6 * t});
                },
                [](double) { return Vector3d(0, 0, 0); }},
               10, 1e-6, 1e-4);
}

TEST(EgoMotion, ACurveWithRollAndPitchIsFollowed) {
  expect_exact(
      {[](double t) {
         return Matrix3d(rotation({0, 0, 0.4 * t}) *
                         rotation({0.05 * std::sin(3 * t), 0.03 * std::sin(5 * t), 0}));
       },
       [](double t) { return Vector3d(std::sin(t), 1 - std::cos(t), 0.02 * std::sin(4 * t)); }},
      10, 1e-4, 3e-4);
}

TEST(EgoMotion, FramesBetweenReadingsAreCarriedOn) {
  // 30 frames/s and 200 readings/s: frames fall between readings, which are held for at most 5 ms.
  expect_exact({[](double t) {
                  return rotation({0, 0, 0.3 * t});
                },
                [](double t) { return Vector3d(0.5 * t, 0, 0); }},
               30, 1e-5, 1e-4);
}

TEST(EgoMotion, OdometryHoldsTheDriftOfABiasedImu) {
  const Path path{[](double) { return Matrix3d::Identity(); },
                  [](double t) { return Vector3d(0.03 * t, 0, 0); }};
  const Mounting m = mounting();
  const Vector3d gyro_bias(1e-3, -1e-3, 5e-4), accel_bias(0.02, -0.03, 0.01);
  enum { alone, with_velocity, with_yaw_rate, kWays };
  double error[kWays], told_sigma[kWays];
  for (int way = alone; way < kWays; ++way) {
    EgoMotionEstimator estimator = start(path, m);
    for (std::int64_t t_ns = 0; t_ns <= 30'000'000'000; t_ns += kImuStep_ns) {
      const double t = static_cast<double>(t_ns) * 1e-9;
      const auto [rate, force] = reading(path, m, t);
      estimator.add_imu(t_ns, rate + gyro_bias, force + accel_bias);
      if (way == alone || t_ns % 20'000'000 != 0) continue;
      estimator.add_odometry(t_ns, {0.03, 0, 0},
                             way == with_yaw_rate ? std::optional(0.0) : std::nullopt);
    }
    error[way] = (estimator.v_WS_mps() - Vector3d(0.03, 0, 0)).norm();
    told_sigma[way] = estimator.frame(30'000'000'000).velocity_sigma_mps;
  }
  EXPECT_GT(error[alone], 0.5);  // 30 s of these biases
  // The reported sigma shows the error, although this IMU is over ten times worse than assumed.
  EXPECT_GT(told_sigma[alone], 0.2);
  for (const int way : {with_velocity, with_yaw_rate}) {
    EXPECT_LT(error[way], 0.01);  // a third of the speed, from 2 cm/s of odometry noise assumed
    EXPECT_LT(told_sigma[way], 0.01);
  }
}

/// From 2 to 5 s one wheel has no grip: the rover turns by up to 0.3 rad/s and slides by up to
/// 0.15 m/s, while its wheels still report straight motion at 0.3 m/s.
Path sliding() {
  const auto bump = [](double t) {
    const double s = std::clamp((t - 2) / 3, 0.0, 1.0);
    return std::pow(s * (1 - s), 4);
  };
  return {[=](double t) {
            return rotation({0, 0, 60 * bump(t)});
          },
          [=](double t) { return Vector3d(0.3 * t, 30 * bump(t), 0); }};
}

struct Slide {
  double off_mps = 0;                       ///< mean error of the velocity during the slide,
  double slips_in_it = 0, slips_after = 0;  ///< and of the probability of wheel slip
};

Slide slide(bool tells_yaw_rate) {
  const Path path = sliding();
  const Mounting m = mounting();
  Random random(3);
  const auto noise = [&](double sigma) { return sigma * std::sqrt(3) * random.uniform(-1, 1); };
  EgoMotionEstimator estimator = start(path, m);
  Slide slide;
  for (std::int64_t t_ns = 0; t_ns <= 8'000'000'000; t_ns += kImuStep_ns) {
    const double t = static_cast<double>(t_ns) * 1e-9;
    const auto [rate, force] = reading(path, m, t);
    estimator.add_imu(t_ns, rate, force);
    if (t_ns % 20'000'000 != 0) continue;
    const Vector3d wheels(0.3 + noise(0.02), noise(0.02), 0);
    const double yaw_rate = noise(0.05);
    estimator.add_odometry(t_ns, wheels, tells_yaw_rate ? std::optional(yaw_rate) : std::nullopt);
    const Vector3d truth =
        derivative([&](double s) -> Vector3d { return path.p_WB(s) + path.R_WB(s) * m.p_BS_m; }, t);
    if (t > 2.5 && t < 4.5) {
      slide.off_mps += (estimator.v_WS_mps() - truth).norm() / 99;
      slide.slips_in_it += estimator.chance_of_slip() / 99;
    }
    if (t > 6) slide.slips_after += estimator.chance_of_slip() / 100;
  }
  return slide;
}

TEST(EgoMotion, WheelsThatContradictTheStartAtOnceLeaveFiniteNumbers) {
  const Path still{[](double) { return Matrix3d::Identity(); },
                   [](double) { return Vector3d::Zero(); }};
  const Mounting m = mounting();
  EgoMotionEstimator estimator = start(still, m);
  estimator.add_imu(0, Vector3d::Zero(), reading(still, m, 0).force);
  estimator.add_odometry(0, {9, 0, 0}, 0.5);
  EXPECT_TRUE(estimator.R_WS().allFinite());
}

TEST(EgoMotion, WheelsThatSlipAreNotBelieved) {
  // Without a yaw rate the estimator follows the wheels and attributes the IMU's contradiction to
  // its bias.
  const Slide blind = slide(false), told = slide(true);
  EXPECT_GT(blind.off_mps, 0.08);
  // In the middle of the slide the yaw rate passes zero; there the wheels are trusted again
  // for some readings.
  EXPECT_LT(told.off_mps, blind.off_mps / 3);
  EXPECT_GT(told.slips_in_it, 0.8);
  EXPECT_LT(told.slips_after, 0.1);
  EXPECT_EQ(blind.slips_in_it, 0);
}

TEST(EgoMotion, ACorrectionIsNoMotionOfTheFrame) {
  // Disagreeing odometry corrects the attitude; the frame's rotation still comes from the gyro.
  const Path path{[](double) { return Matrix3d::Identity(); },
                  [](double t) { return Vector3d(1.0 * t, 0, 0); }};
  const Mounting m = mounting();
  EgoMotionEstimator estimator = start(path, m);
  std::int64_t t_ns = 0;
  for (int k = 1; k <= 50; ++k) {
    for (; t_ns <= k * 100'000'000LL; t_ns += kImuStep_ns) {
      const double t = static_cast<double>(t_ns) * 1e-9;
      const auto [rate, force] = reading(path, m, t);
      estimator.add_imu(t_ns, rate, force);
      if (t_ns % 20'000'000 == 0) estimator.add_odometry(t_ns, {1.0, 0.05, 0});
    }
    const EgoMotion motion = estimator.frame(k * 100'000'000LL);
    if (k > 1) {
      EXPECT_LT(Eigen::AngleAxisd(motion.R_cur_prev).angle(), 2e-4);  // the learnt gyro bias only
    }
  }
}

TEST(EgoMotion, BadReadingsAreDroppedAndCounted) {
  const Path path{[](double) { return Matrix3d::Identity(); },
                  [](double t) { return Vector3d(0.5 * t, 0, 0); }};
  const Mounting m = mounting();
  EgoMotionEstimator estimator = start(path, m);
  const Vector3d up = reading(path, m, 0).force;
  estimator.add_imu(0, Vector3d::Zero(), up);
  estimator.add_imu(10'000'000, Vector3d::Zero(), up);
  estimator.add_imu(5'000'000, Vector3d::Zero(), up);  // older than the last reading
  estimator.add_imu(15'000'000, Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()), up);
  estimator.add_odometry(20'000'000, Vector3d::Constant(std::numeric_limits<double>::infinity()));
  EXPECT_EQ(estimator.diagnostics().count(Fault::imu_out_of_order), 1);
  EXPECT_EQ(estimator.diagnostics().count(Fault::imu_not_finite), 1);
  EXPECT_EQ(estimator.diagnostics().count(Fault::odometry_unusable), 1);
  EXPECT_TRUE(estimator.v_WS_mps().allFinite());
}

TEST(EgoMotion, TheGroundIsLevelThroughTheOriginOfARoverThatPitchesAndRolls) {
  const Path path = {[](double t) {
                       return rotation({0.05 * t, -0.08 * t, 0.3 * t});
                     },
                     [](double) { return Vector3d(0, 0, 0); }};
  Mounting m = mounting();
  m.on_ground = true;
  EgoMotionEstimator estimator = start(path, m);
  for (std::int64_t t_ns = 0; t_ns <= 2'000'000'000; t_ns += kImuStep_ns) {
    const double t = static_cast<double>(t_ns) * 1e-9;
    const auto [rate, force] = reading(path, m, t);
    estimator.add_imu(t_ns, rate, force);
  }
  const EgoMotion motion = estimator.frame(2'000'000'000);
  ASSERT_TRUE(motion.ground);
  const Matrix3d R_WC = path.R_WB(2) * m.R_BC;
  EXPECT_LT((motion.ground->up_C - R_WC.transpose() * Vector3d::UnitZ()).norm(), 1e-4);
  EXPECT_NEAR(motion.ground->height_m, (path.R_WB(2) * m.p_BC_m).z(), 1e-4);
}

TEST(EgoMotion, NoGroundIsKnownToWhatFliesOrLooksFromBelow) {
  Mounting m = mounting();
  EXPECT_FALSE(EgoMotionEstimator(m, {}, {}).ground());
  m.on_ground = true;
  EXPECT_TRUE(EgoMotionEstimator(m, {}, {}).ground());
  m.p_BC_m.z() = -0.1;
  EXPECT_FALSE(EgoMotionEstimator(m, {}, {}).ground());
}

TEST(EgoMotion, TheFirstFrameHasNoMotion) {
  EgoMotionEstimator estimator(mounting(), {}, {});
  const EgoMotion motion = estimator.frame(0);
  EXPECT_EQ(motion.dt_s, 0);
  EXPECT_TRUE(motion.R_cur_prev.isIdentity());
}

}  // namespace
}  // namespace lcs
