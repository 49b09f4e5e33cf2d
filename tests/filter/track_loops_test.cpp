/// The loops over columns of tracks: against the track in plain numbers of double precision
/// (`scalar_track.h`), and this machine's loops against plain ones, bit by bit.
#include "filter/edges/track_loops.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "filter/edges/edge_parameters.h"
#include "filter/edges/gauss.h"
#include "filter/edges/tracks.h"
#include "filter/kinematics/camera.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/kinematics/motion_field.h"
#include "tests/filter/scalar_track.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector3d;
using testing::gauss;
using testing::Noise;
using testing::Random;
using testing::StaticPoint;
using testing::steady_motion;
using testing::Track;
using testing::vga;

const std::vector<const TrackLoops*> kWays = {&track_loops(), &plain_track_loops()};
constexpr double kDt_s = 0.1;
constexpr Noise kNoise = {0.3, 0.4};
const EdgeParameters kUsual;

/// Corners in the picture of a moving camera, some of which move by themselves, as tracks that the
/// plain numbers have followed for some frames. Each lies at its own depth.
struct Followed {
  Followed(std::uint64_t seed, bool with_ground) : random(seed) {
    motion = steady_motion({0.3, -0.1, random.uniform(-1, 2)}, random.vector(0.3), kDt_s);
    if (with_ground) motion.ground = Ground{.up_C = {0.05, -0.99, 0.1}, .height_m = 0.8};
    field.emplace(vga(), motion, FieldParameters{});
    for (int i = 0; i < 403; ++i) {
      Track track;
      track.place_px = {random.uniform(20, 620), random.uniform(20, 460)};
      track.sightings = 1;
      track.belief = random.uniform(-6, 6);
      const int frames = i % 7;
      double inverse_depth_pm = random.uniform(0.02, 1);
      const Vec2 own_px = i % 3 == 0 ? Vec2(random.vector(8).head<2>()) : Vec2(Vec2::Zero());
      for (int k = 0; k < frames; ++k) {
        track = testing::predicted(track, vga(), *field, kUsual, kNoise);
        if (random.uniform(0, 1) < 0.2) continue;  // not seen
        testing::see(track, seen(track, inverse_depth_pm) + own_px, 1e-5, vga(), *field, kUsual,
                     kNoise);
      }
      own_px_.push_back(own_px);
      depths_pm_.push_back(inverse_depth_pm);
      tracks.push_back(track);
    }
  }

  /// A place near that of a static point.
  Vec2 seen(const Track& predicted, double inverse_depth_pm) {
    const Vec2 flow_px = inverse_depth_pm * field->parallax_px_m(predicted.place_px);
    return predicted.place_px + flow_px + random.vector(0.7).head<2>();
  }
  Vec2 next(std::size_t i, const Track& predicted) {
    return seen(predicted, depths_pm_[i]) + own_px_[i];
  }
  TrackFrame frame() const {
    TrackFrame frame = track_frame(vga(), *field, kUsual);
    frame.last_noise2_px2 = static_cast<float>(kNoise.last_px2);
    frame.noise2_px2 = static_cast<float>(kNoise.now_px2);
    return frame;
  }

  Random random;
  EgoMotion motion;
  std::optional<MotionField> field;
  std::vector<Track> tracks;

 private:
  std::vector<Vec2> own_px_;
  std::vector<double> depths_pm_;
};

Tracks predicted_by(const TrackLoops& way, const Followed& one) {
  const Tracks before = testing::columns_of(one.tracks);
  Tracks after = testing::columns_of(one.tracks);
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> homography =
      one.field->homography()->cast<float>();
  for (const TrackColumn x : {kPlaceX, kStaticX, kMovingX}) {
    way.rotate(homography.data(), before.columns[x], before.columns[x + 1], before.size(),
               after.columns[x], after.columns[x + 1]);
  }
  way.predict(one.frame(), before.columns.data(), before.size(), after.columns.data());
  return after;
}

