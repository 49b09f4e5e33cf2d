// The experiments of `lcs kinematics`, each against theory and against the simulator.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>

#include "scenarios/imu_presets.h"
#include "scenarios/load.h"
#include "sim/simulation.h"
#include "tools/bench/detector.h"
#include "tools/bench/ego_motion_feed.h"
#include "tools/kinematics/answer.h"
#include "tools/kinematics/study.h"
#include "tools/kinematics/theory.h"
#include "tools/process/parallel.h"

namespace lcs::kinematics {
namespace {

using Eigen::Vector3d;

constexpr std::array kDepths_m = {1.0, 3.0, 10.0};

sim::Pinhole vga() {
  return sim::Pinhole::from_fovy(640, 480, std::numbers::pi / 3);
}

StudyConfig config_with(std::vector<std::string> sets = {},
                        const Effort& effort = Effort::quick()) {
  return configure(
      scenario::load(LCS_SCENARIOS_DIR "/crossing.yaml", {.sets = std::move(sets), .seed = {}}),
      effort);
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// Error of every landmark under one model after one exact motion, px.
std::vector<double> errors_after(const PointSet& points, const sim::Pose& T_CN,
                                 const FieldModel& model) {
  const FieldParameters field;
  return errors(step_to(points.camera, T_CN, 0.1, field), model, landmarks(points, T_CN, field));
}

// ---- Rotation

/// The remainder after the second order is of third order: half the angle gives an eighth.
TEST(KinematicsTheory, SecondOrderIsWhatTheFirstOrderFieldLacks) {
  const PointSet points = geometric_points(vga(), kDepths_m);
  for (const Vector3d& axis :
       {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1), Vector3d(1, -2, 3).normalized()}) {
    const auto left = [&](double angle) {
      FieldParameters first_order;
      first_order.rotation = RotationModel::first_order;
      sim::Pose T_CN;
      T_CN.R = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
      const FieldStep step = step_to(vga(), T_CN, 1, first_order);
      double worst = 0;
      for (const Landmark& landmark : landmarks(points, T_CN, first_order)) {
        const Vec2 error =
            landmark.after_px -
            MotionField(step.camera, step.motion, first_order).rotated(landmark.before_px);
        const Vec2 second = second_order_rotation(landmark.before_px - vga().centre_px,
                                                  angle * axis, vga().focal_px);
        worst = std::max(worst, (error - second).norm());
      }
      return worst;
    };
    // The worst point may change as points leave the image: 8 within a few percent.
    EXPECT_NEAR(left(0.01) / left(0.005), 8, 0.4) << axis.transpose();
  }
}

/// There x (1 + t^2) w^2 and y (1/2 + t^2) w^2 vanish; f tan(w) - f w = f w^3 / 3 remains.
TEST(KinematicsTheory, AtTheCentrePanningErrsAtThirdOrderAlone) {
  const double f = vga().focal_px;
  EXPECT_EQ(second_order_rotation({0, 0}, {0, 1, 0}, f).norm(), 0);
  const Vec2 corner(300, 200);
  const Vec2 t = corner / f;
  EXPECT_TRUE(
      second_order_rotation(corner, {0, 1, 0}, f)
          .isApprox(Vec2(corner.x() * (1 + t.x() * t.x()), corner.y() * (0.5 + t.x() * t.x())),
                    1e-12));
  EXPECT_NEAR(second_order_rotation(corner, {0, 0, 1}, f).norm(), corner.norm() / 2, 1e-9);

  PointSet centre = geometric_points(vga(), std::array{3.0}, 3, 3);
  centre.sites = {{vga().centre_px, 3}};
  centre.seen_from = [](const sim::Pose& T_CN) {
    return std::vector<Vec2>{vga().project(T_CN.inverse() * Vector3d(0, 0, 3))};
  };
  const double angle = 5 * kDegree;
  const auto error =
      errors_after(centre, turned(1, angle), {RotationModel::first_order, DepthSource::truth});
  EXPECT_NEAR(error.at(0), f * std::pow(angle, 3) / 3, 0.02 * error.at(0));  // next: w^5 * 2/15
}

/// A transcription of the print here, beside the filter's.
TEST(KinematicsTheory, ThePrintedRotationIsOffAtFirstOrder) {
  const PointSet points = geometric_points(vga(), kDepths_m);
  for (int axis = 0; axis < 3; ++axis) {
    const double angle = 1e-4;  // second order contributes 1e-4
    const sim::Pose T_CN = turned(axis, angle);
    const auto seen = landmarks(points, T_CN, {});
    const auto off =
        errors(step_to(vga(), T_CN, 1, {}), {RotationModel::as_printed, DepthSource::truth}, seen);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Vec2 x = seen[i].before_px - vga().centre_px;
      EXPECT_NEAR(off[i] / angle, printed_slope(x, axis, vga().focal_px).norm(), 0.2);
    }
  }
}

/// Third order is a share of w x/f of the second, here up to 0.05.
TEST(KinematicsSweep, TheLimitOfFirstOrderIsTheoryS) {
  for (const double fovy_deg : {20.0, 60.0, 110.0}) {
    const sim::Pinhole camera = sim::Pinhole::from_fovy(640, 480, fovy_deg * kDegree);
    const PointSet points = geometric_points(camera, kDepths_m);
    for (int axis = 0; axis < 3; ++axis) {
      const double theory = first_order_limit_rad(camera, axis, 1);
      const double measured = rotation_limit_rad(points, {}, RotationModel::first_order, axis, 1);
      EXPECT_NEAR(measured / theory, 1, 0.05) << fovy_deg << " deg, " << axis_name(axis);
      // Quadratic: half the angle gives a quarter of the error.
      const double quarter = rotation_limit_rad(points, {}, RotationModel::first_order, axis, 0.25);
      EXPECT_NEAR(measured / quarter, 2, 0.05);
    }
  }
}

TEST(KinematicsSweep, TheHomographyHasNoLimit) {
  const PointSet points = geometric_points(vga(), kDepths_m);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_TRUE(std::isnan(rotation_limit_rad(points, {}, RotationModel::homography, axis, 1e-6)));
  }
}

