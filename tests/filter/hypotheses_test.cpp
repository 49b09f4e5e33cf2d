/// Edges with two hypotheses: each part of `filter/edges/` alone, then the whole rule.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "filter/edges/association.h"
#include "filter/edges/coupling.h"
#include "filter/edges/gauss.h"
#include "filter/edges/motion_fix.h"
#include "filter/edges/static_point.h"
#include "filter/edges/track.h"
#include "filter/ego_motion/estimator.h"
#include "filter/filter.h"
#include "filter/kinematics/geometry.h"
#include "tests/filter/same_result.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using testing::expect_same;
using testing::Random;
using testing::record;
using testing::Scene;
using testing::sparse_world;
using testing::steady_motion;
using testing::vga;
using testing::World;

using Corners = std::vector<Vector2f>;

constexpr double kNoise2_px2 = 0.36;
constexpr double kDt_s = 0.1;

const EdgeParameters kUsual = EdgeParameters{};

/// Density of a sighting without bounds on depth, 1/px^2.
double density(const StaticPoint& point, const Vec2& x_px, double noise2_px2) {
  return gauss(x_px - point.place_px, point.spread(noise2_px2));
}

/// Images of a point in each frame, px, and its 1/Z in the last frame.
struct Seen {
  std::vector<Vec2> places;
  double inverse_depth_pm = 0;
};
Seen watch(const Vec2& px, double depth, const EgoMotion& motion, int frames) {
  World world;
  world.add(px, depth);
  Seen seen;
  for (int k = 0; k < frames; ++k) {
    if (k > 0) world.advance(motion);
    seen.places.push_back(testing::project(world.camera, world.points[0].x_C));
  }
  seen.inverse_depth_pm = 1 / world.points[0].x_C.z();
  return seen;
}

template <int N>
void expect_covariance(const Eigen::Matrix<double, N, N>& C) {
  EXPECT_TRUE(C.isApprox(C.transpose(), 1e-9)) << C;
  // The axes differ in scale by orders of magnitude, so the correlations are checked.
  const Eigen::Matrix<double, N, 1> scale = C.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix<double, N, N> correlations = scale.asDiagonal() * C * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(correlations);
  EXPECT_GT(solver.eigenvalues().minCoeff(), 0) << C;
}

// ---- A static point

TEST(StaticPoint, LearnsTheDepthOfWhatItSeesWhateverTheMotion) {
  struct Drive {
    Vector3d v_mps, w_radps;
  };
  for (const Drive& drive :
       {Drive{{0.5, 0, 0}, {0, 0, 0}}, Drive{{0, 0, 0.8}, {0, 0, 0}},
        Drive{{0, 0, -0.8}, {0, 0, 0}}, Drive{{0.1, -0.3, 0.6}, {0, 0, 0}},
        Drive{{0.1, 0, 0.8}, {0.02, -0.05, 0.1}}, Drive{{0.2, 0, 0.4}, {0, -0.3, 0}}}) {
    const EgoMotion motion = steady_motion(drive.v_mps, drive.w_radps, kDt_s);
    const MotionField field(vga(), motion, {});
    for (const Vec2& px : {Vec2(180, 130), Vec2(430, 330)}) {
      for (const double depth : {2.5, 3.5, 6.0}) {
        SCOPED_TRACE(::testing::Message()
                     << "v " << drive.v_mps.transpose() << ", w " << drive.w_radps.transpose()
                     << ", from " << px.transpose() << ", " << depth << " m");
        const Seen seen = watch(px, depth, motion, 12);
        StaticPoint point;
        double last_miss = 0;
        for (std::size_t k = 1; k < seen.places.size(); ++k) {
          const Vec2& x = seen.places[k];
          point = k == 1 ? StaticPoint::seen_once(field.rotated(px), vga(), field,
                                                  field.displacement_C_m(), kNoise2_px2)
                         : point.predicted(vga(), field, kUsual.ego_share);
          last_miss = (point.place_px - x).norm();
          point.see(x, kNoise2_px2, depth_bounds(field, x));
          expect_covariance<3>(point.covariance);
        }
        // Half a standard deviation of the filter's own uncertainty: the rest comes from the
        // first guess, the middle of the bounds, which the sightings outweigh.
        EXPECT_NEAR(point.inverse_depth_pm, seen.inverse_depth_pm,
                    0.5 * std::sqrt(point.covariance(2, 2)));
        EXPECT_LT(std::sqrt(point.covariance(2, 2)), 0.15) << "it has learnt";
        EXPECT_LT((point.place_px - seen.places.back()).norm(), 0.2);
        EXPECT_LT(last_miss, 0.5) << "px, before it was seen";
      }
    }
  }
}

/// For a camera that moves sideways, places are linear in 1/Z, so the fit to all sightings at once
/// equals the sequential result.
TEST(StaticPoint, IsTheLeastSquaresFitWhereThatIsLinear) {
  const double d = 0.05;
  const EgoMotion motion = steady_motion({d / kDt_s, 0, 0}, Vector3d::Zero(), kDt_s);
  const MotionField field(vga(), motion, {});
  const Seen seen = watch({400, 200}, 2.5, motion, 8);
  Random random(4);
  const Vec2 start = seen.places[0];
  const DepthBounds bounds = depth_bounds(field, start);
  StaticPoint point = StaticPoint::seen_once(field.rotated(start), vga(), field,
                                             field.displacement_C_m(), kNoise2_px2);
  const double middle = point.inverse_depth_pm, variance = point.covariance(2, 2);
  EXPECT_NEAR(middle, 0.5 * (bounds.least_pm + bounds.most_pm), 1e-12);
  // Sums of the slope s of x over 1/Z, and of x, weighted by 1/variance.
  double n = 1, s = 0, ss = 0, x = start.x(), sx = 0;
  for (std::size_t k = 1; k < seen.places.size(); ++k) {
    const Vec2 noisy = seen.places[k] + random.vector(0.6).head<2>();
    if (k > 1) point = point.predicted(vga(), field, 0);
    point.see(noisy, kNoise2_px2, bounds);
    const double slope = -vga().focal_px * d * static_cast<double>(k);
    n += 1, s += slope, ss += slope * slope, x += noisy.x(), sx += slope * noisy.x();
  }
  const double information = (ss - s * s / n) / kNoise2_px2 + 1 / variance;
  const double expected = ((sx - s * x / n) / kNoise2_px2 + middle / variance) / information;
  EXPECT_NEAR(point.inverse_depth_pm, expected, 1e-9);
  EXPECT_NEAR(point.covariance(2, 2), 1 / information, 1e-12);
}

TEST(StaticPoint, IsLikeliestWhereItIsExpected) {
  const MotionField field(vga(), steady_motion({0.1, 0, 0.6}, {0, 0.05, 0}, kDt_s), {});
  const StaticPoint point = StaticPoint::seen_once(field.rotated({200, 150}), vga(), field,
                                                   field.displacement_C_m(), kNoise2_px2);
  const double there = density(point, point.place_px, kNoise2_px2);
  for (int i = 0; i < 16; ++i) {
    const Vec2 aside(std::cos(i * 0.4), std::sin(i * 0.4));
    const double near = density(point, point.place_px + aside, kNoise2_px2);
    EXPECT_LT(near, there);
    EXPECT_LT(density(point, point.place_px + 2 * aside, kNoise2_px2), near);
  }
  // A density sums to one. Steps of 1 px suffice because the noise is no finer.
  double sum = 0;
  for (int v = -80; v <= 80; ++v) {
    for (int u = -80; u <= 80; ++u) sum += density(point, point.place_px + Vec2(u, v), kNoise2_px2);
  }
  EXPECT_NEAR(sum, 1, 0.01);
}

