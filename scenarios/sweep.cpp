#include "scenarios/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "scenarios/load.h"

namespace lcs::scenario {
namespace {

/// More points are a mistake, for example an extra list, and would take days.
constexpr std::size_t kMostPoints = 1000;

/// The point of this number; its mixed-radix digits index the lists of values.
SweepPoint point_at(const std::vector<SweptKey>& sweep, std::size_t index) {
  SweepPoint point;
  point.settings.resize(sweep.size());
  for (std::size_t i = sweep.size(); i-- > 0;) {
    const std::vector<SweptKey::Value>& values = sweep[i].values;
    point.settings[i] = {sweep[i].key, values[index % values.size()].text};
    index /= values.size();
  }
  return point;
}

/// Loads the point; errors cite the value in the file.
void check(const std::filesystem::path& file, const std::vector<SweptKey>& sweep,
           const SweepPoint& point) {
  LoadOptions options;
  for (const auto& [key, value] : point.settings) options.sets.push_back(key + "=" + value);
  try {
    load(file, options);
  } catch (const input::Error& error) {
    const std::string_view message = error.what();
    for (std::size_t i = 0; i < sweep.size(); ++i) {
      const std::string prefix = "--set " + options.sets[i] + ": ";
      if (!message.starts_with(prefix)) continue;
      const auto value =
          std::ranges::find(sweep[i].values, point.settings[i].second, &SweptKey::Value::text);
      throw input::Error(value->source, "sweep.{}: {}", sweep[i].key,
                         message.substr(prefix.size()));
    }
    throw input::Error(sweep.front().source, "sweep, at {}: {}", fmt::join(options.sets, ", "),
                       message);
  }
}

}  // namespace

std::vector<SweepPoint> sweep_points(const std::filesystem::path& file) {
  const std::vector<SweptKey> sweep = load(file).sweep;
  std::size_t count = 1;
  for (const SweptKey& swept : sweep) {
    count *= swept.values.size();
    if (count > kMostPoints) {
      throw input::Error(sweep.front().source, "sweep has more than {} points; shorten its lists",
                         kMostPoints);
    }
  }
  std::vector<SweepPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(point_at(sweep, i));
    if (!sweep.empty()) check(file, sweep, points.back());
  }
  return points;
}

}  // namespace lcs::scenario
