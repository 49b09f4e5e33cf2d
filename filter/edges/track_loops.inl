// The loops of tracks.h. Included by a file for each set of instructions, inside of its namespace,
// after `lanes.inl`.

namespace {

constexpr float kPi_f = std::numbers::pi_v<float>, kTwoPi = 2 * kPi_f;
/// Relative standard deviation of the given height above the ground.
constexpr float kWrongHeight = 0.1F;
/// No static point lies more than this many standard deviations below the ground.
constexpr float kFarBelow = 2;

LCS_INLINE Floats root_of(const Floats& x) {
#ifdef __AVX2__
  return (Floats)_mm256_sqrt_ps((__m256)x);
#else
  Floats root;
  for (std::size_t lane = 0; lane < kLanes; ++lane) root[lane] = __builtin_sqrtf(x[lane]);
  return root;
#endif
}

LCS_INLINE Floats lesser(const Floats& a, const Floats& b) {
  return a < b ? a : b;
}
LCS_INLINE Floats clamped(const Floats& x, const Floats& low, const Floats& high) {
  return lesser(larger(x, low), high);
}

/// Angle of the point (x, y) with y >= 0, within 3e-8 rad by the polynomial (Abramowitz and Stegun,
/// 4.4.49).
LCS_INLINE Floats angle_of(const Floats& x, const Floats& y) {
  const Floats across = x < 0.0F ? -x : x;
  const Floats t = lesser(across, y) / larger(larger(across, y), Floats{} + 1e-30F), t2 = t * t;
  Floats p = 0.0028662257F * t2 - 0.0161657367F;
  p = p * t2 + 0.0429096138F;
  p = p * t2 - 0.0752896400F;
  p = p * t2 + 0.1065626393F;
  p = p * t2 - 0.1420889944F;
  p = p * t2 + 0.1999355085F;
  p = p * t2 - 0.3333314528F;
  const Floats low = t + t * t2 * p;
  const Floats quarter = y > across ? 0.5F * kPi_f - low : low;
  return x < 0.0F ? kPi_f - quarter : quarter;
}

/// Probability that a standard normal variable lies beyond z, on z's side (Abramowitz and Stegun,
/// 7.1.26, within 8e-8), negative for z > 0.
LCS_INLINE Floats tail(const Floats& z) {
  const Floats t = 1.0F / (1.0F + 0.3275911F * 0.70710678F * (z < 0.0F ? -z : z));
  Floats p = 1.061405429F * t - 1.453152027F;
  p = p * t + 1.421413741F;
  p = p * t - 0.284496736F;
  p = p * t + 0.254829592F;
  const Floats beyond = 0.5F * p * t * exp_of(-0.5F * z * z);
  return z > 0.0F ? -beyond : beyond;
}
/// Probability that it lies between two values.
LCS_INLINE Floats between(const Floats& low, const Floats& high) {
  return tail(high) - tail(low) + ((low <= 0.0F) & (high > 0.0F) ? Floats{} + 1.0F : Floats{});
}

/// Bounds of 1/Z of static points (MODEL.md (3)), 1/m; the largest one is the frame's.
struct Bounds {
  Floats least, ground, ground_sigma;
};
LCS_INLINE Bounds bounds_at(const TrackFrame& frame, const Floats& x, const Floats& y) {
  const Floats ground = frame.ground[0] +
                        frame.ground[1] * ((x - frame.centre_x_px) / frame.focal_px) +
                        frame.ground[2] * ((y - frame.centre_y_px) / frame.focal_px);
  const Floats wrong = kWrongHeight * ground;
  const Floats sigma = root_of(frame.slack_pm * frame.slack_pm + wrong * wrong);
  const Ints below = ground > 0.0F;
  return {below ? clamped(ground - kFarBelow * sigma, Floats{}, Floats{} + 0.95F * frame.most_pm)
                : Floats{},
          below ? ground : Floats{}, below ? sigma : Floats{}};
}

struct Places {
  Floats x, y;
};
/// px m: image motion of static points since the camera was displaced, over their final inverse
/// depth.
LCS_INLINE Places parallax_of(const TrackFrame& frame, const Floats& x, const Floats& y,
                              const Floats& shift_x, const Floats& shift_y, const Floats& shift_z) {
  return {(x - frame.centre_x_px) * shift_z - frame.focal_px * shift_x,
          (y - frame.centre_y_px) * shift_z - frame.focal_px * shift_y};
}

/// Tracks as static points. The covariance of the place is V + g g^T C.
struct Points {
  Floats x, y, w, V_xx, V_xy, V_yy, g_x, g_y, C;
};

/// (4): a point with one sighting, predicted to this frame at any depth within the bounds. Omits
/// the error of the velocity: it depends on the image motion, unknown before the second sighting.
/// \param x, y the place after the rotation.
LCS_INLINE Points seen_once(const TrackFrame& frame, const Floats& x, const Floats& y,
                            const Places& parallax, const Floats& noise2) {
  const Bounds bounds = bounds_at(frame, x, y);
  const Floats half = 0.5F * (frame.most_pm - bounds.least), w = bounds.least + half;
  return {x + w * parallax.x, y + w * parallax.y, w,          noise2, Floats{}, noise2,
          parallax.x,         parallax.y,         half * half};
}

/// Probability of the inverse depth within its bounds; never 0, as it is a divisor.
LCS_INLINE Floats mass(const TrackFrame& frame, const Points& point, const Bounds& bounds) {
  const Floats sigma = root_of(point.C);
  // Infinite depth (w = 0) is a sharp bound, the ground an uncertain one.
  const Floats least =
      larger(-point.w / sigma, (bounds.ground - point.w) /
                                   root_of(point.C + bounds.ground_sigma * bounds.ground_sigma));
  return larger(between(least, (frame.most_pm - point.w) / sigma), Floats{} + 1e-12F);
}

/// A sighting of static points: A = V + noise I, u = A^-1 g, and the change of w.
struct Seen {
  Floats A_xx, A_xy, A_yy, det, u_x, u_y, rho, pull, change;
};
LCS_INLINE Seen seen_at(const Points& point, const Floats& x, const Floats& y,
                        const Floats& noise2) {
  Seen seen;
  seen.A_xx = point.V_xx + noise2;
  seen.A_xy = point.V_xy;
  seen.A_yy = point.V_yy + noise2;
  seen.det = seen.A_xx * seen.A_yy - seen.A_xy * seen.A_xy;
  seen.u_x = (seen.A_yy * point.g_x - seen.A_xy * point.g_y) / seen.det;
  seen.u_y = (seen.A_xx * point.g_y - seen.A_xy * point.g_x) / seen.det;
  // The determinant of the whole covariance over that of A.
  seen.rho = 1.0F + point.C * (point.g_x * seen.u_x + point.g_y * seen.u_y);
  seen.pull = seen.u_x * (x - point.x) + seen.u_y * (y - point.y);
  seen.change = point.C * seen.pull / seen.rho;
  return seen;
}

/// (12): updates predicted points by a sighting, and clamps their depth to the bounds.
/// \return the density of the sighting, given the prediction, 1/px^2.
LCS_INLINE Floats update(const TrackFrame& frame, Points& point, const Floats& x, const Floats& y,
                         const Floats& noise2, const Bounds& bounds) {
  const Floats before = mass(frame, point, bounds);
  const Seen seen = seen_at(point, x, y, noise2);
  // What the depth does not explain, and its product with A^-1.
  const Floats left_x = x - point.x - point.g_x * seen.change;
  const Floats left_y = y - point.y - point.g_y * seen.change;
  const Floats t_x = (seen.A_yy * left_x - seen.A_xy * left_y) / seen.det;
  const Floats t_y = (seen.A_xx * left_y - seen.A_xy * left_x) / seen.det;
  const Floats distance2 = left_x * t_x + left_y * t_y + seen.change * seen.pull / seen.rho;
  const Floats V_det = point.V_xx * point.V_yy - point.V_xy * point.V_xy;
  const Floats kept = noise2 / seen.det;
  const Floats most = 1.0F / (kTwoPi * root_of(seen.det * seen.rho));
  point = {x - noise2 * t_x,           y - noise2 * t_y,
           point.w + seen.change,      kept * (V_det + noise2 * point.V_xx),
           kept * noise2 * point.V_xy, kept * (V_det + noise2 * point.V_yy),
           noise2 * seen.u_x,          noise2 * seen.u_y,
           point.C / seen.rho};
  const Floats after = mass(frame, point, bounds);
  // If w is out of bounds: the likeliest point within them.
  const Floats bounded = clamped(point.w, bounds.least, Floats{} + frame.most_pm);
  point.x += point.g_x * (bounded - point.w);
  point.y += point.g_y * (bounded - point.w);
  point.w = bounded;
  return most * exp_of(-0.5F * distance2) *
         lesser(after / larger(before, Floats{} + 1e-6F), Floats{} + 1.0F);
}

/// Steps beside those that static points may make, rotation removed. Those of static points form a
/// segment, from the farthest to the nearest depth.
struct Steps {
  Floats segment;   // px: its length
  Floats along;     // px: of the step, from the segment's far end
  Floats across;    // px
  Floats farthest;  // px: step of a point at the segment's far end
};
LCS_INLINE Steps steps_of(const TrackFrame& frame, const Floats& x, const Floats& y,
                          const Places& parallax, const Bounds& bounds) {
  const Floats length = root_of(parallax.x * parallax.x + parallax.y * parallax.y);
  const Ints is_short = length <= 1e-9F;
  const Floats unit_x = is_short ? Floats{} + 1.0F : parallax.x / length;
  const Floats unit_y = is_short ? Floats{} : parallax.y / length;
  const Floats farthest = bounds.least * length;
  return {(frame.most_pm - bounds.least) * length, x * unit_x + y * unit_y - farthest,
          unit_x * y - unit_y * x, farthest};
}
/// Square of the distance from the segment.
LCS_INLINE Floats off2_of(const Steps& step) {
  const Floats beyond = step.along - clamped(step.along, Floats{}, step.segment);
  return step.across * step.across + beyond * beyond;
}

/// (13): density of the step of a moving point, each order of magnitude of its speed being equally
/// likely, 1/px^2.
/// \param reach the largest step, px. \param noise2 of one end, on an axis.
LCS_INLINE Floats density_of_mover(const Steps& step, const Floats& reach, const Floats& noise2) {
  const Floats a = step.along, s2 = step.across * step.across + 2.0F * noise2, s = root_of(s2);
  const Floats orders = log_of(1.0F + reach * reach / (2.0F * noise2));
  const Floats middle = a - 0.5F * step.segment;
  // The angle at which the segment is seen from a place beside it.
  const Floats seen = angle_of(s2 - a * (step.segment - a), step.segment * s);
  return step.segment > 1e-6F * s ? seen / (step.segment * kPi_f * orders * s)
                                  : 1.0F / (kPi_f * orders * (s2 + middle * middle));
}

/// (34): density of the step of a crossing, where the outline of a near body meets an edge behind
/// it, 1/px^2. A crossing slides along the outline.
LCS_INLINE Floats density_of_crossing(const TrackFrame& frame, const Steps& step,
                                      const Floats& step_variance) {
  const Floats way = frame.slide * (step.farthest + clamped(step.along, Floats{}, step.segment));
  const Floats s2 = way * way + step_variance;
  const Floats density = exp_of(-0.5F * off2_of(step) / s2) / (root_of(kTwoPi * s2) * step.segment);
  return step.segment > 1e-6F ? density : Floats{};  // without parallax nothing slides
}

/// The chance of log odds.
LCS_INLINE Floats chance_of(const Floats& log_odds) {
  return 1.0F / (1.0F + exp_of(-log_odds));
}

LCS_INLINE Ints load_ints(const int* from) {
  Ints values;
  __builtin_memcpy(&values, from, sizeof values);
  return values;
}

LCS_INLINE void store_points(const Ints& either, const Points& a, const Points& b, std::size_t i,
                             float* const* tracks) {
  store(either ? a.x : b.x, tracks[kStaticX] + i);
  store(either ? a.y : b.y, tracks[kStaticY] + i);
  store(either ? a.w : b.w, tracks[kInverseDepth_pm] + i);
  store(either ? a.V_xx : b.V_xx, tracks[kGivenXx] + i);
  store(either ? a.V_xy : b.V_xy, tracks[kGivenXy] + i);
  store(either ? a.V_yy : b.V_yy, tracks[kGivenYy] + i);
  store(either ? a.g_x : b.g_x, tracks[kByDepthX] + i);
  store(either ? a.g_y : b.g_y, tracks[kByDepthY] + i);
  store(either ? a.C : b.C, tracks[kDepthVariance] + i);
}

void rotate(const float* homography, const float* x_px, const float* y_px, std::size_t count,
            float* to_x_px, float* to_y_px) {
  const float farthest = 2147483648.0F;  // coordinates beyond it count as infinite
  const float* const H = homography;
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Floats x = load(x_px + i), y = load(y_px + i);
    const Floats z = H[6] * x + H[7] * y + H[8];
    const Floats to_x = (H[0] * x + H[1] * y + H[2]) / z, to_y = (H[3] * x + H[4] * y + H[5]) / z;
    const Ints is_seen = (z > 1e-6F) & (to_x < farthest) & (to_x > -farthest) & (to_y < farthest) &
                         (to_y > -farthest);
    store(is_seen ? to_x : x, to_x_px + i);
    store(is_seen ? to_y : y, to_y_px + i);
  }
}

