// The filter with arbitrary corners, times and ego-motion: it never throws, its state is finite and
// bounded in size, and its counts agree.
#include <deque>
#include <numeric>
#include <string>
#include <vector>

#include "filter/kinematics/geometry.h"
#include "tests/filter/invariants.h"
#include "tests/filter/world.h"
#include "tests/fuzz/input.h"

namespace {

using namespace lcs;
using fuzz::Bytes;

const Intrinsics kCamera{90, {79.5, 59.5}, 160, 120};
constexpr int kMostFrames = 60;

using Corners = std::vector<Eigen::Vector2f>;

/// The corners of the previous frame, moved by one step, and some new ones.
void next_corners(Bytes& bytes, Corners& corners) {
  const std::uint8_t how = bytes.byte();
  if (how & 1) corners.clear();
  if (how & 2) {
    const float x = static_cast<float>(bytes.byte()) / 16 - 8;
    for (Eigen::Vector2f& corner : corners) corner.x() += x;
  }
  if ((how & 4) && corners.size() < 1000) {
    const Corners same = corners;
    corners.insert(corners.end(), same.begin(), same.end());
  }
  for (int i = how >> 3; i > 0; --i) {
    corners.emplace_back(static_cast<float>(80 + bytes.number(30)),
                         static_cast<float>(60 + bytes.number(20)));
  }
}

EgoMotion next_motion(Bytes& bytes) {
  EgoMotion motion;
  const std::uint8_t how = bytes.byte();
  motion.dt_s = how & 1 ? bytes.number(1) : 0.1;
  if (how & 2) motion.v_C_mps = {bytes.number(0.5), bytes.number(0.5), bytes.number(0.5)};
  if (how & 4) {
    motion.w_C_radps = {bytes.number(0.5), bytes.number(0.5), bytes.number(0.5)};
    const Eigen::Vector3d turn = -motion.w_C_radps * motion.dt_s;
    if (turn.norm() < 1e3) motion.R_cur_prev = testing::rotation(turn);
  }
  if (how & 8) {
    motion.ground =
        Ground{.up_C = {bytes.number(0.1), -1, bytes.number(0.1)}, .height_m = bytes.number(0.5)};
    if (how & 16) motion.ground->up_C.normalize();
  }
  if (how & 32) motion.unseen_turn_rad = bytes.number(0.05);
  if (how & 64) motion.velocity_sigma_mps = bytes.number(0.05);
  if (how == 255) motion.R_cur_prev(bytes.byte() % 3, bytes.byte() % 3) = bytes.number(1);
  return motion;
}

std::size_t taken(const Corners& corners) {
  return static_cast<std::size_t>(
      std::count_if(corners.begin(), corners.end(), [](const auto& x) { return x.allFinite(); }));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const std::uint8_t settings = bytes.byte();
  const std::vector<std::string> presets = preset_names();
  AnyParameters parameters = preset(presets[settings % presets.size()]);
  auto* paper = std::get_if<paper::PaperParameters>(&parameters);
  if (paper && settings & 128) paper->ignore = !paper->ignore;
  if (settings & 64) set(parameters, "line.max_corners", "50");
  if (settings & 32) set(parameters, "field.rotation", "first_order");
  AnyFilter filter(kCamera, parameters);
  Corners corners;
  std::size_t offered = 0;
  for (int k = 0; k < kMostFrames && !bytes.empty(); ++k) {
    next_corners(bytes, corners);
    const FrameResult& result = filter.step(corners, next_motion(bytes));
    if (const auto what = testing::violation(result, corners.size(), kCamera, parameters)) {
      fuzz::fail(*what);
    }
    offered += taken(corners);
    // A corner makes a normal edge, and may make a rebel edge in its place.
    fuzz::require(result.layers.normal_edges.size() <= offered, "edges come of corners");
    fuzz::require(result.layers.rebel_edges.size() <= 2 * offered, "rebel edges come of corners");
    // A row with one sighting per corner, which branches into several rows of two sightings.
    const auto branches = static_cast<std::size_t>(paper ? 1 + paper->edge.alpha_branches : 0);
    fuzz::require(result.paper.chains.size() <= branches * offered, "alpha comes of corners");
  }
  const Diagnostics& diagnostics = filter.diagnostics();
  fuzz::require((diagnostics.total() == 0) == diagnostics.lines().empty(), "what is met is told");
  return 0;
}
