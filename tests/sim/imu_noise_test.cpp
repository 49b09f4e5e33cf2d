#include "sim/imu/imu_noise.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/imu_presets.h"

namespace lcs::sim {
namespace {

using scenario::ImuNoise;

/// Plain numbers per axis: Eigen's vectors would take minutes in a build with sanitizers.
using Series = std::array<std::vector<double>, 3>;

struct Recording {
  Series gyro;
  Series accel;
};

scenario::Imu imu_of(const ImuNoise& noise, double rate_hz) {
  scenario::Imu imu;
  imu.noise = noise;
  imu.rate_hz = rate_hz;
  return imu;
}

/// Readings of the model for an IMU at rest with zero input.
Recording record(const ImuNoise& noise, double rate_hz, int samples, std::uint64_t seed = 1) {
  ImuNoiseModel model(imu_of(noise, rate_hz), seed);
  Recording recording;
  for (int i = 0; i < samples; ++i) {
    const ImuSample sample = model.corrupt({});
    for (int axis = 0; axis < 3; ++axis) {
      recording.gyro[axis].push_back(sample.gyro_radps[axis]);
      recording.accel[axis].push_back(sample.accel_mps2[axis]);
    }
  }
  return recording;
}

/// Overlapping Allan variance with clusters of m samples (IEEE Std 952, annex C): half the mean
/// square of the difference between the means of neighbouring clusters.
double allan_variance(const std::vector<double>& series, std::size_t m) {
  std::vector<double> sums(1, 0.0);
  for (const double x : series) sums.push_back(sums.back() + x);
  double total = 0;
  const std::size_t count = series.size() - 2 * m + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double difference = sums[i + 2 * m] - 2 * sums[i + m] + sums[i];
    total += difference * difference;
  }
  const double cluster = static_cast<double>(m);
  return total / static_cast<double>(count) / (2 * cluster * cluster);
}

/// Mean of the axes.
double allan_variance(const Series& series, std::size_t m) {
  double sum = 0;
  for (const std::vector<double>& axis : series) sum += allan_variance(axis, m);
  return sum / 3;
}

struct Densities {
  double white;
  double walk;
};

// The Allan deviation over M = T / tau independent clusters has a relative standard deviation of
// about 1 / sqrt(2 M); three axes triple M. The lengths below keep it at 3 % or less at each
// figure, so that the tolerance of 10 % is more than three standard deviations.

/// Estimates both figures of one sensor from variance(tau) = white^2 / tau + walk^2 tau / 3 at two
/// taus, a decade below and above the tau of equal terms, so that one term dominates each by
/// 100 to 1. The longest tau, 1,000 samples, fits into the recording 260 times.
Densities measure(const ImuNoise& noise, double white, double walk, Series Recording::*sensor,
                  std::uint64_t seed) {
  const double equal_s = std::sqrt(3.0) * white / walk;
  const double rate_hz = 100 / equal_s;
  const Series series = record(noise, rate_hz, 260'000, seed).*sensor;
  const double t1 = equal_s / 10;
  const double t2 = equal_s * 10;
  Eigen::Matrix2d terms;
  terms << 1 / t1, t1 / 3, 1 / t2, t2 / 3;
  const Eigen::Vector2d variances(allan_variance(series, 10), allan_variance(series, 1000));
  const Eigen::Vector2d squares = terms.inverse() * variances;
  return {std::sqrt(squares[0]), std::sqrt(squares[1])};
}

/// Slope of the Allan deviation between 0.3 s and 10 s at 200 Hz, in decades per decade.
double slope(const Series& series) {
  const double decades = std::log10(2000.0 / 60.0);
  return std::log10(allan_variance(series, 2000) / allan_variance(series, 60)) / 2 / decades;
}

constexpr int k20Minutes = 20 * 60 * 200;  // 120 times 10 s: 3.7 % there, or 0.011 in the slope

TEST(ImuNoise, WhiteNoiseAloneHasItsDensityAtOneSecondAndSlopeMinusHalf) {
  ImuNoise noise;
  noise.gyroscope_noise_density = 1.6968e-4;
  noise.accelerometer_noise_density = 2.0e-3;
  const Recording recording = record(noise, 200, k20Minutes);
  const auto check = [](const Series& series, double density) {
    EXPECT_NEAR(std::sqrt(allan_variance(series, 200)) / density, 1, 0.10);
    EXPECT_NEAR(slope(series), -0.5, 0.05);
  };
  check(recording.gyro, noise.gyroscope_noise_density);
  check(recording.accel, noise.accelerometer_noise_density);
}

TEST(ImuNoise, RandomWalkAloneHasItsFigureAtThreeSecondsAndSlopePlusHalf) {
  ImuNoise noise;
  noise.gyroscope_random_walk = 1.9393e-5;
  noise.accelerometer_random_walk = 3.0e-3;
  const Recording recording = record(noise, 200, k20Minutes);
  const auto check = [](const Series& series, double walk) {
    // the deviation is walk * sqrt(tau / 3)
    EXPECT_NEAR(std::sqrt(allan_variance(series, 600)) / walk, 1, 0.10);
    EXPECT_NEAR(slope(series), 0.5, 0.05);
  };
  check(recording.gyro, noise.gyroscope_random_walk);
  check(recording.accel, noise.accelerometer_random_walk);
}

/// In units of their own figures all IMUs draw the same numbers from one seed, so each has its own
/// seed here.
using NameAndSeed = std::pair<std::string, std::uint64_t>;
class ImuNoisePreset : public testing::TestWithParam<NameAndSeed> {};

TEST_P(ImuNoisePreset, DeliversTheNoiseAskedForWithinTenPercent) {
  const auto& [name, seed] = GetParam();
  const ImuNoise asked = scenario::imu_preset(name).value();
  const Densities gyro = measure(asked, asked.gyroscope_noise_density, asked.gyroscope_random_walk,
                                 &Recording::gyro, seed);
  EXPECT_NEAR(gyro.white / asked.gyroscope_noise_density, 1, 0.10);
  EXPECT_NEAR(gyro.walk / asked.gyroscope_random_walk, 1, 0.10);

  const Densities accel = measure(asked, asked.accelerometer_noise_density,
                                  asked.accelerometer_random_walk, &Recording::accel, seed);
  EXPECT_NEAR(accel.white / asked.accelerometer_noise_density, 1, 0.10);
  EXPECT_NEAR(accel.walk / asked.accelerometer_random_walk, 1, 0.10);
  RecordProperty("gyro_white", std::to_string(gyro.white / asked.gyroscope_noise_density));
  RecordProperty("gyro_walk", std::to_string(gyro.walk / asked.gyroscope_random_walk));
  RecordProperty("accel_white", std::to_string(accel.white / asked.accelerometer_noise_density));
  RecordProperty("accel_walk", std::to_string(accel.walk / asked.accelerometer_random_walk));
}

INSTANTIATE_TEST_SUITE_P(OfKnownImus, ImuNoisePreset,
                         testing::Values(NameAndSeed("adis16448", 1), NameAndSeed("tumvi", 2),
                                         NameAndSeed("esim", 3)),
                         [](const auto& test) { return test.param.first; });

TEST(ImuNoise, IdealChangesNothing) {
  ImuNoiseModel model(imu_of(scenario::imu_preset("ideal").value(), 200), 1);
  const ImuSample truth{5'000'000, {0.1, -0.2, 0.3}, {1e-9, -9.81, 1e3}};
  for (int i = 0; i < 1000; ++i) {
    const ImuSample sample = model.corrupt(truth);
    EXPECT_EQ(sample.t_ns, truth.t_ns);
    EXPECT_EQ(sample.gyro_radps, truth.gyro_radps);
    EXPECT_EQ(sample.accel_mps2, truth.accel_mps2);
  }
}

// Kalibr's model by hand, for one axis after the other.
TEST(ImuNoise, ScaleAndMisalignmentAreThoseOfKalibrsMatrices) {
  scenario::Imu imu = imu_of({}, 200);
  imu.gyroscopes.M << 1.01, 0, 0, 0.002, 0.99, 0, -0.003, 0.004, 1.02;
  imu.gyroscopes.C_gyro_i << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // a quarter turn about z
  imu.gyroscopes.A << 1e-4, 0, 0, 0, 0, 2e-4, 0, 0, 0;
  imu.accelerometers.M << 0.98, 0, 0, 0.01, 1.03, 0, 0.02, -0.01, 1;
  const ImuSample sample = ImuNoiseModel(imu, 1).corrupt({0, {0.1, 0.2, 0.3}, {1, 2, 9}});
  // in the gyroscopes' frame the rate is (-0.2, 0.1, 0.3), the specific force (-2, 1, 9)
  const Eigen::Vector3d gyro(1.01 * -0.2 + 1e-4 * -2, 0.002 * -0.2 + 0.99 * 0.1 + 2e-4 * 9,
                             -0.003 * -0.2 + 0.004 * 0.1 + 1.02 * 0.3);
  const Eigen::Vector3d accel(0.98 * 1, 0.01 * 1 + 1.03 * 2, 0.02 * 1 - 0.01 * 2 + 9);
  EXPECT_LT((sample.gyro_radps - gyro).norm(), 1e-15);
  EXPECT_LT((sample.accel_mps2 - accel).norm(), 1e-14);
}

TEST(ImuNoise, ReadingsStayInTheRangeAndAreMultiplesOfTheResolution) {
  scenario::Imu imu = imu_of(scenario::imu_preset("esim").value(), 200);
  const Recording exact = record(imu.noise, 200, 1000);
  imu.gyroscopes.range_radps = 0.0025;  // about the deviation of the noise
  imu.gyroscopes.resolution_radps = 0.0005;
  imu.accelerometers.range_mps2 = 0.02;
  imu.accelerometers.resolution_mps2 = 0.004;
  ImuNoiseModel model(imu, 1);
  int saturated = 0;
  for (int i = 0; i < 1000; ++i) {
    const ImuSample sample = model.corrupt({});
    for (int axis = 0; axis < 3; ++axis) {
      const double gyro = std::clamp(exact.gyro[axis][i], -0.0025, 0.0025);
      const double accel = std::clamp(exact.accel[axis][i], -0.02, 0.02);
      EXPECT_NEAR(sample.gyro_radps[axis], gyro, 0.0005 / 2 + 1e-15);
      EXPECT_NEAR(sample.accel_mps2[axis], accel, 0.004 / 2 + 1e-15);
      EXPECT_NEAR(std::remainder(sample.gyro_radps[axis], 0.0005), 0, 1e-15);
      EXPECT_NEAR(std::remainder(sample.accel_mps2[axis], 0.004), 0, 1e-14);
      saturated += gyro != exact.gyro[axis][i];
    }
  }
  EXPECT_GT(saturated, 300);  // of 3000: a third lies beyond one deviation
}

TEST(ImuNoise, TheLargestReadingIsTheLastMultipleOfTheResolutionWithinTheRange) {
  scenario::Imu imu = imu_of({}, 200);
  imu.gyroscopes.range_radps = 0.5;
  imu.gyroscopes.resolution_radps = 0.04;
  imu.accelerometers.range_mps2 = 0.3;  // three times .1, up to rounding
  imu.accelerometers.resolution_mps2 = 0.1;
  ImuNoiseModel model(imu, 1);
  for (const double sign : {-1.0, 1.0}) {
    const ImuSample sample = model.corrupt(
        {0, Eigen::Vector3d::Constant(sign * 0.51), Eigen::Vector3d::Constant(sign * 4)});
    EXPECT_LT((sample.gyro_radps.array() - sign * 0.48).abs().maxCoeff(), 1e-15);
    EXPECT_LT((sample.accel_mps2.array() - sign * 0.3).abs().maxCoeff(), 1e-15);
  }
}

TEST(ImuNoise, TheBiasItTellsIsTheOneInTheSample) {
  ImuNoise noise;  // no white noise: only the bias is added
  noise.gyroscope_random_walk = 1e-3;
  noise.accelerometer_random_walk = 1e-2;
  ImuNoiseModel model(imu_of(noise, 100), 3);
  for (int i = 0; i < 100; ++i) {
    const ImuSample sample = model.corrupt({});
    EXPECT_EQ(sample.gyro_radps, model.gyro_bias_radps());
    EXPECT_EQ(sample.accel_mps2, model.accel_bias_mps2());
    EXPECT_EQ(model.gyro_bias_radps().isZero(0), i == 0);
    EXPECT_EQ(model.accel_bias_mps2().isZero(0), i == 0);
  }
}

TEST(ImuNoise, OneFigureLeavesTheNoiseOfTheOthersAsItWas) {
  ImuNoise noise = scenario::imu_preset("tumvi").value();
  const Recording before = record(noise, 200, 100);
  noise.accelerometer_noise_density *= 2;
  noise.accelerometer_random_walk = 0;
  const Recording after = record(noise, 200, 100);
  EXPECT_EQ(before.gyro, after.gyro);
  EXPECT_NE(before.accel, after.accel);
}

TEST(ImuNoise, AnotherSensorLeavesTheNoiseOfTheFirstAsItWas) {
  const ImuNoise noise = scenario::imu_preset("tumvi").value();
  const Recording alone = record(noise, 200, 100);
  ImuNoiseModel first(imu_of(noise, 200), 1);
  ImuNoiseModel second(imu_of(noise, 200), 1, "imu1");
  OdometryNoiseModel wheels({.enabled = true}, 1);
  for (int i = 0; i < 100; ++i) {
    wheels.corrupt({});
    const ImuSample other = second.corrupt({});
    const ImuSample sample = first.corrupt({});
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(sample.gyro_radps[axis], alone.gyro[axis][i]);
      EXPECT_EQ(sample.accel_mps2[axis], alone.accel[axis][i]);
    }
    EXPECT_NE(sample.gyro_radps, other.gyro_radps);
  }
}

TEST(ImuNoise, RepeatsWithItsSeedAndDiffersWithAnother) {
  const ImuNoise noise = scenario::imu_preset("esim").value();
  EXPECT_EQ(record(noise, 200, 100, 5).gyro, record(noise, 200, 100, 5).gyro);
  EXPECT_NE(record(noise, 200, 100, 5).gyro, record(noise, 200, 100, 6).gyro);
}

TEST(ImuNoise, RefusesWhatNoSensorHas) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ImuNoiseModel(imu_of({}, 0), 1), std::invalid_argument);
  EXPECT_THROW(ImuNoiseModel(imu_of({}, nan), 1), std::invalid_argument);
  ImuNoise noise;
  noise.accelerometer_noise_density = -1e-3;
  EXPECT_THROW(ImuNoiseModel(imu_of(noise, 200), 1), std::invalid_argument);
  noise.accelerometer_noise_density = nan;
  EXPECT_THROW(ImuNoiseModel(imu_of(noise, 200), 1), std::invalid_argument);
  EXPECT_THROW(OdometryNoiseModel({.noise_mps = -1}, 1), std::invalid_argument);
  EXPECT_THROW(OdometryNoiseModel({.yaw_noise_radps = nan}, 1), std::invalid_argument);
  EXPECT_THROW(OdometryNoiseModel({.scale_error = nan}, 1), std::invalid_argument);
}