/// Places differ by rounding of coordinates of some 600 px, which are known to 3e-5 px; other
/// numbers by some roundings of 6e-8, which the ratios of standard deviations multiply.
void expect_near(const Track& is, const Track& should, const std::string& what) {
  const auto expect_same_point = [&](const StaticPoint& a, const StaticPoint& b) {
    EXPECT_LT((a.place_px - b.place_px).norm(), 2e-3) << what;
    const double sigma = std::sqrt(b.covariance(2, 2));
    EXPECT_NEAR(a.inverse_depth_pm, b.inverse_depth_pm, 1e-3 * sigma + 1e-6) << what;
    const Vector3d scale = b.covariance.diagonal().cwiseSqrt();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        EXPECT_NEAR(a.covariance(row, column), b.covariance(row, column),
                    1e-3 * scale(row) * scale(column))
            << what << " " << row << " " << column;
      }
    }
  };
  expect_same_point(is.as_static, should.as_static);
  EXPECT_LT((is.place_px - should.place_px).norm(), 2e-4) << what;
  EXPECT_EQ(is.sightings, should.sightings) << what;
  EXPECT_NEAR(is.since_s, should.since_s, 1e-6) << what;
  EXPECT_LT((is.displacement_C_m - should.displacement_C_m).norm(), 1e-6) << what;
  if (!should.has_motion()) return;
  EXPECT_LT((is.as_moving.place_px - should.as_moving.place_px).norm(), 1e-3) << what;
  EXPECT_LT((is.as_moving.velocity_pxps - should.as_moving.velocity_pxps).norm(), 1e-2) << what;
  const Eigen::Matrix2d& C = should.as_moving.covariance;
  const Vec2 scale = C.diagonal().cwiseSqrt();
  const Eigen::Matrix2d off = is.as_moving.covariance - C;
  EXPECT_LT((off.array() / (scale * scale.transpose()).array()).abs().maxCoeff(), 1e-4) << what;
}

TEST(TrackLoops, PredictAsPlainNumbersDo) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const Followed one(seed, seed % 2 == 0);
    for (const TrackLoops* way : kWays) {
      const Tracks after = predicted_by(*way, one);
      for (std::size_t i = 0; i < one.tracks.size(); ++i) {
        const Track should = testing::predicted(one.tracks[i], vga(), *one.field, kUsual, kNoise);
        expect_near(testing::track_of(after, i), should, std::to_string(i));
      }
    }
  }
}

/// What the corners of a frame are to the loops. Every fifth has no track.
struct Corners {
  explicit Corners(Followed& one) {
    const std::size_t room = one.tracks.size() + kLanes;
    for (std::vector<float>* column : {&x, &y, &chance, &crowd}) column->resize(room, 1);
    track_of.resize(room, -1);
    for (std::size_t c = 0; c < one.tracks.size(); ++c) {
      const std::size_t t = one.tracks.size() - 1 - c;
      const Track next = testing::predicted(one.tracks[t], vga(), *one.field, kUsual, kNoise);
      // Some are wrong matches.
      const Vec2 px =
          c % 11 == 0 ? Vec2(next.place_px + one.random.vector(60).head<2>()) : one.next(t, next);
      x[c] = static_cast<float>(px.x());
      y[c] = static_cast<float>(px.y());
      chance[c] = static_cast<float>(one.random.uniform(0, 1e-4));
      crowd[c] = static_cast<float>(1 + c % 9);
      if (c % 5 > 0) track_of[c] = static_cast<int>(t);
    }
  }
  Sightings seen() const {
    return {x.data(), y.data(), track_of.data(), chance.data(), crowd.data()};
  }
  Vec2 place(std::size_t c) const { return {x[c], y[c]}; }
  /// Corners whose tracks may correct the motion, and `kLanes` numbers that are none.
  std::vector<int> asked(const Tracks& predicted, bool started) const {
    std::vector<int> asked;
    for (std::size_t c = 0; c < track_of.size(); ++c) {
      const int t = track_of[c];
      if (t < 0 || (started && !predicted.has_motion(static_cast<std::size_t>(t)))) continue;
      asked.push_back(static_cast<int>(c));
    }
    asked.resize(asked.size() + kLanes, -1);
    return asked;
  }