/// (2): points with a motion in the next frame.
/// \param before_x, before_y before the rotation. \param point before, but for the rotated place.
LCS_INLINE Points advanced(const TrackFrame& frame, const Floats& before_x, const Floats& before_y,
                           const Points& point) {
  const float f = frame.focal_px, dz = frame.displacement_m[2];
  const float shift_x = f * frame.displacement_m[0], shift_y = f * frame.displacement_m[1];
  const Floats h_x = point.x - frame.centre_x_px, h_y = point.y - frame.centre_y_px;
  // A point that the camera passes within the frame is put at z_min. A point turned behind the
  // camera has no image and keeps its place and inverse depth.
  const Floats Z = frame.R[2][0] * ((before_x - frame.centre_x_px) / f) +
                   frame.R[2][1] * ((before_y - frame.centre_y_px) / f) + frame.R[2][2];
  const Floats turned = Z > 0.0F ? larger(Z, point.w / frame.most_pm) : Floats{} + 1.0F;
  const Floats w = point.w / turned;
  const Floats nearing = larger(1.0F - w * dz, w / frame.most_pm);
  const Floats a = 1.0F / nearing, c = a * a / turned;
  Points next;
  next.x = frame.centre_x_px + (h_x - w * shift_x) * a;
  next.y = frame.centre_y_px + (h_y - w * shift_y) * a;
  next.w = w * a;
  // The derivatives are F = [a I, b; 0, c], b = c (h d_z - f d_xy).
  next.g_x = point.g_x * turned * nearing + (h_x * dz - shift_x);
  next.g_y = point.g_y * turned * nearing + (h_y * dz - shift_y);
  next.C = c * c * point.C;
  // A relative error of the velocity: the error along the image motion, half of it across.
  const float share2 = frame.ego_share * frame.ego_share;
  const Floats flow_x = next.x - point.x, flow_y = next.y - point.y;
  const Floats any_way = 0.25F * share2 * (flow_x * flow_x + flow_y * flow_y);
  next.V_xx = a * a * point.V_xx + 0.75F * share2 * flow_x * flow_x + any_way;
  next.V_xy = a * a * point.V_xy + 0.75F * share2 * flow_x * flow_y;
  next.V_yy = a * a * point.V_yy + 0.75F * share2 * flow_y * flow_y + any_way;
  return next;
}

