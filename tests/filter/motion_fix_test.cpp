/// What the corners say of the error of the given motion.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "filter/edges/motion_fix.h"
#include "filter/kinematics/camera.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/kinematics/geometry.h"
#include "filter/kinematics/motion_field.h"
#include "tests/filter/hypotheses_support.h"
#include "tests/filter/scalar_track.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector3d;
using testing::kDt_s;
using testing::kNoise2_px2;
using testing::Random;
using testing::Residual;
using testing::steady_motion;
using testing::vga;

/// Covariance of the given velocity, (m/s)^2: 2 cm/s on each axis.
const Eigen::Matrix3d kWrong = 4e-4 * Eigen::Matrix3d::Identity();

/// A camera moves ahead; its given motion has an error in turn and velocity. Static points cover
/// the picture, each with its offset from the expected place.
struct Misled {
  MotionField told, truth;
  std::vector<Residual> residuals;

  Misled(const Vector3d& turn, const Vector3d& velocity, int points, Random& random,
         double unseen_turn_rad = 0)
      : told(vga(), ahead_and_aside(unseen_turn_rad), {}), truth(told.corrected(turn, velocity)) {
    for (int i = 0; i < points; ++i) {
      const Vec2 before(random.uniform(0, 639), random.uniform(0, 479));
      const double ratio = told.reference_depth_m() / random.uniform(2, 10);
      const Vec2 expected = told.translated(told.rotated(before), ratio);
      const Vec2 x = truth.translated(truth.rotated(before), ratio);
      const Vec2 by_depth = 0.5 * told.parallax_px_m(expected);
      residuals.push_back({expected, x - expected + random.vector(0.3).head<2>(),
                           kNoise2_px2 * Eigen::Matrix2d::Identity(), by_depth,
                           ratio / told.reference_depth_m(), 1e-4, 0.05, 0.97, 1e-6});
    }
  }

  static EgoMotion ahead_and_aside(double unseen_turn_rad) {
    EgoMotion motion = steady_motion({0, 0, 1}, {0, 0.1, 0}, kDt_s);
    motion.unseen_turn_rad = unseen_turn_rad;
    return motion;
  }

  MotionFix fix() const {
    const auto misses = testing::columns_of(residuals, vga(), kDt_s, kWrong.trace() / 3);
    return find_motion_fix(vga(), told, misses.data(), residuals.size(), kWrong);
  }
  bool is_contradicted() const {
    const auto misses = testing::columns_of(residuals, vga(), kDt_s, kWrong.trace() / 3);
    return lcs::is_contradicted(misses.data(), residuals.size());
  }

  /// Largest distance of a field from the true one across the parallax, px.
  double worst_across(const MotionField& field) const {
    double worst = 0;
    for (const Residual& residual : residuals) {
      const double ratio = residual.inverse_depth_pm * told.reference_depth_m();
      const Vec2 is = field.translated(field.rotated(residual.place_px), ratio);
      const Vec2 should = truth.translated(truth.rotated(residual.place_px), ratio);
      worst = std::max(worst, std::abs(cross(truth.direction(should), is - should)));
    }
    return worst;
  }
};

TEST(MotionFix, FindsWhatTheToldMotionIsOffByAmongWrongMatches) {
  Random random(5);
  for (const auto& [turn, velocity] :
       {std::pair<Vector3d, Vector3d>({1e-3, -5e-4, 8e-4}, {0, 0.02, 0}),
        {{-1e-3, 1e-3, -1e-3}, {-0.01, -0.02, 0}}}) {
    Misled misled(turn, velocity, 200, random);
    for (std::size_t i = 0; i < misled.residuals.size(); i += 5) {
      misled.residuals[i].off_px = 30 * random.vector(1).head<2>();
    }
    const double before = misled.worst_across(misled.told);
    const MotionFix fix = misled.fix();
    const double after = misled.worst_across(misled.told.corrected(fix.turn_rad, fix.velocity_mps));
    EXPECT_GT(before, 0.6);
    // The worst of 200 places. A turn and a sideways velocity look alike at known depths, and each
    // residual counts as one of twenty of a body, so the prior limits the fix.
    EXPECT_LT(after, before / 2);
  }
}