// ---- Translation

/// Rounding alone: coordinates of 1e3 px have an ulp of 1e-13, and a few operations add up.
TEST(KinematicsModels, HomographyAndTrueDepthAreExactForAnyMotion) {
  const PointSet points = geometric_points(vga(), kDepths_m);
  for (int axis = 0; axis < 3; ++axis) {
    const auto all = errors_after(points, turned(axis, 0.15, {0.1, -0.05, 0.3}), {});
    ASSERT_GT(all.size(), 500u);
    EXPECT_LT(largest(all), 1e-10);
  }
}

/// At the row's own frame rate: at another rate a short step would be slower than the filter's
/// still speed.
TEST(KinematicsSweep, EveryStepIsExactWithTheTrueDepthWhateverTheConfiguredRate) {
  Study study;
  sweep_translation(config_with({"camera.rate=1 Hz"}), {}, study.translation);
  ASSERT_GT(study.translation.figures("max_px").size(), 200u);
  const Table::Where exact{{"depth", "truth"}};
  const auto errors_px = study.translation.figures("max_px", exact);
  const auto speeds_mps = study.translation.figures("speed_mps", exact);
  const auto rates_hz = study.translation.figures("rate_hz", exact);
  for (std::size_t i = 0; i < errors_px.size(); ++i) {
    EXPECT_LT(errors_px[i], 1e-10) << speeds_mps[i] << " m/s at " << rates_hz[i] << " Hz";
  }
}