/// Bounds apply in addition to the normal distribution of the place.
TEST(StaticPoint, IsNotNearerThanItMayBeNorBehindTheGround) {
  EgoMotion motion = steady_motion({1, 0, 0}, Vector3d::Zero(), kDt_s);
  motion.ground = Ground{.up_C = {0, -1, 0}, .height_m = 0.8};
  const MotionField field(vga(), motion, {});
  const Vec2 px(420, 330);
  const DepthBounds bounds = depth_bounds(field, px);
  const double ground = (px.y() - vga().centre_px.y()) / vga().focal_px / 0.8;
  EXPECT_NEAR(bounds.most_pm, 1 / FieldParameters{}.nearest_depth_m, 1e-12) << "at z_min";
  EXPECT_NEAR(bounds.ground_pm, ground, 1e-12);
  // The ground may slope by 0.015 rad, and the height may be wrong by a tenth.
  const double sigma = std::hypot(0.015 / 0.8, 0.1 * ground);
  EXPECT_NEAR(bounds.ground_sigma_pm, sigma, 1e-12);
  EXPECT_NEAR(bounds.least_pm, ground - 2 * sigma, 1e-12);
  const auto share = [&](double inverse_depth_pm) {
    StaticPoint point =
        StaticPoint::seen_once(px, vga(), field, field.displacement_C_m(), kNoise2_px2);
    const Vec2 x = px - Vec2(vga().focal_px * 0.1 * inverse_depth_pm, 0);
    const double unbounded = density(point, x, kNoise2_px2);
    const double bounded = point.see(x, kNoise2_px2, bounds);
    EXPECT_GE(point.inverse_depth_pm, bounds.least_pm);
    EXPECT_LE(point.inverse_depth_pm, bounds.most_pm);
    return bounded / unbounded;
  };
  EXPECT_GT(share(0.5 * (bounds.least_pm + bounds.most_pm)), 0.99);
  // One frame gives 1/Z to 0.6 px of 42 px m, and the bounds' place to the same: 0.02 1/m.
  EXPECT_GT(share(bounds.most_pm - 0.1), 0.99);
  EXPECT_LT(share(bounds.most_pm + 0.1), 1e-3);
  EXPECT_LT(share(3 * bounds.most_pm), 1e-3);
  EXPECT_GT(share(ground + 0.1), 0.99);
  EXPECT_LT(share(ground - 4 * sigma), 1e-3);
  EXPECT_LT(share(0), 1e-3);
}

/// Z is measured along the optical axis, so it changes when the camera turns.
TEST(StaticPoint, AStandingCameraSaysNothingOfDepth) {
  for (const Vector3d& turn : {Vector3d(0, 0, 0), Vector3d(0.02, -0.1, 0.05)}) {
    const EgoMotion motion = steady_motion(Vector3d::Zero(), turn, kDt_s);
    const MotionField field(vga(), motion, {});
    Random random(6);
    const Vec2 start(180, 300);
    const DepthBounds bounds = depth_bounds(field, start);
    StaticPoint point = StaticPoint::seen_once(field.rotated(start), vga(), field,
                                               field.displacement_C_m(), kNoise2_px2);
    World world;
    world.add(field.rotated(start), 1 / point.inverse_depth_pm);
    const double sigma = std::sqrt(point.covariance(2, 2)) / point.inverse_depth_pm;
    for (int k = 0; k < 40; ++k) {
      if (k > 0) world.advance(motion);
      const Vector3d& x_C = world.points[0].x_C;
      const Vec2 x = testing::project(world.camera, x_C);
      if (k > 0) point = point.predicted(vga(), field, kUsual.ego_share);
      point.see(x + random.vector(1).head<2>(), kNoise2_px2, bounds);
      // The depth error follows the axis error: 1 px of 400, of 0.01 rad per frame.
      EXPECT_NEAR(point.inverse_depth_pm * x_C.z(), 1, 1e-3);
      EXPECT_NEAR(std::sqrt(point.covariance(2, 2)) / point.inverse_depth_pm, sigma, 1e-9);
      EXPECT_TRUE(point.covariance.topRightCorner(2, 1).isZero(0));
      EXPECT_LT((point.place_px - x).norm(), 2) << "it is where it is seen";
    }
    EXPECT_LT(point.covariance(0, 0), kNoise2_px2 / 40 * 1.01) << "a mean of 41";
  }
}

TEST(StaticPoint, IsFiniteWhereTheCameraGoesThroughIt) {
  const MotionField field(vga(), steady_motion({0, 0, 30}, Vector3d::Zero(), kDt_s), {});
  const Vec2 x(250, 200);
  StaticPoint point =
      StaticPoint::seen_once(field.rotated(x), vga(), field, field.displacement_C_m(), kNoise2_px2);
  for (int k = 0; k < 5; ++k) {
    if (k > 0) point = point.predicted(vga(), field, kUsual.ego_share);
    const double density = point.see(x, kNoise2_px2, depth_bounds(field, x));
    EXPECT_TRUE(std::isfinite(density));
    EXPECT_TRUE(point.place_px.allFinite() && point.covariance.allFinite());
  }
}

TEST(StaticPoint, IsFiniteWhereTheCameraTurnsAway) {
  const MotionField field(vga(), steady_motion({0.1, 0, 0.5}, {0, 20, 0}, kDt_s), {});
  for (const double inverse_depth_pm : {0.0, 1e-300, 0.5}) {
    for (const double x_px : {-1e4, 0.0, 250.0, 1e4}) {
      StaticPoint point;
      point.place_px = {x_px, 200};
      point.inverse_depth_pm = inverse_depth_pm;
      point.covariance.setIdentity();
      for (int k = 0; k < 5; ++k) point = point.predicted(vga(), field, kUsual.ego_share);
      EXPECT_TRUE(std::isfinite(point.inverse_depth_pm)) << inverse_depth_pm << " at " << x_px;
      EXPECT_TRUE(point.place_px.allFinite() && point.covariance.allFinite());
    }
  }
}

// ---- A motion of its own

