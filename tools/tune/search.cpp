#include "tools/tune/search.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <nlopt.hpp>
#include <random>
#include <stdexcept>
#include <utility>

#include "scenarios/input/error.h"
#include "scenarios/input/message.h"
#include "scenarios/input/spelling.h"
#include "tools/files/csv.h"
#include "tools/scoring/table.h"
#include "tools/suite/suite_run.h"

namespace lcs::tune {
namespace {

constexpr const char* kSign = "# Written by `lcs tune`: the sets of numbers that it has tried";
constexpr const char* kRemedy = "choose another folder with --out, or remove the file";
constexpr double Worth::*kFigures[] = {&Worth::f1, &Worth::false_moving, &Worth::false_static,
                                       &Worth::false_capped, &Worth::false_corners};
constexpr const char* kColumns = "f1,false_moving,false_static,false_capped,false_corners,check";

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

/// The command, quoted for a shell, as one line, because it becomes a comment in C++.
std::string line_of(std::vector<std::string> command) {
  for (std::string& word : command) word = input::one_line(word);
  return suite::shell_line(command);
}

}  // namespace

Evaluations::Evaluations(const std::filesystem::path& file, const files::Provenance& provenance,
                         const std::vector<std::string>& keys)
    : journal_(file, kSign, provenance, fmt::format("{},{}", fmt::join(keys, ","), kColumns),
               kRemedy, [&](const std::string& row, int line) {
                 const auto refuse = [&](const std::string& what) {
                   throw input::Error({file.string(), line}, "the row '{}' {}; {}",
                                      input::one_line(row), what, kRemedy);
                 };
                 const auto cells = files::fields_of(row);
                 if (cells.size() != keys.size() + std::size(kFigures)) {
                   refuse(fmt::format("has {} cells, and not {}", cells.size(),
                                      keys.size() + std::size(kFigures)));
                 }
                 std::vector<std::string> values;
                 Worth worth;
                 for (std::size_t i = 0; i < cells.size(); ++i) {
                   const auto number = files::number_in<double>(cells[i]);
                   if (!number) {
                     refuse(fmt::format("has '{}', which is no number", input::one_line(cells[i])));
                   }
                   if (i < keys.size()) {
                     values.emplace_back(cells[i]);
                   } else {
                     worth.*kFigures[i - keys.size()] = *number;
                   }
                 }
                 known_[values] = worth;
               }) {}

std::optional<Worth> Evaluations::find(const std::vector<std::string>& values) const {
  const auto found = known_.find(values);
  return found == known_.end() ? std::nullopt : std::optional(found->second);
}

void Evaluations::add(const std::vector<std::string>& values, const Worth& worth) {
  std::string row = fmt::format("{}", fmt::join(values, ","));
  for (double Worth::*figure : kFigures) row += fmt::format(",{}", worth.*figure);
  journal_.add(row);
  known_[values] = worth;
}

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

std::string preset_text(const Found& found, const Circumstances& circumstances) {
  std::string text = fmt::format(
      "/// Written by `lcs tune`, and not by hand: what the preset `default` has learnt from "
      "worlds and\n"
      "/// recordings of `train`.\n"
      "///\n"
      "///   {}\n"
      "/// {}, lcs {}, {} evaluations; objective {:.4f} -> {:.4f}\n"
      "#pragma once\n\n"
      "#include <array>\n"
      "#include <utility>\n\n"
      "namespace lcs {{\n\n"
      "/// Keys as `set` takes them, and values.\n"
      "inline constexpr std::array<std::pair<const char*, double>, {}> kLearnt{{{{\n",
      line_of(circumstances.command), circumstances.date, circumstances.program, found.evaluations,
      found.worth_before.objective(), found.worth_after.objective(), found.after.size());
  for (const Setting& setting : found.after) {
    text += fmt::format("    {{\"{}\", {}}},\n", setting.key, setting.value);
  }
  return text + "}};\n\n}  // namespace lcs\n";
}

std::string record_text(const Found& found, const std::vector<Stated>& stated,
                        const Circumstances& circumstances) {
  std::string text = fmt::format(
      "# What `lcs tune` found\n\n"
      "{}, lcs {}, {} evaluations by NLopt's BOBYQA:\n\n"
      "    {}\n\n"
      "It makes the most of the mean F1 of rebels over the worlds in which something moves, less a "
      "tenth of the mean number\nof false objects in a frame over all of them, of which none "
      "counts for more than one, and less a hundredth of the\nfalse corners in a frame of "
      "recordings in which nothing moves.\n\n"
      "| | objective | F1 | false objects in 100 frames, something moves | nothing moves | false "
      "corners, recordings |\n"
      "|---|---|---|---|---|---|\n",
      circumstances.date, circumstances.program, found.evaluations, line_of(circumstances.command));
  for (const Stated& one : stated) {
    for (const auto& [when, worth] : {std::pair("before", one.before), {"after", one.after}}) {
      text += fmt::format("| {}, {} | {:.4f} | {:.4f} | {:.1f} | {:.1f} | {:.1f} |\n",
                          scoring::in_markdown(input::one_line(one.suite)), when, worth.objective(),
                          worth.f1, 100 * worth.false_moving, 100 * worth.false_static,
                          worth.false_corners);
    }
  }
  text += "\n| parameter | before | after |\n|---|---|---|\n";
  for (std::size_t i = 0; i < found.after.size(); ++i) {
    text += fmt::format("| `{}` | {} | {} |\n", found.after[i].key, found.before[i].value,
                        found.after[i].value);
  }
  return text;
}

}  // namespace lcs::tune