  std::vector<float> x, y, chance, crowd;
  std::vector<int> track_of;
};

TEST(TrackLoops, SeeAsPlainNumbersDo) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    Followed one(seed, seed % 2 == 0);
    const Corners corners(one);
    const std::size_t count = one.tracks.size();
    for (const TrackLoops* way : kWays) {
      const Tracks predicted = predicted_by(*way, one);
      Tracks after;
      after.columns.make(count);
      std::vector<int> kept(count + kLanes);
      const Misses misses = way->see(one.frame(), predicted.columns.data(), corners.seen(), count,
                                     after.columns.data(), kept.data());
      int continued = 0;
      for (std::size_t c = 0; c < count; ++c) {
        const Track is = testing::track_of(after, c);
        EXPECT_EQ(is.place_px, corners.place(c));
        Track should;
        const bool has_track = corners.track_of[c] >= 0;
        if (has_track) {
          should = testing::track_of(predicted, static_cast<std::size_t>(corners.track_of[c]));
        }
        if (!has_track || !testing::see(should, corners.place(c), corners.chance[c], vga(),
                                        *one.field, kUsual, kNoise)) {
          EXPECT_EQ(kept[c], 0) << c;
          EXPECT_EQ(is.sightings, 1) << c;
          EXPECT_EQ(is.log_odds, 0) << c;
          continue;
        }
        ++continued;
        EXPECT_NE(kept[c], 0) << c;
        expect_near(is, should, std::to_string(c));
        EXPECT_NEAR(is.log_odds, should.log_odds, 5e-3) << c;
        EXPECT_NEAR(is.noise_sum_px2, should.noise_sum_px2, 1e-3 * (1 + should.noise_sum_px2));
        EXPECT_NEAR(is.noise_weight, should.noise_weight, 2e-3) << c;
      }
      EXPECT_GT(continued, 200) << "or the test says nothing";
      EXPECT_GT(misses.weight, 50);
      EXPECT_LT(misses.sum_px2 / misses.weight, 5);
    }
  }
}

TEST(TrackLoops, ShowAsPlainNumbersDo) {
  for (const std::uint64_t seed : {5, 6}) {
    Followed one(seed, seed % 2 == 0);
    const Corners corners(one);
    const Tracks tracks = testing::columns_of(one.tracks);
    std::vector<float> shown(one.tracks.size() + kLanes);
    for (const TrackLoops* way : kWays) {
      way->show(one.frame(), tracks.columns.data(), corners.crowd.data(), one.tracks.size(),
                shown.data());
      int changed = 0;
      for (std::size_t i = 0; i < one.tracks.size(); ++i) {
        const double should = testing::shown(one.tracks[i], vga(), *one.field, kUsual,
                                             corners.crowd[i], kNoise.now_px2);
        EXPECT_NEAR(shown[i], should, 1e-3) << i;
        changed += std::abs(should - one.tracks[i].log_odds) > 0.1;
      }
      EXPECT_GT(changed, 10) << "or the test says nothing";
    }
  }
}