/// |g| t_f |1/Z - 1/Z_ref| with Z after the step.
TEST(KinematicsModels, TheReferenceDepthErrsByTheDifferenceOfInverseDepths) {
  const double step_m = 0.2;
  const FieldParameters field;
  for (const double depth_m : {1.0, 3.2, 20.0}) {
    const PointSet points = geometric_points(vga(), std::array{depth_m});
    const sim::Pose T_CN{Eigen::Matrix3d::Identity(), {0, 0, step_m}};
    const auto seen = landmarks(points, T_CN, field);
    const auto off =
        errors_after(points, T_CN, {RotationModel::homography, DepthSource::reference});
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const double r = (seen[i].before_px - vga().centre_px).norm();
      EXPECT_NEAR(off[i],
                  r * step_m * std::abs(1 / (depth_m - step_m) - 1 / field.reference_depth_m),
                  1e-9);
    }
  }
}

/// Two sightings are each rounded by up to half a pixel. Their difference covers kLearningSteps
/// steps, so one step errs by at most sqrt(2) / kLearningSteps px, and a little more as the point
/// approaches.
TEST(KinematicsModels, LearntDepthErrsByAFractionOfAPixel) {
  const PointSet points = geometric_points(vga(), std::array{3.0, 8.0});
  const sim::Pose T_CN{Eigen::Matrix3d::Identity(), {0, 0, 0.05}};
  const auto off = errors_after(points, T_CN, {RotationModel::homography, DepthSource::learnt});
  EXPECT_LT(largest(off), 1.2 * std::sqrt(2.0) / kLearningSteps);
  EXPECT_GT(largest(off), 0.02) << "whole pixels cannot be that good";
}

// ---- Rendered points

/// Two independent truths: the simulator's label of a corner, and the pinhole with its depth.
TEST(KinematicsPoints, TheDepthOfTwoSightingsIsFound) {
  const FieldParameters parameters;
  const FieldStep step = step_to(vga(), {}, 0.1, parameters);
  const MotionField field(step.camera, step.motion, parameters);
  for (const Vector3d& moved_m :
       {Vector3d(0, 0, 0.2), Vector3d(0.1, -0.2, 0), Vector3d(0.1, 0, -0.2)}) {
    for (const Site& site : geometric_points(vga(), kDepths_m).sites) {
      const Vec2 before = vga().project(vga().back_project(site.px, site.depth_m) + moved_m);
      if ((before - site.px).norm() < 1e-6) continue;  // on the focus of expansion
      EXPECT_NEAR(ratio_from(vga(), field, site.px, before, moved_m),
                  parameters.reference_depth_m / site.depth_m, 1e-6);
    }
  }
}

TEST(KinematicsPoints, TheSimulatorAndThePinholeAgreeOnRenderedCorners) {
  const StudyConfig config = config_with();
  const PointSet points = rendered_with_lens(config, config.scenario.camera.fovy_rad);
  ASSERT_GT(points.sites.size(), 30u);
  const sim::Pose T_CN = turned(1, 0.05, {0.1, 0.02, 0.2});
  const std::vector<Vec2> seen = points.seen_from(T_CN);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Site& site = points.sites[i];
    const Vec2 pinhole =
        points.camera.project(T_CN.inverse() * points.camera.back_project(site.px, site.depth_m));
    EXPECT_LT((seen[i] - pinhole).norm(), 1e-9);
  }
}

// ---- Mount

