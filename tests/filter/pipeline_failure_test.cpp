/// An expert's thread that runs out of memory: a program of its own, for it takes the memory away.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "filter/pipeline.h"
#include "tests/filter/world.h"

namespace {

std::atomic<bool> all_is_spent = false;
thread_local bool has_reserves = false;

}  // namespace

void* operator new(std::size_t size) {
  if (void* block = all_is_spent && !has_reserves ? nullptr : std::malloc(size)) return block;
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace lcs {
namespace {

TEST(PipelineFailure, OfAnExpertIsToldByThisAndEveryLaterCall) {
  has_reserves = true;  // this thread alone
  testing::Scene scene(1);
  const auto corners = testing::record(scene, 8);
  const Intrinsics camera = scene.world.camera;
  for (int before = 0; before < 6; ++before) {
    SCOPED_TRACE(before);
    FilterPipeline pipeline(camera, preset("default"));
    for (int k = 0; k < before; ++k) pipeline.push(corners[k], k == 0 ? EgoMotion{} : scene.motion);
    // Frames of many more corners, for which there is no room yet.
    std::vector<Eigen::Vector2f> many;
    for (int i = 0; i < 2000; ++i) many.emplace_back(10 + i % 50 * 12, 10 + i / 50 * 11);
    all_is_spent = true;
    EXPECT_THROW(
        {
          for (int k = 0; k < 3; ++k) pipeline.push(many, scene.motion);
          while (pipeline.drain()) {
          }
        },
        std::bad_alloc);
    all_is_spent = false;
    EXPECT_THROW(pipeline.push(many, scene.motion), std::bad_alloc);
    EXPECT_THROW(pipeline.push(many, scene.motion), std::bad_alloc);
  }
}

}  // namespace
}  // namespace lcs
