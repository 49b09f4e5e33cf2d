/// Which corner continues which track, and what neighbours make each other believe.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "filter/edges/association.h"
#include "filter/edges/coupling.h"
#include "filter/edges/edge_parameters.h"
#include "filter/edges/gauss.h"
#include "filter/edges/neighbourhood.h"
#include "filter/edges/tracks.h"
#include "filter/kinematics/camera.h"
#include "filter/kinematics/geometry.h"
#include "filter/kinematics/motion_field.h"
#include "filter/line/line.h"
#include "filter/types/signature.h"
#include "tests/filter/hypotheses_support.h"
#include "tests/filter/scalar_track.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector3d;
using testing::density;
using testing::gauss;
using testing::kDt_s;
using testing::kNoise2_px2;
using testing::kUsual;
using testing::OwnMotion;
using testing::Random;
using testing::StaticPoint;
using testing::steady_motion;
using testing::Track;
using testing::vga;

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
  const MotionField still(vga(), steady_motion(Vector3d::Zero(), Vector3d::Zero(), kDt_s), {});
  TrackFrame frame = track_frame(vga(), still, parameters);
  frame.noise2_px2 = static_cast<float>(kNoise2_px2);
  Tracks predicted = testing::columns_of(tracks);
  std::vector<int> track_of = Association(parameters).match(chi, around, predicted, frame);
  track_of.resize(chi.size());
  return track_of;
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

TEST(Association, AgreementOfNeighboursBeatsANearerChanceMatch) {
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
  EXPECT_DOUBLE_EQ(parameters.reach_px(0.02), 12);
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
  return Coupling(parameters).settle(nodes, around, kNoise2_px2, parameters.coupling);
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

/// The neighbours add less than the log odds of a corner whose own sightings are sure.
TEST(Coupling, ACornerThatIsSurelyStaticStaysSoAmongAnyNumberOfSureMovers) {
  for (const double dt_s : {0.03, 0.1, 1.0}) {
    const double most = kUsual.most_log_odds(dt_s);
    for (const int movers : {1, 3, 30}) {
      std::vector<Coupling::Node> nodes = {node(300, -most)};
      for (int i = 0; i < movers; ++i) nodes.push_back(node(301 + i % 8, 50));
      std::vector<Vec2> places;
      for (const Coupling::Node& node : nodes) places.push_back(node.place_px);
      Neighbourhood around;
      around.build(places, kUsual.neighbour_reach_px, kUsual.neighbours);
      const double m =
          Coupling(kUsual).settle(nodes, around, kNoise2_px2, std::min(kUsual.coupling, most))[0];
      EXPECT_LT(m, 0) << dt_s << " s, " << movers << " movers";
    }
  }
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

}  // namespace
}  // namespace lcs
