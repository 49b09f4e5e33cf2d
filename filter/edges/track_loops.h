/// \file
/// The state of tracks as columns of numbers, and the steps of MODEL.md as loops over them, eight
/// tracks at a time. The results have the same bits on each machine (`filter/vectors/vectors.h`).
#pragma once

#include <cstddef>
#include <cstdint>

namespace lcs {

/// A column of the tracks' state. A static point's place depends on its inverse depth w: given w
/// (`kGiven...`), it is normal about the place at the mean of w, moved by `kByDepth` for each 1/m.
/// So the covariance of (x, y, w) has no small difference of large numbers, even where the depth is
/// unknown.
enum TrackColumn : std::uint8_t {
  kPlaceX,  ///< px: last sighting; in a prediction rotated to this frame
  kPlaceY,
  kSince_s,   ///< since the last sighting
  kShiftX_m,  ///< displacement of the camera since then, in its present frame
  kShiftY_m,
  kShiftZ_m,
  kSightings,
  kLogOdds,      ///< of moving, by its own sightings
  kBelief,       ///< log odds of moving, coupled with its neighbours
  kNoiseSum,     ///< px^2: faded sum of its squared misses, MODEL.md (17)
  kNoiseWeight,  ///< faded number of these
  kStaticX,      ///< px: as a static point; of a track seen once: set in predictions only
  kStaticY,
  kInverseDepth_pm,
  kGivenXx,  ///< px^2: covariance of the place, given w
  kGivenXy,
  kGivenYy,
  kByDepthX,  ///< px m
  kByDepthY,
  kDepthVariance,  ///< of w, 1/m^2
  kMovingX,        ///< px: as a moving point, from the second sighting on
  kMovingY,
  kVelocityX,  ///< px/s, camera rotation removed
  kVelocityY,
  kMovingXx,  ///< covariance of (x, v), the same on each axis
  kMovingXv,
  kMovingVv,
  kStaticPxx,  ///< 1/px^2: precision of a sighting, if static; in predictions only, like the next
  kStaticPxy,
  kStaticPyy,
  kStaticMost,  ///< 1/px^2: the largest density of a sighting, times the chance of being static
  kMovingP,     ///< the same if it moves
  kMovingMost,
  kAnywhere,       ///< 1/px^2: density of a sighting that neither explains
  kStaticDensity,  ///< 1/px^2: p_S, (12); of the sighting that made the state, like the next
  kMovingDensity,  ///< 1/px^2: p_M, (13)
  kWrongDensity,   ///< 1/px^2: phi, (15)
  kLogOddsBefore,  ///< L', (15)
  kSeenNoise2,     ///< px^2: sigma^2, (17)
  kTrackColumns
};

/// A frame's motion and parameters, as the loops take them.
struct TrackFrame {
  float focal_px, centre_x_px, centre_y_px;
  float R[3][3];            ///< R_cur_prev
  float displacement_m[3];  ///< of the camera, in its frame of k
  float dt_s;
  float most_pm;    ///< 1 / z_min
  float ground[3];  ///< inverse depth of the ground is this times (1, h), 1/m; zeros if unknown
  float slack_pm;   ///< standard deviation of it, by the ground's tilt
  float ego_share, turnover_ps, turnover, kind_turnover, prior;
  float first_odds;  ///< of moving, of a new corner
  float most_log_odds, usual_weight;
  float max_speed_pxps, reach_area_px2;
  float crossings, slide;
  float noise2_px2 = 0;       ///< of this frame's corners
  float last_noise2_px2 = 0;  ///< of the last frame's corners
};

/// The corners of a frame that continue tracks, as the loops take them; padded.
struct Sightings {
  const float *x_px, *y_px;
  const int* track_of;       ///< of each corner; -1: none
  const float* chance_ppx2;  ///< `Association::chance_ppx2`
  const float* crowd;        ///< `Association::crowd`
};

/// Sums for `CornerNoise`.
struct Misses {
  float sum_px2 = 0, weight = 0;
};

/// A column of misses: of static tracks' corners from their predictions (MODEL.md (8)).
enum MissColumn : std::uint8_t {
  kRayX,  ///< h, of the predicted place
  kRayY,
  kMotion_s,  ///< s/m: inverse depth times the frame's time, by which a velocity acts
  kOffX,      ///< px: the miss
  kOffY,
  kSpreadXx,  ///< px^2: covariance of the miss at the track's depth
  kSpreadXy,
  kSpreadYy,
  kSpreadDet,  ///< px^4: its determinant, which its entries would give with a large error
  kSxx,        ///< px^2: at any depth and velocity
  kSxy,
  kSyy,
  kSDet,
  kVoice,      ///< weight: tracks of one body are off together; 0 for none
  kStands,     ///< chance that the point is static
  kOtherwise,  ///< 1/px^2: density of the corner if not static, times 1 - `kStands`
  kMissColumns
};

/// Sums of weighted least squares for six unknowns, row by row.
struct NormalSums {
  double information[21];  ///< upper triangle
  double pull[6];
};

/// Weight of the static tracks that left their predictions, of all static tracks, and of all
/// tracks.
struct Agreement {
  double left = 0, stood = 0, all = 0;
};

struct TrackLoops {
  /// (1): places after a rotation. A point turned behind the camera keeps its place.
  /// \param homography row by row.
  void (*rotate)(const float* homography, const float* x_px, const float* y_px, std::size_t count,
                 float* to_x_px, float* to_y_px);
  /// (2) to (5): the state in the next frame. \param after holds the rotated places.
  void (*predict)(const TrackFrame& frame, const float* const* before, std::size_t count,
                  float* const* after);
  /// (6): sets the columns from `kStaticPxx` on.
  void (*expect)(const TrackFrame& frame, std::size_t count, float* const* tracks);
  /// The densities (6) of a corner for some tracks.
  /// \param which indices of tracks; padded.
  /// \param ln_density, ln_off padded: of the density; of the larger share of its largest value.
  void (*densities)(const float* const* tracks, const int* which, std::size_t count, float x_px,
                    float y_px, float* ln_density, float* ln_off);
  /// (8): all columns of misses, one for each of some corners.
  /// \param asked indices of corners with tracks; padded.
  /// \param started whether the tracks have a motion.
  /// \param velocity_variance_m2ps2 of the told velocity, on an axis.
  void (*misses)(const TrackFrame& frame, const float* const* tracks, const Sightings& seen,
                 const int* asked, std::size_t count, bool started, float velocity_variance_m2ps2,
                 float* const* misses);
  /// (12) to (17): the tracks after their sightings, corner by corner. A corner of which no track
  /// is left starts a track. \param kept 0 for these corners; padded.
  Misses (*see)(const TrackFrame& frame, const float* const* predicted, const Sightings& seen,
                std::size_t count, float* const* after, int* kept);
  /// (34): the log odds that tracks show to their neighbours; padded.
  void (*show)(const TrackFrame& frame, const float* const* tracks, const float* crowd,
               std::size_t count, float* log_odds);
  /// Image motion of the tracks, rotation removed: their own if they move, else that of static
  /// points; padded.
  /// \param moving whether the camera moves.
  /// \param angle_rad of the direction; of a point without motion, from the principal point.
  void (*image_motion)(const TrackFrame& frame, const float* const* tracks, std::size_t count,
                       bool moving, float* speed_pxps, float* angle_rad);
  /// Square of the distance of a corner from the segment of places that its track would have as a
  /// static point seen in the last frame only, px^2; padded.
  void (*off_segment)(const TrackFrame& frame, const float* const* tracks, const Sightings& seen,
                      std::size_t count, float* off2_px2);
  /// Sums of the equations of (9) for the turn and the velocity. Behind the misses must be some of
  /// voice 0.
  /// \param fix present estimate.
  /// \param root lower triangle of a Cholesky factor of the estimate's covariance, row by row.
  void (*normal_sums)(const float* const* misses, std::size_t count, float focal_px,
                      const float* fix, const float* root, NormalSums& sums);
  /// How many static tracks left their predictions, by their misses.
  Agreement (*agree)(const float* const* misses, std::size_t count);
};

/// The loops by the instructions that all machines have.
const TrackLoops& plain_track_loops();
/// The loops by this machine's instructions.
const TrackLoops& track_loops();

}  // namespace lcs