/// Without acceleration the fit is the line through all sightings.
TEST(OwnMotion, IsTheLeastSquaresFitOfAConstantVelocity) {
  const MotionField field(vga(), steady_motion(Vector3d::Zero(), Vector3d::Zero(), kDt_s), {});
  Random random(3);
  std::vector<Vec2> places;
  for (int k = 0; k < 9; ++k) {
    places.push_back(Vec2(100, 200) + k * kDt_s * Vec2(80, -25) + random.vector(0.6).head<2>());
  }
  OwnMotion motion = OwnMotion::first(places[0], places[1], kNoise2_px2, kDt_s);
  for (std::size_t k = 2; k < places.size(); ++k) {
    motion = motion.predicted(field, 0);
    motion.see(places[k], kNoise2_px2);
    const double last = static_cast<double>(k), mean = last / 2;
    double tt = 0;
    Vec2 tx = Vec2::Zero(), x = Vec2::Zero();
    for (std::size_t i = 0; i <= k; ++i) {
      const double t = (static_cast<double>(i) - mean) * kDt_s;
      tt += t * t, tx += t * places[i], x += places[i] / (last + 1);
    }
    const Vec2 slope = tx / tt, end = x + slope * (last - mean) * kDt_s;
    EXPECT_LT((motion.velocity_pxps - slope).norm(), 1e-9);
    EXPECT_LT((motion.place_px - end).norm(), 1e-9);
    EXPECT_NEAR(motion.covariance(1, 1), kNoise2_px2 / tt, 1e-9);
    EXPECT_NEAR(motion.step_variance_px2(kDt_s), kNoise2_px2 / tt * kDt_s * kDt_s, 1e-9);
  }
}

TEST(OwnMotion, FollowsAVelocityUnderARotationAndGrowsSurer) {
  const MotionField field(vga(), steady_motion({0, 0, 0.5}, {0.02, -0.2, 0.1}, kDt_s), {});
  const Vec2 velocity(60, 30);
  std::vector<Vec2> places = {{200, 150}};
  for (int k = 1; k < 15; ++k) places.push_back(field.rotated(places.back()) + velocity * kDt_s);
  OwnMotion motion = OwnMotion::first(field.rotated(places[0]), places[1], kNoise2_px2, kDt_s);
  double variance = motion.covariance(1, 1);
  for (std::size_t k = 2; k < places.size(); ++k) {
    motion = motion.predicted(field, kUsual.turnover_ps);
    EXPECT_LT((motion.place_px - places[k]).norm(), 1e-9);
    const double there = motion.density(places[k], kNoise2_px2);
    EXPECT_GT(there, motion.density(places[k] + Vec2(1, 0), kNoise2_px2));
    EXPECT_EQ(motion.density(places[k] + Vec2(1, 0), kNoise2_px2),
              motion.density(places[k] - Vec2(1, 0), kNoise2_px2));
    motion.see(places[k], kNoise2_px2);
    expect_covariance<2>(motion.covariance);
    // Process noise is added in each frame: the variance falls to a steady state and oscillates
    // about it by less than 1 %.
    EXPECT_LT(motion.covariance(1, 1), variance * 1.01);
    variance = motion.covariance(1, 1);
  }
  // The velocity variance grows by q = 45 px^2/s^2 per frame, and a step measures it with r = 72:
  // the steady state lies below r.
  EXPECT_LT(variance, kNoise2_px2 * 2 / (kDt_s * kDt_s));
  EXPECT_LT(motion.covariance(0, 0), kNoise2_px2) << "more than a sighting tells";
  EXPECT_LT((motion.velocity_pxps - velocity).norm(), 1e-9);
}

// ---- Association

/// A static track at `x`, px, after one sighting.
Track track_at(const Vec2& x, const Signature& signature = {}) {
  const MotionField still(vga(), steady_motion(Vector3d::Zero(), Vector3d::Zero(), kDt_s), {});
  Track track;
  track.place_px = x;
  track.signature = signature;
  track.as_static = StaticPoint::seen_once(x, vga(), still, still.displacement_C_m(), kNoise2_px2);
  track.sightings = 1;
  return track;
}

Chi chi_of(const std::vector<Vec2>& corners, const std::vector<Signature>& signatures = {}) {
  Chi chi;
  chi.locations = corners;
  for (std::size_t i = 0; i < corners.size(); ++i) chi.sources.push_back(static_cast<int>(i));
  chi.signatures = signatures;
  return chi;
}

Signature with_bits(int bits) {
  Signature signature{};
  for (int i = 0; i < bits; ++i) signature[i / 64] |= 1ULL << (i % 64);
  return signature;
}

std::vector<int> match(const EdgeParameters& parameters, const Chi& chi,
                       const std::vector<Track>& tracks) {
  Neighbourhood around;
  around.build(chi.locations, parameters.neighbour_reach_px, parameters.neighbours);
  return Association(parameters).match(chi, around, tracks, kNoise2_px2, kDt_s);
}

/// Corners with jitter that appear and vanish; some belong to a moving group.
struct Crowd {
  explicit Crowd(std::uint64_t seed) {
    Random random(seed);
    const auto at = [](const Vec2& x) { return Vec2((64 * x).array().round() / 64); };
    for (int i = 0; i < 150; ++i) {
      const Vec2 x = at({random.uniform(5, 634), random.uniform(5, 474)});
      tracks.push_back(track_at(x));
      if (i % 10 > 0) corners.push_back(at(x + random.vector(0.6).head<2>()));
    }
    for (int i = 0; i < 20; ++i) {
      const Vec2 x = at({random.uniform(300, 360), random.uniform(200, 260)});
      tracks.push_back(track_at(x));
      corners.push_back(at(x + Vec2(14, -5) + random.vector(0.6).head<2>()));
    }
    for (int i = 0; i < 15; ++i)
      corners.push_back(at({random.uniform(5, 634), random.uniform(5, 474)}));
  }
  std::vector<Track> tracks;
  std::vector<Vec2> corners;
};

TEST(Association, IsOneToOne) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Crowd crowd(seed);
    const auto track_of = match(kUsual, chi_of(crowd.corners), crowd.tracks);
    ASSERT_EQ(track_of.size(), crowd.corners.size());
    std::set<int> taken;
    int matched = 0;
    for (const int track : track_of) {
      ASSERT_GE(track, -1);
      ASSERT_LT(track, static_cast<int>(crowd.tracks.size()));
      if (track < 0) continue;
      ++matched;
      EXPECT_TRUE(taken.insert(track).second) << "track " << track << " has two corners";
    }
    EXPECT_GT(matched, 130) << "of the 155 that are seen again";
  }
}

