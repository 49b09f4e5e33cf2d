#include "tests/benchmark/page.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <opencv2/core/utility.hpp>
#include <optional>
#include <vector>

#include "sim/simulation.h"
#include "tests/benchmark/raw_renderer.h"
#include "tools/files/output.h"

namespace lcs::test {
namespace {

constexpr const char* kScenes[] = {"lab", "street"};
constexpr int kCorners[] = {100, 200, 700, 2000, 5000, 10000, 20000};

/// The targets, and the lower end of the range for the growth.
constexpr double kMostOfFast = 2, kMostOfKlt = 0.1, kMostGrowth = 1.15;
constexpr int kTargetCorners = 700, kGrowthFrom = 200;

/// Columns of times: FAST, klt, signatures, the filter, its three experts. The first column with a
/// ratio to FAST.
constexpr std::size_t kTimes = 7, kOverFast = 2, kFilter = 3;

using Growth = std::vector<std::pair<double, double>>;  ///< corners, ms

constexpr const char* kStyle =
    "body{font:15px/1.5 sans-serif;max-width:68em;margin:2em auto;padding:0 1em}"
    "table{border-collapse:collapse;margin:1em 0}td,th{padding:.2em .6em;text-align:right;"
    "border-bottom:1px solid "
    "#ccc}th[colspan]{text-align:center}td:first-child,th:first-child{text-align:left}"
    ".met{color:#060}.missed{color:#a00}code{background:#eee}";

std::string cell(std::optional<double> value, const char* format) {
  return "<td>" + (value ? fmt::format(fmt::runtime(format), *value) : "-") + "</td>";
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

std::string machine() {
  const benchmark::CPUInfo& cpu = benchmark::CPUInfo::Get();
  std::string load;
  for (const double one : cpu.load_avg) load += fmt::format(" {:.1f}", one);
  const sim::Versions versions = sim::versions();
  const char* threads = std::getenv("LP_NUM_THREADS");
  return fmt::format(
      "<p>{}, {} cores, load at the start{}. MuJoCo {}, {}{}, OpenCV {} on one thread. The "
      "filter's parameters are the default ones; the scenarios are "
      "<code>tests/benchmark/lab.yaml</code> and "
      "<code>street.yaml</code>.</p>\n",
      processor(), cpu.num_cpus, load, versions.mujoco, versions.gl_renderer,
      threads ? fmt::format(" with LP_NUM_THREADS={}", threads) : "", cv::getVersionString());
}

/// Slope of the best-fit line through (log x, log y); empty for fewer than two points.
std::optional<double> exponent(const Growth& points) {
  if (points.size() < 2) return std::nullopt;
  double mx = 0, my = 0, xx = 0, xy = 0;
  const double n = static_cast<double>(points.size());
  for (const auto& [x, y] : points) {
    mx += std::log(x) / n;
    my += std::log(y) / n;
  }
  for (const auto& [x, y] : points) {
    xx += (std::log(x) - mx) * (std::log(x) - mx);
    xy += (std::log(x) - mx) * (std::log(y) - my);
  }
  return xy / xx;
}

std::optional<double> ratio(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return std::nullopt;
  return *a / *b;
}

std::string target(const std::string& what, std::optional<double> value, double most) {
  if (!value) return fmt::format("<li>{}: not measured</li>\n", what);
  return fmt::format("<li class={0}>{1}: {2:.2f}, at most {3:g} &mdash; {0}</li>\n",
                     *value <= most ? "met" : "missed", what, *value, most);
}

}  // namespace

void PageReporter::ReportRuns(const std::vector<Run>& runs) {
  ConsoleReporter::ReportRuns(runs);
  for (const Run& run : runs) {
    if (run.error_occurred || run.run_type != Run::RT_Iteration) continue;
    const std::string& name = run.run_name.function_name;
    const double ms = run.GetAdjustedRealTime();
    const auto [place, is_new] = measured_.try_emplace(name);
    if (!is_new && place->second.ms <= ms) continue;
    place->second = {ms, {}};
    for (const auto& [key, counter] : run.counters) place->second.counters[key] = counter.value;
  }
}

bool PageReporter::any(const std::string& prefix) const {
  const auto first = measured_.lower_bound(prefix);
  return first != measured_.end() && first->first.starts_with(prefix);
}

std::optional<double> PageReporter::ms(const std::string& name) const {
  const auto found = measured_.find(name);
  return found == measured_.end() ? std::nullopt : std::optional(found->second.ms);
}

std::optional<double> PageReporter::counter(const std::string& name, const char* key) const {
  const auto found = measured_.find(name);
  if (found == measured_.end() || !found->second.counters.count(key)) return std::nullopt;
  return found->second.counters.at(key);
}

std::string PageReporter::filter_table(const std::string& scene, std::string& targets) const {
  std::string table =
      "<table><tr><th><th colspan=7>ms a frame<th colspan=5>over cv::FAST<th>over klt</tr>\n"
      "<tr><th>corners<th>cv::FAST<th>klt<th>signatures<th>filter<th>Line<th>Circle<th>Square"
      "<th>signatures<th>filter<th>Line<th>Circle<th>Square<th>filter</tr>\n";
  std::array<Growth, kTimes> growth;
  for (const int n : kCorners) {
    const std::string of = fmt::format("{}/{}", scene, n);
    const auto fast = ms("fast/" + of), klt = ms("klt/" + of), filter = ms("filter/" + of);
    const std::array<std::optional<double>, kTimes> times = {fast,
                                                             klt,
                                                             ms("describe/" + of),
                                                             filter,
                                                             counter("filter/" + of, "line_ms"),
                                                             counter("filter/" + of, "circle_ms"),
                                                             counter("filter/" + of, "square_ms")};
    const auto seen = counter("filter/" + of, "corners");
    const auto corners = seen ? seen : counter("fast/" + of, "corners");
    table += "<tr>" + cell(corners, "{:.0f}");
    for (std::size_t i = 0; i < kTimes; ++i) {
      table += cell(times[i], "{:.3f}");
      if (corners && times[i] && n >= kGrowthFrom) growth[i].emplace_back(*corners, *times[i]);
    }
    for (std::size_t i = kOverFast; i < kTimes; ++i) table += cell(ratio(times[i], fast), "{:.2f}");
    table += cell(ratio(filter, klt), "{:.3f}") + "</tr>\n";
    if (n == kTargetCorners) {
      const std::string at = fmt::format("{}, {} corners: filter over ", scene, n);
      targets += target(at + "cv::FAST", ratio(filter, fast), kMostOfFast);
      targets += target(at + "klt", ratio(filter, klt), kMostOfKlt);
    }
  }
  table += fmt::format("<tr><td>exponent of growth from {} on</td>", kGrowthFrom);
  for (const Growth& points : growth) table += cell(exponent(points), "{:.2f}");
  targets += target(fmt::format("{}: exponent of growth from {} corners on", scene, kGrowthFrom),
                    exponent(growth[kFilter]), kMostGrowth);
  return table + "<td colspan=6></td></tr>\n</table>\n";
}

std::string PageReporter::simulation_table(const std::string& scene) const {
  const auto render = ms("render/" + scene), simulate = ms("simulate/" + scene);
  const auto ego_motion =
      ratio(ms("ego_motion/" + scene), counter("ego_motion/" + scene, "frames"));
  std::string table = "<table><tr><th>a frame of 640x480<th>ms<th>of the bare render loop</tr>\n";
  const auto row = [&](const char* what, std::optional<double> value) {
    table += fmt::format("<tr><td>{}</td>", what) + cell(value, "{:.3f}") +
             cell(ratio(value, render), "{:.3f}") + "</tr>\n";
  };
  row("bare render loop: the picture and nothing else", render);
  row("simulation: physics, IMU, picture, depth, truth", simulate);
  row("ego-motion from the IMU", ego_motion);
  row("making the scene, once a run", ms("generate/" + scene));
  return table + "</table>\n";
}

std::string PageReporter::settings_table(const std::string& scene) const {
  std::string table =
      "<table><tr><th><th colspan=3>by the wall clock<th colspan=2>time of all cores</tr>\n"
      "<tr><th>renders of a frame of 640x480<th>ms<th>frames/s<th>over the first row's<th>ms"
      "<th>over the first row's</tr>\n";
  const std::string project = "settings/" + scene + "/" + kRenderSettings[0].name;
  for (const NamedRenderSettings& named : kRenderSettings) {
    const std::string name = "settings/" + scene + "/" + named.name;
    const auto wall = ms(name), cores = counter(name, "cores_ms");
    table += fmt::format("<tr><td>{}</td>", named.what) + cell(wall, "{:.2f}") +
             cell(ratio(1000, wall), "{:.1f}") + cell(ratio(wall, ms(project)), "{:.2f}") +
             cell(cores, "{:.2f}") + cell(ratio(cores, counter(project, "cores_ms")), "{:.2f}") +
             "</tr>\n";
  }
  return table + "</table>\n";
}

void PageReporter::write(const std::filesystem::path& page) const {
  std::string targets, tables;
  for (const std::string scene : kScenes) {
    tables += fmt::format("<h2>{}</h2>\n", scene);
    const std::string of_filter = filter_table(scene, targets);
    if (any("fast/" + scene) || any("filter/" + scene) || any("klt/" + scene) ||
        any("describe/" + scene)) {
      tables += of_filter;
    }
    if (any("render/" + scene) || any("simulate/" + scene) || any("generate/" + scene) ||
        any("ego_motion/" + scene)) {
      tables += simulation_table(scene);
    }
    if (any("settings/" + scene)) tables += settings_table(scene);
  }

  files::Output output(page, files::Overwrite::own);
  files::write_file(
      output.staging(),
      fmt::format("<!doctype html><meta charset=utf-8><title>lcs benchmarks</title><style>{}"
                  "</style>\n<h1>Benchmarks, {:%Y-%m-%d %H:%M} UTC</h1>\n",
                  kStyle, fmt::gmtime(std::time(nullptr))) +
          machine() +
          "<p>Milliseconds a frame, the quickest of the repetitions: of one core's time for "
          "what computes, of all threads for what renders, of the wall clock for the "
          "settings. The streams "
          "have the density of corners of the recorded pictures; with their number grows "
          "the picture.</p>\n<ul>\n" +
          targets + "</ul>\n" + tables);
  output.commit();
}

}  // namespace lcs::test
