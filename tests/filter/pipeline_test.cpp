/// The experts side by side: the same bits as one after the other.
#include "filter/pipeline.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/filter/presets.h"
#include "tests/filter/same_result.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using testing::expect_same;
using testing::record;
using testing::Scene;
using Corners = std::vector<Eigen::Vector2f>;

constexpr int kFrames = 60;

struct Footage {
  explicit Footage(std::uint64_t seed) {
    Scene scene(seed);
    camera = scene.world.camera;
    corners = record(scene, kFrames);
    motions.assign(kFrames, scene.motion);
    motions.front() = {};
    // What is bad, comes twice or not at all on the way through.
    motions[20].dt_s = -1;
    motions[21].dt_s = 0;
    corners[30].clear();
    corners[40].insert(corners[40].end(), corners[40].begin(), corners[40].begin() + 20);
    corners[41].emplace_back(-5.F, 1e9F);
  }
  Intrinsics camera;
  std::vector<Corners> corners;
  std::vector<EgoMotion> motions;
};

struct Pipeline : testing::OfEachPreset {};
INSTANTIATE_TEST_SUITE_P(Presets, Pipeline, testing::each_preset(), testing::name_of_preset);

TEST_P(Pipeline, GivesTheBitsOfTheFilterTwoFramesLater) {
  const Footage footage(31);
  Filter filter(footage.camera, parameters());
  FilterPipeline pipeline(footage.camera, parameters());
  int given = 0;
  const auto expect_next = [&](const FrameResult& result) {
    const FrameResult& expected = filter.step(footage.corners[given], footage.motions[given]);
    expect_same(result, expected, static_cast<std::size_t>(given));
    ASSERT_EQ(result.layers.normal_edges.size(), expected.layers.normal_edges.size());
    for (std::size_t i = 0; i < expected.layers.normal_edges.size(); ++i) {
      EXPECT_EQ(result.layers.normal_edges[i].id, expected.layers.normal_edges[i].id);
    }
    ++given;
  };
  for (int k = 0; k < kFrames; ++k) {
    const FrameResult* result = pipeline.push(footage.corners[k], footage.motions[k]);
    ASSERT_EQ(result != nullptr, k >= FilterPipeline::kLag);
    if (result) expect_next(*result);
  }
  while (const FrameResult* result = pipeline.drain()) expect_next(*result);
  EXPECT_EQ(given, kFrames);
  EXPECT_EQ(pipeline.drain(), nullptr);
  for (const Fault fault : {Fault::time_back, Fault::corner_outside, Fault::corner_repeated}) {
    EXPECT_EQ(pipeline.diagnostics().count(fault), filter.diagnostics().count(fault));
    EXPECT_GT(pipeline.diagnostics().count(fault), 0);
  }
}

TEST_P(Pipeline, GoesOnAfterItWasDrained) {
  const Footage footage(32);
  Filter filter(footage.camera, parameters());
  FilterPipeline pipeline(footage.camera, parameters());
  int given = 0;
  const auto expect_next = [&](const FrameResult* result) {
    if (!result) return false;
    expect_same(*result, filter.step(footage.corners[given], footage.motions[given]),
                static_cast<std::size_t>(given));
    ++given;
    return true;
  };
  for (int k = 0; k < kFrames; ++k) {
    expect_next(pipeline.push(footage.corners[k], footage.motions[k]));
    if (k % 7 < 2) {
      while (expect_next(pipeline.drain())) continue;
      EXPECT_EQ(given, k + 1);
    }
  }
}

TEST(PipelineOfAnyKind, EndsWithFramesUnderWayAndCanBeMoved) {
  const Footage footage(33);
  for (int frames = 0; frames < 5; ++frames) {
    FilterPipeline pipeline(footage.camera, preset("default"));
    for (int k = 0; k < frames; ++k) pipeline.push(footage.corners[k], footage.motions[k]);
    FilterPipeline moved = std::move(pipeline);
    for (int k = frames; k < frames + 2; ++k) moved.push(footage.corners[k], footage.motions[k]);
    EXPECT_NE(moved.drain(), nullptr);
    pipeline = std::move(moved);
    EXPECT_NE(pipeline.drain(), nullptr);
    EXPECT_EQ(pipeline.drain(), nullptr);
  }
}

TEST(PipelineOfAnyKind, RefusesWhatTheFilterRefuses) {
  EXPECT_THROW(FilterPipeline({0, {0, 0}, 640, 480}, preset("default")), std::invalid_argument);
}

}  // namespace
}  // namespace lcs