void predict(const TrackFrame& frame, const float* const* before, std::size_t count,
             float* const* after) {
  const auto& R = frame.R;
  const float* const d = frame.displacement_m;
  const float dt = frame.dt_s;
  for (std::size_t i = 0; i < count; i += kLanes) {
    for (const int column :
         {kSightings, kLogOdds, kBelief, kNoiseSum, kNoiseWeight, kVelocityX, kVelocityY}) {
      store(load(before[column] + i), after[column] + i);
    }
    store(load(before[kSince_s] + i) + dt, after[kSince_s] + i);
    const Floats x0 = load(before[kShiftX_m] + i), y0 = load(before[kShiftY_m] + i);
    const Floats z0 = load(before[kShiftZ_m] + i);
    const Floats shift_x = R[0][0] * x0 + R[0][1] * y0 + R[0][2] * z0 + d[0];
    const Floats shift_y = R[1][0] * x0 + R[1][1] * y0 + R[1][2] * z0 + d[1];
    const Floats shift_z = R[2][0] * x0 + R[2][1] * y0 + R[2][2] * z0 + d[2];
    store(shift_x, after[kShiftX_m] + i);
    store(shift_y, after[kShiftY_m] + i);
    store(shift_z, after[kShiftZ_m] + i);

    const Ints has_motion = load(before[kSightings] + i) >= 2.0F;
    const Floats x = load(after[kPlaceX] + i), y = load(after[kPlaceY] + i);
    const Points once = seen_once(frame, x, y, parallax_of(frame, x, y, shift_x, shift_y, shift_z),
                                  Floats{} + frame.last_noise2_px2);
    const Points more = advanced(
        frame, load(before[kStaticX] + i), load(before[kStaticY] + i),
        {load(after[kStaticX] + i), load(after[kStaticY] + i), load(before[kInverseDepth_pm] + i),
         load(before[kGivenXx] + i), load(before[kGivenXy] + i), load(before[kGivenYy] + i),
         load(before[kByDepthX] + i), load(before[kByDepthY] + i),
         load(before[kDepthVariance] + i)});
    store_points(has_motion, more, once, i, after);

    // A moving point's velocity is a random walk: variances of place and velocity at the end.
    const Floats v_x = load(before[kVelocityX] + i), v_y = load(before[kVelocityY] + i);
    const Floats C_xv = load(before[kMovingXv] + i), C_vv = load(before[kMovingVv] + i);
    const float change = frame.turnover_ps * dt;
    const Floats change2 = change * change * (v_x * v_x + v_y * v_y);
    store(load(after[kMovingX] + i) + v_x * dt, after[kMovingX] + i);
    store(load(after[kMovingY] + i) + v_y * dt, after[kMovingY] + i);
    store(load(before[kMovingXx] + i) + 2 * dt * C_xv + dt * dt * C_vv + change2 * (dt * dt / 3),
          after[kMovingXx] + i);
    store(C_xv + dt * C_vv + change2 * (dt / 2), after[kMovingXv] + i);
    store(C_vv + change2, after[kMovingVv] + i);
  }
}

