/// Depth from the path of a corner: exact where sightings are, and as good as it says where not.
#include "filter/path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "filter/filter.h"
#include "filter/motion_field.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector3d;
using testing::Random;
using testing::steady_motion;
using testing::vga;
using testing::World;

const double kReference_m = FieldParameters{}.reference_depth_m;

/// A static point, followed for some frames; none if it leaves the image.
struct Followed {
  Path path;
  double ratio;  ///< the true one at the end
};

template <typename Noise>
std::optional<Followed> follow(const Vec2& px, double depth_m, int frames, const EgoMotion& motion,
                               Noise&& noise) {
  const MotionField field(vga(), motion, FieldParameters{});
  World world;
  world.add(px, depth_m);
  Followed result;
  result.path.start(px + noise(), 1, vga());
  for (int k = 0; k < frames; ++k) {
    world.advance(motion);
    const auto image = world.image(world.points[0]);
    if (!image) return std::nullopt;
    result.path.carry(field);
    result.path.see(*image + noise(), vga(), field);
  }
  result.ratio = kReference_m / world.points[0].x_C.z();
  return result;
}

TEST(Path, IsExactForExactSightingsWhateverTheMotion) {
  Random random(1);
  int followed = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Vec2 px(random.uniform(100, 540), random.uniform(100, 380));
    const EgoMotion motion = steady_motion(random.vector(0.5), random.vector(0.2), 0.1);
    const auto point = follow(px, random.uniform(1.5, 20), 6, motion, [] { return Vec2(0, 0); });
    if (!point || point->ratio > kReference_m / FieldParameters{}.nearest_depth_m) continue;
    EXPECT_NEAR(point->path.ratio, point->ratio, 1e-4 * point->ratio) << trial;
    ++followed;
  }
  EXPECT_GT(followed, 150);
}

/// Errors over their stated standard deviations have the spread of 1, with noise as large as is
/// stated: the 2000 trials give it to 2 %, the curvature of the perspective takes some more.
TEST(Path, ErrsAsMuchAsItSays) {
  Random random(2);
  const auto noise = [&] {
    // Uniform, of the standard deviation of a sighting.
    const double half = Path::kSighting_px * std::sqrt(3.0);
    const double x = random.uniform(-half, half);
    return Vec2(x, random.uniform(-half, half));
  };
  const EgoMotion motion = steady_motion({0.2, 0, 0.6}, {0, 0.05, 0}, 0.1);
  double squares = 0;
  int n = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec2 px(random.uniform(60, 580), random.uniform(60, 420));
    const auto point = follow(px, random.uniform(3, 8), 8, motion, noise);
    // Where the depth is not known at all it is clamped to what is plausible.
    if (!point || point->path.sigma() > 0.2 * point->ratio) continue;
    squares += std::pow((point->path.ratio - point->ratio) / point->path.sigma(), 2);
    ++n;
  }
  ASSERT_GT(n, 1000);
  EXPECT_NEAR(std::sqrt(squares / n), 1, 0.1);
}

/// Held to a first sighting that is a pixel off, a depth would stay as wrong as one is; with all
/// sightings alike it is one among many.
TEST(Path, IsNotHeldToItsFirstSighting) {
  const EgoMotion motion = steady_motion({0.3, 0, 0}, Vector3d::Zero(), 0.1);
  bool first = true;
  const auto first_is_off = [&] { return Vec2(std::exchange(first, false) ? 1 : 0, 0); };
  const auto point = follow({320, 240}, 4, 12, motion, first_is_off);
  ASSERT_TRUE(point);
  const double path_px = 12 * 0.03 * vga().focal_px / 4;
  const double held = 1 / path_px;  // relative error from the first and the last alone
  EXPECT_LT(std::abs(point->path.ratio / point->ratio - 1), 0.4 * held);
}

TEST(Path, KnowsNothingWithoutParallax) {
  const auto exactly = [] { return Vec2(0, 0); };
  const auto still = follow({100, 100}, 4, 5, steady_motion({0, 0, 0}, {0, 0.1, 0}, 0.1), exactly);
  ASSERT_TRUE(still);
  EXPECT_EQ(still->path.weight, 0);
  EXPECT_EQ(still->path.ratio, 1);
  EXPECT_TRUE(std::isinf(still->path.sigma()));
  // In the focus of expansion nothing moves.
  const auto focus =
      follow(vga().centre_px, 9, 5, steady_motion({0, 0, 0.5}, Vector3d::Zero(), 0.1), exactly);
  ASSERT_TRUE(focus);
  EXPECT_LT(focus->path.weight, 1e-3);
}

/// In the whole filter: after a while the path tells the depth to a few per cent, from corners
/// that are rounded to whole pixels.
TEST(Path, IsWithinFivePerCentAfterTenFramesOfRoundedCorners) {
  World world;
  Random random(1);
  for (int i = 0; i < 120; ++i) {
    world.add({random.uniform(40, 600), random.uniform(40, 440)}, random.uniform(2, 5));
  }
  const EgoMotion motion = steady_motion({0.3, 0, 0.5}, {0, 0.05, 0}, 0.1);
  Filter filter(world.camera, preset("default"));
  std::vector<double> errors;
  for (int k = 0; k < 12; ++k) {
    std::vector<Eigen::Vector2f> corners = world.corners();
    std::vector<double> depths;
    for (const auto& point : world.points) {
      if (world.image(point)) depths.push_back(point.x_C.z());
    }
    for (auto& x : corners) x = x.array().round();
    const FrameResult& result = filter.step(corners, k == 0 ? EgoMotion{} : motion);
    if (k == 11) {
      for (const Edge& edge : result.layers.normal_edges) {
        if (edge.corner < 0 || edge.age < 8) continue;
        const double depth = FieldParameters{}.reference_depth_m / edge.path.ratio;
        errors.push_back(std::abs(depth / depths[edge.corner] - 1));
      }
    }
    world.advance(motion);
  }
  ASSERT_GT(errors.size(), 30u);
  std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.05);
}

/// A camera that flees for ever: nothing grows without bound.
TEST(Path, StaysFiniteHoweverFarTheCameraFlees) {
  for (const double speed : {1000.0, -1000.0}) {
    const EgoMotion motion = steady_motion({0, 0, speed}, Vector3d::Zero(), 0.1);
    const MotionField field(vga(), motion, FieldParameters{});
    Path path;
    path.start({330, 240}, 1, vga());
    for (int k = 0; k < 3000; ++k) {
      path.carry(field);
      path.see({330, 240}, vga(), field);
      ASSERT_TRUE(path.sightings.allFinite() && std::isfinite(path.weight)) << k;
      ASSERT_TRUE(path.ratio >= 0 && std::isfinite(path.ratio)) << k;
    }
  }
}

/// What is known without end, in numbers, is known no more before it overflows.
TEST(Path, BeginsAnewWhereWhatItKnowsWouldOverflow) {
  const EgoMotion back = steady_motion({0, 0, -600}, Vector3d::Zero(), 0.1);
  const MotionField field(vga(), back, FieldParameters{});
  Path path;
  path.start({330, 240}, 1, vga());
  path.sightings *= 1e40;
  path.weight = 1e47;
  path.carry(field);  // from 3 to 63 m away
  EXPECT_NEAR(path.ratio, 3. / 63, 1e-12);
  EXPECT_EQ(path.weight, 0);
  EXPECT_TRUE(path.sightings.isZero(0));
}

}  // namespace
}  // namespace lcs
