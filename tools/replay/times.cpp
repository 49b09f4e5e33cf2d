#include "tools/replay/times.h"

#include <chrono>
#include <cmath>
#include <string>

namespace lcs::replay {
namespace {

constexpr double kNanosecondsASecond = 1e9;

/// Three texts with separators between them.
struct Parts {
  std::string_view first, second, third;
};
std::optional<Parts> parts_of(std::string_view text, char separator) {
  const std::size_t one = text.find(separator);
  if (one == text.npos) return std::nullopt;
  const std::size_t two = text.find(separator, one + 1);
  if (two == text.npos) return std::nullopt;
  return Parts{text.substr(0, one), text.substr(one + 1, two - one - 1), text.substr(two + 1)};
}

std::optional<int> whole_within(std::string_view text, int least, int most) {
  const auto number = bench::number_in<int>(text);
  return number && *number >= least && *number <= most ? number : std::nullopt;
}

std::optional<std::chrono::sys_days> day_in(std::string_view date) {
  const auto parts = parts_of(date, '-');
  if (!parts) return std::nullopt;
  const auto year = whole_within(parts->first, 1900, 2099);
  const auto month = whole_within(parts->second, 1, 12);
  const auto day = whole_within(parts->third, 1, 31);
  if (!year || !month || !day) return std::nullopt;
  const std::chrono::year_month_day on{std::chrono::year(*year), std::chrono::month(*month),
                                       std::chrono::day(*day)};
  if (!on.ok()) return std::nullopt;
  return std::chrono::sys_days(on);
}

std::optional<std::chrono::nanoseconds> time_of_day_in(std::string_view clock) {
  const auto parts = parts_of(clock, ':');
  if (!parts) return std::nullopt;
  const auto hour = whole_within(parts->first, 0, 23);
  const auto minute = whole_within(parts->second, 0, 59);
  const auto second = bench::number_in<double>(parts->third);
  if (!hour || !minute || !second || !(*second >= 0 && *second < 61)) return std::nullopt;
  return std::chrono::hours(*hour) + std::chrono::minutes(*minute) +
         std::chrono::nanoseconds(std::llround(*second * kNanosecondsASecond));
}

bool is_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

}  // namespace

std::optional<std::int64_t> seconds_in(std::string_view text) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  constexpr std::size_t kDigits = 9;
  const std::size_t point = text.find('.');
  const std::string_view fraction = point == text.npos ? "" : text.substr(point + 1);
  if (is_digits(text.substr(0, point)) && (fraction.empty() || is_digits(fraction))) {
    // not through a double, whose precision at such times is above a nanosecond
    std::string digits(fraction.substr(0, kDigits));
    digits.resize(kDigits, '0');
    const auto seconds = time_in(text.substr(0, point), kSecond_ns);
    const auto rest = bench::number_in<std::int64_t>(digits);
    return seconds && rest && is_time(*seconds + *rest) ? std::optional(*seconds + *rest)
                                                        : std::nullopt;
  }
  const auto number = bench::number_in<double>(text);
  if (!number || std::abs(*number) * kNanosecondsASecond >= static_cast<double>(kFarthest_ns)) {
    return std::nullopt;
  }
  return std::llround(*number * kNanosecondsASecond);
}

std::optional<std::int64_t> calendar_time_in(std::string_view date, std::string_view clock) {
  const auto day = day_in(date);
  const auto time_of_day = time_of_day_in(clock);
  if (!day || !time_of_day) return std::nullopt;
  return std::chrono::nanoseconds(day->time_since_epoch() + *time_of_day).count();
}

}  // namespace lcs::replay