void expect(const TrackFrame& frame, std::size_t count, float* const* tracks) {
  const float anywhere = 1 / frame.reach_area_px2, wrong = frame.turnover;
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Floats moves = chance_of(load(tracks[kBelief] + i));
    const Floats A_xx = load(tracks[kGivenXx] + i) + frame.noise2_px2;
    const Floats A_yy = load(tracks[kGivenYy] + i) + frame.noise2_px2;
    const Floats A_xy = load(tracks[kGivenXy] + i);
    const Floats g_x = load(tracks[kByDepthX] + i), g_y = load(tracks[kByDepthY] + i);
    const Floats C = load(tracks[kDepthVariance] + i);
    const Floats det = (A_xx * A_yy - A_xy * A_xy) +
                       C * (g_x * g_x * A_yy - 2.0F * g_x * g_y * A_xy + g_y * g_y * A_xx);
    store((A_yy + C * g_y * g_y) / det, tracks[kStaticPxx] + i);
    store(-(A_xy + C * g_x * g_y) / det, tracks[kStaticPxy] + i);
    store((A_xx + C * g_x * g_x) / det, tracks[kStaticPyy] + i);
    store((1 - wrong) * (1.0F - moves) / (kTwoPi * root_of(det)), tracks[kStaticMost] + i);
    const Ints has_motion = load(tracks[kSightings] + i) >= 2.0F;
    const Floats variance = load(tracks[kMovingXx] + i) + frame.noise2_px2;
    // A track seen once may have moved anywhere within reach.
    store(has_motion ? 1.0F / variance : Floats{}, tracks[kMovingP] + i);
    store(has_motion ? (1 - wrong) * moves / (kTwoPi * variance) : Floats{},
          tracks[kMovingMost] + i);
    store((has_motion ? Floats{} + wrong : wrong + (1 - wrong) * moves) * anywhere,
          tracks[kAnywhere] + i);
  }
}

void densities(const float* const* tracks, const int* which, std::size_t count, float x_px,
               float y_px, float* ln_density, float* ln_off) {
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Ints track = before(i, count) ? load_ints(which + i) : Ints{};
    const Floats x = x_px - gather(tracks[kStaticX], track);
    const Floats y = y_px - gather(tracks[kStaticY], track);
    const Floats still = -0.5F * (x * x * gather(tracks[kStaticPxx], track) +
                                  y * y * gather(tracks[kStaticPyy], track)) -
                         x * y * gather(tracks[kStaticPxy], track);
    const Floats moving_most = gather(tracks[kMovingMost], track);
    const Floats m_x = x_px - gather(tracks[kMovingX], track);
    const Floats m_y = y_px - gather(tracks[kMovingY], track);
    const Floats moving = moving_most > 0.0F
                              ? -0.5F * (m_x * m_x + m_y * m_y) * gather(tracks[kMovingP], track)
                              : still;
    store(larger(still, moving), ln_off + i);
    store(log_of(gather(tracks[kStaticMost], track) * exp_of(still) + moving_most * exp_of(moving) +
                 gather(tracks[kAnywhere], track)),
          ln_density + i);
  }
}

