/// \file
/// A change of light that a pixel of an event camera reports.
#pragma once

#include <cstdint>

namespace lcs::sim {

struct Event {
  std::int64_t t_ns = 0;  ///< by the clock of the pictures' times
  std::uint16_t x = 0, y = 0;
  bool is_on = false;  ///< the light has grown

  bool operator==(const Event&) const = default;
};

}  // namespace lcs::sim
