/// Whether two filters give bitwise equal results for a frame.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

#include "filter/filter.h"

namespace lcs::testing {

/// Compares all but the ids, which continue in a filter that restarts.
inline void expect_same(const FrameResult& a, const FrameResult& b, std::size_t frame) {
  ASSERT_EQ(a.verdicts, b.verdicts) << "frame " << frame;
  ASSERT_EQ(a.reasons, b.reasons) << "frame " << frame;
  const auto expect_same_items = [&](const auto& from, const auto& to) {
    ASSERT_EQ(from.size(), to.size()) << "frame " << frame;
    for (std::size_t i = 0; i < from.size(); ++i) {
      EXPECT_EQ(from[i].location, to[i].location);
      EXPECT_EQ(from[i].origin, to[i].origin);
      EXPECT_EQ(from[i].speed, to[i].speed);
      EXPECT_EQ(from[i].depth_ratio, to[i].depth_ratio);
      EXPECT_EQ(from[i].angle, to[i].angle);
      EXPECT_EQ(from[i].trust, to[i].trust);
      EXPECT_EQ(from[i].age, to[i].age);
    }
  };
  expect_same_items(a.layers.normal_edges, b.layers.normal_edges);
  expect_same_items(a.layers.rebel_edges, b.layers.rebel_edges);
  expect_same_items(a.layers.normal_circles, b.layers.normal_circles);
  expect_same_items(a.layers.rebel_circles, b.layers.rebel_circles);
  expect_same_items(a.layers.squares, b.layers.squares);
  for (std::size_t i = 0; i < a.layers.squares.size(); ++i) {
    EXPECT_TRUE(std::ranges::equal(a.layers.squares[i].outline.vertices(),
                                   b.layers.squares[i].outline.vertices()))
        << "frame " << frame;
  }
  EXPECT_EQ(a.paper.chains.size(), b.paper.chains.size());
}

}  // namespace lcs::testing