LCS_INLINE Points gathered(const float* const* tracks, const Ints& track) {
  return {gather(tracks[kStaticX], track),         gather(tracks[kStaticY], track),
          gather(tracks[kInverseDepth_pm], track), gather(tracks[kGivenXx], track),
          gather(tracks[kGivenXy], track),         gather(tracks[kGivenYy], track),
          gather(tracks[kByDepthX], track),        gather(tracks[kByDepthY], track),
          gather(tracks[kDepthVariance], track)};
}

/// The corners' tracks that are left, and the lanes of which a track is.
struct Continued {
  Ints track, valid;
};
LCS_INLINE Continued continued(const Sightings& seen, std::size_t i, std::size_t count) {
  const Ints track = load_ints(seen.track_of + i), valid = (track >= 0) & before(i, count);
  return {valid ? track : Ints{}, valid};
}

/// The determinant of A + v v^T, without the difference of two large numbers that its entries give.
LCS_INLINE Floats widened(const Floats& determinant, const Floats& A_xx, const Floats& A_xy,
                          const Floats& A_yy, const Places& v) {
  return determinant + (A_yy * v.x * v.x - 2.0F * A_xy * v.x * v.y + A_xx * v.y * v.y);
}

void misses(const TrackFrame& frame, const float* const* tracks, const Sightings& seen,
            const int* asked, std::size_t count, bool started, float velocity_variance_m2ps2,
            float* const* misses) {
  const float anywhere = 1 / frame.reach_area_px2, per_depth = frame.focal_px * frame.dt_s;
  const float* const d = frame.displacement_m;
  const Floats none = {}, one = none + 1.0F;
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Ints valid = before(i, count), corner = valid ? load_ints(asked + i) : Ints{};
    const Ints track = gather(seen.track_of, corner);
    const Floats x = gather(seen.x_px, corner), y = gather(seen.y_px, corner);
    const Points point = gathered(tracks, track);
    Floats w = point.w, w_variance = point.C;
    Floats moving = none + anywhere;
    if (started) {
      const Floats off_x = x - gather(tracks[kMovingX], track);
      const Floats off_y = y - gather(tracks[kMovingY], track);
      const Floats variance = gather(tracks[kMovingXx], track) + frame.noise2_px2;
      moving = exp_of(-0.5F * (off_x * off_x + off_y * off_y) / variance) / (kTwoPi * variance);
    } else {
      const Seen once = seen_at(point, x, y, none + frame.noise2_px2);
      w = clamped(w + once.change, bounds_at(frame, x, y).least, none + frame.most_pm);
      w_variance = point.C / once.rho;
    }
    const Places parallax =
        parallax_of(frame, point.x, point.y, none + d[0], none + d[1], none + d[2]);
    const Floats deep = 0.5F * (frame.most_pm - bounds_at(frame, point.x, point.y).least);
    const Places by_depth = {deep * parallax.x, deep * parallax.y};
    const Floats moves = chance_of(gather(tracks[kBelief], track));
    const Floats voice = valid ? 1.0F / gather(seen.crowd, corner) : none;
    const Floats otherwise = moves * moving + anywhere;
    const Floats V_xx = point.V_xx + frame.noise2_px2, V_yy = point.V_yy + frame.noise2_px2;
    const Floats spread_xx = V_xx + point.C * point.g_x * point.g_x;
    const Floats spread_xy = point.V_xy + point.C * point.g_x * point.g_y;
    const Floats spread_yy = V_yy + point.C * point.g_y * point.g_y;
    const Floats deviation = root_of(point.C);
    const Floats spread_det =
        widened(V_xx * V_yy - point.V_xy * point.V_xy, V_xx, point.V_xy, V_yy,
                {deviation * point.g_x, deviation * point.g_y});
    // The effect of a change of velocity on a point is as uncertain as the point's depth.
    const Floats moved = per_depth * per_depth * velocity_variance_m2ps2 * w_variance;
    const Floats wide_xx = spread_xx + moved, wide_yy = spread_yy + moved;
    const Floats S_xx = wide_xx + by_depth.x * by_depth.x;
    const Floats S_xy = spread_xy + by_depth.x * by_depth.y;
    const Floats S_yy = wide_yy + by_depth.y * by_depth.y;
    const Floats S_det = widened(spread_det + moved * (spread_xx + spread_yy + moved), wide_xx,
                                 spread_xy, wide_yy, by_depth);
    const Floats ray_x = (point.x - frame.centre_x_px) / frame.focal_px;
    const Floats ray_y = (point.y - frame.centre_y_px) / frame.focal_px;
    // The precision across a segment of a million pixels is lost in rounding. The squares of a place
    // at a thousand focal lengths, where no corner is seen, could overflow.
    const Floats ray2 = ray_x * ray_x + ray_y * ray_y;
    const Ints is_sure = (S_det > 1e-12F * (S_xx + S_yy) * (S_xx + S_yy)) &
                         (1e-12F * ray2 * ray2 < 1.0F);
    store(is_sure ? ray_x : none, misses[kRayX] + i);
    store(is_sure ? ray_y : none, misses[kRayY] + i);
    store(is_sure ? w * frame.dt_s : none, misses[kMotion_s] + i);
    store(is_sure ? x - point.x : none, misses[kOffX] + i);
    store(is_sure ? y - point.y : none, misses[kOffY] + i);
    store(is_sure ? spread_xx : one, misses[kSpreadXx] + i);
    store(is_sure ? spread_xy : none, misses[kSpreadXy] + i);
    store(is_sure ? spread_yy : one, misses[kSpreadYy] + i);
    store(is_sure ? spread_det : one, misses[kSpreadDet] + i);
    store(is_sure ? S_xx : one, misses[kSxx] + i);
    store(is_sure ? S_xy : none, misses[kSxy] + i);
    store(is_sure ? S_yy : one, misses[kSyy] + i);
    store(is_sure ? S_det : one, misses[kSDet] + i);
    store(is_sure ? voice : none, misses[kVoice] + i);
    store(1.0F - moves, misses[kStands] + i);
    store(otherwise, misses[kOtherwise] + i);
  }
}