/// MODEL.md (7), term by term: each kept pair with the votes of all neighbours.
std::vector<int> matched_by_formula(const EdgeParameters& parameters, const Chi& chi,
                                    const std::vector<Track>& tracks) {
  const double reach = parameters.max_speed_pxps * kDt_s, near = parameters.neighbour_reach_px;
  const double t = parameters.turnover(kDt_s), anywhere = 1 / (kPi * reach * reach);
  const auto likeness = [&](std::size_t c, const Track& track) {
    return chi.signatures.empty()
               ? 0
               : parameters.bits_weight *
                     (parameters.bits_even - distance(chi.signatures[c], track.signature));
  };
  const auto is_pair = [&](std::size_t c, const Track& track) {
    return (chi.locations[c] - track.place_px).norm() <= reach && likeness(c, track) >= 0;
  };
  const auto clutter = [&](std::size_t c) {
    const auto about = std::ranges::count_if(tracks, [&](const Track& track) {
      return (chi.locations[c] - track.place_px).norm() <= near;
    });
    return static_cast<double>(1 + about) / (kPi * near * near);
  };
  const auto ln_density = [&](std::size_t c, const Track& track) {
    const double P = chance(track.belief);
    return std::log((1 - t) * ((1 - P) * density(track.as_static, chi.locations[c], kNoise2_px2) +
                               P * anywhere) +
                    t * anywhere);
  };
  std::vector<std::vector<std::size_t>> kept(chi.size());  // tracks of the likeliest pairs
  for (std::size_t c = 0; c < chi.size(); ++c) {
    std::vector<std::pair<double, std::size_t>> pairs;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      if (!is_pair(c, tracks[i])) continue;
      pairs.emplace_back(-ln_density(c, tracks[i]) - likeness(c, tracks[i]), i);
    }
    std::ranges::sort(pairs);
    if (!chi.signatures.empty()) pairs.resize(std::min<std::size_t>(pairs.size(), 8));
    for (const auto& [less, i] : pairs) kept[c].push_back(i);
  }
  std::vector<std::tuple<double, int, int>> best;  // per corner: -weight, corner, track
  for (std::size_t c = 0; c < chi.size(); ++c) {
    std::vector<std::pair<double, std::size_t>> others;
    for (std::size_t o = 0; o < chi.size(); ++o) {
      const double apart = (chi.locations[c] - chi.locations[o]).norm();
      if (o != c && apart <= 3 * near) others.emplace_back(apart, o);
    }
    std::ranges::sort(others);
    if (others.size() > static_cast<std::size_t>(parameters.neighbours))
      others.resize(static_cast<std::size_t>(parameters.neighbours));
    best.emplace_back(0, static_cast<int>(c), -1);
    for (const std::size_t i : kept[c]) {
      double weight = ln_density(c, tracks[i]) - std::log(clutter(c)) + likeness(c, tracks[i]);
      const Vec2 step = chi.locations[c] - tracks[i].place_px;
      const double variance =
          4 * kNoise2_px2 + std::pow(parameters.step_share, 2) * step.squaredNorm();
      for (const auto& [apart, o] : others) {
        double agrees = 0;
        for (const std::size_t theirs : kept[o]) {
          const Vec2 off = chi.locations[o] - tracks[theirs].place_px - step;
          agrees = std::max(agrees, gauss(off, variance) * std::exp(likeness(o, tracks[theirs])));
        }
        weight += std::exp(-0.5 * apart * apart / (near * near)) *
                  std::log(0.5 * (1 + agrees / clutter(o)));
      }
      best.back() = std::min(best.back(), {-weight, static_cast<int>(c), static_cast<int>(i)});
    }
  }
  std::ranges::sort(best);
  std::vector<int> track_of(chi.size(), -1);
  std::set<int> taken;
  for (const auto& [less, corner, track] : best) {
    if (less < 0 && taken.insert(track).second) track_of[static_cast<std::size_t>(corner)] = track;
  }
  return track_of;
}

TEST(Association, IsThatOfTheFormula) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Crowd crowd(seed);
    EXPECT_EQ(match(kUsual, chi_of(crowd.corners), crowd.tracks),
              matched_by_formula(kUsual, chi_of(crowd.corners), crowd.tracks));
    std::vector<Signature> seen;
    for (std::size_t i = 0; i < crowd.corners.size(); ++i)
      seen.push_back(with_bits(static_cast<int>(7 * i % 90)));
    for (std::size_t i = 0; i < crowd.tracks.size(); ++i)
      crowd.tracks[i].signature = with_bits(static_cast<int>(11 * i % 120));
    EXPECT_EQ(match(kUsual, chi_of(crowd.corners, seen), crowd.tracks),
              matched_by_formula(kUsual, chi_of(crowd.corners, seen), crowd.tracks));
  }
}

TEST(Association, MatchesTheSameWhateverTheOrderAndTheSide) {
  const Crowd crowd(4);
  const auto mirrored = [](Vec2 x) { return Vec2(639 - x.x(), x.y()); };
  std::vector<Track> tracks;
  for (const Track& track : crowd.tracks) tracks.push_back(track_at(mirrored(track.place_px)));
  std::reverse(tracks.begin(), tracks.end());
  std::vector<Vec2> corners;
  for (const Vec2& x : crowd.corners) corners.push_back(mirrored(x));
  std::reverse(corners.begin(), corners.end());
  const auto straight = match(kUsual, chi_of(crowd.corners), crowd.tracks);
  const auto other = match(kUsual, chi_of(corners), tracks);
  const int last_track = static_cast<int>(tracks.size()) - 1;
  for (std::size_t c = 0; c < straight.size(); ++c) {
    const int there = other[other.size() - 1 - c];
    EXPECT_EQ(straight[c], there < 0 ? -1 : last_track - there) << "corner " << c;
  }
}

TEST(Association, SignaturesDecideBetweenTwoThatAreEquallyNear) {
  const std::vector<Track> tracks = {track_at({300, 200})};
  const std::vector<Vec2> either_side = {{298.5, 200}, {301.5, 200}};
  const Signature like = with_bits(40), less_like = with_bits(70), unlike = with_bits(120);
  EXPECT_EQ(match(kUsual, chi_of(either_side, {like, less_like}), tracks),
            (std::vector<int>{0, -1}));
  EXPECT_EQ(match(kUsual, chi_of(either_side, {less_like, like}), tracks),
            (std::vector<int>{-1, 0}));
  EXPECT_EQ(match(kUsual, chi_of(either_side, {unlike, unlike}), tracks),
            (std::vector<int>{-1, -1}));
}

TEST(Association, WhatNeighboursAgreeOnGoesBeforeANearerChanceMatch) {
  const std::vector<Vec2> group = {{300, 200}, {311, 197}, {304, 213}, {290, 208}, {296, 189},
                                   {317, 209}, {283, 195}, {308, 186}, {292, 221}};
  std::vector<Track> tracks;
  std::vector<Vec2> corners;
  for (const Vec2& x : group) {
    tracks.push_back(track_at(x));
    corners.push_back(x + Vec2(22, 5));
  }
  corners.push_back(group[0] + Vec2(1, 1));  // a chance match of the first corner
  EdgeParameters parameters = kUsual;
  parameters.step_share = 0.1;  // they move as one group
  const auto asked = match(parameters, chi_of(corners), tracks);
  for (int c = 0; c < 9; ++c) EXPECT_EQ(asked[c], c);
  EXPECT_EQ(asked[9], -1);
  parameters.neighbours = 0;
  const auto alone = match(parameters, chi_of(corners), tracks);
  EXPECT_NE(alone[0], 0);
  EXPECT_EQ(alone[9], 0) << "or the test says nothing";
}

TEST(Association, ReachesNoFartherThanTheFastest) {
  EdgeParameters parameters = kUsual;
  parameters.max_speed_pxps = 600;
  EXPECT_DOUBLE_EQ(Association(parameters).reach_px(0.02), 12);
  const std::vector<Track> tracks = {track_at({300, 200})};
  const Signature same{};
  Track fast = tracks[0];
  fast.as_static.covariance.topLeftCorner<2, 2>() *= 1e4;
  EXPECT_EQ(match(parameters, chi_of({{359, 200}}, {same}), {fast}), (std::vector<int>{0}));
  EXPECT_EQ(match(parameters, chi_of({{361, 200}}, {same}), {fast}), (std::vector<int>{-1}));
  EXPECT_EQ(match(parameters, chi_of({}), tracks), std::vector<int>{});
  EXPECT_EQ(match(parameters, chi_of({{300, 200}}), {}), (std::vector<int>{-1}));
}

