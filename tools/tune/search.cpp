#include "tools/tune/search.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <nlopt.hpp>
#include <optional>
#include <random>
#include <sstream>
#include <stdexcept>

#include "tools/files/output_file.h"

namespace lcs::tune {
namespace {

/// How far a value may go from the present one, as a factor.
constexpr double kReach = 4;
/// Of the first steps, and of where other seeds start: in logarithms to that base.
constexpr double kFirstStep = 0.25;

/// A parameter on the search's scale: 0 is the present value, 1 `kReach` times that.
struct Axis {
  std::string key;
  double start = 0, low = 0, high = 0;

  double value(double z) const { return std::clamp(start * std::pow(kReach, z), low, high); }
  double z(double value) const { return std::log(value / start) / std::log(kReach); }
};

double number(std::string_view text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

Axis axis_of(const std::vector<ParameterInfo>& known, const std::string& key) {
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const ParameterInfo& info) { return info.key == key; });
  if (found == known.end()) throw std::invalid_argument("the filter has no parameter " + key);
  const std::size_t to = found->range.find(" to ");
  Axis axis{key, number(found->value), 0, 0};
  if (to == std::string::npos || !(axis.start > 0)) {
    throw std::invalid_argument(
        fmt::format("{} is {}; what is tuned must be a number above 0", key, found->value));
  }
  axis.low = std::max(number(found->range), axis.start / kReach);
  axis.high = std::min(number(found->range.substr(to + 4)), axis.start * kReach);
  return axis;
}

/// Three digits are as many as a mean over worlds tells apart; a whole number where the parameter
/// is one.
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

/// What was tried, and what came of it, as it is made and as it is read back.
class Journal {
 public:
  Journal(const std::filesystem::path& path, const std::string& subject,
          const std::vector<std::string>& keys)
      : path_(path),
        head_(fmt::format(
            "# lcs tune: {}\n{},f1,false_moving,false_static,false_capped,false_corners\n", subject,
            fmt::join(keys, ","))) {
    std::ifstream file(path);
    std::stringstream all;
    all << file.rdbuf();
    std::string text = all.str();
    if (!text.empty() && !text.starts_with(head_)) {
      throw std::runtime_error(fmt::format(
          "{} is of another search; name another folder, or take it away", path.string()));
    }
    // What was cut off in the middle of a line is asked again.
    text.resize(text.rfind('\n') + 1);
    if (text.empty()) text = head_;
    std::stringstream lines(text.substr(head_.size()));
    for (std::string line; std::getline(lines, line);) {
      std::vector<std::string> cells;
      std::stringstream cell_stream(line);
      for (std::string cell; std::getline(cell_stream, cell, ',');) cells.push_back(cell);
      if (cells.size() != keys.size() + 5) {
        throw std::runtime_error(
            fmt::format("{} has a line of another search: {}; take it away", path.string(), line));
      }
      const std::string* figures = &cells[keys.size()];
      known_[fmt::format("{}", fmt::join(cells.begin(), cells.begin() + keys.size(), ","))] = {
          number(figures[0]), number(figures[1]), number(figures[2]), number(figures[3]),
          number(figures[4])};
    }
    file_.emplace(path);
    file_->write(text);
    file_->flush();
  }

  std::optional<Worth> known(const std::string& values) const {
    const auto found = known_.find(values);
    return found == known_.end() ? std::nullopt : std::optional(found->second);
  }
  void add(const std::string& values, const Worth& worth) {
    known_[values] = worth;
    file_->write(fmt::format("{},{},{},{},{},{}\n", values, worth.f1, worth.false_moving,
                             worth.false_static, worth.false_capped, worth.false_corners));
    file_->flush();
  }

 private:
  std::filesystem::path path_;
  std::string head_;
  std::map<std::string, Worth> known_;  // by the values, with commas
  std::optional<bench::OutputFile> file_;
};

}  // namespace

Found search(const Parameters& start, const SearchOptions& options, const Judge& judge,
             const std::filesystem::path& journal_path, const std::string& subject,
             const std::function<void(int)>& tick) {
  std::vector<Axis> axes;
  const std::vector<ParameterInfo> known = describe(start);
  for (const std::string& key : options.keys) axes.push_back(axis_of(known, key));
  Journal journal(journal_path, subject, options.keys);

  Found found;
  std::exception_ptr problem;
  const auto settings_at = [&](const std::vector<double>& z) {
    std::vector<Setting> settings;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      settings.push_back({axes[i].key, text_of(start, axes[i].key, axes[i].value(z[i]))});
    }
    return settings;
  };
  const auto worth_at = [&](const std::vector<double>& z) {
    const std::vector<Setting> settings = settings_at(z);
    std::vector<std::string> values;
    Parameters parameters = start;
    for (const Setting& setting : settings) {
      values.push_back(setting.value);
      set(parameters, setting.key, setting.value);
    }
    const std::string row = fmt::format("{}", fmt::join(values, ","));
    std::optional<Worth> worth = journal.known(row);
    if (!worth) {
      worth = judge(parameters);
      journal.add(row, *worth);
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
  worth_at(z);  // the present values come first, whatever the seed
  std::mt19937_64 draw(options.seed);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    low.push_back(axes[i].z(axes[i].low));
    high.push_back(axes[i].z(axes[i].high));
    // The standard library's distributions differ from one to the next.
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
    } catch (...) {  // not through a library in C
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
  } catch (const nlopt::roundoff_limited&) {  // as close as it comes
  }
  if (problem) std::rethrow_exception(problem);
  return found;
}

}  // namespace lcs::tune
