/// \file
/// The error of physics that cannot go on.
#pragma once

#include <stdexcept>

namespace lcs::sim {

/// Thrown when MuJoCo warns or fails (bad qacc and the like); the message has the simulated time.
class PhysicsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace lcs::sim
