/// \file
/// A world's random choices, from the project's own generator (sim/base/random.h).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "sim/base/random.h"

namespace lcs::worlds {

using Eigen::Vector2d;
using Eigen::Vector3d;

class Draw {
 public:
  Draw(std::uint64_t seed, std::string_view name) : random_(seed, name) {}

  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  /// Log-uniform; both limits are above 0.
  double scaled(double low, double high) {
    return low * std::exp(between(0, std::log(high / low)));
  }
  /// Uniform integer; both limits are included.
  int whole(int low, int high) {
    return low + static_cast<int>(random_.bits() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double share) { return random_.uniform() < share; }
  double sign() { return chance(0.5) ? 1 : -1; }
  /// Uniform between the limits, with a random sign.
  double either(double low, double high) {
    const double size = between(low, high);
    return sign() * size;
  }
  double normal() { return random_.normal(); }

  template <class T>
  T pick(std::initializer_list<T> choices) {
    return choices.begin()[whole(0, static_cast<int>(choices.size()) - 1)];
  }
  template <class T>
  const T& pick(const std::vector<T>& choices) {
    return choices[static_cast<std::size_t>(whole(0, static_cast<int>(choices.size()) - 1))];
  }

 private:
  sim::RandomStream random_;
};

}  // namespace lcs::worlds
