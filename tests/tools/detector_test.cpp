#include "filter/detect/fast.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace lcs {
namespace {

/// Dots of one pixel: each has the whole circle of 16 against it.
cv::Mat1b dots(uchar ground, uchar dot) {
  cv::Mat1b image(100, 120, ground);
  image(30, 40) = dot;
  image(30, 70) = dot;
  image(60, 20) = dot;
  return image;
}

TEST(FastDetector, FindsDotsWhereTheyAreRowByRow) {
  const std::vector<Eigen::Vector2f> expected{{40, 30}, {70, 30}, {20, 60}};
  EXPECT_EQ(FastDetector(20).detect(dots(50, 200)), expected);
  EXPECT_EQ(FastDetector(20).detect(dots(200, 50)), expected);
  EXPECT_TRUE(FastDetector(20).detect(cv::Mat1b(100, 120, uchar{50})).empty());
}

TEST(FastDetector, ThresholdIsTheContrastThatACornerMustExceed) {
  EXPECT_EQ(FastDetector(29).detect(dots(50, 80)).size(), 3u);
  EXPECT_EQ(FastDetector(30).detect(dots(50, 80)).size(), 0u);
}

TEST(FastDetector, RefusesAThresholdThatIsNoContrast) {
  EXPECT_THROW(FastDetector(0), std::invalid_argument);
  EXPECT_THROW(FastDetector(255), std::invalid_argument);
  EXPECT_NO_THROW(FastDetector(1));
  EXPECT_NO_THROW(FastDetector(254));
}

}  // namespace
}  // namespace lcs
