#include "tools/suite/interval.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <utility>

#include "tools/scoring/statistics.h"

namespace lcs::suite {
namespace {

Interval interval_with(double mean, double error, int degrees_of_freedom, double level) {
  const boost::math::students_t law(degrees_of_freedom);
  const double most = quantile(complement(law, level / 2));
  return {mean, most * error, error, degrees_of_freedom};
}

/// The square of the standard error of the mean of a sample of at least two values.
double squared_error(const std::vector<double>& values, double mean) {
  double squares = 0;
  for (const double value : values) squares += std::pow(value - mean, 2);
  const auto count = static_cast<double>(values.size());
  return squares / (count - 1) / count;
}

}  // namespace

Interval interval_of(const std::vector<double>& values, double level) {
  const double mean = scoring::mean(values).value();
  if (values.size() < 2) return {.mean = mean, .half = std::nullopt};
  return interval_with(mean, std::sqrt(squared_error(values, mean)),
                       static_cast<int>(values.size()) - 1, level);
}

Interval interval_of_strata(const std::vector<std::vector<double>>& strata, double level) {
  std::vector<double> means;
  bool has_noise = true;
  for (const std::vector<double>& values : strata) {
    means.push_back(scoring::mean(values).value());
    has_noise &= values.size() >= 2;
  }
  if (!has_noise) return interval_of(means, level);
  double sum = 0, weighed = 0;
  int degrees = 0;
  for (std::size_t i = 0; i < strata.size(); ++i) {
    const double squared = squared_error(strata[i], means[i]);
    const auto own = static_cast<int>(strata[i].size()) - 1;
    sum += squared;
    weighed += squared * squared / own;
    degrees += own;
  }
  if (weighed > 0) degrees = std::max(1, static_cast<int>(sum * sum / weighed));
  return interval_with(scoring::mean(means).value(),
                       std::sqrt(sum) / static_cast<double>(strata.size()), degrees, level);
}

double chance_beyond(const Interval& interval, double least) {
  const double beyond = std::abs(interval.mean) - least;
  if (!interval.half || beyond <= 0) return 1;
  if (interval.error == 0) return 0;
  const boost::math::students_t law(interval.degrees_of_freedom);
  return 2 * cdf(complement(law, beyond / interval.error));
}

std::vector<bool> real_among(const std::vector<double>& chances, double level) {
  std::vector<std::size_t> order(chances.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(chances[i], i); });
  std::vector<bool> real(chances.size(), false);
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    if (chances[order[rank]] > level / static_cast<double>(order.size() - rank)) break;
    real[order[rank]] = true;
  }
  return real;
}

}  // namespace lcs::suite
