/// The filter's memory, measured by a counting allocator: no allocation once the scene is at its
/// busiest, and a total bounded by the picture's size and `line.max_corners`.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <new>

#include "filter/filter.h"
#include "tests/filter/world.h"

namespace {

struct Heap {
  std::size_t allocations = 0, bytes = 0, peak_bytes = 0;
} heap;

/// Precedes each block and holds its size for the deallocation; its own size keeps the block
/// aligned.
constexpr std::size_t kHeader = alignof(std::max_align_t);

}  // namespace

void* operator new(std::size_t size) {
  auto* block = static_cast<std::byte*>(std::malloc(size + kHeader));
  if (!block) throw std::bad_alloc();
  *reinterpret_cast<std::size_t*>(block) = size;
  ++heap.allocations;
  heap.bytes += size;
  heap.peak_bytes = std::max(heap.peak_bytes, heap.bytes);
  return block + kHeader;
}

void operator delete(void* memory) noexcept {
  if (!memory) return;
  auto* block = static_cast<std::byte*>(memory) - kHeader;
  heap.bytes -= *reinterpret_cast<std::size_t*>(block);
  std::free(block);
}

void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}

namespace lcs {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using testing::Random;
using testing::steady_motion;
using testing::vga;
using testing::World;

using Corners = std::vector<Vector2f>;

/// Number of frames after which `busy_frames` repeat.
constexpr std::size_t kPeriod = 80;

/// `count` corners: a wall that passes sideways, a pattern that repeats every 160 px, and on it a
/// group with its own motion. A tenth of the corners is missing at a time.
std::vector<Corners> busy_frames(int count, std::size_t frames) {
  Random random(1);
  struct Corner {
    double x, y, step;
  };
  std::vector<Corner> corners;  // of one pattern
  for (int i = 0; i < count / 4; ++i) {
    const bool moves = i % 8 == 0;
    const double size = moves ? 0.3 : 1;
    corners.push_back(
        {size * random.uniform(0, 160), size * random.uniform(0, 480), moves ? 4. : -2.});
  }
  std::vector<Corners> seen(frames);
  for (std::size_t k = 0; k < frames; ++k) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if ((i + k) % 10 == 0) continue;
      const double x =
          std::fmod(corners[i].x + corners[i].step * static_cast<double>(k % kPeriod) + 160, 160);
      for (int tile = 0; tile < 4; ++tile) seen[k].emplace_back(x + 160 * tile, corners[i].y);
    }
  }
  return seen;
}

EgoMotion sideways() {
  return steady_motion({0.15, 0, 0}, Vector3d::Zero(), 0.1);  // 2 px a frame at 3 m
}

/// On level ground 1.5 m below the camera: the wall's foot is visible.
EgoMotion sideways_on_ground() {
  EgoMotion ego = sideways();
  ego.ground = Ground{.up_C = {0, -1, 0}, .height_m = 1.5};
  return ego;
}

void expect_none_in_the_end(const EgoMotion& ego) {
  const std::size_t warm_up = 4 * kPeriod;
  const std::vector<Corners> frames = busy_frames(400, warm_up + kPeriod);
  Filter filter(vga());
  std::size_t in_the_end = 0, rebels = 0, squares = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const std::size_t before = heap.allocations;
    const FrameResult& result = filter.step(frames[k], k == 0 ? EgoMotion{} : ego);
    if (k >= warm_up) {
      in_the_end += heap.allocations - before;
      rebels += result.layers.rebel_edges.size();
      squares += result.layers.squares.size();
    }
  }
  EXPECT_EQ(in_the_end, 0U);
  // All parts of the filter were at work.
  EXPECT_GT(rebels, 10 * kPeriod);
  EXPECT_GT(squares, kPeriod / 2);
}

TEST(Memory, ASteadySceneAsksForNone) {
  expect_none_in_the_end(sideways());
}

TEST(Memory, ASteadySceneOnAKnownGroundAsksForNone) {
  expect_none_in_the_end(sideways_on_ground());
}

/// Peak memory of the filter, bytes, with `offered` corners.
std::size_t peak_bytes(const Intrinsics& camera, const char* max_corners, int offered) {
  const std::vector<Corners> frames = busy_frames(offered, 40);
  Parameters parameters;
  set(parameters, "line.max_corners", max_corners);
  const std::size_t before = heap.bytes;
  heap.peak_bytes = before;
  Filter filter(camera, parameters);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    filter.step(frames[k], k == 0 ? EgoMotion{} : sideways());
  }
  return heap.peak_bytes - before;
}

TEST(Memory, IsBoundedByTheMostCornersAndHowCloseTheyLie) {
  // Measured: 8.2 kB for each processed corner, while its pairs move to a larger buffer.
  EXPECT_LT(peak_bytes(vga(), "300", 300), 300 * 9500);
  // At ten times the density each corner has more neighbours; an unprocessed
  // corner costs its verdict and its place in the queue.
  EXPECT_LT(peak_bytes(vga(), "300", 3000), 300 * 12500 + 2700 * 120);
}

}  // namespace
}  // namespace lcs