/// The estimator with a wrong mount, on a curved drive, agrees with `seen_by_wrong_mount`.
TEST(KinematicsMount, AWrongMountTurnsWhatTheEstimatorTells) {
  const StudyConfig config = config_with();
  const sim::Drive drive = sim::drive(curved_drive(config, 1, 10, 0.3));
  const Eigen::Matrix3d R_CM = turned(0, 3 * kDegree).R * turned(2, 2 * kDegree).R;
  sim::Calibration wrong = drive.calibration;
  wrong.T_BC.R = wrong.T_BC.R * R_CM;
  scenario::Scenario scenario = config.scenario;
  scenario.odometry.enabled = false;
  bench::EgoMotionFeed right_feed(scenario, drive.calibration), wrong_feed(scenario, wrong);
  for (const sim::Observation& frame : drive.frames) {
    sim::Observation without_odometry = frame;
    without_odometry.odometry.clear();
    const EgoMotion right = right_feed.next(without_odometry).told;
    const EgoMotion told = wrong_feed.next(without_odometry).told;
    const EgoMotion expected = seen_by_wrong_mount(right, R_CM);
    EXPECT_TRUE(told.R_cur_prev.isApprox(expected.R_cur_prev, 1e-9));
    EXPECT_LT((told.v_C_mps - expected.v_C_mps).norm(), 1e-9);
    EXPECT_LT((told.w_C_radps - expected.w_C_radps).norm(), 1e-9);
  }
}

// ---- Noise

/// One ideal drive with added noise has the same bits as the simulator's noisy readings.
TEST(KinematicsNoise, IsTheSimulatorSOwnForTheSameSeed) {
  const StudyConfig config = config_with();
  scenario::Scenario noisy = straight_drive(config, 1, 10);
  noisy.imu.noise = *scenario::imu_preset("tumvi");
  noisy.imu.noise.gyroscope_turn_on_bias_radps = 1e-3;
  noisy.odometry.noise_mps = 0.01;
  noisy.odometry.scale_error = 0.02;
  noisy.seed = 7;
  const sim::Drive simulated = sim::drive(noisy);
  const sim::Drive made = with_noise(sim::drive(straight_drive(config, 1, 10)), noisy);
  ASSERT_EQ(made.frames.size(), simulated.frames.size());
  for (std::size_t k = 0; k < made.frames.size(); ++k) {
    const sim::Observation &a = made.frames[k], &b = simulated.frames[k];
    ASSERT_EQ(a.imu.size(), b.imu.size());
    for (std::size_t i = 0; i < a.imu.size(); ++i) {
      EXPECT_EQ(a.imu[i].gyro_radps, b.imu[i].gyro_radps);
      EXPECT_EQ(a.imu[i].accel_mps2, b.imu[i].accel_mps2);
    }
    ASSERT_EQ(a.odometry.size(), b.odometry.size());
    for (std::size_t i = 0; i < a.odometry.size(); ++i) {
      EXPECT_EQ(a.odometry[i].velocity_mps, b.odometry[i].velocity_mps);
    }
  }
}

TEST(KinematicsNoise, AnOwnImuIsTriedBeforeThePresets) {
  EXPECT_EQ(imus(config_with()).size(), scenario::imu_preset_names().size());
  const auto with_own = imus(config_with({"imu.gyroscope_noise_density=0.01"}));
  EXPECT_EQ(with_own.size(), scenario::imu_preset_names().size() + 1);
  EXPECT_EQ(with_own.front().name, "own");
}

/// Results depend on the seed, not on the thread: two runs give the same bits.
TEST(KinematicsNoise, ItsRowsAreTheSameInEveryRun) {
  const StudyConfig config = config_with({"imu.rate=50 Hz"}, {.noise_seeds = 2});
  Study once, again;
  add_imu_rows(config, once.imu, [](int) {});
  add_imu_rows(config, again.imu, [](int) {});
  for (const char* column : {"rms_px", "median_px", "max_px", "rotation_rms_px"}) {
    EXPECT_FALSE(once.imu.figures(column).empty());
    EXPECT_EQ(once.imu.figures(column), again.imu.figures(column)) << column;
  }
}

TEST(KinematicsParallel, DoesEveryPieceOnceAndTellsOfAll) {
  std::array<std::atomic<int>, 100> done{};
  int told = 0;
  process::for_each_parallel(
      100, [&](int i) { ++done[static_cast<std::size_t>(i)]; }, [&](int more) { told += more; });
  for (const auto& count : done) EXPECT_EQ(count, 1);
  EXPECT_EQ(told, 100);
}

