#include "tools/suite/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <stdexcept>

#include "scenarios/input/inputs_read.h"
#include "scenarios/input/message.h"
#include "scenarios/input/spelling.h"
#include "scenarios/load.h"
#include "scenarios/shipped.h"
#include "scenarios/sweep.h"
#include "tools/scoring/criteria.h"

namespace lcs::suite {
namespace {

/// Limit on characters times repetitions by braces, because std::regex recurses for each.
constexpr double kMostParts = 1000;

/// The longest file name. The time of a search grows with the square of the length.
constexpr std::size_t kLongestName = 255;

double parts_of(const std::string& text) {
  double parts = static_cast<double>(text.size());
  static const std::regex kCounts(R"(\{(\d{0,9}),?(\d{0,9})\d*)");
  for (std::sregex_iterator found(text.begin(), text.end(), kCounts), end; found != end; ++found) {
    const auto count = [&](std::size_t group) {
      const std::string digits = (*found)[group].str();
      return digits.empty() ? 1.0 : std::stod(digits);
    };
    parts *= std::max({1.0, count(1), count(2)});
  }
  return parts;
}

constexpr const char* kAnyGroup = "all";
constexpr const char* kDefaultGroup = "short";

struct File {
  fs::path path;
  bool is_own = false;  ///< from the project's folder, without being named
};

/// Makes the paths of files below the current folder relative, so that results are portable.
fs::path as_people_write(const fs::path& path) {
  std::error_code error;
  const fs::path relative = fs::proximate(path, error);
  return error || relative.empty() || *relative.begin() == ".." ? path : relative;
}

void add_folder(const fs::path& folder, std::vector<File>& files) {
  std::vector<fs::path> found;
  input::note_input(folder);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() == ".yaml") {
      found.push_back(as_people_write(entry.path()));
    }
  }
  if (found.empty()) {
    throw std::runtime_error(
        fmt::format("there is no .yaml file in {}; give a folder of scenarios", folder.string()));
  }
  std::ranges::sort(found);
  std::error_code error;
  const bool is_own = fs::equivalent(folder, scenario::shipped_folder("scenarios"), error);
  for (const fs::path& path : found) files.push_back({path, is_own});
}

/// All scenario files, without duplicates under different names.
std::vector<File> files_of(std::vector<fs::path> paths) {
  if (paths.empty()) paths.push_back(scenario::shipped_folder("scenarios"));
  std::vector<File> files;
  for (const fs::path& path : paths) {
    if (fs::is_directory(path)) {
      add_folder(path, files);
    } else if (fs::exists(path)) {
      files.push_back({path, false});
    } else if (const auto shipped = scenario::shipped_scenario(path)) {
      files.push_back({as_people_write(*shipped), false});
    } else {
      throw std::runtime_error(fmt::format(
          "there is no file or folder {}; give scenario files or folders of them", path.string()));
    }
  }
  std::set<fs::path> seen;
  std::erase_if(files, [&](const File& file) {
    return !seen.insert(fs::weakly_canonical(file.path)).second;
  });
  return files;
}

/// Converts a value to a part of a name: "0.5 m/s" to "0.5mps", "[4 m, -1.3 m]" to "4m_-1.3m".
std::string name_part(const std::string& value) {
  std::string part;
  for (const char c : value) {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '_') part += c;
    if (c == '/') part += 'p';
    if (c == ',') part += '_';
  }
  return part;
}

std::string name_of(const fs::path& file, const scenario::SweepPoint& point) {
  std::string name = file.stem().string();
  char separator = '@';
  for (const auto& [key, value] : point.settings) {
    name += separator + name_part(value);
    separator = ',';
  }
  return name;
}

PlannedScenario broken(const fs::path& file, const std::string& name, const std::string& error) {
  return {.name = name, .file = file, .error = error, .seeds = {0}};
}

PlannedScenario plan_point(const fs::path& file, const scenario::SweepPoint& point,
                           const PlanOptions& options) {
  PlannedScenario planned;
  planned.name = name_of(file, point);
  planned.file = file;
  planned.sets = options.sets;
  planned.point = point.settings;
  for (const auto& [key, value] : point.settings) planned.sets.push_back(key + "=" + value);
  try {
    planned.scenario = scenario::load(file, {.sets = planned.sets, .seed = {}});
    scoring::require_known_metrics(planned.scenario->criteria);
    // a recording is the same for every seed
    const int seeds = planned.scenario->recording ? 1 : options.seeds;
    for (int i = 0; i < seeds; ++i) {
      planned.seeds.push_back(planned.scenario->seed + static_cast<std::uint64_t>(i));
    }
    return planned;
  } catch (const std::exception& error) {
    return broken(file, planned.name, input::message_of(error));
  }
}