/// Every other match is wrong, by an offset that a turn of this size could cause.
TEST(MotionFix, FindsALargeTurnThatNoGyroSawAmongWrongMatches) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const Vector3d turn = random.vector(0.05);
    Misled misled(turn, Vector3d::Zero(), 200, random, 0.1);
    for (std::size_t i = 0; i < misled.residuals.size(); i += 2) {
      misled.residuals[i].off_px = Vec2(50, -100) + 50 * random.vector(1).head<2>();
    }
    const MotionFix fix = misled.fix();
    // The fix is linear in the turn.
    EXPECT_LT((fix.turn_rad - turn).norm(), 1e-3 + turn.squaredNorm() / 2) << "seed " << seed;
  }
}

/// As if a depth had been learnt under a wrong motion.
TEST(MotionFix, TakesNothingFromWhatADepthExplains) {
  Random random(6);
  Misled misled(Vector3d::Zero(), Vector3d::Zero(), 200, random);
  for (Residual& residual : misled.residuals) {
    residual.off_px += 3 * misled.told.direction(residual.place_px);
  }
  const MotionFix fix = misled.fix();
  EXPECT_LT(fix.turn_rad.norm(), 2e-4);
  EXPECT_LT(misled.worst_across(misled.told.corrected(fix.turn_rad, fix.velocity_mps)), 0.3);
}

TEST(MotionFix, TakesLittleFromWhatIsKnownToMove) {
  Random random(7);
  Misled misled(Vector3d::Zero(), Vector3d::Zero(), 200, random);
  for (std::size_t i = 0; i < 120; ++i) {
    misled.residuals[i].off_px += Vec2(2, 2);
    misled.residuals[i].stands = 0.01;
    misled.residuals[i].otherwise_ppx2 = 0.2;
  }
  const MotionFix fix = misled.fix();
  EXPECT_LT(misled.worst_across(misled.told.corrected(fix.turn_rad, fix.velocity_mps)), 0.3);
}

/// The fix grows with the certainty of the residuals; no minimum number is required.
TEST(MotionFix, SaysNothingWhereNobodyTellsAndMoreTheMoreTell) {
  Random random(8);
  double turn = 0;
  for (const int residuals : {0, 20, 200}) {
    const Misled misled({1e-3, 0, 0}, Vector3d::Zero(), residuals, random);
    const MotionFix fix = misled.fix();
    if (residuals == 0) {
      EXPECT_EQ(fix.turn_rad.norm(), 0);
      EXPECT_TRUE(fix.velocity_covariance.isApprox(kWrong));
    } else {
      EXPECT_GT(fix.turn_rad.x(), turn) << residuals;
      EXPECT_LT(fix.velocity_covariance.trace(), kWrong.trace());
    }
    turn = fix.turn_rad.x();
  }
  EXPECT_GT(turn, 5e-4);
}

/// Known movers give no information about the motion.
TEST(MotionFix, IsContradictedWhereMoreLeaveThanFourFifths) {
  Random random(9);
  EXPECT_FALSE(Misled(Vector3d::Zero(), Vector3d::Zero(), 0, random).is_contradicted());
  for (const std::size_t leave : {0, 100, 155, 170, 200}) {
    Misled misled(Vector3d::Zero(), Vector3d::Zero(), 200, random);
    for (std::size_t i = 0; i < leave; ++i) misled.residuals[i].off_px = {30, 40};
    EXPECT_EQ(misled.is_contradicted(), leave > 160) << leave;
    for (std::size_t i = 0; i < leave; ++i) misled.residuals[i].stands = 0.1;
    EXPECT_FALSE(misled.is_contradicted()) << leave;
  }
}

/// A camera whose given velocity has a constant error; the corners show half of it.
struct Drifting {
  explicit Drifting(double told_sigma_mps, const Vector3d& rate_radps = Vector3d::Zero())
      : motion(steady_motion({0, 0, 1}, rate_radps, kDt_s)) {
    motion.velocity_sigma_mps = told_sigma_mps;
  }
  /// Remaining velocity error, m/s, when each frame is really `error_mps` faster than given.
  Vector3d left_after(int frames, const Vector3d& error_mps) {
    for (int k = 0; k < frames; ++k) {
      const MotionField told(vga(), motion, {});
      error.advance(told, lasts);
      const MotionField field = error.without(told);
      left = error_mps - (field.displacement_C_m() - told.displacement_C_m()) / kDt_s;
      error.update({Vector3d::Zero(), left / 2, error.covariance() / 2});
    }
    return left;
  }
  EgoMotion motion;
  VelocityError error{0.002};
  double lasts = 1;
  Vector3d left;
};