/// Tracks of four distinct signatures, seen three times, and corners that lie `off_px` from them.
struct Followed {
  explicit Followed(const std::array<Vec2, 4>& off_px) {
    for (std::size_t i = 0; i < off_px.size(); ++i) {
      const Vec2 x(150.0 + 100.0 * static_cast<double>(i), 200);
      Track& track = tracks.emplace_back(track_at(x, Signature{1ULL << i}));
      track.sightings = 3;
      track.as_moving = OwnMotion::first(x, x, kNoise2_px2, kDt_s);
      signatures.push_back(track.signature);
      corners.push_back(x + off_px[i]);
    }
  }
  std::vector<int> matched() const { return match(kUsual, chi_of(corners, signatures), tracks); }
  std::vector<Track> tracks;
  std::vector<Signature> signatures;
  std::vector<Vec2> corners;
};

TEST(Association, FollowsNoTrackFartherThanTheFastestGoes) {
  Followed one({Vec2(0, 0), Vec2(0, 0), Vec2(0, 0), Vec2(0, 0)});
  for (const double off_px : {89.0, 91.0}) {  // of the 90 px in 0.1 s
    const Vec2 place = one.tracks[3].place_px + Vec2(0, off_px);
    one.tracks[3].as_static.place_px = one.tracks[3].as_moving.place_px = one.corners[3] = place;
    EXPECT_EQ(one.matched()[3], off_px < 90 ? 3 : -1) << off_px;
  }
}

TEST(Association, LooksWithinTheReachOfTheFastestForWhatLeavesItsPrediction) {
  const Vec2 far_px(kUsual.neighbour_reach_px + 20, 0);
  EXPECT_EQ(Followed({far_px, Vec2(1, 0), Vec2(0, 1), far_px}).matched(),
            (std::vector<int>{0, 1, 2, 3}));
}

TEST(Association, DoesNotCompareACornerThatSurelyContinuesATrackWithNewTracks) {
  Followed one({Vec2(1, 0), Vec2(0, 0), Vec2(0, 0), Vec2(0, 0)});
  // A track seen once at the corner's very place, with its very signature.
  one.tracks.push_back(track_at(one.corners[0], one.signatures[0]));
  EXPECT_EQ(one.matched(), (std::vector<int>{0, 1, 2, 3}));
  one.tracks[0].sightings = 2;
  EXPECT_EQ(one.matched()[0], 4) << "or the test says nothing";
}

// ---- Coupling

Coupling::Node node(double x, double log_odds, const Vec2& step = Vec2::Zero()) {
  return {{x, 240}, log_odds, step, 0};
}

std::vector<double> settle(std::span<const Coupling::Node> nodes,
                           const EdgeParameters& parameters = kUsual) {
  std::vector<Vec2> places;
  for (const Coupling::Node& node : nodes) places.push_back(node.place_px);
  Neighbourhood around;
  around.build(places, parameters.neighbour_reach_px, parameters.neighbours);
  return Coupling(parameters).settle(nodes, around, kNoise2_px2);
}

/// An isolated mover is more likely a chance match than a body.
TEST(Coupling, ANodeThatNoneMovesLikeHasTheWholeWorldAgainstIt) {
  const std::vector<Coupling::Node> nodes = {node(100, 1.5), node(300, -4, {20, 0}),
                                             node(500, 0.2, {-20, 0})};
  std::vector<double> m = settle(nodes);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    EXPECT_NEAR(m[i], nodes[i].log_odds - kUsual.coupling, 1e-5);
  }
  m = settle(std::span(nodes).first(1));
  EXPECT_NEAR(m[0], nodes[0].log_odds - kUsual.coupling, 1e-5);
}

TEST(Coupling, OfTwoNodesIsTheSumByHand) {
  EdgeParameters parameters = kUsual;
  parameters.coupling = 8;
  parameters.step_share = 0.1;
  parameters.neighbour_reach_px = 25;
  // Each node is at the rim of the other's reach, w = exp(-1/2 25^2 / (25^2 + 25^2)) = 0.7788. The
  // far field counts for exp(-1/2 3^2) = 0.0111, a share of 0.0281 against both. The first is
  // certain, so the second has -1 + 8 (1 - 0.0281), and the first 20 + 8 (0.9859 tanh(6.775 / 2)
  // - 0.0141).
  std::vector<double> m = settle(std::vector{node(100, 20), node(125, -1)}, parameters);
  EXPECT_NEAR(m[0], 27.7570, 1e-3);
  EXPECT_NEAR(m[1], 6.7750, 1e-3);
  // The steps differ by 6 px; 0.6^2 + (0.1 * 6)^2 = 0.72 px^2 is tolerated. This is more than three
  // standard deviations, so there is no coupling.
  m = settle(std::vector{node(100, 20), node(125, -1, {6, 0})}, parameters);
  EXPECT_EQ(m[1], -1 - 8);
  // Between a certain mover, w = exp(-1/2 25^2 / (50^2 + 25^2)) = 0.9048, and an equally certain
  // static node whose step is 1 px off, w = 0.9048 exp(-1/2 / 0.37) = 0.2343:
  // -1 + 8 (0.9048 - 0.2343 - 0.0111) / 1.1502.
  m = settle(std::vector{node(100, 20), node(125, -1), node(150, -20, {1, 0})}, parameters);
  EXPECT_NEAR(m[1], 3.5869, 1e-3);
}

TEST(Coupling, ADoubtfulNodeAmongSureOnesTakesTheirs) {
  for (const double theirs : {-6.0, 6.0}) {
    std::vector<Coupling::Node> nodes = {node(300, theirs > 0 ? -1 : 1, {10, 0})};
    for (const double aside : {-20, -12, 9, 17})
      nodes.push_back(node(300 + aside, theirs, {10.3, 0}));
    const std::vector<double> m = settle(nodes);
    EXPECT_GT(m[0] * theirs, 0);
    EXPECT_GT(std::abs(m[0]), 4);
  }
}

TEST(Coupling, TwoSureNodesAmongAnotherMotionKeepTheirOwn) {
  std::vector<Coupling::Node> nodes = {node(300, 5, {10, 0}), node(304, 5, {10, 0})};
  for (const double aside : {-20, -12, 9, 17}) nodes.push_back(node(300 + aside, -6));
  const std::vector<double> m = settle(nodes);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_GT(m[i], 5 + 0.9 * kUsual.coupling);
  for (std::size_t i = 2; i < m.size(); ++i) EXPECT_LT(m[i], -6);
}

