#include "tools/comparators/flow_detectors.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tools/bench/ego_motion_feed.h"

namespace lcs::comparators {
namespace {

EgoMotion step_of(double dt_s, const Eigen::Vector3d& v_C_mps = {0, 0, 1}) {
  EgoMotion motion;
  motion.dt_s = dt_s;
  motion.v_C_mps = v_C_mps;
  return motion;
}

/// A camera that turns and moves, with a different pose in each frame.
sim::Pose pose(int k) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2 + 0.3 * k, -1 + 0.5 * k).normalized();
  return {Eigen::AngleAxisd(0.2 + 0.05 * k * k, axis).toRotationMatrix(),
          Eigen::Vector3d(0.4 * k, 0.1 * k * k, 1 - 0.2 * k)};
}

TEST(Composed, IsTheMotionFromTheFirstPoseToTheLast) {
  const std::vector<double> dts_s{0.1, 0.03, 0.25};
  EgoMotion whole;
  double elapsed_s = 0;
  for (int k = 0; k < 3; ++k) {
    EgoMotion next = bench::motion_between(pose(k), pose(k + 1), dts_s[k]);
    next.unseen_turn_rad = k < 2 ? 3 + k : 0;
    next.ground = Ground{.up_C = {0, -1, 0}, .height_m = 1.0 + k};
    whole = composed(whole, next);
    elapsed_s += dts_s[k];
    const EgoMotion expected = bench::motion_between(pose(0), pose(k + 1), elapsed_s);
    EXPECT_NEAR(whole.dt_s, elapsed_s, 1e-12);
    EXPECT_TRUE(whole.R_cur_prev.isApprox(expected.R_cur_prev, 1e-9));
    EXPECT_TRUE(whole.v_C_mps.isApprox(expected.v_C_mps, 1e-9));
    EXPECT_TRUE(whole.w_C_radps.isApprox(expected.w_C_radps, 1e-9));
  }
  EXPECT_DOUBLE_EQ(whole.unseen_turn_rad, 5);
  EXPECT_EQ(whole.ground->height_m, 3);  // at the end of it
}

TEST(Composed, OfNoTimeIsNoMotion) {
  const EgoMotion none = composed({}, {});
  EXPECT_EQ(none.dt_s, 0);
  EXPECT_TRUE(none.R_cur_prev.isIdentity());
  EXPECT_TRUE(none.v_C_mps.isZero());
}

/// Shows frames 0, 1, 2, ... at a rate; each picture is its own number.
class Shown {
 public:
  explicit Shown(double baseline_s) : lookback(baseline_s) {}
  void show(const EgoMotion& motion) { lookback.begin(motion) = number++; }
  void show(int frames, double rate_hz) {
    for (int k = 0; k < frames; ++k) show(number == 0 ? EgoMotion() : step_of(1 / rate_hz));
  }
  /// Age, in frames, of the picture that the last one is compared with.
  int frames_back() const { return number - 1 - *lookback.earlier(); }

  Lookback<int> lookback;
  int number = 0;
};

TEST(Lookback, OfTheFirstFrameIsNone) {
  Shown shown(0.1);
  shown.show(1, 30);
  EXPECT_EQ(shown.lookback.earlier(), nullptr);
  EXPECT_EQ(shown.lookback.now(), 0);
  EXPECT_EQ(shown.lookback.motion().dt_s, 0);
}

TEST(Lookback, IsAboutABaselineAgoAndAtALowRateTheLastPicture) {
  for (const auto& [rate_hz, frames] : std::vector<std::pair<double, int>>{
           {1, 1}, {5, 1}, {10, 1}, {14, 1}, {19, 2}, {20, 2}, {30, 3}, {60, 6}, {100, 10}}) {
    Shown shown(0.1);
    shown.show(40, rate_hz);
    EXPECT_EQ(shown.frames_back(), frames) << rate_hz << " Hz";
    EXPECT_EQ(shown.lookback.now(), 39);
    EXPECT_NEAR(shown.lookback.motion().dt_s, frames / rate_hz, 1e-9);
    EXPECT_TRUE(shown.lookback.motion().v_C_mps.isApprox(Eigen::Vector3d(0, 0, 1)));
  }
}

TEST(Lookback, OfFewFramesGoesAsFarAsThereAreAny) {
  Shown shown(0.1);
  for (int k = 1; k < 6; ++k) {
    shown.show(k == 1 ? 2 : 1, 50);
    EXPECT_EQ(shown.frames_back(), k);
  }
  shown.show(1, 50);
  EXPECT_EQ(shown.frames_back(), 5);
}

TEST(Lookback, FollowsARateThatChanges) {
  Shown shown(0.1);
  shown.show(20, 50);
  shown.show(1, 5);
  EXPECT_EQ(shown.frames_back(), 1);
  shown.show(20, 20);
  EXPECT_EQ(shown.frames_back(), 2);
}

TEST(Lookback, WithoutABaselineIsTheLastPicture) {
  Shown shown(0);
  shown.show(20, 200);
  EXPECT_EQ(shown.frames_back(), 1);
}

TEST(Lookback, IsBoundedAtARateThatIsBeyondAll) {
  Shown shown(10);
  shown.show(200, 1000);
  EXPECT_LT(shown.frames_back(), 20);
}

TEST(Lookback, ForgetsWhatCameBeforeAMotionThatIsUnknown) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const EgoMotion& broken :
       {step_of(-0.1), step_of(1000), step_of(0.03, {kNan, 0, 0}), step_of(kNan)}) {
    Shown shown(0.1);
    shown.show(10, 30);
    shown.show(broken);
    EXPECT_EQ(shown.lookback.earlier(), nullptr);
    EXPECT_EQ(shown.lookback.diagnostics().total(), 1);
    shown.show(2, 30);
    EXPECT_EQ(shown.frames_back(), 2);
    EXPECT_NEAR(shown.lookback.motion().dt_s, 2 / 30.0, 1e-12);
  }
}

TEST(Lookback, RefusesABaselineThatIsNoTime) {
  EXPECT_THROW(Lookback<int>{-0.1}, std::invalid_argument);
  EXPECT_THROW(Lookback<int>{std::numeric_limits<double>::quiet_NaN()}, std::invalid_argument);
}

}  // namespace
}  // namespace lcs::comparators
