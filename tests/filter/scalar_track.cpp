#include "tests/filter/scalar_track.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "filter/kinematics/geometry.h"
#include "filter/matching/point_grid.h"

namespace lcs::testing {
namespace {

/// Relative standard deviation of the given height above the ground.
constexpr double kWrongHeight = 0.1;
/// No static point lies more than this many standard deviations below the ground.
constexpr double kFarBelow = 2;

/// Probability of a normal variable between the bounds; never 0, as it is a divisor.
double mass(double mean, double variance, const DepthBounds& bounds) {
  const double sigma = std::sqrt(variance);
  // Infinite depth (w = 0) is a sharp bound, the ground an uncertain one.
  const double least = std::max(
      -mean / sigma, (bounds.ground_pm - mean) / Vec2(sigma, bounds.ground_sigma_pm).norm());
  return std::max(1e-12, below((bounds.most_pm - mean) / sigma) - below(least));
}

/// 1/z_min.
double nearest_pm(const MotionField& field) {
  return field.max_ratio() / field.reference_depth_m();
}

/// Covariance of an image motion under a relative error of the velocity: the error along the
/// motion, half of it across.
Eigen::Matrix2d wrong_flow(const Vec2& flow_px, double ego_share) {
  return ego_share * ego_share *
         (0.75 * flow_px * flow_px.transpose() +
          0.25 * flow_px.squaredNorm() * Eigen::Matrix2d::Identity());
}

}  // namespace

Vec2 parallax_px_m(const Intrinsics& camera, const Eigen::Vector3d& displacement_C_m,
                   const Vec2& rotated_px) {
  return (rotated_px - camera.centre_px) * displacement_C_m.z() -
         camera.focal_px * displacement_C_m.head<2>();
}

DepthBounds depth_bounds(const MotionField& field, const Vec2& x_px) {
  DepthBounds bounds;
  bounds.most_pm = nearest_pm(field);
  const auto ground = field.ground_ratio(x_px);
  if (!ground || *ground <= 0) return bounds;
  bounds.ground_pm = *ground / field.reference_depth_m();
  bounds.ground_sigma_pm =
      Vec2(field.ground_slack() / field.reference_depth_m(), kWrongHeight * bounds.ground_pm)
          .norm();
  bounds.least_pm =
      std::clamp(bounds.ground_pm - kFarBelow * bounds.ground_sigma_pm, 0.0, 0.95 * bounds.most_pm);
  return bounds;
}

StaticPoint StaticPoint::seen_once(const Vec2& rotated_px, const Intrinsics& camera,
                                   const MotionField& field,
                                   const Eigen::Vector3d& displacement_C_m, double noise2_px2) {
  const DepthBounds bounds = depth_bounds(field, rotated_px);
  const double half = bounds.half_pm();
  const Vec2 parallax = parallax_px_m(camera, displacement_C_m, rotated_px);
  StaticPoint point;
  point.inverse_depth_pm = bounds.least_pm + half;
  point.place_px = rotated_px + point.inverse_depth_pm * parallax;
  Eigen::Vector3d by_depth;
  by_depth << parallax, 1;
  point.covariance = half * half * by_depth * by_depth.transpose();
  point.covariance.topLeftCorner<2, 2>() += noise2_px2 * Eigen::Matrix2d::Identity();
  return point;
}

StaticPoint::Step StaticPoint::move(const StaticPoint& before, const Intrinsics& camera,
                                    const MotionField& field) {
  const Eigen::Vector3d d = field.displacement_C_m();
  Step step;
  step.rotated_px = field.rotated(before.place_px);
  const Vec2 h = step.rotated_px - camera.centre_px, shift = camera.focal_px * d.head<2>();
  // A point that the camera passes within the frame is put at z_min. A point turned behind the
  // camera has no image and keeps its place and inverse depth.
  const double nearest = nearest_pm(field);
  const Vec2 ray = (before.place_px - camera.centre_px) / camera.focal_px;
  const double Z = field.R_cur_prev().row(2).dot(ray.homogeneous());  // Z after R / Z before
  const double turned = Z > 0 ? std::max(before.inverse_depth_pm / nearest, Z) : 1;
  const double w = before.inverse_depth_pm / turned;
  const double nearing = std::max(w / nearest, 1 - w * d.z());
  place_px = camera.centre_px + (h - w * shift) / nearing;
  inverse_depth_pm = w / nearing;
  step.a = 1 / nearing;
  step.c = step.a * step.a / turned;
  step.b = step.c * (h * d.z() - shift);
  return step;
}

StaticPoint StaticPoint::predicted(const Intrinsics& camera, const MotionField& field,
                                   double ego_share) const {
  StaticPoint next;
  const auto [rotated, a, b, c] = next.move(*this, camera, field);
  // F C F^T, with the derivatives F = [a I, b; 0, c].
  const double C_ww = covariance(2, 2);
  const Vec2 C_xw = covariance.topRightCorner<2, 1>(), next_xw = a * C_xw + C_ww * b;
  next.covariance.topLeftCorner<2, 2>() = a * a * covariance.topLeftCorner<2, 2>() +
                                          a * C_xw * b.transpose() + b * next_xw.transpose() +
                                          wrong_flow(next.place_px - rotated, ego_share);
  next.covariance.topRightCorner<2, 1>() = c * next_xw;
  next.covariance.bottomLeftCorner<1, 2>() = c * next_xw.transpose();
  next.covariance(2, 2) = c * c * C_ww;
  return next;
}

Eigen::Matrix2d StaticPoint::spread(double noise2_px2) const {
  return covariance.topLeftCorner<2, 2>() + noise2_px2 * Eigen::Matrix2d::Identity();
}

double StaticPoint::update(const Vec2& x_px, double noise2_px2, const DepthBounds& bounds) {
  const Eigen::Matrix2d S = spread(noise2_px2);
  const Vec2 residual = x_px - place_px;
  const double before = mass(inverse_depth_pm, covariance(2, 2), bounds);
  const Eigen::Matrix<double, 3, 2> gain = covariance.leftCols<2>() * S.inverse();
  const Eigen::Vector3d change = gain * residual;
  place_px += change.head<2>();
  inverse_depth_pm += change.z();
  // Joseph's form keeps the covariance positive definite.
  Eigen::Matrix3d kept = Eigen::Matrix3d::Identity();
  kept.leftCols<2>() -= gain;
  covariance = kept * covariance * kept.transpose() + noise2_px2 * gain * gain.transpose();
  const double after = mass(inverse_depth_pm, covariance(2, 2), bounds);
  // If w is out of bounds: the likeliest point within them.
  const double bounded = std::clamp(inverse_depth_pm, bounds.least_pm, bounds.most_pm);
  place_px += covariance.col(2).head<2>() / covariance(2, 2) * (bounded - inverse_depth_pm);
  inverse_depth_pm = bounded;
  return gauss(residual, S) * std::min(1.0, after / std::max(1e-6, before));
}

OwnMotion OwnMotion::first(const Vec2& before_px, const Vec2& x_px, double noise2_px2,
                           double dt_s) {
  OwnMotion motion;
  motion.place_px = x_px;
  motion.velocity_pxps = (x_px - before_px) / dt_s;
  motion.covariance << 1, 1 / dt_s, 1 / dt_s, 2 / (dt_s * dt_s);
  motion.covariance *= noise2_px2;
  return motion;
}

OwnMotion OwnMotion::predicted(const MotionField& field, double acceleration) const {
  const double dt = field.dt_s();
  OwnMotion next;
  next.place_px = moved(field);
  next.velocity_pxps = velocity_pxps;
  Eigen::Matrix2d F;
  F << 1, dt, 0, 1;
  // Velocity as a random walk: the variances of velocity and place at the frame's end.
  const double change2 = acceleration * acceleration * dt * dt * velocity_pxps.squaredNorm();
  Eigen::Matrix2d Q;
  Q << dt * dt / 3, dt / 2, dt / 2, 1;
  next.covariance = F * covariance * F.transpose() + change2 * Q;
  return next;
}

void OwnMotion::update(const Vec2& x_px, double noise2_px2) {
  const double S = covariance(0, 0) + noise2_px2;
  const Eigen::Vector2d gain = covariance.col(0) / S;
  const Vec2 residual = x_px - place_px;
  place_px += gain.x() * residual;
  velocity_pxps += gain.y() * residual;
  covariance -= gain * S * gain.transpose();
}

double OwnMotion::density(const Vec2& x_px, double noise2_px2) const {
  return gauss(x_px - place_px, covariance(0, 0) + noise2_px2);
}

Step::Step(const Vec2& step_px, const Vec2& parallax_px_m, const DepthBounds& bounds) {
  const double length = parallax_px_m.norm();
  const Vec2 direction = length > 1e-9 ? Vec2(parallax_px_m / length) : Vec2::UnitX();
  segment_px = (bounds.most_pm - bounds.least_pm) * length;
  farthest_px = bounds.least_pm * length;
  along_px = step_px.dot(direction) - farthest_px;
  across_px = cross(direction, step_px);
}

double Step::density_of_mover(double reach_px, double noise2_px2) const {
  const double a = along_px, s2 = across_px * across_px + 2 * noise2_px2, s = std::sqrt(s2);
  const double orders = std::log(1 + reach_px * reach_px / (2 * noise2_px2));
  return segment_px > 1e-6 * s
             ? (std::atan((segment_px - a) / s) + std::atan(a / s)) /
                   (segment_px * kPi * orders * s)
             : 1 / (kPi * orders * (s2 + (a - segment_px / 2) * (a - segment_px / 2)));
}

double Step::density_of_crossing(double slide, double step_variance_px2) const {
  if (!(segment_px > 1e-6)) return 0;  // without parallax nothing slides
  const double nearest = std::clamp(along_px, 0.0, segment_px);
  const double off2 = across_px * across_px + (along_px - nearest) * (along_px - nearest);
  const double way = slide * (farthest_px + nearest), s2 = way * way + step_variance_px2;
  return std::exp(-0.5 * off2 / s2) / (std::sqrt(2 * kPi * s2) * segment_px);
}

Track predicted(const Track& track, const Intrinsics& camera, const MotionField& field,
                const EdgeParameters& parameters, const Noise& noise) {
  Track next = track;
  next.place_px = field.rotated(track.place_px);
  next.since_s += field.dt_s();
  next.displacement_C_m = field.R_cur_prev() * track.displacement_C_m + field.displacement_C_m();
  if (!track.has_motion()) {
    next.as_static =
        StaticPoint::seen_once(next.place_px, camera, field, next.displacement_C_m, noise.last_px2);
  } else {
    next.as_static = track.as_static.predicted(camera, field, parameters.ego_share);
    next.as_moving = track.as_moving.predicted(field, parameters.turnover_ps);
  }
  return next;
}

Densities densities_of(const Track& track, const Vec2& x_px, const Intrinsics& camera,
                       const MotionField& field, const EdgeParameters& parameters,
                       double noise2_px2) {
  const DepthBounds bounds = depth_bounds(field, x_px);
  const double kind = parameters.kind_turnover(field.dt_s());
  const double first2 =
      noise2_px2 + std::pow(parameters.ego_share * (x_px - track.place_px).norm(), 2);
  StaticPoint seen = track.as_static;
  double still = seen.update(x_px, track.has_motion() ? noise2_px2 : first2, bounds);
  double moving = 0, before = 0;
  if (!track.has_motion()) {
    const Vec2 parallax = parallax_px_m(camera, track.displacement_C_m, track.place_px);
    moving = Step(x_px - track.place_px, parallax, bounds)
                 .density_of_mover(parameters.reach_px(track.since_s), noise2_px2);
    before = log_odds(parameters.prior) + parameters.newcomer;
  } else {
    moving = track.as_moving.density(x_px, noise2_px2);
    before = log_odds(chance(track.log_odds) * (1 - kind) + parameters.prior * kind);
  }
  if (track.log_odds > 0) {
    StaticPoint rested =
        StaticPoint::seen_once(track.place_px, camera, field, track.displacement_C_m, noise2_px2);
    const double anew = rested.update(x_px, first2, bounds), moved = chance(track.log_odds);
    const double was_still = (1 - moved) * (1 - kind * parameters.prior) * still;
    const double rests = moved * kind * (1 - parameters.prior) * anew;
    still = (was_still + rests) / (1 - chance(before));
    if (rests > was_still) seen = rested;
  }
  return {still, moving, before, seen};
}

bool see(Track& track, const Vec2& x_px, double chance_ppx2, const Intrinsics& camera,
         const MotionField& field, const EdgeParameters& parameters, const Noise& noise) {
  const double turnover = parameters.turnover(field.dt_s()), right = 1 - turnover;
  const double anywhere = turnover / parameters.reach_area_px2(field.dt_s());
  const double noise2 =
      std::max(1.0 / 12, (parameters.neighbours * noise.now_px2 + track.noise_sum_px2) /
                             (parameters.neighbours + track.noise_weight));
  const auto [still, moving, before, seen] =
      densities_of(track, x_px, camera, field, parameters, noise2);
  if (track.has_motion() && right * std::max(still, moving) < anywhere) return false;
  const double none = anywhere + chance_ppx2;
  const double evidence = std::log((right * moving + none) / (right * still + none));
  const double most = parameters.most_log_odds(field.dt_s());
  track.log_odds = std::clamp(before + evidence, -most, most);
  if (!track.has_motion()) {
    track.as_moving = OwnMotion::first(track.place_px, x_px, noise2, track.since_s);
  } else {
    track.as_moving.update(x_px, noise2);
  }
  const double moves = chance(before + evidence);
  const double stands = (1 - moves) * right * still / (right * still + none);
  const double goes = moves * right * moving / (right * moving + none);
  const double miss2 =
      (x_px - seen.place_px).squaredNorm() + seen.covariance.topLeftCorner<2, 2>().trace();
  const double moving_miss2 =
      (x_px - track.as_moving.place_px).squaredNorm() + 2 * track.as_moving.covariance(0, 0);
  track.noise_sum_px2 = right * track.noise_sum_px2 + (stands * miss2 + goes * moving_miss2) / 2;
  track.noise_weight = right * track.noise_weight + stands + goes;
  track.as_static = seen;
  track.place_px = x_px;
  track.since_s = 0;
  track.displacement_C_m.setZero();
  ++track.sightings;
  return true;
}

double shown(const Track& track, const Intrinsics& camera, const MotionField& field,
             const EdgeParameters& parameters, double crowd, double noise2_px2) {
  if (!track.has_motion() || track.log_odds < -kFar) return track.log_odds;
  const double dt = field.dt_s();
  const Vec2 step_px = dt * track.as_moving.velocity_pxps;
  const Step step(step_px,
                  parallax_px_m(camera, field.displacement_C_m(), track.place_px - step_px),
                  depth_bounds(field, track.place_px));
  const double crossing =
      parameters.crossings / (crowd * crowd) *
      step.density_of_crossing(parameters.slide, track.as_moving.step_variance_px2(dt)) /
      step.density_of_mover(parameters.reach_px(dt), noise2_px2);
  return -std::log(std::exp(-track.log_odds) + crossing);
}

Tracks columns_of(std::span<const Track> tracks) {
  Tracks list;
  list.columns.make(tracks.size());
  for (const Track& track : tracks) {
    const std::size_t i = list.size();
    const auto set = [&](TrackColumn column, double value) {
      list.columns[column][i] = static_cast<float>(value);
    };
    const auto set_point = [&](TrackColumn column, const Vec2& value) {
      set(column, value.x());
      set(static_cast<TrackColumn>(column + 1), value.y());
    };
    for (std::size_t column = 0; column < kTrackColumns; ++column) list.columns[column][i] = 0;
    set_point(kPlaceX, track.place_px);
    set(kSince_s, track.since_s);
    set_point(kShiftX_m, track.displacement_C_m.head<2>());
    set(kShiftZ_m, track.displacement_C_m.z());
    set(kSightings, track.sightings);
    set(kLogOdds, track.log_odds);
    set(kBelief, track.belief);
    set(kNoiseSum, track.noise_sum_px2);
    set(kNoiseWeight, track.noise_weight);
    const StaticPoint& point = track.as_static;
    const double variance = point.covariance(2, 2);
    const Vec2 by_depth = variance > 0 ? Vec2(point.covariance.topRightCorner<2, 1>() / variance)
                                       : Vec2(Vec2::Zero());
    const Eigen::Matrix2d given =
        point.covariance.topLeftCorner<2, 2>() - variance * by_depth * by_depth.transpose();
    set_point(kStaticX, point.place_px);
    set(kInverseDepth_pm, point.inverse_depth_pm);
    set(kGivenXx, given(0, 0));
    set(kGivenXy, given(0, 1));
    set(kGivenYy, given(1, 1));
    set_point(kByDepthX, by_depth);
    set(kDepthVariance, variance);
    set_point(kMovingX, track.as_moving.place_px);
    set_point(kVelocityX, track.as_moving.velocity_pxps);
    set(kMovingXx, track.as_moving.covariance(0, 0));
    set(kMovingXv, track.as_moving.covariance(0, 1));
    set(kMovingVv, track.as_moving.covariance(1, 1));
    list.records.push_back({.signature = track.signature});
  }
  return list;
}

Track track_of(const Tracks& tracks, std::size_t index) {
  const auto at = [&](TrackColumn column) { return double{tracks.at(column, index)}; };
  Track track;
  track.place_px = tracks.point(kPlaceX, index);
  track.since_s = at(kSince_s);
  track.displacement_C_m << at(kShiftX_m), at(kShiftY_m), at(kShiftZ_m);
  track.sightings = static_cast<int>(at(kSightings));
  track.log_odds = at(kLogOdds);
  track.belief = at(kBelief);
  track.noise_sum_px2 = at(kNoiseSum);
  track.noise_weight = at(kNoiseWeight);
  StaticPoint& point = track.as_static;
  point.place_px = tracks.point(kStaticX, index);
  point.inverse_depth_pm = at(kInverseDepth_pm);
  point.covariance(2, 2) = at(kDepthVariance);
  point.covariance.topRightCorner<2, 1>() = tracks.point(kByDepthX, index) * at(kDepthVariance);
  point.covariance.bottomLeftCorner<1, 2>() = point.covariance.topRightCorner<2, 1>().transpose();
  point.covariance.topLeftCorner<2, 2>() = tracks.static_spread(index, 0);
  track.as_moving.place_px = tracks.point(kMovingX, index);
  track.as_moving.velocity_pxps = tracks.point(kVelocityX, index);
  track.as_moving.covariance << at(kMovingXx), at(kMovingXv), at(kMovingXv), at(kMovingVv);
  if (!tracks.records.empty()) track.signature = tracks.records[index].signature;
  return track;
}

Columns<float, kMissColumns> columns_of(std::span<const Residual> residuals,
                                        const Intrinsics& camera, double dt_s,
                                        double velocity_variance_m2ps2) {
  Columns<float, kMissColumns> misses;
  misses.make(residuals.size());
  const double per_depth_px_m = camera.focal_px * dt_s;
  for (std::size_t i = 0; i < residuals.size() + kLanes; ++i) {
    for (std::size_t column = 0; column < kMissColumns; ++column) {
      const bool is_variance = column == kSxx || column == kSyy || column == kSpreadXx ||
                               column == kSpreadYy || column == kSpreadDet || column == kSDet ||
                               column == kOtherwise;
      misses[column][i] = is_variance ? 1 : 0;
    }
    if (i >= residuals.size()) continue;
    const Residual& residual = residuals[i];
    Eigen::Matrix2d S =
        residual.covariance_px2 + residual.by_depth_px * residual.by_depth_px.transpose();
    S.diagonal().array() += per_depth_px_m * per_depth_px_m * velocity_variance_m2ps2 *
                            residual.inverse_depth_variance_pm2;
    if (!(S.determinant() > 1e-12 * S.trace() * S.trace())) continue;
    const Vec2 h = (residual.place_px - camera.centre_px) / camera.focal_px;
    const std::array<double, kMissColumns> row = {h.x(),
                                                  h.y(),
                                                  residual.inverse_depth_pm * dt_s,
                                                  residual.off_px.x(),
                                                  residual.off_px.y(),
                                                  residual.covariance_px2(0, 0),
                                                  residual.covariance_px2(0, 1),
                                                  residual.covariance_px2(1, 1),
                                                  residual.covariance_px2.determinant(),
                                                  S(0, 0),
                                                  S(0, 1),
                                                  S(1, 1),
                                                  S.determinant(),
                                                  residual.voice,
                                                  residual.stands,
                                                  residual.otherwise_ppx2};
    for (std::size_t column = 0; column < kMissColumns; ++column) {
      misses[column][i] = static_cast<float>(row[column]);
    }
  }
  return misses;
}

}  // namespace lcs::testing
