/// \file
/// `lcs_benchmarks`: time of each part beside its reference: cv::FAST, the comparator klt, and a
/// loop that only renders.
#include <benchmark/benchmark.h>

#include <ctime>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "filter/detect/describe.h"
#include "filter/filter.h"
#include "scenarios/load.h"
#include "sim/camera/lens_renderer.h"
#include "sim/drive.h"
#include "sim/simulation.h"
#include "sim/world/world.h"
#include "tests/benchmark/page.h"
#include "tests/benchmark/raw_renderer.h"
#include "tests/benchmark/stream.h"
#include "tools/bench/detector.h"
#include "tools/bench/ego_motion_feed.h"
#include "tools/comparators/flow_detectors.h"

namespace lcs::test {
namespace {

/// Frames until the filter has tracks to compare and a steady number of edges.
constexpr std::size_t kWarmUpFrames = 6;

/// klt needs the pictures themselves, and some seconds per frame at the largest sizes.
constexpr int kMostForKlt = 2000;

std::string scenario_file(const std::string& scene) {
  return std::string(LCS_BENCH_SCENARIOS) + "/" + scene + ".yaml";
}

const Footage& footage(const std::string& scene) {
  static std::map<std::string, Footage> known;
  const auto found = known.find(scene);
  return (found != known.end() ? found : known.emplace(scene, scenario_file(scene)).first)->second;
}

/// Keeps the last stream: benchmarks of one stream run consecutively.
const Stream& stream(const std::string& scene, int corners) {
  static std::pair<std::string, int> key;
  static std::unique_ptr<Stream> last;
  if (!last || key != std::pair(scene, corners)) {
    last.reset();
    last = std::make_unique<Stream>(footage(scene), corners);
    key = {scene, corners};
  }
  return *last;
}

template <typename Work>
double seconds_by(clockid_t clock, Work&& work) {
  const auto now = [clock] {
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

/// CPU time of this thread, s: wall time would include the load of the machine.
template <typename Work>
double cpu_seconds(Work&& work) {
  return seconds_by(CLOCK_THREAD_CPUTIME_ID, std::forward<Work>(work));
}

/// CPU time of all threads, s, for rendering, which the driver does in its own threads.
template <typename Work>
double cores_seconds(Work&& work) {
  return seconds_by(CLOCK_PROCESS_CPUTIME_ID, std::forward<Work>(work));
}

void fast(benchmark::State& state, const std::string& scene, int corners) {
  const Stream& of = stream(scene, corners);
  const cv::Mat1b grey = of.grey(kWarmUpFrames);
  std::vector<cv::KeyPoint> found;
  const int threshold = footage(scene).scenario.fast_threshold.value();
  for (auto _ : state) {
    state.SetIterationTime(cpu_seconds(
        [&] { cv::FAST(grey, found, threshold, true, cv::FastFeatureDetector::TYPE_9_16); }));
  }
  state.counters["corners"] = static_cast<double>(found.size());
}

void signatures(benchmark::State& state, const std::string& scene, int corners) {
  const Stream& of = stream(scene, corners);
  const cv::Mat1b grey = of.grey(kWarmUpFrames);
  const std::vector<Eigen::Vector2f>& found = of.corners_px(kWarmUpFrames);
  for (auto _ : state) {
    state.SetIterationTime(cpu_seconds([&] { benchmark::DoNotOptimize(describe(grey, found)); }));
  }
  state.counters["corners"] = static_cast<double>(found.size());
}

void filter(benchmark::State& state, const std::string& scene, int corners) {
  const Stream& of = stream(scene, corners);
  const auto fresh = [&] { return Filter(of.camera(), Parameters{}); };
  Filter under_test = fresh();
  StageTimes sum;
  double total_s = 0;
  std::size_t k = 0;
  for (auto _ : state) {
    if (k == of.size()) {
      under_test = fresh();
      k = 0;
    }
    for (; k < kWarmUpFrames; ++k) {
      under_test.step(of.corners_px(k), of.signatures(k), of.motion(k));
    }
    const double s = cpu_seconds([&] {
      const FrameResult& result = under_test.step(of.corners_px(k), of.signatures(k), of.motion(k));
      sum.line_ms += result.times.line_ms;
      sum.circle_ms += result.times.circle_ms;
      sum.square_ms += result.times.square_ms;
    });
    state.SetIterationTime(s);
    total_s += s;
    ++k;
  }
  state.counters["corners"] = of.mean_corners();
  // The filter times its experts by the wall clock; this gives their shares of the thread's time.
  const double share_ms = 1000 * total_s / static_cast<double>(state.iterations()) /
                          (sum.line_ms + sum.circle_ms + sum.square_ms);
  state.counters["line_ms"] = share_ms * sum.line_ms;
  state.counters["circle_ms"] = share_ms * sum.circle_ms;
  state.counters["square_ms"] = share_ms * sum.square_ms;
}

void klt(benchmark::State& state, const std::string& scene, int corners) {
  const Stream& of = stream(scene, corners);
  comparators::KltDetector detector(of.camera());
  std::vector<cv::Mat3b> images;
  std::vector<cv::Mat1b> greys;
  for (std::size_t k = 0; k < of.size(); ++k) {
    images.push_back(of.image(k));
    greys.push_back(of.grey(k));
  }
  const auto step = [&](std::size_t k) {
    detector.step({images[k], greys[k], of.corners_px(k), of.motion(k)});
  };
  step(0);
  std::size_t k = 0;
  for (auto _ : state) {
    // The return to the start is one long step, which is not timed.
    if (++k == of.size()) {
      step(0);
      k = 1;
    }
    state.SetIterationTime(cpu_seconds([&] { step(k); }));
  }
  state.counters["corners"] = of.mean_corners();
}

void ego_motion(benchmark::State& state, const std::string& scene) {
  const scenario::Scenario scenario =
      scenario::load(scenario_file(scene), {.sets = {"ego_motion=imu"}, .seed = {}});
  const sim::Drive drive = sim::drive(scenario);
  for (auto _ : state) {
    bench::EgoMotionFeed feed(scenario, drive.calibration);
    state.SetIterationTime(cpu_seconds([&] {
      for (const sim::Observation& observation : drive.frames) {
        benchmark::DoNotOptimize(feed.next(observation));
      }
    }));
  }
  state.counters["frames"] = static_cast<double>(drive.frames.size());
}

void generate(benchmark::State& state, const std::string& scene) {
  const scenario::Scenario scenario = scenario::load(scenario_file(scene));
  for (auto _ : state) {
    std::optional<sim::Simulation> simulation;
    state.SetIterationTime(cores_seconds([&] { simulation.emplace(scenario); }));
  }
}

void simulate(benchmark::State& state, const std::string& scene) {
  const scenario::Scenario scenario = scenario::load(scenario_file(scene));
  auto simulation = std::make_unique<sim::Simulation>(scenario);
  for (auto _ : state) {
    std::optional<sim::Observation> observation;
    double s = cores_seconds([&] { observation = simulation->next(); });
    if (!observation) {
      simulation = std::make_unique<sim::Simulation>(scenario);
      s = cores_seconds([&] { observation = simulation->next(); });
    }
    state.SetIterationTime(s);
  }
}

sim::LensRenderer renderer_of(sim::World& world, const scenario::Camera& camera, int samples) {
  return {world.model(), world.camera_id(),
          sim::Pinhole::from_fovy(camera.width_px, camera.height_px, camera.fovy_rad), samples};
}

/// Minimum for a picture: no physics, no depth, no truth.
void render(benchmark::State& state, const std::string& scene) {
  const scenario::Scenario scenario = scenario::load(scenario_file(scene));
  sim::World world(scenario);
  sim::LensRenderer renderer = renderer_of(world, scenario.camera, scenario.image.samples);
  cv::Mat3f light;
  for (auto _ : state) {
    state.SetIterationTime(cores_seconds([&] {
      renderer.update();
      renderer.render_light(light);
    }));
  }
}

/// The renders of a frame with so many samples of each pixel: light, depth and ids.
void samples(benchmark::State& state, const std::string& scene, int count) {
  const scenario::Scenario scenario = scenario::load(scenario_file(scene));
  sim::World world(scenario);
  sim::LensRenderer renderer = renderer_of(world, scenario.camera, count);
  cv::Mat3f light;
  cv::Mat1f depth_m;
  cv::Mat1i geom;
  for (auto _ : state) {
    state.SetIterationTime(cores_seconds([&] {
      renderer.update();
      renderer.render_light(light);
      renderer.render_depth_and_geoms(depth_m, geom);
    }));
  }
}

/// The renders of a frame by MuJoCo alone, with one setting changed.
void settings(benchmark::State& state, const std::string& scene, const RenderSettings& chosen) {
  const scenario::Scenario scenario = scenario::load(scenario_file(scene));
  sim::World world(scenario);
  RawRenderer renderer(world, {scenario.camera.width_px, scenario.camera.height_px}, chosen);
  double cores_s = 0;
  for (auto _ : state) {
    cores_s += cores_seconds(
        [&] { state.SetIterationTime(seconds_by(CLOCK_MONOTONIC, [&] { renderer.render(); })); });
  }
  state.counters["cores_ms"] = 1000 * cores_s / static_cast<double>(state.iterations());
}

void add(const std::string& name, const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond)->UseManualTime();
}

void add_all() {
  for (const std::string scene : {"lab", "street"}) {
    add("render/" + scene, [=](auto& s) { render(s, scene); });
    add("simulate/" + scene, [=](auto& s) { simulate(s, scene); });
    add("generate/" + scene, [=](auto& s) { generate(s, scene); });
    add("ego_motion/" + scene, [=](auto& s) { ego_motion(s, scene); });
    for (const int n : {1, 4, 5, 9}) {
      add("samples/" + scene + "/" + std::to_string(n), [=](auto& s) { samples(s, scene, n); });
    }
    for (const NamedRenderSettings& named : kRenderSettings) {
      add("settings/" + scene + "/" + named.name,
          [=](auto& s) { settings(s, scene, named.settings); });
    }
    for (const int n : {100, 200, 700, 2000, 5000, 10000, 20000}) {
      const std::string of = scene + "/" + std::to_string(n);
      add("fast/" + of, [=](auto& s) { fast(s, scene, n); });
      add("describe/" + of, [=](auto& s) { signatures(s, scene, n); });
      add("filter/" + of, [=](auto& s) { filter(s, scene, n); });
      if (n <= kMostForKlt) add("klt/" + of, [=](auto& s) { klt(s, scene, n); });
    }
  }
}

}  // namespace
}  // namespace lcs::test

int main(int argc, char** argv) {
  cv::setNumThreads(1);  // like the filter: ratios compare work, not cores
  lcs::test::add_all();
  benchmark::Initialize(&argc, argv);
  // The remaining argument is the file of the page.
  if (argc > 2 || (argc == 2 && argv[1][0] == '-')) {
    std::cerr << "lcs_benchmarks: unknown argument " << argv[1]
              << "; give the file for the page, and see --help for the options\n";
    return 2;
  }
  try {
    lcs::test::PageReporter reporter;
    benchmark::RunSpecifiedBenchmarks(&reporter);
    if (argc == 2 && reporter.any()) reporter.write(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << "lcs_benchmarks: " << error.what() << '\n';
    return 2;
  }
}