/// Lengths scale with the spacing of the corners, so density does not matter.
TEST(Coupling, IsTheSameForAnyDensityOfCorners) {
  Random random(7);
  std::vector<Coupling::Node> nodes, dense;
  for (int i = 0; i < 60; ++i) {
    nodes.push_back({{random.uniform(0, 639), random.uniform(0, 479)},
                     random.uniform(-5, 5),
                     {random.uniform(-1, 1), 0},
                     0,
                     i % 5 > 0});
    dense.push_back(nodes.back());
    dense.back().place_px /= 8;
  }
  const std::vector<double> m = settle(nodes);
  const std::vector<double> m_dense = settle(dense);
  for (std::size_t i = 0; i < nodes.size(); ++i) EXPECT_NEAR(m_dense[i], m[i], 1e-4) << i;
}

TEST(Coupling, ANodeWithoutMotionTakesTheBeliefOfItsNearestNodeWithMotion) {
  const auto silent = [](double x, double y) {
    return Coupling::Node{{x, y}, 0, Vec2::Zero(), 0, false};
  };
  for (const double sign : {1.0, -1.0}) {
    const std::vector<double> m =
        settle(std::vector{node(300, 20 * sign, {9, 0}), node(320, -20 * sign), silent(309, 240),
                           silent(311, 250), silent(310, 235)});
    EXPECT_EQ(m[2], m[0]);
    EXPECT_EQ(m[3], m[1]);
    EXPECT_EQ(m[4], std::max(m[0], m[1]));
  }
  // One known node, then a row of new ones: the last ones have no known node among their nearest.
  std::vector<Coupling::Node> nodes = {node(0, 20)};
  for (int i = 1; i <= 2 * kUsual.neighbours; ++i) nodes.push_back(silent(10 * i, 240));
  const std::vector<double> m = settle(nodes);
  EXPECT_EQ(m[1], m[0]);
  EXPECT_EQ(m.back(), 0);
}

// ---- Error of the given motion

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
      const Vec2 by_depth = 0.5 * parallax_px_m(vga(), told.displacement_C_m(), expected);
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

/// Covariance of the given velocity, (m/s)^2: 2 cm/s on each axis.
const Eigen::Matrix3d kWrong = 4e-4 * Eigen::Matrix3d::Identity();

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
    const MotionFix fix = MotionFinder().find(vga(), misled.told, misled.residuals, kWrong);
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
    const MotionFix fix = MotionFinder().find(vga(), misled.told, misled.residuals, kWrong);
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
  const MotionFix fix = MotionFinder().find(vga(), misled.told, misled.residuals, kWrong);
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
  const MotionFix fix = MotionFinder().find(vga(), misled.told, misled.residuals, kWrong);
  EXPECT_LT(misled.worst_across(misled.told.corrected(fix.turn_rad, fix.velocity_mps)), 0.3);
}