/// (6), by the covariances.
TEST(TrackLoops, DensitiesAreThoseOfTheFormula) {
  const Followed one(7, true);
  const double t = kUsual.turnover(kDt_s), anywhere = 1 / kUsual.reach_area_px2(kDt_s);
  for (const TrackLoops* way : kWays) {
    Tracks predicted = predicted_by(*way, one);
    way->expect(one.frame(), predicted.size(), predicted.columns.data());
    const std::size_t count = predicted.size();
    for (const Vec2& off_px : {Vec2(0, 0), Vec2(2, -1), Vec2(40, 30)}) {
      std::vector<int> which(count + kLanes, -1);  // behind the tracks, which no loop reads
      std::vector<float> ln_density(count + kLanes), ln_off(count + kLanes);
      for (std::size_t i = 0; i < count; ++i) {
        const Track track = testing::track_of(predicted, i);
        const Eigen::Vector2f x = (track.as_static.place_px + off_px).cast<float>();
        which[0] = static_cast<int>(i);
        way->densities(predicted.columns.data(), which.data(), 1, x.x(), x.y(), ln_density.data(),
                       ln_off.data());
        const double moves = chance(track.belief);
        const Vec2 still_off = x.cast<double>() - track.as_static.place_px;
        const Eigen::Matrix2d S = track.as_static.spread(kNoise.now_px2);
        const double still = gauss(still_off, S);
        const double moving = track.has_motion()
                                  ? track.as_moving.density(x.cast<double>(), kNoise.now_px2)
                                  : anywhere;
        const double all = (1 - t) * ((1 - moves) * still + moves * moving) + t * anywhere;
        EXPECT_NEAR(ln_density[0], std::log(all), 5e-3) << i;
        double off = -0.5 * distance2(still_off, S);
        if (track.has_motion()) {
          const double variance = track.as_moving.covariance(0, 0) + kNoise.now_px2;
          off = std::max(
              off, -0.5 * (x.cast<double>() - track.as_moving.place_px).squaredNorm() / variance);
        }
        EXPECT_NEAR(ln_off[0], off, 1e-2 * (0.1 - off)) << i;
      }
    }
  }
}

/// (8), by the covariances.
TEST(TrackLoops, MissesAreThoseOfTheFormula) {
  constexpr float kVariance_m2ps2 = 4e-4F;
  for (const bool started : {true, false}) {
    Followed one(8, true);
    const Corners corners(one);
    const std::size_t count = one.tracks.size();
    const double anywhere = 1 / kUsual.reach_area_px2(kDt_s);
    for (const TrackLoops* way : kWays) {
      const Tracks predicted = predicted_by(*way, one);
      Columns<float, kMissColumns> misses;
      misses.make(count);
      const std::vector<int> asked = corners.asked(predicted, started);
      way->misses(one.frame(), predicted.columns.data(), corners.seen(), asked.data(),
                  asked.size() - kLanes, started, kVariance_m2ps2, misses.data());
      EXPECT_GT(asked.size(), 100u) << "or the test says nothing";
      for (std::size_t i = 0; i + kLanes < asked.size(); ++i) {
        const auto c = static_cast<std::size_t>(asked[i]);
        const int t = corners.track_of[c];
        const Track track = testing::track_of(predicted, static_cast<std::size_t>(t));
        const StaticPoint& point = track.as_static;
        const Vec2 x = corners.place(c);
        StaticPoint seen = point;
        if (!started) seen.update(x, kNoise.now_px2, testing::depth_bounds(*one.field, x));
        const double moves = chance(track.belief);
        const testing::Residual residual = {
            point.place_px,
            x - point.place_px,
            point.spread(kNoise.now_px2),
            testing::depth_bounds(*one.field, point.place_px).half_pm() *
                one.field->parallax_px_m(point.place_px),
            seen.inverse_depth_pm,
            seen.covariance(2, 2),
            1.0 / corners.crowd[c],
            1 - moves,
            moves * (started ? track.as_moving.density(x, kNoise.now_px2) : anywhere) + anywhere};
        const auto should =
            testing::columns_of(std::span(&residual, 1), vga(), kDt_s, kVariance_m2ps2);
        for (std::size_t column = 0; column < kMissColumns; ++column) {
          const double is = misses[column][i], known = should[column][0];
          EXPECT_NEAR(is, known, 1e-3 * std::abs(known) + 1e-5) << column << " of " << c;
        }
      }
    }
  }
}

