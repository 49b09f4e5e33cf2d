/// An IMU, wheels and clocks with faults: nothing throws, each fault is named and counted, all
/// results stay finite, and wheels restore the motion within a stated number of
/// frames.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "filter/ego_motion/estimator.h"
#include "filter/ego_motion/intake.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::Random;
using testing::rotation;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kGravity_mps2 = 9.81;
constexpr std::int64_t kImuStep_ns = 5'000'000, kFrameStep_ns = 100'000'000;
constexpr int kReadingsAFrame = kFrameStep_ns / kImuStep_ns;
/// Frames of the drive; those from kFirstBad to kLastBad have the fault.
constexpr int kFrames = 60, kFirstBad = 21, kLastBad = 25;

/// Maximum number of frames after the last bad one until the motion is correct again.
constexpr int kRecovered = 3;

/// A rover on a circle, with the noise that the estimator expects.
constexpr double kSpeed_mps = 0.5, kYawRate_radps = 0.3;

struct Sample {
  std::int64_t t_ns = 0;
  Vector3d gyro_radps = Vector3d::Zero(), accel_mps2 = Vector3d::Zero();
};

struct Speed {
  std::int64_t t_ns = 0;
  Vector3d v_B_mps = Vector3d::Zero();
};

/// The readings between two frames, and the time of the second frame.
struct Interval {
  int frame;
  std::int64_t t_ns;
  std::vector<Sample> imu;
  std::vector<Speed> wheels;
};

Interval interval(int frame, Random& random) {
  Interval made{frame, frame * kFrameStep_ns, {}, {}};
  const auto noise = [&](double deviation) -> Vector3d {
    return deviation * (random.vector(1.7320508));  // uniform, with this standard deviation
  };
  for (int i = frame == 0 ? 0 : (frame - 1) * kReadingsAFrame + 1; i <= frame * kReadingsAFrame;
       ++i) {
    const EgoMotionNoise expected;
    const double root_rate = std::sqrt(1e9 / static_cast<double>(kImuStep_ns));
    made.imu.push_back({i * kImuStep_ns,
                        Vector3d(0, 0, kYawRate_radps) + noise(expected.gyro_density * root_rate),
                        Vector3d(0, kSpeed_mps * kYawRate_radps, kGravity_mps2) +
                            noise(expected.accel_density * root_rate)});
    if (i % 4 == 0) {
      made.wheels.push_back({i * kImuStep_ns, Vector3d(kSpeed_mps, 0, 0) + noise(0.01)});
    }
  }
  return made;
}

/// A camera at the rover's origin that looks ahead.
Mounting mounting() {
  Mounting m;
  m.R_BC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return m;
}

struct Outcome {
  /// One entry per frame.
  std::vector<double> velocity_error_mps, rotation_error_rad, unseen_turn_rad;
  Diagnostics diagnostics;

  /// Frames after the last bad one until both errors stay small for good.
  int recovered_after() const {
    int last_wrong = kLastBad;
    for (int k = kLastBad + 1; k < kFrames; ++k) {
      if (velocity_error_mps[k] > 0.03 || rotation_error_rad[k] > 2e-3) last_wrong = k;
    }
    return last_wrong - kLastBad;
  }
};