TEST(OdometryNoise, ScaleIsDrawnOnceARunWithTheDeviationAskedFor) {
  const scenario::Odometry odometry{.enabled = true, .noise_mps = 0, .scale_error = 0.05};
  const int runs = 10'000;
  double sum = 0;
  double sum2 = 0;
  for (int seed = 0; seed < runs; ++seed) {
    OdometryNoiseModel model(odometry, static_cast<std::uint64_t>(seed));
    const double first = model.corrupt({0, {2, 0, 0}}).velocity_mps.x() / 2;
    EXPECT_EQ(model.corrupt({0, {2, 0, 0}}).velocity_mps.x() / 2, first);
    sum += first - 1;
    sum2 += (first - 1) * (first - 1);
  }
  // Relative standard deviations over 10,000 draws: 1 % of 0.05 for the mean, 0.7 % for the
  // deviation.
  EXPECT_NEAR(sum / runs, 0, 0.05 * 0.05);
  EXPECT_NEAR(std::sqrt(sum2 / runs) / 0.05, 1, 0.04);
}

TEST(OdometryNoise, WhiteNoiseIsInXAndYAndHeightIsNotTold) {
  const scenario::Odometry odometry{.enabled = true, .noise_mps = 0.01, .scale_error = 0};
  OdometryNoiseModel model(odometry, 1);
  const int n = 100'000;
  Eigen::Vector2d sum2 = Eigen::Vector2d::Zero();
  for (int i = 0; i < n; ++i) {
    const OdometrySample sample = model.corrupt({i, {0.5, -0.1, 0.02}});
    EXPECT_EQ(sample.t_ns, i);
    EXPECT_EQ(sample.velocity_mps.z(), 0);
    EXPECT_FALSE(sample.yaw_rate_radps);
    sum2 += (sample.velocity_mps.head<2>() - Eigen::Vector2d(0.5, -0.1)).cwiseAbs2();
  }
  for (const int axis : {0, 1}) EXPECT_NEAR(std::sqrt(sum2[axis] / n) / 0.01, 1, 0.02);
}