std::vector<PlannedScenario> plan_file(const fs::path& file, const PlanOptions& options) {
  std::vector<PlannedScenario> all;
  try {
    for (const scenario::SweepPoint& point : scenario::sweep_points(file)) {
      all.push_back(plan_point(file, point, options));
    }
  } catch (const std::exception& error) {
    return {broken(file, file.stem().string(), input::message_of(error))};
  }
  return all;
}

bool is_in_group(const PlannedScenario& planned, const std::string& group) {
  if (!planned.scenario || group == kAnyGroup) return true;
  const std::vector<std::string>& groups = planned.scenario->groups;
  return std::ranges::find(groups, group) != groups.end();
}

/// Numbers equal names of a sweep's points. \throws std::runtime_error if two files share a name.
void make_names_unique(std::vector<PlannedScenario>& all) {
  std::map<std::string, fs::path> first;
  std::map<std::string, int> count;
  for (PlannedScenario& planned : all) {
    const auto [found, is_new] = first.emplace(planned.name, planned.file);
    if (!is_new && found->second != planned.file) {
      throw std::runtime_error(fmt::format("{} and {} are both called {}; rename one of them",
                                           found->second.string(), planned.file.string(),
                                           planned.name));
    }
    if (const int number = ++count[planned.name]; number > 1) {
      planned.name += fmt::format("#{}", number);
    }
  }
}

std::vector<std::string> group_names(const std::vector<PlannedScenario>& all) {
  std::set<std::string> names;
  for (const PlannedScenario& planned : all) {
    if (planned.scenario) {
      names.insert(planned.scenario->groups.begin(), planned.scenario->groups.end());
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace

Pattern::Pattern(const std::string& text, std::string_view option, std::string_view example) {
  // Check the size before parsing.
  if (static_cast<double>(text.size()) > kMostParts || parts_of(text) > kMostParts) {
    throw std::runtime_error(
        fmt::format("{} {} repeats more than {} characters; give a part of a name, or as '{}'",
                    option, text, kMostParts, example));
  }
  try {
    // The default matching algorithm would recurse for each character of a name.
    regex_ = std::regex(text, std::regex::ECMAScript | std::regex_constants::__polynomial);
  } catch (const std::regex_error&) {
    throw std::runtime_error(
        fmt::format("{} {} is not a regular expression; give a part of a name, or as '{}'", option,
                    text, example));
  }
}

bool Pattern::is_in(std::string_view name) const {
  name = name.substr(0, kLongestName);
  return std::regex_search(name.begin(), name.end(), regex_);
}

std::vector<PlannedScenario> plan(const PlanOptions& options) {
  const Pattern filter(options.filter, "--filter", "cross.*far");
  std::vector<PlannedScenario> all, chosen;
  for (const File& file : files_of(options.paths)) {
    const std::string group = options.group.value_or(file.is_own ? kDefaultGroup : kAnyGroup);
    for (PlannedScenario& planned : plan_file(file.path, options)) {
      if (is_in_group(planned, group) && filter.is_in(planned.name)) {
        chosen.push_back(planned);
      }
      all.push_back(std::move(planned));
    }
  }
  const std::vector<std::string> groups = group_names(all);
  if (options.group && *options.group != kAnyGroup &&
      std::ranges::find(groups, *options.group) == groups.end()) {
    const auto near = input::nearest(*options.group, groups);
    throw std::runtime_error(
        fmt::format("no scenario is of the group '{}'; {}", *options.group,
                    near ? fmt::format("did you mean '{}'?", *near)
                         : fmt::format("the groups are {}", fmt::join(groups, ", "))));
  }
  if (chosen.empty()) {
    throw std::runtime_error(
        fmt::format("none of the {} scenarios is in the group and fits the filter; the groups are "
                    "{}; see lcs suite --group all --list",
                    all.size(), fmt::join(groups, ", ")));
  }
  make_names_unique(chosen);
  return chosen;
}

void keep_runs(std::vector<PlannedScenario>& plan,
               const std::set<std::pair<std::string, std::uint64_t>>& runs) {
  for (PlannedScenario& planned : plan) {
    std::erase_if(planned.seeds, [&](std::uint64_t seed) {
      return !runs.contains({planned.name, seed});
    });
  }
  std::erase_if(plan, [](const PlannedScenario& planned) { return planned.seeds.empty(); });
}

double work(const scenario::Scenario& scenario) {
  constexpr int kUsualRecording = 300;
  const int frames = scenario.frames > 0 ? scenario.frames : kUsualRecording;
  return static_cast<double>(frames) * scenario.camera.width_px * scenario.camera.height_px;
}

}  // namespace lcs::suite