TEST(VelocityErrors, AreAsLargeAsToldAllTheWhile) {
  for (const double speed_mps : {0.0, 1.0}) {
    for (const double told_sigma_mps : {0.0, 0.03}) {
      EgoMotion motion = steady_motion({0, 0, speed_mps}, {0.1, 0.2, 0.3}, kDt_s);
      motion.velocity_sigma_mps = told_sigma_mps;
      VelocityError error(0.02);
      for (int k = 0; k < 20; ++k) {
        error.advance(MotionField(vga(), motion, {}), 0.9);
        const double sigma_mps = std::hypot(told_sigma_mps, 0.02 * speed_mps);
        const Eigen::Matrix3d expected = sigma_mps * sigma_mps * Eigen::Matrix3d::Identity();
        EXPECT_LT((error.covariance() - expected).norm(), 1e-12);
        if (k == 10) error.update({Vector3d::Zero(), {0.1, 0, 0}, expected});
      }
    }
  }
}

TEST(VelocityErrors, AreCarriedOn) {
  const Vector3d off(0.1, -0.05, 0.02);
  EXPECT_LT(Drifting(0.2).left_after(10, off).norm(), 0.01 * off.norm());
}

TEST(VelocityErrors, AreForgottenOnceTheEstimatorKnowsBetter) {
  Drifting drifting(0.2);
  const Vector3d off(0.1, -0.05, 0.02);
  drifting.left_after(10, off);
  drifting.motion.velocity_sigma_mps = 0.002;  // the wheels were read
  EXPECT_LT(drifting.left_after(1, Vector3d::Zero()).norm(), 0.02 * off.norm());
}

TEST(VelocityErrors, AreForgottenByTheShareThatDoesNotLast) {
  const Vector3d off(0.1, -0.05, 0.02);
  double last = 0;
  for (const double lasts : {1.0, 0.7, 0.3, 0.0}) {
    Drifting drifting(0.2);
    drifting.lasts = lasts;
    const double left = drifting.left_after(10, off).norm();
    EXPECT_GT(left, last) << lasts;
    last = left;
  }
  EXPECT_DOUBLE_EQ(last, off.norm()) << "what was found in the frame before says nothing";
}

TEST(VelocityErrors, StayInTheWorldWhileTheCameraTurns) {
  Drifting drifting(0.2, {0, 0, 0.5 * kPi / kDt_s});  // a quarter turn per frame
  drifting.left_after(1, {0.1, 0, 0});
  const MotionField told(vga(), drifting.motion, {});
  drifting.error.advance(told, 1);
  const Vector3d known = drifting.error.without(told).displacement_C_m() - told.displacement_C_m();
  EXPECT_GT(std::abs(known.y()), 10 * std::abs(known.x()));
}

TEST(VelocityErrors, OfMoreThanThreeDeviationsAreNotBelieved) {
  constexpr double kSigma_mps = 0.1;
  EgoMotion motion = steady_motion({0, 0, 1}, {0, 0, 0}, kDt_s);
  motion.velocity_sigma_mps = kSigma_mps;
  const MotionField told(vga(), motion, {});
  VelocityError error(0);
  const MotionFix fix{
      Vector3d::Zero(), {0.9 * kSigma_mps, 0, 0}, 1e-4 * Eigen::Matrix3d::Identity()};
  const auto known_mps = [&] {
    return ((error.without(told).displacement_C_m() - told.displacement_C_m()) / kDt_s).eval();
  };
  for (int k = 1; k <= 3; ++k) {  // up to 2.7 deviations
    error.advance(told, 1);
    EXPECT_LT((error.update(fix) - fix.velocity_mps).norm(), 1e-12);
    EXPECT_NEAR(known_mps().norm(), k * 0.9 * kSigma_mps, 1e-9);
  }
  error.advance(told, 1);
  EXPECT_LT((error.update(fix) + 3 * fix.velocity_mps).norm(), 1e-9) << "back to the told velocity";
  EXPECT_LT(known_mps().norm(), 1e-9);
}

}  // namespace
}  // namespace lcs