/// A drive in which `spoil` changes each of the bad intervals.
Outcome drive(const std::function<void(Interval&)>& spoil, bool in_all = false) {
  EgoMotionEstimator estimator(mounting(), {},
                               {.t_ns = 0,
                                .R_WB = Matrix3d::Identity(),
                                .v_WB_mps = {kSpeed_mps, 0, 0},
                                .gravity_mps2 = kGravity_mps2});
  Random random(3);
  Outcome outcome;
  for (int k = 0; k < kFrames; ++k) {
    Interval now = interval(k, random);
    if (in_all || (k >= kFirstBad && k <= kLastBad)) spoil(now);
    // At equal times the IMU reading comes first.
    std::size_t wheel = 0;
    for (const Sample& sample : now.imu) {
      for (; wheel < now.wheels.size() && now.wheels[wheel].t_ns < sample.t_ns; ++wheel) {
        estimator.add_odometry(now.wheels[wheel].t_ns, now.wheels[wheel].v_B_mps);
      }
      estimator.add_imu(sample.t_ns, sample.gyro_radps, sample.accel_mps2);
    }
    for (; wheel < now.wheels.size(); ++wheel) {
      estimator.add_odometry(now.wheels[wheel].t_ns, now.wheels[wheel].v_B_mps);
    }
    const EgoMotion motion = estimator.frame(now.t_ns);
    EXPECT_TRUE(motion.v_C_mps.allFinite() && motion.w_C_radps.allFinite() &&
                std::isfinite(motion.dt_s) && is_rotation(motion.R_cur_prev))
        << "frame " << k;
    EXPECT_TRUE(estimator.v_WS_mps().allFinite() && is_rotation(estimator.R_WS())) << "frame " << k;
    const Vector3d turned = motion.w_C_radps - Vector3d(0, -kYawRate_radps, 0);
    outcome.velocity_error_mps.push_back((motion.v_C_mps - Vector3d(0, 0, kSpeed_mps)).norm() *
                                         (motion.dt_s > 0));
    outcome.rotation_error_rad.push_back(turned.norm() * motion.dt_s);
    outcome.unseen_turn_rad.push_back(motion.unseen_turn_rad);
  }
  outcome.diagnostics = estimator.diagnostics();
  return outcome;
}

constexpr int kBadReadings = (kLastBad - kFirstBad + 1) * kReadingsAFrame;

/// Spoils each reading of the IMU.
std::function<void(Interval&)> each(const std::function<void(Sample&)>& spoil) {
  return [spoil](Interval& now) {
    for (Sample& sample : now.imu) spoil(sample);
  };
}

TEST(ImuFaults, AGoodImuHasNone) {
  const Outcome outcome = drive([](Interval&) {});
  EXPECT_EQ(outcome.diagnostics.lines(), std::vector<std::string>{});
  EXPECT_EQ(outcome.recovered_after(), 0);
  EXPECT_EQ(outcome.unseen_turn_rad, std::vector<double>(kFrames, 0.0));
}

TEST(ImuFaults, ReadingsThatAreNoNumbersAreLeftOutAndTheGapIsNamed) {
  for (const double value : {kNan, kInf, -kInf}) {
    const Outcome outcome = drive(each([&](Sample& s) { s.accel_mps2.y() = value; }));
    EXPECT_EQ(outcome.diagnostics.count(Fault::imu_not_finite), kBadReadings);
    EXPECT_EQ(outcome.diagnostics.count(Fault::imu_gap), 1);
    EXPECT_EQ(outcome.diagnostics.total(), kBadReadings + 1);
    EXPECT_LE(outcome.recovered_after(), kRecovered);
  }
}

TEST(ImuFaults, ReadingsBeyondAnySensorAreLeftOut) {
  for (const double value : {1e300, -1e9, 2500.0}) {
    const Outcome outcome = drive(each([&](Sample& s) { s.gyro_radps.z() = value; }));
    EXPECT_EQ(outcome.diagnostics.count(Fault::imu_too_large), kBadReadings);
    EXPECT_LE(outcome.recovered_after(), kRecovered);
  }
}

TEST(ImuFaults, AFrozenImuIsTakenForASilentOne) {
  std::optional<Sample> first;
  const Outcome outcome = drive(each([&](Sample& s) {
    if (!first) first = s;
    s.gyro_radps = first->gyro_radps;
    s.accel_mps2 = first->accel_mps2;
  }));
  EXPECT_EQ(outcome.diagnostics.count(Fault::imu_frozen), kBadReadings - 10);
  EXPECT_EQ(outcome.diagnostics.total(), kBadReadings - 10);
  EXPECT_LE(outcome.recovered_after(), kRecovered);
  for (int k = kFirstBad + 1; k <= kLastBad; ++k) EXPECT_GT(outcome.unseen_turn_rad[k], 0) << k;
}

