#include "filter/detect/fast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "filter/detect/picture_noise.h"

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

/// Tilted boards of many greys, with nothing in them that repeats itself; without noise.
cv::Mat1b boards() {
  cv::RNG random(7);
  cv::Mat1b picture(480, 640, uchar{120});
  for (int i = 0; i < 120; ++i) {
    const cv::RotatedRect board(cv::Point2f(random.uniform(0.F, 640.F), random.uniform(0.F, 480.F)),
                                cv::Size2f(random.uniform(10.F, 80.F), random.uniform(10.F, 80.F)),
                                random.uniform(0.F, 180.F));
    cv::Point2f at[4];
    board.points(at);
    std::vector<cv::Point> outline(at, at + 4);
    cv::fillConvexPoly(picture, outline, cv::Scalar(random.uniform(40, 210)), cv::LINE_AA);
  }
  picture.rowRange(0, 100).setTo(150);  // a sky
  return picture;
}

cv::Mat1b noisy(const cv::Mat1b& picture, double levels) {
  cv::RNG random(11);
  cv::Mat1f noise(picture.size());
  random.fill(noise, cv::RNG::NORMAL, 0, levels);
  cv::Mat1b sum;
  cv::add(picture, noise, sum, cv::noArray(), CV_8U);
  return sum;
}

cv::Mat1b compressed(const cv::Mat1b& picture, int quality) {
  std::vector<uchar> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

/// Root mean square of what compression has changed within FAST's circle about corners.
double changed_levels(const cv::Mat1b& before, const cv::Mat1b& after) {
  double squares = 0;
  int pixels = 0;
  for (const Eigen::Vector2f& corner : FastDetector(20).detect(before)) {
    const cv::Rect circle(static_cast<int>(corner.x()) - 3, static_cast<int>(corner.y()) - 3, 7, 7);
    squares += std::pow(cv::norm(before(circle), after(circle)), 2);
    pixels += circle.area();
  }
  return std::sqrt(squares / pixels);
}

TEST(Compression, IsMeasuredByTheGridThatItLeaves) {
  const cv::Mat1b clean = noisy(boards(), 2);  // as any camera has it
  EXPECT_LT(compression_levels(clean), 1);
  double last = 1;
  for (const int quality : {80, 60, 40, 20}) {
    const cv::Mat1b picture = compressed(clean, quality);
    const double levels = compression_levels(picture), truth = changed_levels(clean, picture);
    EXPECT_GT(levels, last) << quality;
    EXPECT_GT(levels, 0.5 * truth) << quality;
    EXPECT_LT(levels, 1.5 * truth) << quality;
    last = levels;
    // what is cut out of a larger picture has its grid elsewhere
    const cv::Mat1b cut = picture(cv::Rect(5, 3, 600, 400));
    EXPECT_NEAR(compression_levels(cut), levels, 0.2 * levels) << quality;
  }
}

TEST(Compression, IsNoFenceNorTooSmallAPicture) {
  cv::Mat1b fence(240, 320, uchar{200});
  for (int x = 0; x < fence.cols; x += 8) fence.col(x).setTo(30);
  EXPECT_EQ(compression_levels(fence), 0);
  for (const int side : {1, 2, 3, 8, 16}) {
    const cv::Mat1b small(side, side, uchar{90});
    EXPECT_EQ(compression_levels(small), 0) << side;
    EXPECT_EQ(threshold_of(small), 20) << side;
  }
}

TEST(Threshold, FollowsCompressionWhereCornersAreMany) {
  cv::RNG random(3);
  cv::Mat1b gravel(480, 640, uchar{120});
  for (int i = 0; i < 12000; ++i) {
    const cv::Point at(random.uniform(0, 640), random.uniform(0, 480));
    cv::circle(gravel, at, random.uniform(1, 5), cv::Scalar(random.uniform(30, 220)), cv::FILLED);
  }
  gravel.rowRange(0, 120).setTo(150);  // a sky: of gravel alone no noise can be told
  EXPECT_EQ(threshold_of(gravel), 20);
  const std::size_t enough = gravel.total() / 256;
  int last = 20;
  for (const int quality : {90, 70, 40, 10}) {
    const cv::Mat1b picture = compressed(gravel, quality);
    const int threshold = threshold_of(picture);
    const double most = 8 * std::hypot(compression_levels(picture), *noise_levels(picture));
    EXPECT_GE(threshold, last) << quality;
    EXPECT_LE(threshold, most + 1) << quality;
    EXPECT_GE(FastDetector(threshold).detect(picture).size(), enough) << quality;
    // and it goes as far as either lets it
    const bool ends_there = FastDetector(threshold + 2).detect(picture).size() < enough + 100;
    EXPECT_TRUE(ends_there || threshold >= most - 1) << quality << " has " << threshold;
    last = std::min(threshold, 40);
  }
  EXPECT_GT(last, 20);
}

TEST(Threshold, FollowsWhatIsNotOfTheScene) {
  EXPECT_EQ(threshold_of(boards()), 20);
  EXPECT_EQ(threshold_of(noisy(boards(), 1)), 20);
  EXPECT_NEAR(threshold_of(noisy(boards(), 4)), 32, 4);
  EXPECT_EQ(threshold_of(noisy(boards(), 8)), 48) << "what is more is taken for texture";
  // boards have far fewer corners than one for every 16x16 px: compression does not take them
  const cv::Mat1b both = compressed(noisy(boards(), 4), 40);
  EXPECT_GT(compression_levels(both), 4);
  EXPECT_LT(threshold_of(both), 32) << "and it has less noise";
  EXPECT_EQ(FastDetector(std::nullopt).threshold(both), threshold_of(both));
  EXPECT_EQ(FastDetector(std::nullopt).detect(both), FastDetector(threshold_of(both)).detect(both));
  EXPECT_EQ(FastDetector(30).threshold(both), 30);
}

}  // namespace
}  // namespace lcs
