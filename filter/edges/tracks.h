/// \file
/// The tracks: corners over time under two hypotheses, static and moving by itself, with the log
/// odds of moving. Their state is columns of numbers, and the steps of MODEL.md are loops over
/// them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "filter/edges/edge_parameters.h"
#include "filter/edges/track_loops.h"
#include "filter/kinematics/camera.h"
#include "filter/kinematics/motion_field.h"
#include "filter/types/layers.h"
#include "filter/types/signature.h"
#include "filter/vectors/columns.h"

namespace lcs {

struct Tracks {
  /// What the loops do not need.
  struct Record {
    Id id = 0;
    Signature signature{};
    int age = 0;      ///< frames since the first sighting
    int unseen = 0;   ///< frames since the last sighting
    int corner = -1;  ///< index in this frame, -1: none
  };

  Columns<float, kTrackColumns> columns;
  std::vector<Record> records;

  std::size_t size() const { return records.size(); }
  float at(TrackColumn column, std::size_t track) const { return columns[column][track]; }
  /// The point whose coordinates are this column and the next, px.
  Vec2 point(TrackColumn column, std::size_t track) const {
    return {at(column, track), at(static_cast<TrackColumn>(column + 1), track)};
  }
  bool has_motion(std::size_t track) const { return at(kSightings, track) >= 2; }
  /// Covariance of a sighting, given the static prediction, px^2.
  Eigen::Matrix2d static_spread(std::size_t track, double noise2_px2) const;
  /// Appends a track of another list. There must be room for it.
  void append(const Tracks& from, std::size_t track);
};

/// The motion and the parameters of a frame, but for the noise of corners.
TrackFrame track_frame(const Intrinsics& camera, const MotionField& field,
                       const EdgeParameters& parameters);

}  // namespace lcs
