// Speed of generating sequences, compared with a bare loop of rendering and reading back on the
// same scene, in one run:
//
// ninja -C build generate_throughput && build/tests/sequence/generate_throughput [FRAMES]
//
// Measured in processor time per core, so that other load on the machine does not count.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "scenarios/load.h"
#include "sim/camera/lens_renderer.h"
#include "sim/world/world.h"
#include "tests/tools/temporary_folder.h"
#include "tools/sequence/generator.h"
#include "tools/sequence/writer.h"

namespace {

using namespace lcs;

double processor_s() {
  timespec now = {};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double bare_loop_s(const scenario::Scenario& scenario) {
  sim::World world(scenario);
  const scenario::Camera& camera = scenario.camera;
  sim::LensRenderer renderer(
      world.model(), world.camera_id(),
      sim::Pinhole::from_fovy(camera.width_px, camera.height_px, camera.fovy_rad));
  cv::Mat3f light;
  cv::Mat1f depth;
  cv::Mat1i geoms;
  std::vector<sim::ImuSample> imu;
  std::vector<sim::OdometrySample> odometry;
  const double start = processor_s();
  for (int k = 0; k < scenario.frames; ++k) {
    world.advance_to(sim::event_time_ns(k, scenario.camera.rate_hz), imu, odometry);
    renderer.update();
    renderer.render_light(light);
    renderer.render_depth_and_geoms(depth, geoms);
  }
  return processor_s() - start;
}

double generate_s(const scenario::Scenario& scenario, std::vector<std::string> formats) {
  const test::TemporaryFolder folder;
  const sequence::GenerateOptions options{std::move(formats), {}, {}};
  sequence::SequenceFolder target(folder.path() / "sequence", scenario.file.parent_path(), false,
                                  false, {});
  target.is_complete(sequence::facts_of(scenario, options));
  // From the first complete frame to the last; no renderer starts in between.
  double first = 0;
  sequence::generate_frames(scenario, options, target, {0, scenario.frames}, [&](int whole) {
    if (whole == 1) first = processor_s();
  });
  const double last = processor_s();
  sequence::finish_sequence(scenario, options, target);
  return (last - first) * scenario.frames / (scenario.frames - 1);
}

}  // namespace

int main(int argc, char** argv) {
  for (const char* name : {"crossing", "suite/crossing_street"}) {
    const auto file = std::filesystem::path(LCS_SCENARIOS_DIR) / (std::string(name) + ".yaml");
    scenario::Scenario scenario = scenario::load(file);
    scenario.frames = argc > 1 ? std::atoi(argv[1]) : 60;
    const double bare = bare_loop_s(scenario);
    const auto tell = [&](const std::string& what, double seconds) {
      fmt::print("{:<24}{:<24}{:6.1f} frames/s a core, {:3.0f} % of the bare loop\n", name, what,
                 scenario.frames / seconds, 100 * bare / seconds);
    };
    tell("bare loop", bare);
    std::vector<std::string> all;
    for (const sequence::Format& format : sequence::formats()) all.emplace_back(format.name);
    tell("all formats", generate_s(scenario, all));
    std::erase(all, "flow");
    tell("all formats but flow", generate_s(scenario, all));
    tell("euroc", generate_s(scenario, {"euroc"}));
  }
}