/// The fix grows with the certainty of the residuals; no minimum number is required.
TEST(MotionFix, SaysNothingWhereNobodyTellsAndMoreTheMoreTell) {
  Random random(8);
  double turn = 0;
  for (const int residuals : {0, 20, 200}) {
    const Misled misled({1e-3, 0, 0}, Vector3d::Zero(), residuals, random);
    const MotionFix fix = MotionFinder().find(vga(), misled.told, misled.residuals, kWrong);
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
  EXPECT_FALSE(is_contradicted({}));
  for (const std::size_t leave : {0, 100, 155, 170, 200}) {
    Misled misled(Vector3d::Zero(), Vector3d::Zero(), 200, random);
    for (std::size_t i = 0; i < leave; ++i) misled.residuals[i].off_px = {30, 40};
    EXPECT_EQ(is_contradicted(misled.residuals), leave > 160) << leave;
    for (std::size_t i = 0; i < leave; ++i) misled.residuals[i].stands = 0.1;
    EXPECT_FALSE(is_contradicted(misled.residuals)) << leave;
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
      error.see({Vector3d::Zero(), left / 2, error.covariance() / 2});
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
        if (k == 10) error.see({Vector3d::Zero(), {0.1, 0, 0}, expected});
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
    EXPECT_LT((error.see(fix) - fix.velocity_mps).norm(), 1e-12);
    EXPECT_NEAR(known_mps().norm(), k * 0.9 * kSigma_mps, 1e-9);
  }
  error.advance(told, 1);
  EXPECT_LT((error.see(fix) + 3 * fix.velocity_mps).norm(), 1e-9) << "back to the told velocity";
  EXPECT_LT(known_mps().norm(), 1e-9);
}

// ---- The rule

/// Whole pixels, as FAST returns them.
Corners rounded(Corners corners) {
  for (Vector2f& x : corners) x = x.array().round();
  return corners;
}

std::ptrdiff_t rebels(const FrameResult& result, std::size_t first, std::size_t last) {
  const auto begin = result.verdicts.begin();
  return std::count(begin + static_cast<std::ptrdiff_t>(first),
                    begin + static_cast<std::ptrdiff_t>(last), Verdict::rebel);
}
std::ptrdiff_t rebels(const FrameResult& result) {
  return rebels(result, 0, result.verdicts.size());
}

TEST(HypothesisEdges, AStaticWorldOfWholePixelsIsSilent) {
  for (const double spacing : {60, 30}) {
    for (const Vector3d& v : {Vector3d(0, 0, 0.5), Vector3d(0.3, 0, 0), Vector3d(0, 0, -0.4)}) {
      World world = sparse_world(5, spacing);
      const EgoMotion motion = steady_motion(v, {0.01, 0.05, -0.02}, kDt_s);
      Filter filter(world.camera);
      for (int k = 0; k < 25; ++k) {
        const FrameResult& result =
            filter.step(rounded(world.corners()), k == 0 ? EgoMotion{} : motion);
        EXPECT_EQ(rebels(result), 0)
            << "v " << v.transpose() << ", every " << spacing << " px, frame " << k;
        world.advance(motion);
      }
    }
  }
}

/// No track has a motion yet; a turn of 4 mrad is 1.7 px, more than most of the first steps.
TEST(HypothesisEdges, AFirstTurnThatIsToldWrongIsSeenByTheCorners) {
  for (const Vector3d& turn_rad :
       {Vector3d(4e-3, 0, 0), Vector3d(0, -4e-3, 0), Vector3d(2e-3, 2e-3, 4e-3)}) {
    World world = sparse_world(5, 30);
    const EgoMotion motion = steady_motion({0, 0, 0.5}, {0.01, 0.05, -0.02}, kDt_s);
    const EgoMotion wrong =
        steady_motion(motion.v_C_mps, motion.w_C_radps + turn_rad / kDt_s, kDt_s);
    Filter filter(world.camera);
    for (std::size_t k = 0; k < 6; ++k) {
      const EgoMotion told = k == 0 ? EgoMotion{} : k == 1 ? wrong : motion;
      const FrameResult& result = filter.step(rounded(world.corners()), world.signatures(k), told);
      EXPECT_EQ(rebels(result), 0) << turn_rad.transpose() << ", frame " << k;
      world.advance(motion);
    }
  }
}

/// As when poses jump, or freeze for some frames: the motion before goes on.
TEST(HypothesisEdges, GoOnWhereTheToldMotionIsNotTheCameras) {
  const EgoMotion motion = steady_motion({0.6, 0, 0.5}, {0.01, 0.05, -0.02}, kDt_s);
  struct Wrong {
    const char* what;
    EgoMotion told;
    int frames;
  };
  for (const auto& [what, wrong, frames] :
       {Wrong{"a turn", steady_motion(motion.v_C_mps, {0, 1, 0}, kDt_s), 3},
        Wrong{"a step aside", steady_motion({8, 0, 0.5}, motion.w_C_radps, kDt_s), 1},
        Wrong{"a step upwards", steady_motion({0.6, -8, 0.5}, motion.w_C_radps, kDt_s), 3},
        Wrong{"none at all", steady_motion(Vector3d::Zero(), Vector3d::Zero(), kDt_s), 3}}) {
    World world = sparse_world(5, 30);
    Filter filter(world.camera);
    for (int k = 0; k < 16; ++k) {
      const bool is_wrong = k >= 8 && k < 8 + frames;
      const FrameResult& result =
          filter.step(rounded(world.corners()), world.signatures(static_cast<std::uint64_t>(k)),
                      k == 0     ? EgoMotion{}
                      : is_wrong ? wrong
                                 : motion);
      EXPECT_EQ(rebels(result), 0) << what << ", frame " << k;
      const auto edges = result.layers.normal_edges.size();
      EXPECT_EQ(edges > 200, k > 0) << what << ", frame " << k << ": " << edges;
      world.advance(motion);
    }
    EXPECT_EQ(filter.diagnostics().count(Fault::motion_contradicted), frames) << what;
    EXPECT_EQ(filter.diagnostics().total(), frames) << what;
  }
}

/// One position is wrong, so that two motions are: there and back.
TEST(HypothesisEdges, GoOnWhereOnePositionIsWrong) {
  const EgoMotion motion = steady_motion({0, 0, 0.5}, {0.01, 0.05, -0.02}, kDt_s);
  for (const Vector3d& off_m : {Vector3d(1, 0, 0), Vector3d(0, 0, 1), Vector3d(0, 0.5, -1)}) {
    World world = sparse_world(5, 30);
    Filter filter(world.camera);
    for (int k = 0; k < 16; ++k) {
      EgoMotion told = k == 0 ? EgoMotion{} : motion;
      if (k == 8) told.v_C_mps += off_m / kDt_s;
      if (k == 9) told.v_C_mps -= off_m / kDt_s;
      const FrameResult& result = filter.step(
          rounded(world.corners()), world.signatures(static_cast<std::uint64_t>(k)), told);
      EXPECT_EQ(rebels(result), 0) << off_m.transpose() << ", frame " << k;
      world.advance(motion);
    }
    EXPECT_EQ(filter.diagnostics().count(Fault::motion_contradicted), 2) << off_m.transpose();
  }
}

/// The depths that it gave are dropped once the next motion contradicts them.
TEST(HypothesisEdges, BeginAnewAfterAWrongFirstMotion) {
  const EgoMotion motion = steady_motion({0, 0, 0.5}, {0.01, 0.05, -0.02}, kDt_s);
  for (const Vector3d& off_m : {Vector3d(3, 0, 0), Vector3d(0, 0, 2)}) {
    World world = sparse_world(5, 30);
    Filter filter(world.camera);
    for (int k = 0; k < 12; ++k) {
      EgoMotion told = k == 0 ? EgoMotion{} : motion;
      if (k == 1) told.v_C_mps += off_m / kDt_s;
      const FrameResult& result = filter.step(
          rounded(world.corners()), world.signatures(static_cast<std::uint64_t>(k)), told);
      EXPECT_TRUE(k <= 5 || rebels(result) < 5) << off_m.transpose() << ", frame " << k;
      world.advance(motion);
    }
    EXPECT_GE(filter.diagnostics().count(Fault::motion_contradicted), 1) << off_m.transpose();
  }
}

/// The object was parked until then.
TEST(HypothesisEdges, WhatFillsHalfOfThePictureMayDriveOff) {
  World world = sparse_world(5, 30);
  const EgoMotion motion = steady_motion({0, 0, 0.5}, {0, 0.05, 0}, kDt_s);
  Filter filter(world.camera);
  for (std::size_t k = 0; k < 12; ++k) {
    if (k == 6) {
      for (World::Point& point : world.points) {
        if (point.x_C.x() > 0) point.velocity_C = {0.3, -0.6, 0};
      }
    }
    const FrameResult& result =
        filter.step(rounded(world.corners()), world.signatures(k), k == 0 ? EgoMotion{} : motion);
    if (k > 8) {
      EXPECT_GT(rebels(result), 0.4 * static_cast<double>(result.verdicts.size())) << k;
    }
    world.advance(motion);
  }
  EXPECT_EQ(filter.diagnostics().total(), 0);
}

/// As on a pole in the wind: each frame turns by up to 10 mrad, 4 px, undetected by any gyro.
TEST(HypothesisEdges, AStandingCameraMayShake) {
  const World still = sparse_world(5, 30);
  EgoMotion told = steady_motion(Vector3d::Zero(), Vector3d::Zero(), kDt_s);
  told.unseen_turn_rad = unseen_turn_rad(kDt_s);
  Random random(1);
  Filter filter(still.camera);
  for (std::size_t k = 0; k < 40; ++k) {
    World shaken = still;
    shaken.advance(steady_motion(Vector3d::Zero(), random.vector(0.01) / kDt_s, kDt_s));
    const FrameResult& result =
        filter.step(rounded(shaken.corners()), shaken.signatures(k), k == 0 ? EgoMotion{} : told);
    if (k >= 10) {
      EXPECT_LE(rebels(result), 2) << "frame " << k;
    }
  }
}

TEST(HypothesisEdges, CornersThatJitterBeforeAStandingCameraStand) {
  for (const double spacing : {60, 20}) {
    const World world = sparse_world(8, spacing);
    const EgoMotion motion = steady_motion(Vector3d::Zero(), Vector3d::Zero(), kDt_s);
    Random random(1);
    Filter filter(world.camera);
    for (int k = 0; k < 40; ++k) {
      Corners corners = world.corners();
      for (Vector2f& x : corners) x += random.vector(0.7).head<2>().cast<float>();
      const FrameResult& result = filter.step(rounded(corners), k == 0 ? EgoMotion{} : motion);
      EXPECT_EQ(rebels(result), 0) << "every " << spacing << " px, frame " << k;
    }
  }
}

/// As with another detector or camera: the filter first assumes a noise of 0.35 px.
TEST(HypothesisEdges, CornersOfAnyExactnessStandBeforeACameraThatDrives) {
  for (const double half_px : {0.0, 1.0, 2.0, 4.0}) {
    World world = sparse_world(8, 40);
    const EgoMotion motion = steady_motion({0.1, 0, 0.3}, {0, 0.02, 0}, kDt_s);
    Random random(1);
    Filter filter(world.camera);
    std::size_t called = 0, seen = 0;
    for (std::size_t k = 0; k < 40; ++k) {
      Corners corners = world.corners();
      for (Vector2f& x : corners) x += random.vector(half_px).head<2>().cast<float>();
      const FrameResult& result =
          filter.step(corners, world.signatures(k), k == 0 ? EgoMotion{} : motion);
      world.advance(motion);
      if (k < 10) continue;
      called += static_cast<std::size_t>(rebels(result));
      seen += corners.size();
    }
    EXPECT_LE(100 * called, seen) << half_px << " px: " << called << " of " << seen;
  }
}

/// A background, and twelve close corners that cross it, before a moving or standing camera, with
/// and without signatures.
TEST(HypothesisEdges, APatchThatCrossesIsCalledAndTheBackgroundIsNot) {
  for (const double speed_mps : {0.0, 0.3}) {
    for (const bool looks : {false, true}) {
      World world = sparse_world(4, 40);
      for (int i = 0; i < 12; ++i) {
        world.add({500 + 11 * (i % 4) + 3 * (i / 4), 200 + 13 * (i / 4) + 2 * (i % 4)}, 3,
                  {-0.6, 0.05, 0});
      }
      const EgoMotion motion = steady_motion({0, 0, speed_mps}, {0, 0.02, 0}, kDt_s);
      Filter filter(world.camera);
      for (std::size_t k = 0; k < 12; ++k) {
        SCOPED_TRACE(::testing::Message()
                     << speed_mps << " m/s, frame " << k << (looks ? ", signatures" : ""));
        const Corners corners = rounded(world.corners());
        const EgoMotion told = k == 0 ? EgoMotion{} : motion;
        const FrameResult& result =
            looks ? filter.step(corners, world.signatures(k), told) : filter.step(corners, told);
        world.advance(motion);
        if (k < 3) continue;
        const std::size_t patch = corners.size() - 12;
        EXPECT_GE(rebels(result, patch, corners.size()), 10);
        // The patch does not occlude here: background inside it, or beside it for the first time,
        // may be taken for a part of it.
        EXPECT_LE(rebels(result, 0, patch), 2);
        for (std::size_t i = 0; i < patch; ++i) {
          const bool apart = std::all_of(corners.begin() + static_cast<std::ptrdiff_t>(patch),
                                         corners.end(), [&](const Vector2f& x) {
                                           return (x - corners[i]).norm() >
                                                  static_cast<float>(2 * kUsual.neighbour_reach_px);
                                         });
          EXPECT_FALSE(apart && result.verdicts[i] == Verdict::rebel) << corners[i].transpose();
        }
      }
    }
  }
}

TEST(HypothesisEdges, ACornerThatNobodyKnowsIsNotCalled) {
  // First frames, and later a new corner far from all others.
  Filter filter(vga());
  const EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), kDt_s);
  for (int k = 0; k < 3; ++k) {
    const Corners corners(1, Vector2f(100 + 200 * k, 200));
    const FrameResult& result = filter.step(corners, k == 0 ? EgoMotion{} : motion);
    EXPECT_EQ(result.verdicts[0], Verdict::pending);
    EXPECT_EQ(result.reasons[0], Reason::first_sighting);
  }
}

