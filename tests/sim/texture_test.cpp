#include "sim/scene/texture.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <set>

#include "tests/tools/refusal.h"

namespace lcs::sim {
namespace {

cv::Mat3b painted(const std::string& style, std::uint64_t seed) {
  return paint(style, 128, 128, RandomStream(seed, "texture"));
}

TEST(Texture, TheSameSeedPaintsTheSamePicture) {
  for (const std::string& style : texture_styles()) {
    EXPECT_EQ(cv::norm(painted(style, 7), painted(style, 7), cv::NORM_INF), 0) << style;
  }
}

TEST(Texture, AnotherSeedPaintsAnother) {
  for (const std::string& style : texture_styles()) {
    EXPECT_GT(cv::norm(painted(style, 7), painted(style, 8), cv::NORM_INF), 0) << style;
  }
}

TEST(Texture, StylesAreSortedAndDiffer) {
  const auto& styles = texture_styles();
  EXPECT_TRUE(std::is_sorted(styles.begin(), styles.end()));
  std::set<double> sums;
  for (const std::string& style : styles) sums.insert(cv::norm(painted(style, 7)));
  EXPECT_EQ(sums.size(), styles.size());
}

TEST(Texture, AnUnknownStyleNamesTheKnownOnes) {
  const std::string what =
      lcs::test::refusal_of<std::invalid_argument>([] { painted("tartan", 1); });
  EXPECT_NE(what.find("tartan"), std::string::npos);
  EXPECT_NE(what.find("bricks"), std::string::npos);
}

TEST(Texture, TheStyleIsReadFromTheNameBehindAnyPrefix) {
  EXPECT_EQ(procedural_style("procedural:windows:2"), "windows");
  EXPECT_EQ(procedural_style("procedural:windows"), "windows");
  EXPECT_EQ(procedural_style("walker/procedural:panel:coat"), "panel");
  EXPECT_EQ(procedural_style("wallpaper"), "");
  EXPECT_EQ(procedural_style(""), "");
}

// A repeating texture must be as continuous across its border as inside.
TEST(Texture, GroundRepeatsWithoutASeam) {
  const cv::Mat3b ground = painted("ground", 3);
  double inside = 0;
  double seam = 0;
  for (int y = 0; y < ground.rows; ++y) {
    inside = std::max(inside, std::abs(double(ground(y, 63)[0]) - ground(y, 64)[0]));
    seam = std::max(seam, std::abs(double(ground(y, 127)[0]) - ground(y, 0)[0]));
  }
  EXPECT_LE(seam, inside + 2);
}

}  // namespace
}  // namespace lcs::sim
