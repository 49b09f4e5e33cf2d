/// \file
/// Parameters of the circles (keys `circle.*`). MODEL.md defines each by its formula.
#pragma once

#include "filter/types/trust.h"

namespace lcs {

struct CircleParameters {
  TrustRanks trust{2, 3, 7};  ///< Tr^c
  int min_members = 7;        ///< fewest edges of a circle
  /// px: least standard deviation of a circle's edges across their principal line. Crossings of an
  /// outline and the pixel steps of a slanting line slide along the line, and make no circle.
  double min_width = 1.5;
  double gap_m = 0.2;       ///< m: typical distance between neighbouring edges of one body
  double upward = 0.45;     ///< weight of a vertical distance, relative to a horizontal one
  double roughness = 0.05;  ///< standard deviation of a body's depths about a plane, relative
};

}  // namespace lcs
