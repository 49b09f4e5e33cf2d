// Warnings from an IMU at rest.
#include "tools/replay/recorded.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>
#include <vector>

namespace lcs::replay {
namespace {

using Eigen::Vector3d;
constexpr double kGravity = 9.81;
const Vector3d kGyroBias(5e-3, -3e-3, 8e-3);
const Vector3d kTilted =
    Eigen::AngleAxisd(0.3, Vector3d::UnitY()) * Vector3d(0, 0, kGravity + 0.05);

/// Readings at 200 Hz: at rest for `still_s`, then with acceleration and rotation.
std::vector<sim::ImuSample> readings(double still_s, double seconds = 4) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto noise = [&](double size) {
    return Vector3d(size * normal(random), size * normal(random), size * normal(random));
  };
  std::vector<sim::ImuSample> all;
  for (int k = 0; k < 200 * seconds; ++k) {
    sim::ImuSample& reading = all.emplace_back();
    reading.t_ns = 5'000'000LL * k;
    reading.gyro_radps = kGyroBias + noise(2e-3);
    reading.accel_mps2 = kTilted + noise(0.03);
    if (k >= 200 * still_s) {
      reading.gyro_radps.z() += 0.2;
      reading.accel_mps2.x() += 1;
    }
  }
  return all;
}

TEST(AtRest, IsTakenWhereTheFirstSecondIsStill) {
  const std::optional<Rest> rest = rest_at_start(readings(2), std::nullopt, kGravity);
  ASSERT_TRUE(rest);
  EXPECT_NEAR(1e-9 * static_cast<double>(rest->until_ns), 2, 0.26);
  EXPECT_LE(rest->until_ns, 2'000'000'000);
  EXPECT_LT((rest->start.gyro_bias_radps - kGyroBias).norm(), 5e-4);
  EXPECT_LT((rest->start.q_WB * kTilted.normalized() - Vector3d::UnitZ()).norm(), 2e-3);
  EXPECT_NEAR(rest->start.accel_bias_mps2.norm(), 0.05, 0.01);
  EXPECT_FALSE(rest->moved);
}

TEST(AtRest, IsNotTakenFromWhatMoves) {
  EXPECT_FALSE(rest_at_start(readings(0), std::nullopt, kGravity)) << "it turns from the start on";
  EXPECT_FALSE(rest_at_start(readings(0.7), std::nullopt, kGravity)) << "too short";
  EXPECT_FALSE(rest_at_start(readings(4, 0.9), std::nullopt, kGravity)) << "no second is there";
  EXPECT_FALSE(rest_at_start({}, std::nullopt, kGravity));
  EXPECT_FALSE(rest_at_start({}, 2, kGravity));
  std::vector<sim::ImuSample> in_g = readings(4);
  for (sim::ImuSample& reading : in_g) reading.accel_mps2 /= kGravity;
  EXPECT_FALSE(rest_at_start(in_g, std::nullopt, kGravity)) << "nothing stands at 1 m/s^2";
  std::vector<sim::ImuSample> shaken = readings(4);
  for (std::size_t i = 0; i < shaken.size(); ++i) shaken[i].accel_mps2.z() += i % 2 ? 1 : -1;
  EXPECT_FALSE(rest_at_start(shaken, std::nullopt, kGravity)) << "an engine runs";
}

TEST(AtRest, IsTakenWhereItIsSaidAndNotBelievedBlindly) {
  const std::optional<Rest> rest = rest_at_start(readings(4), 0.5, kGravity);
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->until_ns, 500'000'000);
  EXPECT_FALSE(rest->moved);
  const std::optional<Rest> moved = rest_at_start(readings(1), 3, kGravity);
  ASSERT_TRUE(moved);
  EXPECT_TRUE(moved->moved);
}

}  // namespace
}  // namespace lcs::replay
