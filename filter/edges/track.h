/// \file
/// A corner over time under two hypotheses, static and moving by itself, with the log odds of
/// moving.
#pragma once

#include "filter/edges/own_motion.h"
#include "filter/edges/static_point.h"
#include "filter/layers.h"
#include "filter/signature.h"

namespace lcs {

struct Track {
  Id id = 0;
  Vec2 place_px = Vec2::Zero();  ///< last sighting; in a prediction rotated to this frame
  Signature signature{};
  StaticPoint as_static;  ///< of a track seen once: set in predictions only
  OwnMotion as_moving;    ///< from the second sighting on
  int sightings = 0;
  /// Time since the last sighting, and displacement since then in the camera's present frame.
  double since_s = 0;
  Eigen::Vector3d displacement_C_m = Eigen::Vector3d::Zero();
  int age = 0;          ///< frames since the first sighting
  int unseen = 0;       ///< frames since the last sighting
  int corner = -1;      ///< index in this frame, -1: none
  double log_odds = 0;  ///< of moving, by its own sightings
  double belief = 0;    ///< log odds of moving, coupled with its neighbours

  bool has_motion() const { return sightings >= 2; }
};

}  // namespace lcs
