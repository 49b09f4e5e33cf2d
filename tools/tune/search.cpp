#include "tools/tune/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlopt.hpp>
#include <optional>
#include <random>
#include <stdexcept>
#include <utility>

#include "scenarios/input/spelling.h"

namespace lcs::tune {
namespace {

/// Largest ratio of a value to the present one.
constexpr double kReach = 4;
/// Length of the first steps and range of the other seeds' starts, as a logarithm to base `kReach`.
constexpr double kFirstStep = 0.25;

/// \name The search's logarithmic scale: 0 is the present value, 1 is `kReach` times that.
///@{
double value_at(const Axis& axis, double z) {
  return std::clamp(axis.start * std::pow(kReach, z), axis.low, axis.high);
}
double z_of(const Axis& axis, double value) {
  return std::log(value / axis.start) / std::log(kReach);
}
///@}

/// The number at the beginning of a text, such as the filter's description of a parameter.
double number(std::string_view text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

Axis axis_of(const std::vector<ParameterInfo>& known, const std::string& key) {
  const auto found = std::ranges::find(known, key, &ParameterInfo::key);
  if (found == known.end()) {
    std::vector<std::string> names;
    for (const ParameterInfo& info : known) names.push_back(info.key);
    throw std::invalid_argument(
        fmt::format("--keys: the filter has no parameter '{}'; the nearest is '{}'", key,
                    input::nearest_first(key, std::move(names)).front()));
  }
  const std::size_t to = found->range.find(" to ");
  Axis axis{key, number(found->value), 0, 0};
  if (to == std::string::npos || !(axis.start > 0)) {
    throw std::invalid_argument(
        fmt::format("--keys: {} is {}, and only a number above 0 can be tuned; leave it out", key,
                    found->value));
  }
  axis.low = std::max(number(found->range), axis.start / kReach);
  axis.high = std::min(number(found->range.substr(to + 4)), axis.start * kReach);
  return axis;
}

/// The value with three digits, which is all that a mean over worlds resolves; rounded if the
/// parameter is an integer.
std::string text_of(const Parameters& parameters, const std::string& key, double value) {
  const std::string text = fmt::format("{:.3g}", value);
  Parameters copy = parameters;
  try {
    set(copy, key, text);
    return text;
  } catch (const std::invalid_argument&) {
    return fmt::format("{}", std::lround(value));
  }
}

}  // namespace

std::vector<Axis> axes_of(const Parameters& start, const std::vector<std::string>& keys) {
  const std::vector<ParameterInfo> known = describe(start);
  std::vector<Axis> axes;
  for (const std::string& key : keys) {
    if (std::ranges::count(keys, key) > 1) {
      throw std::invalid_argument(fmt::format("--keys: {} is given twice; remove one", key));
    }
    axes.push_back(axis_of(known, key));
  }
  return axes;
}

void add_facts(files::Json& facts, const SearchOptions& options) {
  facts["seed"] = options.seed;
  facts["keys"] = files::Json::array();
  for (const Axis& axis : options.axes) {
    facts["keys"].push_back(axis.key);
    facts[axis.key] = fmt::format("{}, tried from {} to {}", axis.start, axis.low, axis.high);
  }
}

Found search(const Parameters& start, const SearchOptions& options, const Judge& judge,
             Evaluations& known, const std::function<void(int)>& tick) {
  const std::vector<Axis>& axes = options.axes;
  Found found;
  std::exception_ptr problem;
  const auto worth_at = [&](const std::vector<double>& z) {
    std::vector<Setting> settings;
    std::vector<std::string> values;
    Parameters parameters = start;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const std::string& key = axes[i].key;
      values.push_back(text_of(start, key, value_at(axes[i], z[i])));
      settings.push_back({key, values.back()});
      set(parameters, key, values.back());
    }
    std::optional<Worth> worth = known.find(values);
    if (!worth) {
      worth = judge(parameters);
      known.add(values, *worth);
    }
    if (found.evaluations++ == 0) {
      found.before = settings;
      found.worth_before = *worth;
    }
    if (found.after.empty() || worth->objective() > found.worth_after.objective()) {
      found.after = settings;
      found.worth_after = *worth;
    }
    tick(found.evaluations);
    return worth->objective();
  };

  std::vector<double> z(axes.size(), 0.0), low, high;
  worth_at(z);  // evaluate the present values first, for every seed
  std::mt19937_64 draw(options.seed);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    low.push_back(z_of(axes[i], axes[i].low));
    high.push_back(z_of(axes[i], axes[i].high));
    // Not a standard distribution, because these differ between standard libraries.
    const double unit = static_cast<double>(draw() >> 11) * 0x1p-53;
    if (options.seed != 1) z[i] = std::clamp(kFirstStep * (2 * unit - 1), low[i], high[i]);
  }
  if (options.evaluations <= found.evaluations || axes.empty()) return found;

  nlopt::opt bobyqa(nlopt::LN_BOBYQA, static_cast<unsigned>(axes.size()));
  bobyqa.set_lower_bounds(low);
  bobyqa.set_upper_bounds(high);
  bobyqa.set_initial_step(kFirstStep);
  bobyqa.set_maxeval(options.evaluations - found.evaluations);
  std::function<double(const std::vector<double>&)> objective = [&](const auto& at) {
    try {
      return worth_at(at);
    } catch (...) {  // exceptions must not pass through C code
      problem = std::current_exception();
      bobyqa.force_stop();
      return 0.0;
    }
  };
  bobyqa.set_max_objective(
      [](const std::vector<double>& at, std::vector<double>&, void* data) {
        return (*static_cast<decltype(objective)*>(data))(at);
      },
      &objective);
  try {
    double best = 0;
    bobyqa.optimize(z, best);
  } catch (const nlopt::forced_stop&) {
  } catch (const nlopt::roundoff_limited&) {  // converged to machine precision
  }
  if (problem) std::rethrow_exception(problem);
  return found;
}

}  // namespace lcs::tune
