/// \file
/// Confidence intervals of means, and the probability that chance alone gives such a mean.
#pragma once

#include <optional>
#include <vector>

namespace lcs::suite {

/// The probability that a verdict is a false alarm. 95 % intervals leave so much out.
inline constexpr double kFalseAlarms = 0.05;

/// A mean with a confidence interval, of 95 % unless stated, which assumes normally distributed
/// values.
struct Interval {
  double mean = 0;
  std::optional<double> half;  ///< half width; absent for a single value, whose noise is unknown
  double error = 0;            ///< the standard error of the mean, if `half` is known
  int degrees_of_freedom = 0;  ///< of `error`, if `half` is known
};

/// The mean of a random sample. \param values at least one value.
/// \param level probability that the interval misses the true mean.
Interval interval_of(const std::vector<double>& values, double level = kFalseAlarms);

/// The mean over a fixed set of strata, each a random sample, with equal weights. Only noise within
/// the strata counts (degrees of freedom by Welch and Satterthwaite, rounded down). If a stratum
/// has one value, the strata's means are taken for a random sample: this overestimates the noise.
/// \param strata at least one, none empty.
Interval interval_of_strata(const std::vector<std::vector<double>>& strata,
                            double level = kFalseAlarms);

/// The probability of a mean at least so far beyond `least`, on both sides, if the true mean is not
/// beyond it; 1 for a mean whose noise is unknown.
double chance_beyond(const Interval& interval, double least);

/// Holm's rule: which of the results are real, if at most this share of families of results may
/// have any that chance made. \param chances the probability of each under chance.
std::vector<bool> real_among(const std::vector<double>& chances, double level = kFalseAlarms);

}  // namespace lcs::suite
