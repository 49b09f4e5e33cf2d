// Usage: soak SCENARIO FRAMES
//
// Runs the filter for very long: the corners of a scenario, recorded once, pass forth and back,
// each time without a random twentieth and with another tenth a pixel off. Exits with 1 if the
// memory or the layers grow, or violate an invariant; times are only printed.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

#include "scenarios/load.h"
#include "sim/simulation.h"
#include "tests/filter/invariants.h"
#include "tools/bench/bench.h"
#include "tools/bench/detector.h"

namespace {

using namespace lcs;
using Corners = std::vector<Eigen::Vector2f>;

constexpr int kSeenFrames = 40;
/// Parts of the drive; each is reported, and the first is for warm-up.
constexpr int kParts = 10;
/// Allowed growth from the second part to the last: the missing corners are random.
constexpr double kMostGrowth = 1.05;

struct Seen {
  Corners corners;
  EgoMotion forth, back;  ///< from the previous frame, and from the next one
};

/// The motion from a frame back to the previous one.
EgoMotion reversed(const EgoMotion& motion, const std::optional<Ground>& ground_before) {
  EgoMotion back = motion;
  back.R_cur_prev = motion.R_cur_prev.transpose();
  back.v_C_mps = -(back.R_cur_prev * motion.v_C_mps);
  back.w_C_radps = -(back.R_cur_prev * motion.w_C_radps);
  back.ground = ground_before;
  return back;
}

class Recorder : public bench::Detector {
 public:
  const FrameResult& step(const bench::DetectorInput& input) override {
    seen.push_back({{input.corners_px.begin(), input.corners_px.end()}, input.motion, {}});
    result_.verdicts.assign(input.corners_px.size(), Verdict::pending);
    return result_;
  }
  std::vector<Seen> seen;

 private:
  FrameResult result_;
};

std::vector<Seen> see(const scenario::Scenario& scenario, Intrinsics& camera) {
  sim::Simulation simulation(scenario);
  camera = bench::intrinsics(simulation.calibration().camera);
  Recorder recorder;
  const bench::DetectorRun detector{recorder, [](const auto&, const auto&) {}};
  bench::run(scenario, simulation, {&detector, 1});
  for (std::size_t k = 0; k + 1 < recorder.seen.size(); ++k) {
    recorder.seen[k].back = reversed(recorder.seen[k + 1].forth, recorder.seen[k].forth.ground);
  }
  return recorder.seen;
}

/// splitmix64 hash of a corner's place in the drive.
std::uint64_t chance(std::uint64_t frame, std::uint64_t corner) {
  std::uint64_t z = frame * 0x9e3779b97f4a7c15ULL + corner * 0xd1b54a32d192ed03ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

void perturb(const Corners& seen, std::uint64_t frame, Corners& corners) {
  corners.clear();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::uint64_t dice = chance(frame, i);
    if (dice % 20 == 0) continue;
    corners.push_back(seen[i]);
    if (dice % 10 == 1) corners.back().x() += (dice >> 32) % 2 == 0 ? 1.F : -1.F;
  }
}

/// Maxima over a part of the drive.
struct Part {
  std::size_t heap_bytes = 0, items = 0, corners = 0;
  double frame_ms = 0;  ///< mean
};

int drive(const std::vector<Seen>& seen, const Intrinsics& camera, int frames) {
  const Parameters parameters;
  Filter filter(camera, parameters);
  Corners corners;
  corners.reserve(100'000);  // so that the driver itself does not grow
  std::array<Part, kParts> parts;
  const int turn = static_cast<int>(seen.size()) - 1;
  for (int p = 0, k = 0; p < kParts; ++p) {
    Part& part = parts[p];
    const int end = static_cast<int>(static_cast<std::int64_t>(frames) * (p + 1) / kParts);
    const int count = end - k;
    for (; k < end; ++k) {
      const int place = k % (2 * turn);
      const bool forth = place <= turn;
      const Seen& now = seen[forth ? place : 2 * turn - place];
      perturb(now.corners, static_cast<std::uint64_t>(k), corners);
      const bool back = !forth || (place == 0 && k > 0);
      const EgoMotion motion = k == 0 ? EgoMotion{} : back ? now.back : now.forth;
      const auto start = std::chrono::steady_clock::now();
      const FrameResult& result = filter.step(corners, motion);
      part.frame_ms +=
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
              .count() /
          count;
      part.items = std::max(part.items, result.layers.dimension());
      part.corners = std::max(part.corners, corners.size());
      if (k % 50 == 0) {
        part.heap_bytes = std::max(part.heap_bytes, ::mallinfo2().uordblks);
        if (const auto what = testing::violation(result, corners.size(), camera, parameters)) {
          fmt::print(stderr, "frame {}: {}\n", k, *what);
          return 1;
        }
      }
    }
    fmt::print("{:7} frames: at most {} corners, {} items, {:.2f} MB in use; {:.3f} ms a frame\n",
               k, part.corners, part.items, static_cast<double>(part.heap_bytes) / 1e6,
               part.frame_ms);
    std::fflush(stdout);
  }
  const auto grew = [](std::size_t from, std::size_t to) {
    return static_cast<double>(to) > kMostGrowth * static_cast<double>(from);
  };
  const Part &early = parts[1], &late = parts.back();
  if (grew(early.heap_bytes, late.heap_bytes)) return fmt::print(stderr, "the memory grows\n"), 1;
  if (grew(early.items, late.items)) return fmt::print(stderr, "the layers grow\n"), 1;
  if (filter.diagnostics().count(Fault::corner_too_many) > 0) return 1;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return fmt::print(stderr, "usage: soak SCENARIO FRAMES\n"), 2;
  try {
    const scenario::Scenario scenario =
        scenario::load(argv[1], {.sets = {fmt::format("frames={}", kSeenFrames)}, .seed = {}});
    Intrinsics camera;
    const std::vector<Seen> seen = see(scenario, camera);
    return drive(seen, camera, std::max(kParts, std::atoi(argv[2])));
  } catch (const std::exception& error) {
    fmt::print(stderr, "soak: {}\n", error.what());
    return 2;
  }
}