/// Odds of moving a frame later: the corner may have changed its kind.
LCS_INLINE Floats faded_odds(const TrackFrame& frame, const Floats& log_odds) {
  const Floats odds = exp_of(log_odds), all = frame.kind_turnover * (1.0F + odds);
  return (odds * (1 - frame.kind_turnover) + frame.prior * all) /
         ((1 - frame.kind_turnover) + (1 - frame.prior) * all);
}

Misses see(const TrackFrame& frame, const float* const* predicted, const Sightings& seen,
           std::size_t count, float* const* after, int* kept) {
  const float right = 1 - frame.turnover, anywhere = frame.turnover / frame.reach_area_px2;
  const float kind = frame.kind_turnover;
  const Floats none = {}, one = none + 1.0F;
  Floats sum = {}, sum_weight = {};
  for (std::size_t i = 0; i < count; i += kLanes) {
    const auto [track, valid] = continued(seen, i, count);
    const Floats x = load(seen.x_px + i), y = load(seen.y_px + i);
    const Bounds bounds = bounds_at(frame, x, y);
    const Floats sightings = gather(predicted[kSightings], track);
    const Ints has_motion = sightings >= 2.0F;
    const Floats place_x = gather(predicted[kPlaceX], track);
    const Floats place_y = gather(predicted[kPlaceY], track);
    const Floats step_x = x - place_x, step_y = y - place_y;
    const Floats noise_sum = gather(predicted[kNoiseSum], track);
    const Floats noise_weight = gather(predicted[kNoiseWeight], track);
    const Floats weights = frame.usual_weight + noise_weight;
    const Floats noise = weights > 0.0F
                             ? (frame.usual_weight * frame.noise2_px2 + noise_sum) / weights
                             : none + frame.noise2_px2;
    // A place that is rounded to whole pixels has at least 1/12 px^2.
    const Floats noise2 = larger(noise, none + 1.0F / 12);
    // At the first step the error of the velocity is added, which its prediction omits.
    const float share2 = frame.ego_share * frame.ego_share;
    const Floats first2 = noise2 + share2 * (step_x * step_x + step_y * step_y);
    Points point = gathered(predicted, track);
    Floats still = update(frame, point, x, y, has_motion ? noise2 : first2, bounds);

    const Places parallax =
        parallax_of(frame, place_x, place_y, gather(predicted[kShiftX_m], track),
                    gather(predicted[kShiftY_m], track), gather(predicted[kShiftZ_m], track));
    const Floats since = gather(predicted[kSince_s], track);
    const Floats log_odds = gather(predicted[kLogOdds], track);
    Floats m_xx = gather(predicted[kMovingXx], track), m_xv = gather(predicted[kMovingXv], track);
    Floats m_vv = gather(predicted[kMovingVv], track);
    const Floats m_off_x = x - gather(predicted[kMovingX], track);
    const Floats m_off_y = y - gather(predicted[kMovingY], track);
    const Floats S = m_xx + noise2;
    Floats moving = exp_of(-0.5F * (m_off_x * m_off_x + m_off_y * m_off_y) / S) / (kTwoPi * S);
    Floats before = faded_odds(frame, log_odds);
    if (any(~has_motion & valid)) {
      const Floats first = density_of_mover(steps_of(frame, step_x, step_y, parallax, bounds),
                                            frame.max_speed_pxps * since, noise2);
      moving = has_motion ? moving : first;
      before = has_motion ? before : none + frame.first_odds;
    }
    const Ints moved = (log_odds > 0.0F) & valid;
    if (any(moved)) {
      // It may have come to rest since its last sighting, at a depth that is not known yet.
      Points rested = seen_once(frame, place_x, place_y, parallax, noise2);
      const Floats anew = update(frame, rested, x, y, first2, bounds), moves = chance_of(log_odds);
      const Floats was_still = (1.0F - moves) * (1 - kind * frame.prior) * still;
      const Floats rests = moves * kind * (1 - frame.prior) * anew;
      still = moved ? (was_still + rests) * (1.0F + before) : still;
      const Ints is_anew = moved & (rests > was_still);
      point = {is_anew ? rested.x : point.x,       is_anew ? rested.y : point.y,
               is_anew ? rested.w : point.w,       is_anew ? rested.V_xx : point.V_xx,
               is_anew ? rested.V_xy : point.V_xy, is_anew ? rested.V_yy : point.V_yy,
               is_anew ? rested.g_x : point.g_x,   is_anew ? rested.g_y : point.g_y,
               is_anew ? rested.C : point.C};
    }
    // If neither hypothesis explains the sighting, the track is not continued.
    const Ints keeps = valid & ~(has_motion & (right * larger(still, moving) < anywhere));
    // A wrong match has a uniform density, plus the density of corners that look as good.
    const Floats wrong = anywhere + load(seen.chance_ppx2 + i);
    const Floats moves_here = right * moving, stands_here = right * still;
    const Floats odds = before * ((moves_here + wrong) / (stands_here + wrong));
    const Floats most = none + frame.most_log_odds;

    // The motion of its own: a Kalman update; the first one is from two sightings.
    const Floats share = noise2 / S, gain_v = m_xv / S;
    const Floats v_x = gather(predicted[kVelocityX], track) + gain_v * m_off_x;
    const Floats v_y = gather(predicted[kVelocityY], track) + gain_v * m_off_y;
    const Floats miss_x = has_motion ? m_off_x * share : none;
    const Floats miss_y = has_motion ? m_off_y * share : none;
    m_vv = has_motion ? m_vv - m_xv * gain_v : 2.0F * noise2 / (since * since);
    m_xv = has_motion ? m_xv * share : noise2 / since;
    m_xx = has_motion ? m_xx * share : noise2;

    // A step of EM: miss and variance of the estimated place are noise, if the match is right.
    const Floats moves = odds / (1.0F + odds);
    const Floats stands = (1.0F - moves) * stands_here / (stands_here + wrong);
    const Floats goes = moves * moves_here / (moves_here + wrong);
    const Floats off_x = x - point.x, off_y = y - point.y;
    const Floats miss2 = off_x * off_x + off_y * off_y + point.V_xx + point.V_yy +
                         (point.g_x * point.g_x + point.g_y * point.g_y) * point.C;
    const Floats moving_miss2 = miss_x * miss_x + miss_y * miss_y + 2.0F * m_xx;
    sum += keeps ? 0.5F * stands * miss2 : none;
    sum_weight += keeps ? stands : none;

    __builtin_memcpy(kept + i, &keeps, sizeof keeps);
    store(still, after[kStaticDensity] + i);
    store(moving, after[kMovingDensity] + i);
    store(wrong, after[kWrongDensity] + i);
    store(log_of(before), after[kLogOddsBefore] + i);
    store(noise2, after[kSeenNoise2] + i);
    store(x, after[kPlaceX] + i);
    store(y, after[kPlaceY] + i);
    for (const int column : {kSince_s, kShiftX_m, kShiftY_m, kShiftZ_m, kBelief}) {
      store(none, after[column] + i);
    }
    store(keeps ? sightings + 1.0F : one, after[kSightings] + i);
    store(keeps ? clamped(log_of(odds), -most, most) : none, after[kLogOdds] + i);
    store(keeps ? noise_sum * right + 0.5F * (stands * miss2 + goes * moving_miss2) : none,
          after[kNoiseSum] + i);
    store(keeps ? noise_weight * right + stands + goes : none, after[kNoiseWeight] + i);
    store_points(keeps, point, Points{}, i, after);
    store(keeps ? x - miss_x : x, after[kMovingX] + i);
    store(keeps ? y - miss_y : y, after[kMovingY] + i);
    store(keeps ? (has_motion ? v_x : step_x / since) : none, after[kVelocityX] + i);
    store(keeps ? (has_motion ? v_y : step_y / since) : none, after[kVelocityY] + i);
    store(keeps ? m_xx : none, after[kMovingXx] + i);
    store(keeps ? m_xv : none, after[kMovingXv] + i);
    store(keeps ? m_vv : none, after[kMovingVv] + i);
  }
  return {total(sum), total(sum_weight)};
}

