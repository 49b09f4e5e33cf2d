#include "tools/suite/interval.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/scoring/statistics.h"

namespace lcs::suite {

double student_t_95(int degrees_of_freedom) {
  // Table values below ten degrees. Above, the expansion in 1 / degrees (Abramowitz and Stegun,
  // 26.7.5) is accurate enough.
  constexpr std::array<double, 9> kExact{12.7062, 4.3027, 3.1824, 2.7764, 2.5706,
                                         2.4469,  2.3646, 2.3060, 2.2622};
  if (degrees_of_freedom <= static_cast<int>(kExact.size()))
    return kExact.at(degrees_of_freedom - 1);
  constexpr double kNormal = 1.959964;
  const double z2 = kNormal * kNormal, n = degrees_of_freedom;
  const double first = (z2 + 1) / 4, second = ((5 * z2 + 16) * z2 + 3) / 96;
  const double third = (((3 * z2 + 19) * z2 + 17) * z2 - 15) / 384;
  return kNormal * (1 + first / n + second / (n * n) + third / (n * n * n));
}

Interval interval_of(const std::vector<double>& values) {
  Interval interval{bench::mean(values).value(), std::nullopt};
  if (values.size() < 2) return interval;
  double squares = 0;
  for (const double value : values) squares += std::pow(value - interval.mean, 2);
  const auto count = static_cast<double>(values.size());
  const double deviation = std::sqrt(squares / (count - 1));
  interval.half = student_t_95(static_cast<int>(values.size()) - 1) * deviation / std::sqrt(count);
  return interval;
}

std::string half_text(double half, int decimals) {
  const auto width = static_cast<std::size_t>(std::max(3, decimals + 1));
  std::string digits = fmt::format("{:.{}f}", half, decimals);
  if (digits.find_first_not_of("0.") == std::string::npos) return std::string(1 + width, ' ');
  if (decimals >= 2 && digits.starts_with("0.")) digits.erase(0, 1);
  if (digits.size() > width && decimals == 1) digits = fmt::format("{:.0f}", half);
  return fmt::format("±{:<{}}", digits, width);
}

}  // namespace lcs::suite
