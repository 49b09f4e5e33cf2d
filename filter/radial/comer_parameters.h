/// \file
/// Parameters of the comers (keys `comers.*`). MODEL.md defines each by its formula.
#pragma once

namespace lcs {

struct ComerParameters {
  double hanging = 0.003;    ///< share of static circles that hang free; 1 switches the rule off
  double count_power = 0.3;  ///< power of the number of edges in the evidence of an empty gap
  double memory = 2;         ///< frames over which the log odds of a circle fade
};

}  // namespace lcs
