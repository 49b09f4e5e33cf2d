/// \file
/// Times of recordings: nanoseconds of a clock, whatever its zero.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "tools/files/csv.h"

namespace lcs::replay {

/// No time is farther from the clock's zero (146 years), so that any two have a difference.
inline constexpr std::int64_t kFarthest_ns = std::numeric_limits<std::int64_t>::max() / 2;

inline bool is_time(std::int64_t t_ns) {
  return t_ns >= -kFarthest_ns && t_ns <= kFarthest_ns;
}

/// A whole number of units as a time; none if it is anything else, or too far away.
inline std::optional<std::int64_t> time_in(std::string_view text, std::int64_t unit_ns) {
  const auto units = bench::number_in<std::int64_t>(text);
  if (!units || *units > kFarthest_ns / unit_ns || *units < -kFarthest_ns / unit_ns) {
    return std::nullopt;
  }
  return *units * unit_ns;
}

/// Seconds, as "1305031102.175304" or "1.5e-01", as a time; none if it is anything else, or too far
/// away. Digits behind the ninth of a fraction are left out.
std::optional<std::int64_t> seconds_in(std::string_view text);

/// "2011-09-26" and "13:02:25.964389445", in UTC, as nanoseconds since 1970, to the nearest; none
/// if that is no day of the years 1900 to 2099, or no time of a day. A leap second is the next
/// minute's first.
std::optional<std::int64_t> calendar_time_in(std::string_view date, std::string_view clock);

}  // namespace lcs::replay
