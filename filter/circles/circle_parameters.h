/// \file
/// Parameters of the circles (keys `circle.*`). MODEL.md defines each by its formula.
#pragma once

#include "filter/trust.h"

namespace lcs {

struct CircleParameters {
  TrustRanks trust{2, 3, 7};  ///< Tr^c
  int min_members = 7;        ///< edges that a circle has at least
  /// px: standard deviation of a circle's edges across their line, at least. The crossings of an
  /// outline, and the steps that a slanting line is drawn in, slide along the line.
  double min_width = 1.5;
  double gap_m = 0.2;       ///< m: typical distance between neighbouring edges of one body
  double upward = 0.45;     ///< weight of a distance upwards, relative to one along the horizon
  double roughness = 0.05;  ///< standard deviation of a body's depths about a plane, as a share
};

}  // namespace lcs
