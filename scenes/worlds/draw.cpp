#include "scenes/worlds/draw.h"

#include <cmath>

namespace lcs::worlds {

double Draw::scaled(double low, double high) {
  return low * std::exp(between(0, std::log(high / low)));
}

}  // namespace lcs::worlds