TEST(ImuFaults, ASaturatedAccelerometerIsNamedAndWheelsAreBelieved) {
  // A blow of 0.5 s beyond the sensor's range of 2 g: it reads 19.6 m/s^2 forwards throughout.
  const Outcome outcome =
      drive(each([&](Sample& s) { s.accel_mps2.x() = std::min(19.6, s.accel_mps2.x() + 30); }));
  EXPECT_EQ(outcome.diagnostics.count(Fault::imu_saturated), kBadReadings - 4);
  EXPECT_EQ(outcome.diagnostics.total(), kBadReadings - 4);
  EXPECT_LE(outcome.recovered_after(), kRecovered);
}

TEST(ImuFaults, ASaturatedGyroIsNamed) {
  const Outcome outcome = drive(each([&](Sample& s) { s.gyro_radps.z() = 2.18; }));  // 125 deg/s
  EXPECT_EQ(outcome.diagnostics.count(Fault::imu_saturated), kBadReadings - 4);
  EXPECT_LE(outcome.recovered_after(), kRecovered);
}

TEST(ImuFaults, GapsAreCountedAndBridged) {
  const Outcome outcome = drive([](Interval& now) { now.imu.clear(); });
  EXPECT_EQ(outcome.diagnostics.count(Fault::imu_gap), 1);
  EXPECT_EQ(outcome.diagnostics.total(), 1);
  EXPECT_LE(outcome.recovered_after(), kRecovered);
  // 0.1 rad/s/sqrt(Hz) over 80 ms, because silence is detected after 20 ms; over 100 ms; and over
  // the 5 ms before the next reading.
  for (int k = 0; k < kFrames; ++k) {
    const double unheard_s = k == kFirstBad                   ? 0.08
                             : k > kFirstBad && k <= kLastBad ? 0.1
                             : k == kLastBad + 1              ? 0.005
                                                              : 0;
    EXPECT_NEAR(outcome.unseen_turn_rad[k], 0.1 * std::sqrt(unheard_s), 1e-9) << k;
  }
}

TEST(ImuFaults, AGapThatIsOpenAtTheEndIsCountedLikewise) {
  EgoMotionEstimator estimator(mounting(), {}, {.v_WB_mps = {kSpeed_mps, 0, 0}});
  for (int i = 0; i <= kReadingsAFrame; ++i) {
    estimator.add_imu(i * kImuStep_ns, {1e-3 * i, 0, 0}, {0, 0, kGravity_mps2});
  }
  for (int k = 1; k <= 5; ++k) {
    EXPECT_EQ(estimator.diagnostics().count(Fault::imu_gap), k > 2 ? 1 : 0) << k;
    estimator.frame(k * kFrameStep_ns);
  }
  EXPECT_EQ(estimator.diagnostics().total(), 1);
}

TEST(ImuFaults, UnseenTurnBeforeTheClockWasSetIsNotToldAfterIt) {
  EgoMotionEstimator estimator(mounting(), {}, {.v_WB_mps = {kSpeed_mps, 0, 0}});
  const auto hear = [&](std::int64_t from_ns) {
    for (int i = 0; i <= kReadingsAFrame; ++i) {
      estimator.add_imu(from_ns + i * kImuStep_ns, {1e-3 * i, 0, 0}, {0, 0, kGravity_mps2});
    }
  };
  hear(0);
  estimator.frame(kFrameStep_ns);
  estimator.add_odometry(3 * kFrameStep_ns, {kSpeed_mps, 0, 0});  // the IMU is silent meanwhile
  constexpr std::int64_t kOtherClock_ns = 1'000'000'000'000;
  estimator.frame(kOtherClock_ns);
  estimator.frame(kOtherClock_ns + kFrameStep_ns);
  ASSERT_EQ(estimator.diagnostics().count(Fault::clock_set), 1);
  hear(kOtherClock_ns + kFrameStep_ns);
  EXPECT_EQ(estimator.frame(kOtherClock_ns + 2 * kFrameStep_ns).unseen_turn_rad, 0);
}

