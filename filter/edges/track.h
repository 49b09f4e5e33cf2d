/// \file
/// A corner over time under two hypotheses, static and moving by itself, and how much more likely
/// the second is.
#pragma once

#include "filter/edges/own_motion.h"
#include "filter/edges/static_point.h"
#include "filter/layers.h"
#include "filter/signature.h"

namespace lcs {

struct Track {
  Id id = 0;
  Vec2 place_px = Vec2::Zero();  ///< last sighting, or where it is expected; rotated on predicting
  Signature signature{};
  StaticPoint as_static;  ///< of a track seen once in predictions alone
  OwnMotion as_moving;    ///< from the second sighting on
  int sightings = 0;
  /// Since the last sighting: time, and the camera's displacement in its present frame.
  double since_s = 0;
  Eigen::Vector3d displacement_C_m = Eigen::Vector3d::Zero();
  int age = 0;          ///< frames since the first
  int unseen = 0;       ///< frames since the last
  int corner = -1;      ///< that it has in this frame, -1: none
  double log_odds = 0;  ///< that it moves, by its own sightings
  double belief = 0;    ///< the same, with what is round it

  bool has_motion() const { return sightings >= 2; }
};

}  // namespace lcs