TEST(OdometryNoise, OfTheYawRateIsItsOwn) {
  const scenario::Odometry odometry{
      .enabled = true, .noise_mps = 0.01, .yaw_noise_radps = 0.05, .scale_error = 0};
  OdometryNoiseModel with(odometry, 1), without(odometry, 1);
  const int n = 100'000;
  double sum2 = 0;
  for (int i = 0; i < n; ++i) {
    const OdometrySample sample = with.corrupt({i, {0.5, -0.1, 0}, 0.3});
    sum2 += std::pow(sample.yaw_rate_radps.value() - 0.3, 2);
    EXPECT_EQ(sample.velocity_mps, without.corrupt({i, {0.5, -0.1, 0}}).velocity_mps);
  }
  EXPECT_NEAR(std::sqrt(sum2 / n) / 0.05, 1, 0.02);
}

TEST(ImuNoise, TheTurnOnBiasIsDrawnOnceAndHasTheDeviationAskedFor) {
  const ImuNoise noise{.gyroscope_turn_on_bias_radps = 0.02,
                       .accelerometer_turn_on_bias_mps2 = 0.5};
  double gyro = 0, accel = 0;
  constexpr int kRuns = 1000;
  for (int seed = 1; seed <= kRuns; ++seed) {
    ImuNoiseModel model(imu_of(noise, 200), static_cast<std::uint64_t>(seed));
    const ImuSample first = model.corrupt({});
    const ImuSample second = model.corrupt({});
    ASSERT_EQ(first.gyro_radps, second.gyro_radps);
    ASSERT_EQ(first.accel_mps2, second.accel_mps2);
    gyro += first.gyro_radps.squaredNorm();
    accel += first.accel_mps2.squaredNorm();
  }
  // a variance from 3,000 draws is good to 2.6 %, the deviation to 1.3 %: four of these
  EXPECT_NEAR(std::sqrt(gyro / (3 * kRuns)), 0.02, 0.05 * 0.02);
  EXPECT_NEAR(std::sqrt(accel / (3 * kRuns)), 0.5, 0.05 * 0.5);
}

TEST(ImuNoise, ATurnOnBiasLeavesTheNoiseAroundItAsItWas) {
  ImuNoise noise{1e-3, 1e-4, 1e-2, 1e-3};
  ImuNoiseModel plain(imu_of(noise, 200), 7);
  noise.gyroscope_turn_on_bias_radps = 0.1;
  ImuNoiseModel biased(imu_of(noise, 200), 7);
  Eigen::Vector3d offset;
  for (int i = 0; i < 100; ++i) {
    const ImuSample a = plain.corrupt({}), b = biased.corrupt({});
    EXPECT_EQ(a.accel_mps2, b.accel_mps2);
    if (i == 0) offset = b.gyro_radps - a.gyro_radps;
    EXPECT_LT((b.gyro_radps - a.gyro_radps - offset).norm(), 1e-12);
  }
  EXPECT_GT(offset.norm(), 0.01);
}

}  // namespace
}  // namespace lcs::sim