TEST(ImuFaults, ReadingsOutOfOrderAreLeftOut) {
  const Outcome outcome = drive([](Interval& now) {
    for (std::size_t i = 0; i + 1 < now.imu.size(); i += 2) std::swap(now.imu[i], now.imu[i + 1]);
  });
  EXPECT_EQ(outcome.diagnostics.count(Fault::imu_out_of_order), kBadReadings / 2);
  EXPECT_LE(outcome.recovered_after(), kRecovered);
}

TEST(ImuFaults, ReadingsThatComeTwiceDoNoHarm) {
  const Outcome outcome = drive([](Interval& now) {
    const auto once = now.imu;
    now.imu.clear();
    for (const Sample& sample : once) now.imu.insert(now.imu.end(), {sample, sample});
  });
  EXPECT_EQ(outcome.diagnostics.total(), 0);
  EXPECT_EQ(outcome.recovered_after(), 0);
}

TEST(ImuFaults, AnAccelerometerInGIsRecognisedByGravityAndTakenTimesIt) {
  for (const bool in_all : {false, true}) {
    const Outcome outcome = drive(each([&](Sample& s) { s.accel_mps2 /= kGravity_mps2; }), in_all);
    const int bad = in_all ? (kFrames - 1) * kReadingsAFrame + 1 : kBadReadings;
    EXPECT_EQ(outcome.diagnostics.count(Fault::imu_in_g), bad);
    EXPECT_EQ(outcome.diagnostics.total(), bad);
    EXPECT_LE(outcome.recovered_after(), in_all ? 0 : kRecovered);
  }
}

TEST(ImuFaults, OnTheMoonReadingsOfItsGravityAreNotTakenForG) {
  // Where gravity is 1.62 m/s^2, a magnitude near 1 does not indicate the unit g.
  EgoMotionEstimator estimator(mounting(), {}, {.gravity_mps2 = 1.62});
  for (int i = 0; i < 100; ++i) {
    estimator.add_imu(i * kImuStep_ns, {0, 0, 1e-6 * i}, {0, 0, 1.3});
  }
  EXPECT_EQ(estimator.diagnostics().total(), 0);
}

TEST(ImuFaults, OneReadingFromTheFarFutureIsLeftOut) {
  const std::int64_t latest = std::numeric_limits<std::int64_t>::max();
  const Outcome outcome = drive([&](Interval& now) { now.imu.back().t_ns = latest; });
  EXPECT_EQ(outcome.diagnostics.count(Fault::imu_jump), kLastBad - kFirstBad + 1);
  EXPECT_EQ(outcome.diagnostics.total(), kLastBad - kFirstBad + 1);
  EXPECT_EQ(outcome.recovered_after(), 0);
}

TEST(ImuFaults, ReadingsAtNearlyOneTimeDoNotMakeTheRestSilence) {
  // Times of a bus that delivers in pairs. One wrong interval must not become the period.
  const Outcome outcome = drive([](Interval& now) { now.imu[5].t_ns = now.imu[4].t_ns + 1; });
  EXPECT_EQ(outcome.diagnostics.total(), 0);
  EXPECT_LE(outcome.recovered_after(), kRecovered);
}

TEST(ImuFaults, WheelsThatMeasureNothingAreLeftOut) {
  for (const double value : {kNan, kInf, 1e300, -2000.0}) {
    const Outcome outcome = drive([&](Interval& now) {
      for (Speed& speed : now.wheels) speed.v_B_mps.x() = value;
    });
    EXPECT_EQ(outcome.diagnostics.count(Fault::odometry_unusable), kBadReadings / 4);
    EXPECT_EQ(outcome.diagnostics.total(), kBadReadings / 4);
    EXPECT_LE(outcome.recovered_after(), kRecovered);
  }
}

