/// \file
/// Times of recordings: nanoseconds of a clock with any zero.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "tools/files/csv.h"

namespace lcs::replay {

/// The largest distance from the clock's zero (146 years), so that differences do not overflow.
inline constexpr std::int64_t kFarthest_ns = std::numeric_limits<std::int64_t>::max() / 2;

inline bool is_time(std::int64_t t_ns) {
  return t_ns >= -kFarthest_ns && t_ns <= kFarthest_ns;
}

/// Parses a whole number of units as a time; absent if malformed or too far from zero.
inline std::optional<std::int64_t> time_in(std::string_view text, std::int64_t unit_ns) {
  const auto units = bench::number_in<std::int64_t>(text);
  if (!units || *units > kFarthest_ns / unit_ns || *units < -kFarthest_ns / unit_ns) {
    return std::nullopt;
  }
  return *units * unit_ns;
}

/// Parses seconds, as "1305031102.175304" or "1.5e-01"; absent if malformed or too far from zero.
/// Fraction digits after the ninth are dropped.
std::optional<std::int64_t> seconds_in(std::string_view text);

/// Parses UTC, as "2011-09-26" and "13:02:25.964389445", to nanoseconds since 1970, rounded; absent
/// for an invalid time or a date outside the years 1900 to 2099. A leap second becomes the first
/// second of the next minute.
std::optional<std::int64_t> calendar_time_in(std::string_view date, std::string_view clock);

}  // namespace lcs::replay