void show(const TrackFrame& frame, const float* const* tracks, const float* crowd,
          std::size_t count, float* log_odds) {
  const float* const d = frame.displacement_m;
  const float dt = frame.dt_s;
  const Floats none = {};
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Floats own = load(tracks[kLogOdds] + i);
    store(own, log_odds + i);
    // Surely static corners are not asked, and those of unknown motion.
    const Ints asked = (load(tracks[kSightings] + i) >= 2.0F) & (own >= -3.0F) & before(i, count);
    if (!any(asked)) continue;
    const Floats x = load(tracks[kPlaceX] + i), y = load(tracks[kPlaceY] + i);
    const Floats step_x = dt * load(tracks[kVelocityX] + i);
    const Floats step_y = dt * load(tracks[kVelocityY] + i);
    const Steps step =
        steps_of(frame, step_x, step_y,
                 parallax_of(frame, x - step_x, y - step_y, none + d[0], none + d[1], none + d[2]),
                 bounds_at(frame, x, y));
    const Floats alone = 1.0F / load(crowd + i);
    const Floats crossing =
        frame.crossings * alone * alone *
        density_of_crossing(frame, step, dt * dt * load(tracks[kMovingVv] + i)) /
        density_of_mover(step, none + frame.max_speed_pxps * dt, none + frame.noise2_px2);
    store(asked ? -log_of(exp_of(-own) + crossing) : own, log_odds + i);
  }
}

void image_motion(const TrackFrame& frame, const float* const* tracks, std::size_t count,
                  bool moving, float* speed_pxps, float* angle_rad) {
  const float per_s = moving ? 1 / frame.dt_s : 0;
  const Floats d_x = Floats{} + frame.displacement_m[0] * per_s;
  const Floats d_y = Floats{} + frame.displacement_m[1] * per_s;
  const Floats d_z = Floats{} + frame.displacement_m[2] * per_s;
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Floats x = load(tracks[kPlaceX] + i), y = load(tracks[kPlaceY] + i);
    const Ints moves = load(tracks[kBelief] + i) > 0.0F;
    const Places flow = parallax_of(frame, x, y, d_x, d_y, d_z);
    const Floats v_x = moves ? load(tracks[kVelocityX] + i) : flow.x;
    const Floats v_y = moves ? load(tracks[kVelocityY] + i) : flow.y;
    const Floats length = root_of(v_x * v_x + v_y * v_y);
    store(moves ? length : load(tracks[kInverseDepth_pm] + i) * length, speed_pxps + i);
    const Ints rests = ~moves & (length <= 1e-9F);
    const Floats to_x = rests ? x - frame.centre_x_px : v_x;
    const Floats to_y = rests ? y - frame.centre_y_px : v_y;
    const Floats angle = angle_of(to_x, to_y < 0.0F ? -to_y : to_y);
    store(to_y < 0.0F ? -angle : angle, angle_rad + i);
  }
}