/// Shifts all times of an interval, as a wrong clock does.
void shift(Interval& now, std::int64_t by_ns) {
  now.t_ns += by_ns;
  for (Sample& sample : now.imu) sample.t_ns += by_ns;
  for (Speed& speed : now.wheels) speed.t_ns += by_ns;
}

TEST(ImuFaults, AClockThatIsSetAndSetBackIsFollowedAtTheSecondFrame) {
  for (const std::int64_t by_ns : {-1'000'000'000'000LL, 1'000'000'000'000LL, -1'500'000'000LL}) {
    const Outcome outcome = drive([&](Interval& now) { shift(now, by_ns); });
    EXPECT_GE(outcome.diagnostics.count(Fault::clock_set), 1) << by_ns;
    EXPECT_LE(outcome.recovered_after(), kRecovered) << by_ns;
  }
}

TEST(ImuFaults, OneFrameWithAWrongTimeHasNoMotionAndChangesNothing) {
  for (const std::int64_t wrong_ns :
       {std::numeric_limits<std::int64_t>::min(), std::int64_t{0},
        std::numeric_limits<std::int64_t>::max(), std::int64_t{3600'000'000'000}}) {
    const Outcome outcome = drive([&](Interval& now) {
      if (now.frame == kLastBad) now.t_ns = wrong_ns;
    });
    EXPECT_EQ(outcome.diagnostics.total(), 0) << wrong_ns;
    EXPECT_EQ(outcome.recovered_after(), 0) << wrong_ns;
  }
  EgoMotionEstimator estimator(mounting(), {}, {});
  estimator.add_imu(0, {}, {0, 0, kGravity_mps2});
  estimator.frame(kFrameStep_ns);
  EXPECT_LT(estimator.frame(0).dt_s, 0) << "so that the filter knows";
  EXPECT_GT(estimator.frame(3600'000'000'000).dt_s, kLongestStep_s);
}

TEST(ImuFaults, AnImuOfAnotherClockIsNamed) {
  const Outcome outcome = drive(
      [](Interval& now) {
        for (Sample& sample : now.imu) sample.t_ns += 1'400'000'000'000'000'000;
      },
      true);
  EXPECT_EQ(outcome.diagnostics.count(Fault::imu_jump), (kFrames - 1) * kReadingsAFrame + 1);
}

TEST(ImuFaults, InvalidConstructorArgumentsAreRefused) {
  const auto refuses =
      [](const std::function<void(Mounting&, EgoMotionNoise&, EgoMotionEstimator::Start&)>& spoil) {
        Mounting m = mounting();
        EgoMotionNoise noise;
        EgoMotionEstimator::Start start;
        spoil(m, noise, start);
        EXPECT_THROW(EgoMotionEstimator(m, noise, start), std::invalid_argument);
      };
  refuses([](auto& m, auto&, auto&) { m.R_BC.setZero(); });
  refuses([](auto& m, auto&, auto&) { m.R_BS(0, 0) = kNan; });
  refuses([](auto& m, auto&, auto&) { m.p_BC_m.x() = kInf; });
  refuses([](auto& m, auto&, auto&) { m.p_BS_m.x() = kNan; });
  refuses([](auto&, auto& n, auto&) { n.gyro_density = -1; });
  refuses([](auto&, auto& n, auto&) { n.accel_walk = kNan; });
  refuses([](auto&, auto& n, auto&) { n.odometry_mps = 0; });
  refuses([](auto&, auto&, auto& s) { s.R_WB *= 2; });
  refuses([](auto&, auto&, auto& s) { s.v_WB_mps.z() = kNan; });
  refuses([](auto&, auto&, auto& s) { s.gravity_mps2 = -9.81; });
}

}  // namespace
}  // namespace lcs