TEST(KinematicsParallel, ExceptionOfAPieceOrTheListenerComesBack) {
  const auto nothing = [](int) {};
  EXPECT_THROW(process::for_each_parallel(
                   50,
                   [](int i) {
                     if (i == 17) throw std::runtime_error("17");
                   },
                   nothing),
               std::runtime_error);
  EXPECT_THROW(
      process::for_each_parallel(50, nothing, [](int) { throw std::logic_error("enough"); }),
      std::logic_error);
  process::for_each_parallel(0, nothing, nothing);  // nothing to do is no error
}

// ---- Bits of the configuration

TEST(KinematicsConfig, ARoverThatStandsIsGivenASpeedAndTheAnswerSaysSo) {
  const StudyConfig config = config_with({"ego.speed=0 m/s"});
  EXPECT_TRUE(config.stands);
  EXPECT_GT(config.speed_mps, 0.1);
  EXPECT_NE(subject(config).find("in place of standing"), std::string::npos);
}

/// In a camera that looks to the left, the rover's forward step points to the right.
TEST(KinematicsConfig, TheStepIsInTheAxesOfTheMountedCamera) {
  const StudyConfig left = config_with({"camera.rotation=[0 deg, 0 deg, 90 deg]"});
  EXPECT_TRUE(left.forward_C.isApprox(Vector3d(1, 0, 0), 1e-9));
  EXPECT_TRUE(config_with().forward_C.isApprox(Vector3d(0, 0, 1), 1e-9));
}

// ---- Distortion, shutter and clock that are left out

/// A drive that speeds up in a curve.
const std::vector<std::string> kHurried{"frames=20", "ego.speed=0.2 m/s",
                                        "ego.acceleration=0.5 m/s^2", "ego.yaw_rate=20 deg/s"};

/// The ways are so short (20 ms and 5 ms) that their second order is a few percent.
TEST(KinematicsLeftOut, ShutterAndClockErrAsTheMotionFieldSays) {
  const LeftOut left = left_out(config_with(kHurried));
  EXPECT_EQ(left.readout_s, kReadout_s);
  EXPECT_EQ(left.offset_s, kOffset_s);
  EXPECT_GT(left.readout_px, 1);
  EXPECT_GT(left.offset_px, 0.01);
  EXPECT_NEAR(left.readout_px, left.expected_readout_px, 0.05 * left.expected_readout_px);
  EXPECT_NEAR(left.offset_px, left.expected_offset_px, 0.05 * left.expected_offset_px);

  std::vector<std::string> sets = kHurried;
  sets.insert(sets.end(), {"camera.rolling_shutter=10 ms", "camera.told.time_offset_error=-5 ms"});
  const LeftOut other = left_out(config_with(sets));
  EXPECT_NEAR(other.readout_px, left.readout_px / 2, 0.05 * left.readout_px) << "half the readout";
  EXPECT_NEAR(other.offset_px, left.offset_px, 0.02 * left.offset_px) << "an earlier clock";
}

/// The error is linear in small coefficients.
TEST(KinematicsLeftOut, DistortionErrsInProportionToItself) {
  const auto error_px = [](const char* coefficients) {
    std::vector<std::string> sets = kHurried;
    sets.push_back(std::string("camera.distortion=") + coefficients);
    return left_out(config_with(sets)).distortion_px;
  };
  EXPECT_EQ(left_out(config_with(kHurried)).distortion_px, 0);
  const double whole_px = error_px("[-0.02, 0.002, 0, 0, 0]");
  EXPECT_GT(whole_px, 0.1);
  EXPECT_NEAR(error_px("[-0.01, 0.001, 0, 0, 0]"), whole_px / 2, 0.05 * whole_px);
}

}  // namespace
}  // namespace lcs::kinematics