TEST(TrackLoops, PointsTurnedBehindTheCameraKeepTheirPlaces) {
  const MotionField field(vga(), steady_motion({0, 0, 1}, {0, 20, 0}, kDt_s), {});
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> homography = field.homography()->cast<float>();
  std::vector<float> x, y, to_x(16 + kLanes), to_y(16 + kLanes);
  for (std::size_t i = 0; i < 16 + kLanes; ++i) {
    x.push_back(40.0F * static_cast<float>(i));
    y.push_back(200);
  }
  for (const TrackLoops* way : kWays) {
    way->rotate(homography.data(), x.data(), y.data(), 16, to_x.data(), to_y.data());
    for (std::size_t i = 0; i < 16; ++i) {
      const Vec2 should = field.rotated({x[i], y[i]});
      EXPECT_NEAR(to_x[i], should.x(), 1e-5 * (100 + should.norm())) << i;
      EXPECT_NEAR(to_y[i], should.y(), 1e-5 * (100 + should.norm())) << i;
    }
  }
}

TEST(TrackLoops, HaveTheSameBitsOnAnyMachine) {
  Followed one(9, true);
  const Corners corners(one);
  const std::size_t count = one.tracks.size();
  std::vector<std::vector<float>> states;
  std::vector<std::vector<double>> sums;
  for (const TrackLoops* way : kWays) {
    Tracks predicted = predicted_by(*way, one);
    way->expect(one.frame(), count, predicted.columns.data());
    Tracks after;
    after.columns.make(count);
    std::vector<int> kept(count + kLanes);
    const Misses miss = way->see(one.frame(), predicted.columns.data(), corners.seen(), count,
                                 after.columns.data(), kept.data());
    std::vector<float>& state = states.emplace_back();
    state = {miss.sum_px2, miss.weight};
    for (std::size_t column = 0; column < kTrackColumns; ++column) {
      state.insert(state.end(), predicted.columns[column], predicted.columns[column] + count);
      if (column >= kStaticPxx && column <= kAnywhere) continue;  // of predictions only
      state.insert(state.end(), after.columns[column], after.columns[column] + count);
    }
    std::vector<float> shown(count + kLanes), off2(count + kLanes);
    way->show(one.frame(), after.columns.data(), corners.crowd.data(), count, shown.data());
    way->off_segment(one.frame(), predicted.columns.data(), corners.seen(), count, off2.data());
    state.insert(state.end(), shown.begin(), shown.begin() + static_cast<std::ptrdiff_t>(count));
    state.insert(state.end(), off2.begin(), off2.begin() + static_cast<std::ptrdiff_t>(count));
    Columns<float, kMissColumns> misses;
    misses.make(count);
    const std::vector<int> asked = corners.asked(predicted, true);
    way->misses(one.frame(), predicted.columns.data(), corners.seen(), asked.data(),
                asked.size() - kLanes, true, 4e-4F, misses.data());
    const std::vector<float> fix(6, 1e-3F), root(21, 1e-3F);
    NormalSums sum;
    way->normal_sums(misses.data(), asked.size() - kLanes, 400, fix.data(), root.data(), sum);
    const Agreement agreement = way->agree(misses.data(), asked.size() - kLanes);
    sums.push_back({agreement.left, agreement.stood, agreement.all});
    sums.back().insert(sums.back().end(), std::begin(sum.information), std::end(sum.information));
    sums.back().insert(sums.back().end(), std::begin(sum.pull), std::end(sum.pull));
    EXPECT_GT(sum.information[0], 0);
    EXPECT_GT(agreement.stood, 0);
  }
  EXPECT_EQ(states[0], states[1]);
  EXPECT_EQ(sums[0], sums[1]);
}

}  // namespace
}  // namespace lcs