TEST(HypothesisEdges, ACornerSeenOnceIsWhatTheNearestEdgeIs) {
  // Five cross by 8 px a frame before a standing camera, towards five static ones.
  const Corners moving = {{200, 200}, {209, 197}, {204, 211}, {219, 206}, {213, 217}};
  const Corners standing = {{269, 206}, {278, 199}, {284, 210}, {275, 217}, {290, 204}};
  const Vector2f by_a_mover(255, 206), by_what_stands(265, 206), halfway(260, 206),
      by_none(500, 400);
  const EgoMotion motion = steady_motion({0, 0, 0}, Vector3d::Zero(), kDt_s);
  for (const bool movers_first : {true, false}) {
    SCOPED_TRACE(movers_first ? "movers first" : "movers last");
    Filter filter(vga());
    FrameResult result;
    for (int k = 0; k < 5; ++k) {
      Corners movers = moving, corners = standing;
      for (Vector2f& x : movers) x.x() += static_cast<float>(8 * k);
      corners.insert(movers_first ? corners.begin() : corners.end(), movers.begin(), movers.end());
      if (k == 4) corners.insert(corners.end(), {by_a_mover, by_what_stands, halfway, by_none});
      result = filter.step(corners, k == 0 ? EgoMotion{} : motion);
    }
    const std::vector<Reason> reasons(result.reasons.end() - 4, result.reasons.end());
    EXPECT_EQ(reasons[0], Reason::inherited);
    EXPECT_EQ(reasons[1], Reason::first_sighting);
    EXPECT_EQ(reasons[2], Reason::inherited) << "of equally near ones the mover";
    EXPECT_EQ(reasons[3], Reason::first_sighting);
  }
}

TEST(HypothesisEdges, SayTheSameAgainAndWhateverTheOrderOfTheCorners) {
  Scene scene(2);
  Filter first(vga()), second(vga());
  Filter backward(vga());
  std::ptrdiff_t found = 0;
  for (std::size_t k = 0; k < 10; ++k) {
    const EgoMotion motion = k == 0 ? EgoMotion{} : scene.motion;
    Corners corners = scene.world.corners();
    std::vector<Signature> signatures = scene.world.signatures(k);
    const FrameResult& a = first.step(corners, signatures, motion);
    expect_same(a, second.step(corners, signatures, motion), k);
    std::reverse(corners.begin(), corners.end());
    std::reverse(signatures.begin(), signatures.end());
    FrameResult reversed = backward.step(corners, signatures, motion);
    std::reverse(reversed.verdicts.begin(), reversed.verdicts.end());
    std::reverse(reversed.reasons.begin(), reversed.reasons.end());
    expect_same(a, reversed, k);
    found += rebels(a);
    scene.world.advance(scene.motion);
  }
  EXPECT_GT(found, 20) << "or there is little to compare";
}

TEST(HypothesisEdges, ForgetAllWhereTheyStartAnew) {
  Scene scene(6);
  const auto frames = record(scene, 12);
  // A time step of zero, and an unknown time step.
  for (const double dt_s : {0.0, std::nan("")}) {
    Filter used(vga()), fresh(vga());
    std::ptrdiff_t found = 0;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      EgoMotion motion = scene.motion;
      if (k == 0 || k == 6) motion = {};
      if (k == 6) motion.dt_s = dt_s;
      const FrameResult& result = used.step(frames[k], motion);
      found += rebels(result);
      if (k < 6) continue;
      const FrameResult& expected = fresh.step(frames[k], motion);
      ASSERT_EQ(result.verdicts, expected.verdicts) << "frame " << k;
      ASSERT_EQ(result.reasons, expected.reasons) << "frame " << k;
      ASSERT_EQ(result.layers.normal_edges.size(), expected.layers.normal_edges.size());
      for (std::size_t i = 0; i < expected.layers.normal_edges.size(); ++i)
        EXPECT_EQ(result.layers.normal_edges[i].speed, expected.layers.normal_edges[i].speed);
      if (std::isnan(dt_s)) expect_same(result, expected, k);  // circles and squares are equal, too
      if (k > 6) continue;
      EXPECT_TRUE(result.layers.normal_edges.empty() && result.layers.rebel_edges.empty());
      for (const Reason reason : result.reasons) EXPECT_EQ(reason, Reason::first_sighting);
      for (const Verdict verdict : result.verdicts) EXPECT_EQ(verdict, Verdict::pending);
    }
    EXPECT_GT(found, 0) << "or there is nothing to forget";
  }
}

}  // namespace
}  // namespace lcs
