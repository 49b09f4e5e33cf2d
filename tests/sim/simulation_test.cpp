// Whole runs through the public interface.

#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "sim/drive.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using Eigen::Vector3d;
using scenario::Shape;
using test::floor_with;
using test::line_actor;
using test::scenario_in;
using test::scenario_in_mjcf;

/// FNV-1a over all outputs of a run.
class Fingerprint {
 public:
  void add(const void* data, std::size_t size) {
    const auto* byte = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) hash_ = (hash_ ^ byte[i]) * 0x100000001b3u;
  }
  void add(const cv::Mat& m) {
    for (int y = 0; y < m.rows; ++y) add(m.ptr(y), static_cast<std::size_t>(m.cols) * m.elemSize());
  }
  void add(const Pose& T) {
    add(T.R.data(), sizeof T.R);
    add(T.p.data(), sizeof T.p);
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

struct Fingerprints {
  std::uint64_t images, readings, truth;
};

Fingerprints run(const scenario::Scenario& s) {
  Fingerprint images, readings, truth;
  Simulation simulation(s);
  while (const auto o = simulation.next()) {
    images.add(o->image);
    for (const ImuSample& r : o->imu) {
      readings.add(&r.t_ns, sizeof r.t_ns);
      readings.add(r.gyro_radps.data(), sizeof r.gyro_radps);
      readings.add(r.accel_mps2.data(), sizeof r.accel_mps2);
    }
    for (const OdometrySample& r : o->odometry) {
      readings.add(r.velocity_mps.data(), sizeof r.velocity_mps);
    }
    truth.add(o->truth.depth_m);
    truth.add(o->truth.object);
    for (const Snapshot* at : {&o->truth.now, &o->truth.next}) {
      truth.add(at->T_WC);
      for (const Pose& T : at->T_WO) truth.add(T);
    }
    for (const ObjectTruth& b : o->objects) truth.add(&b.visible_fraction, sizeof(double));
  }
  return {images.value(), readings.value(), truth.value()};
}

scenario::Scenario busy(scenario::Drive drive) {
  auto s = scenario_in("lab", 0.5, 8);
  s.ego.drive = drive;
  s.ego.phases[0].yaw_rate_radps = 0.1;
  s.imu.noise = {1.7e-4, 1.9e-5, 2.0e-3, 3.0e-3};
  s.odometry.enabled = true;
  s.actors = {line_actor("box", Shape::box, {0, -1}, 1.5, 0.5),
              line_actor("walker", Shape::pedestrian, {1, 1}, -1.5, 0.7)};
  return s;
}

TEST(Simulation, TwoRunsOfOneScenarioGiveTheSameBits) {
  for (const auto drive : {scenario::Drive::holonomic, scenario::Drive::wheeled}) {
    const Fingerprints a = run(busy(drive));
    const Fingerprints b = run(busy(drive));
    EXPECT_EQ(a.images, b.images);
    EXPECT_EQ(a.readings, b.readings);
    EXPECT_EQ(a.truth, b.truth);
  }
}

/// A run without camera has all outputs that need none.
TEST(Simulation, ADriveWithoutPicturesHasTheSameMotionsAndReadings) {
  for (const auto drives : {scenario::Drive::holonomic, scenario::Drive::wheeled}) {
    const scenario::Scenario s = busy(drives);
    const Drive blind = drive(s);
    Simulation simulation(s);
    EXPECT_EQ(blind.calibration.T_BC.R, simulation.calibration().T_BC.R);
    EXPECT_EQ(blind.calibration.T_BS.p, simulation.calibration().T_BS.p);
    EXPECT_EQ(blind.calibration.T_WB_start.p, simulation.calibration().T_WB_start.p);
    EXPECT_EQ(blind.calibration.v_WB_start_mps, simulation.calibration().v_WB_start_mps);
    EXPECT_EQ(blind.calibration.camera.focal_px, simulation.calibration().camera.focal_px);
    std::size_t k = 0;
    while (const auto seen = simulation.next()) {
      const Observation& frame = blind.frames.at(k++);
      EXPECT_EQ(frame.index, seen->index);
      EXPECT_EQ(frame.t_ns, seen->t_ns);
      ASSERT_EQ(frame.imu.size(), seen->imu.size());
      for (std::size_t i = 0; i < frame.imu.size(); ++i) {
        EXPECT_EQ(frame.imu[i].t_ns, seen->imu[i].t_ns);
        EXPECT_EQ(frame.imu[i].gyro_radps, seen->imu[i].gyro_radps);
        EXPECT_EQ(frame.imu[i].accel_mps2, seen->imu[i].accel_mps2);
      }
      ASSERT_EQ(frame.odometry.size(), seen->odometry.size());
      for (std::size_t i = 0; i < frame.odometry.size(); ++i) {
        EXPECT_EQ(frame.odometry[i].velocity_mps, seen->odometry[i].velocity_mps);
      }
      EXPECT_EQ(frame.truth.v_WC_mps, seen->truth.v_WC_mps);
      EXPECT_EQ(frame.truth.w_C_radps, seen->truth.w_C_radps);
      for (const auto& [a, b] : {std::pair(&frame.truth.now, &seen->truth.now),
                                 std::pair(&frame.truth.next, &seen->truth.next)}) {
        EXPECT_EQ(a->T_WC.R, b->T_WC.R);
        EXPECT_EQ(a->T_WC.p, b->T_WC.p);
        ASSERT_EQ(a->T_WO.size(), b->T_WO.size());
        for (std::size_t i = 0; i < a->T_WO.size(); ++i) EXPECT_EQ(a->T_WO[i].p, b->T_WO[i].p);
      }
    }
    EXPECT_EQ(k, blind.frames.size());
  }
}

TEST(Simulation, AnotherSeedPaintsAndShakesOtherwiseButMovesAlike) {
  auto s = busy(scenario::Drive::holonomic);
  const Fingerprints a = run(s);
  s.seed = 2;
  const Fingerprints b = run(s);
  EXPECT_NE(a.images, b.images);
  EXPECT_NE(a.readings, b.readings);
  EXPECT_EQ(a.truth, b.truth);
}

TEST(Simulation, InAGapOfTheImuReadingsAreMissingAndNoOthersChange) {
  auto s = busy(scenario::Drive::holonomic);
  Simulation whole(s);
  s.imu.gaps = {{0.2, 0.35}};
  Simulation gapped(s);
  std::vector<ImuSample> all, some;
  while (const auto o = whole.next()) {
    all.insert(all.end(), o->imu.begin(), o->imu.end());
    const auto other = gapped.next();
    some.insert(some.end(), other->imu.begin(), other->imu.end());
    EXPECT_EQ(o->odometry.size(), other->odometry.size());
  }
  EXPECT_EQ(some.size() + 30, all.size());  // 0.15 s at 200 Hz
  auto next = some.begin();
  for (const ImuSample& reading : all) {
    if (reading.t_ns >= 200'000'000 && reading.t_ns < 350'000'000) continue;
    ASSERT_NE(next, some.end());
    EXPECT_EQ(next->t_ns, reading.t_ns);
    EXPECT_EQ(next->gyro_radps, reading.gyro_radps);
    EXPECT_EQ(next->accel_mps2, reading.accel_mps2);
    ++next;
  }
}

TEST(Simulation, GivesAsManyFramesAsAskedAtTheirTimes) {
  auto s = scenario_in_mjcf(floor_with(""), 0.5, 5);
  s.camera.rate_hz = 30;
  Simulation simulation(s);
  for (int k = 0; k < 5; ++k) {
    const auto o = simulation.next();
    ASSERT_TRUE(o);
    EXPECT_EQ(o->index, k);
    EXPECT_EQ(o->t_ns, std::llround(k * 1e9 / 30));
    EXPECT_EQ(o->image.size(), cv::Size(640, 480));
  }
  EXPECT_FALSE(simulation.next());
  EXPECT_FALSE(simulation.next());
}

TEST(Simulation, EveryReadingComesOnceBetweenItsFrames) {
  auto s = scenario_in_mjcf(floor_with(""), 0.5, 9);
  s.camera.rate_hz = 30;
  s.odometry = {.enabled = true, .rate_hz = 50, .noise_mps = 0, .scale_error = 0};
  Simulation simulation(s);
  std::int64_t last_ns = -1;
  std::int64_t imu = 0;
  std::int64_t odometry = 0;
  while (const auto o = simulation.next()) {
    if (o->index == 0) {
      ASSERT_EQ(o->imu.size(), 1u);
      ASSERT_EQ(o->odometry.size(), 1u);
    }
    for (const ImuSample& r : o->imu) {
      EXPECT_EQ(r.t_ns, imu++ * 5'000'000);
      EXPECT_GT(r.t_ns, last_ns);
      EXPECT_LE(r.t_ns, o->t_ns);
    }
    for (const OdometrySample& r : o->odometry) {
      EXPECT_EQ(r.t_ns, odometry++ * 20'000'000);
      EXPECT_GT(r.t_ns, last_ns);
      EXPECT_LE(r.t_ns, o->t_ns);
    }
    last_ns = o->t_ns;
  }
  // 8 / 30 s = 266.7 ms
  EXPECT_EQ(imu, 54);
  EXPECT_EQ(odometry, 14);
}

TEST(Simulation, HasNoOdometryUnlessAsked) {
  Simulation simulation(scenario_in_mjcf(floor_with(""), 0.5, 3));
  while (const auto o = simulation.next()) EXPECT_TRUE(o->odometry.empty());
}

TEST(Simulation, NextPosesAreThoseOfTheNextFrameAlsoAfterTheLast) {
  auto s = scenario_in("lab", 0.5, 3);
  s.actors = {line_actor("box", Shape::box, {1, -1}, 1.5, 0.5)};
  Simulation simulation(s);
  std::optional<Snapshot> expected;
  Observation last;
  while (auto o = simulation.next()) {
    if (expected) {
      EXPECT_EQ(o->truth.now.T_WC.p, expected->T_WC.p);
      EXPECT_EQ(o->truth.now.T_WO.back().p, expected->T_WO.back().p);
    }
    expected = o->truth.next;
    last = std::move(*o);
  }
  EXPECT_NEAR((last.truth.next.T_WC.p - last.truth.now.T_WC.p).norm(), 0.05, 1e-6);
  EXPECT_NEAR((last.truth.next.T_WO.back().p - last.truth.now.T_WO.back().p).norm(), 0.05, 1e-9);
  EXPECT_EQ(last.truth.now.T_WO.size(), simulation.objects().size() + 1);
  EXPECT_EQ(last.truth.now.T_WO[0].p, Vector3d(0, 0, 0));
}

TEST(Simulation, CalibrationIsTheMountingOfTheScenario) {
  auto s = scenario_in_mjcf(floor_with(""), 0.4, 1);
  s.ego.start_m = {2, 3};
  s.ego.heading_rad = 0.5;
  s.camera.mount_position_m = {0.3, -0.1, 0.6};
  s.camera.mount_rpy_rad = {0, 0.2, 0};  // pitch about y (left): the nose goes down
  Simulation simulation(s);
  const Calibration& c = simulation.calibration();
  EXPECT_NEAR((c.T_BC.p - Vector3d(0.3, -0.1, 0.6)).norm(), 0, 1e-9);
  const Vector3d axis = c.T_BC.R * Vector3d::UnitZ();
  EXPECT_NEAR((axis - Vector3d(std::cos(0.2), 0, -std::sin(0.2))).norm(), 0, 1e-9);
  EXPECT_NEAR((c.T_BC.R * Vector3d::UnitX() - Vector3d(0, -1, 0)).norm(), 0, 1e-9) << "x right";
  EXPECT_NEAR(c.T_BC.R.determinant(), 1, 1e-9);
  EXPECT_NEAR((c.T_WB_start.p - Vector3d(2, 3, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((c.v_WB_start_mps - 0.4 * Vector3d(std::cos(0.5), std::sin(0.5), 0)).norm(), 0, 1e-9);
  EXPECT_EQ(c.gravity_mps2, 9.81);
  EXPECT_TRUE(c.on_ground);
  const Observation o = simulation.next().value();
  EXPECT_NEAR((o.truth.now.T_WC.p - (c.T_WB_start * c.T_BC).p).norm(), 0, 1e-12);
  EXPECT_NEAR((o.truth.now.T_WC.R - (c.T_WB_start * c.T_BC).R).norm(), 0, 1e-12);
}

TEST(Simulation, MountErrorChangesTheCalibrationAndNotThePicture) {
  auto s = scenario_in_mjcf(floor_with("<geom type='box' pos='3 0 .5' size='.2 .2 .5'/>"), 0.4, 1);
  Simulation exact(s);
  s.camera.told = {.height_error_m = 0.05, .pitch_error_rad = 0.02};
  Simulation wrong(s);
  const Pose& told = wrong.calibration().T_BC;
  EXPECT_NEAR((told.p - exact.calibration().T_BC.p - Vector3d(0, 0, 0.05)).norm(), 0, 1e-12);
  const Vector3d axis = told.R * Vector3d::UnitZ();
  EXPECT_NEAR((axis - Vector3d(std::cos(0.02), 0, -std::sin(0.02))).norm(), 0, 1e-12);
  const Observation a = exact.next().value(), b = wrong.next().value();
  EXPECT_EQ(cv::norm(a.image, b.image, cv::NORM_INF), 0);
  EXPECT_EQ(a.truth.now.T_WC.p, b.truth.now.T_WC.p);
}

// The camera's velocity and rate against differences of its poses over 5 ms.
TEST(Simulation, VelocityAndRateOfTheCameraAreThoseOfItsPoses) {
  auto s = scenario_in_mjcf(floor_with(""), 0.5, 6);
  s.ego.phases[0].yaw_rate_radps = 0.6;
  s.camera.mount_position_m = {0.4, 0.3, 0.5};
  s.camera.mount_rpy_rad = {0.1, -0.2, 0.7};
  s.camera.rate_hz = 200;
  s.camera.width_px = 32;
  s.camera.height_px = 32;
  Simulation simulation(s);
  while (const auto o = simulation.next()) {
    const Pose& a = o->truth.now.T_WC;
    const Pose& b = o->truth.next.T_WC;
    const Vector3d v = (b.p - a.p) / 0.005;
    const Eigen::AngleAxisd turn(a.R.transpose() * b.R);
    // half a step of v w = 0.3 m/s^2, and the base's first milliseconds
    EXPECT_NEAR((v - o->truth.v_WC_mps).norm(), 0, 3e-3);
    EXPECT_NEAR((turn.axis() * turn.angle() / 0.005 - o->truth.w_C_radps).norm(), 0, 1e-3);
  }
}

TEST(ObjectTruth, HasTheModalBoxOfItsPixels) {
  Simulation simulation(scenario_in("lab", 0, 1));
  const Observation o = simulation.next().value();
  ASSERT_GT(o.objects.size(), 10u);
  int last_id = 0;
  for (const ObjectTruth& object : o.objects) {
    EXPECT_GT(object.object, last_id) << "by id";
    last_id = object.object;
    cv::Mat1b mask;
    cv::compare(o.truth.object, object.object, mask, cv::CMP_EQ);
    EXPECT_EQ(object.visible_px, cv::countNonZero(mask));
    EXPECT_GT(object.visible_px, 0);
    const cv::Rect box(object.left, object.top, object.right - object.left,
                       object.bottom - object.top);
    EXPECT_EQ(cv::countNonZero(mask(box)), object.visible_px) << "all inside";
    for (const cv::Mat1b& side :
         {cv::Mat1b(mask(box).row(0)), cv::Mat1b(mask(box).row(box.height - 1))}) {
      EXPECT_GT(cv::countNonZero(side), 0) << "and touching the borders";
    }
    EXPECT_FALSE(object.moving);
  }
}

// For an actor alone and fully in view, the computed silhouette must equal the rendered one.
TEST(ObjectTruth, AnUnoccludedShapeIsWhollyVisible) {
  for (const Shape shape : {Shape::box, Shape::cylinder, Shape::pedestrian, Shape::car}) {
    auto s = scenario_in_mjcf(floor_with(""), 0, 1);
    s.actors = {line_actor("a", shape, {7, 0.4}, 0.7, 0.3)};
    const Observation o = Simulation(s).next().value();
    ASSERT_EQ(o.objects.size(), 1u);
    EXPECT_GT(o.objects[0].visible_fraction, 0.985);
    EXPECT_TRUE(o.objects[0].moving);
  }
}

TEST(ObjectTruth, HalfHiddenIsHalfVisible) {
  // a screen before the left half of a board; both flat and at nearly the same depth
  const auto s = scenario_in_mjcf(
      floor_with("<body name='board' pos='5 0 1'><geom type='box' size='.01 .6 .4'/></body>"
                 "<geom type='box' pos='4.9 1 1' size='.01 1 1'/>"),
      0, 1);
  const Observation o = Simulation(s).next().value();
  ASSERT_EQ(o.objects.size(), 1u);
  EXPECT_NEAR(o.objects[0].visible_fraction, 0.5, 0.02);
}

TEST(ObjectTruth, HalfOutsideOfTheImageIsHalfVisible) {
  // the image border is at 320 / f = 0.770 of the depth; the board crosses it
  const double border = 4.79 * (320 / 415.692);
  const auto s = scenario_in_mjcf(floor_with("<body name='board' pos='5 " + std::to_string(border) +
                                             " 1'><geom type='box' size='.01 .6 .4'/></body>"),
                                  0, 1);
  const Observation o = Simulation(s).next().value();
  ASSERT_EQ(o.objects.size(), 1u);
  EXPECT_NEAR(o.objects[0].visible_fraction, 0.5, 0.02);
}

TEST(Simulation, AnActorWaitsForItsTrigger) {
  auto s = scenario_in("lab", 0.5, 12);
  s.actors = {line_actor("box", Shape::box, {-1.5, 0}, 1.5708, 0.5)};
  s.actors[0].start.ego_within_m = 2.25;  // from 2.5 m away, reached after 0.5 s
  Simulation simulation(s);
  while (const auto o = simulation.next()) {
    const bool moving = moved(o->truth.now.T_WO.back(), o->truth.next.T_WO.back());
    EXPECT_EQ(moving, o->index >= 5) << "frame " << o->index;
  }
}

TEST(Simulation, WheelsShakeTheCameraOnRoughGroundAndNotOnFlat) {
  std::string bumps;
  for (int i = 0; i < 30; ++i) {
    bumps += "<geom type='cylinder' pos='" + std::to_string(0.35 + 0.23 * i) +
             " 0 0' size='.012 1' zaxis='0 1 0'/>";
  }
  const auto vertical_spread = [](const std::string& ground) {
    auto s = scenario_in_mjcf(ground, 0.5, 20);
    s.ego.drive = scenario::Drive::wheeled;
    s.camera.width_px = s.camera.height_px = 32;
    Simulation simulation(s);
    double low = 1e9;
    double high = -1e9;
    while (const auto o = simulation.next()) {
      low = std::min(low, o->truth.now.T_WC.p.z());
      high = std::max(high, o->truth.now.T_WC.p.z());
    }
    return high - low;
  };
  EXPECT_LT(vertical_spread(floor_with("")), 0.001);
  EXPECT_GT(vertical_spread(floor_with(bumps)), 0.003);
}

TEST(Versions, NameTheLibraryAndTheRenderer) {
  const Versions v = versions();
  EXPECT_FALSE(v.mujoco.empty());
  EXPECT_TRUE(std::isdigit(static_cast<unsigned char>(v.mujoco[0]))) << v.mujoco;
  EXPECT_NE(v.gl_renderer.find("Mesa"), std::string::npos) << v.gl_renderer;
}

TEST(Simulation, FramesAfterOnesThatWereSkippedAreAsTheyWouldHaveBeen) {
  scenario::Scenario s = scenario_in("lab", 0.5, 5);
  s.imu.noise.gyroscope_noise_density = 1e-3;
  s.actors = {line_actor("crosser", Shape::box, {0, -1}, 1.5, 0.5)};
  Simulation whole(s), skipping(s);
  for (int k = 0; k < 4; ++k) {
    whole.next();
    skipping.skip();
  }
  const auto a = whole.next(), b = skipping.next();
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->index, b->index);
  EXPECT_EQ(cv::norm(a->image, b->image, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(a->truth.depth_m, b->truth.depth_m, cv::NORM_INF), 0);
  ASSERT_EQ(a->imu.size(), b->imu.size());
  EXPECT_EQ(a->imu.back().gyro_radps, b->imu.back().gyro_radps);
  EXPECT_EQ(a->truth.next.T_WO.back().p, b->truth.next.T_WO.back().p);
  EXPECT_FALSE(skipping.next()) << "it was the last one";
}

TEST(Simulation, TellsTheTruthOfTheImuAtEachOfItsReadings) {
  scenario::Scenario s = scenario_in("lab", 0.5, 3);
  s.imu.noise.gyroscope_turn_on_bias_radps = 0.1;
  s.imu.gaps = {{0.05, 0.08}};
  Simulation simulation(s);
  simulation.next();
  const auto o = simulation.next();
  ASSERT_TRUE(o);
  ASSERT_EQ(o->imu_truth.size(), 20u) << "of 200 Hz in 0.1 s, the gap included";
  EXPECT_EQ(o->imu.size(), 14u);
  EXPECT_EQ(o->imu_truth.back().t_ns, o->t_ns);
  // The IMU is mounted on the same body as the camera.
  const Pose T_WB = o->truth.now.T_WC * simulation.calibration().T_BC.inverse();
  const Pose T_WS = T_WB * simulation.calibration().T_BS;
  EXPECT_LT((T_WS.p - o->imu_truth.back().T_WS.p).norm(), 1e-12);
  EXPECT_LT((T_WS.R - o->imu_truth.back().T_WS.R).norm(), 1e-12);
  EXPECT_NEAR(o->imu_truth.back().v_WS_mps.x(), 0.5, 1e-3);
  // Without white noise and random walk a gyro at rest reads its bias.
  EXPECT_LT((o->imu.back().gyro_radps - o->imu_truth.back().gyro_bias_radps).norm(), 1e-3);
  EXPECT_GT(o->imu_truth.back().gyro_bias_radps.norm(), 1e-2);
}

}  // namespace
}  // namespace lcs::sim