void off_segment(const TrackFrame& frame, const float* const* tracks, const Sightings& seen,
                 std::size_t count, float* off2_px2) {
  const float* const d = frame.displacement_m;
  const Floats none = {};
  for (std::size_t i = 0; i < count; i += kLanes) {
    const Ints track = continued(seen, i, count).track;
    const Floats place_x = gather(tracks[kPlaceX], track);
    const Floats place_y = gather(tracks[kPlaceY], track);
    const Floats x = load(seen.x_px + i), y = load(seen.y_px + i);
    store(off2_of(
              steps_of(frame, x - place_x, y - place_y,
                       parallax_of(frame, place_x, place_y, none + d[0], none + d[1], none + d[2]),
                       bounds_at(frame, x, y))),
          off2_px2 + i);
  }
}

void normal_sums(const float* const* misses, std::size_t count, float focal_px, const float* fix,
                 const float* root, NormalSums& sums) {
  Floats information[21] = {}, pull[6] = {};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Floats hx = load(misses[kRayX] + k), hy = load(misses[kRayY] + k);
    const Floats motion = load(misses[kMotion_s] + k) * focal_px;
    const float f = focal_px;
    const Floats J[2][6] = {
        {f * hx * hy, -f * (1.0F + hx * hx), f * hy, -motion, Floats{}, motion * hx},
        {f * (1.0F + hy * hy), -f * hx * hy, -f * hx, Floats{}, -motion, motion * hy}};
    const Floats off[2] = {load(misses[kOffX] + k), load(misses[kOffY] + k)};
    Floats left[2] = {off[0], off[1]};
    // Covariance S of the residual; T adds the covariance of the fix, J root (J root)^T.
    const Floats S_xx = load(misses[kSxx] + k), S_xy = load(misses[kSxy] + k);
    const Floats S_yy = load(misses[kSyy] + k), S_det = load(misses[kSDet] + k);
    Floats T_xx = S_xx, T_xy = S_xy, T_yy = S_yy, T_det = S_det;
    for (int column = 0; column < 6; ++column) {
      Places spread = {};
      for (int row = column; row < 6; ++row) {
        const float entry = root[row * (row + 1) / 2 + column];
        spread.x += J[0][row] * entry;
        spread.y += J[1][row] * entry;
      }
      T_det = widened(T_det, T_xx, T_xy, T_yy, spread);
      T_xx += spread.x * spread.x;
      T_xy += spread.x * spread.y;
      T_yy += spread.y * spread.y;
      left[0] -= J[0][column] * fix[column];
      left[1] -= J[1][column] * fix[column];
    }
    const Floats distance2 =
        (left[0] * left[0] * T_yy - 2.0F * left[0] * left[1] * T_xy + left[1] * left[1] * T_xx) /
        T_det;
    const Floats stands =
        load(misses[kStands] + k) * exp_of(-0.5F * distance2) / (kTwoPi * root_of(T_det));
    const Floats weight =
        load(misses[kVoice] + k) * stands / (stands + load(misses[kOtherwise] + k));
    const Floats precision = weight / S_det;
    const Floats P_xx = S_yy * precision, P_xy = -S_xy * precision, P_yy = S_xx * precision;
    for (int row = 0, entry = 0; row < 6; ++row) {
      const Floats weighed[2] = {P_xx * J[0][row] + P_xy * J[1][row],
                                 P_xy * J[0][row] + P_yy * J[1][row]};
      for (int column = row; column < 6; ++column, ++entry) {
        information[entry] += weighed[0] * J[0][column] + weighed[1] * J[1][column];
      }
      pull[row] += weighed[0] * off[0] + weighed[1] * off[1];
    }
  }
  for (int i = 0; i < 21; ++i) sums.information[i] = double{total(information[i])};
  for (int i = 0; i < 6; ++i) sums.pull[i] = double{total(pull[i])};
}

Agreement agree(const float* const* misses, std::size_t count) {
  Floats left = {}, stood = {}, all = {};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Floats x = load(misses[kOffX] + k), y = load(misses[kOffY] + k);
    const Floats S_xx = load(misses[kSpreadXx] + k), S_xy = load(misses[kSpreadXy] + k);
    const Floats S_yy = load(misses[kSpreadYy] + k), det = load(misses[kSpreadDet] + k);
    const Floats distance2 = (x * x * S_yy - 2.0F * x * y * S_xy + y * y * S_xx) / det;
    const Floats stands = load(misses[kStands] + k);
    const Floats fits = stands * exp_of(-0.5F * distance2) / (kTwoPi * root_of(det));
    const Floats voice = load(misses[kVoice] + k), otherwise = load(misses[kOtherwise] + k);
    left += voice * stands * otherwise / (fits + otherwise);
    stood += voice * stands;
    all += voice;
  }
  return {double{total(left)}, double{total(stood)}, double{total(all)}};
}

constexpr TrackLoops kTrackLoops = {rotate, predict,      expect,      densities,   misses, see,
                                    show,   image_motion, off_segment, normal_sums, agree};

}  // namespace
