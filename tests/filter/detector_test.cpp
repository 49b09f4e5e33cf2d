#include "filter/detect/fast.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <stdexcept>
#include <vector>

#include "filter/detect/describe.h"
#include "filter/detect/picture_noise.h"

namespace lcs {
namespace {

/// Dots of one pixel: all 16 pixels of FAST's circle differ from each.
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

/// Tilted boards of many greys, without repeating patterns and without noise.
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

/// Root mean square of the changes by compression within FAST's circles about corners.
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

TEST(Noise, IsEstimatedWithinATenthOnFlatAndOnCrowdedPictures) {
  cv::Mat1b slope(240, 320);
  for (int x = 0; x < slope.cols; ++x) slope.col(x).setTo(60 + 0.25 * x);
  const double rounding = 1 / std::sqrt(12.0);
  for (const double levels : {1.0, 2.0, 5.0, 12.0}) {
    for (const cv::Mat1b& clean : {slope, boards()}) {
      EXPECT_NEAR(noise_levels(noisy(clean, levels)).value_or(0), std::hypot(levels, rounding),
                  0.1 * levels);
    }
  }
}

TEST(Noise, IsUnknownWhereAllIsBlackOrWhite) {
  EXPECT_FALSE(noise_levels(cv::Mat1b(240, 320, uchar{0})));
  EXPECT_FALSE(noise_levels(cv::Mat1b(240, 320, uchar{255})));
  EXPECT_EQ(noise_levels(cv::Mat1b(240, 320, uchar{90})), 0);
}

TEST(Compression, IsMeasuredByTheGridThatItLeaves) {
  const cv::Mat1b clean = noisy(boards(), 2);  // the noise of any camera
  EXPECT_LT(compression_levels(clean), 1);
  double last = 1;
  for (const int quality : {80, 60, 40, 20}) {
    const cv::Mat1b picture = compressed(clean, quality);
    const double levels = compression_levels(picture), truth = changed_levels(clean, picture);
    EXPECT_GT(levels, last) << quality;
    EXPECT_GT(levels, 0.5 * truth) << quality;
    EXPECT_LT(levels, 1.5 * truth) << quality;
    last = levels;
    // a crop of a larger picture has its block grid elsewhere
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
  gravel.rowRange(0, 120).setTo(150);  // a sky, because noise cannot be estimated from gravel alone
  EXPECT_EQ(threshold_of(gravel), 20);
  const std::size_t enough = gravel.total() / 256;
  int last = 20;
  for (const int quality : {90, 70, 40, 10}) {
    const cv::Mat1b picture = compressed(gravel, quality);
    const int threshold = threshold_of(picture);
    const double most = 8 * std::hypot(compression_levels(picture), *noise_levels(picture));
    EXPECT_GE(threshold, last) << quality;
    EXPECT_LE(threshold, std::max(20.0, most + 1)) << quality;
    EXPECT_GE(FastDetector(threshold).detect(picture).size(), enough) << quality;
    // the threshold goes as far as either condition allows
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
  // boards have fewer than one corner per 16x16 px, so compression does not raise the threshold
  const cv::Mat1b both = compressed(noisy(boards(), 4), 40);
  EXPECT_GT(compression_levels(both), 4);
  EXPECT_LT(threshold_of(both), 32) << "and it has less noise";
  EXPECT_EQ(FastDetector(std::nullopt).threshold(both), threshold_of(both));
  EXPECT_EQ(FastDetector(std::nullopt).detect(both), FastDetector(threshold_of(both)).detect(both));
  EXPECT_EQ(FastDetector(30).threshold(both), 30);
}

// ---- Signatures

using Corners = std::vector<Eigen::Vector2f>;

/// Overlapping rectangles of all greys: many corners, all different.
cv::Mat1b clutter(int width_px, int height_px) {
  std::mt19937 random(5);
  const auto below = [&](int end) {
    return static_cast<int>(random() % static_cast<unsigned>(end));
  };
  cv::Mat1b picture(height_px, width_px, uchar{128});
  for (int i = 0; i < 600; ++i) {
    const cv::Rect where(below(width_px) - 10, below(height_px) - 10, 3 + below(30), 3 + below(30));
    picture(where & cv::Rect(0, 0, width_px, height_px)) = static_cast<uchar>(below(256));
  }
  return picture;
}

Corners corners_of(const cv::Mat1b& picture) {
  const Corners corners = FastDetector(20).detect(picture);
  EXPECT_GT(corners.size(), 80U);
  return corners;
}

TEST(Describe, TellsCornersApartAndGivesTheSameBitsAgain) {
  const cv::Mat1b picture = clutter(320, 240);
  const Corners corners = corners_of(picture);
  const std::vector<Signature> signatures = describe(picture, corners);
  ASSERT_EQ(signatures.size(), corners.size());
  const int threads = cv::getNumThreads();
  for (const int count : {1, 2, 4}) {
    cv::setNumThreads(count);
    EXPECT_EQ(describe(picture, corners), signatures) << count << " threads";
  }
  cv::setNumThreads(threads);
  int alike = 0;
  for (std::size_t a = 0; a < corners.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if ((corners[a] - corners[b]).norm() < 20) continue;
      alike += distance(signatures[a], signatures[b]) < 40;
    }
  }
  EXPECT_LT(alike, static_cast<int>(corners.size()) / 10) << "pairs of " << corners.size();
}

TEST(Describe, IsInTheOrderOfTheCornersAndOfEachAlone) {
  const cv::Mat1b picture = clutter(320, 240);
  Corners corners = corners_of(picture);
  std::vector<Signature> signatures = describe(picture, corners);
  for (std::size_t i = 0; i < corners.size(); i += 17) {
    EXPECT_EQ(describe(picture, {&corners[i], 1}), std::vector{signatures[i]}) << i;
  }
  std::reverse(corners.begin(), corners.end());
  std::reverse(signatures.begin(), signatures.end());
  EXPECT_EQ(describe(picture, corners), signatures);
}

TEST(Describe, MovesWithThePictureByWholePixels) {
  const cv::Mat1b world = clutter(400, 300);
  const cv::Rect here(20, 30, 320, 240);
  for (const cv::Point shift : {cv::Point(1, 0), cv::Point(0, -3), cv::Point(-13, 17)}) {
    const cv::Mat1b before = world(here), after = world(here + shift);
    Corners at, moved;
    for (const Eigen::Vector2f& x : corners_of(before)) {
      const Eigen::Vector2f there =
          x - Eigen::Vector2f(static_cast<float>(shift.x), static_cast<float>(shift.y));
      const auto is_inside = [&](const Eigen::Vector2f& place) {
        // inside the margin of the unrotated patch of 31 px and the blur of 7 px
        return place.x() >= 19 && place.y() >= 19 && place.x() < 301 && place.y() < 221;
      };
      if (!is_inside(x) || !is_inside(there)) continue;
      at.push_back(x);
      moved.push_back(there);
    }
    EXPECT_GT(at.size(), 40U);
    EXPECT_EQ(describe(before, at), describe(after, moved)) << shift;
  }
}

TEST(Describe, OfAPartOfAPictureLooksAtNothingElse) {
  const cv::Mat1b world = clutter(400, 300);
  const cv::Mat1b part = world(cv::Rect(20, 30, 320, 240));
  const Corners corners = corners_of(part);
  EXPECT_EQ(describe(part, corners), describe(part.clone(), corners));
}

/// Reference: OpenCV's own call. It drops corners near the border and rotates by the found or
/// given angle, here 0.
TEST(Describe, IsOrbsDescriptorUpright) {
  const cv::Mat1b picture = clutter(320, 240);
  std::vector<cv::KeyPoint> keypoints;
  for (const cv::KeyPoint& found : FastDetector(20).detect_scored(picture)) {
    keypoints.emplace_back(found.pt, 31.F, 0.F);
  }
  cv::Mat1b expected;
  cv::ORB::create(500, 1.2F, 1)->compute(picture, keypoints, expected);
  ASSERT_GT(keypoints.size(), 50U);
  Corners corners;
  for (const cv::KeyPoint& kept : keypoints) corners.emplace_back(kept.pt.x, kept.pt.y);
  const std::vector<Signature> signatures = describe(picture, corners);
  for (int k = 0; k < expected.rows; ++k) {
    const auto bytes = std::bit_cast<SignatureBytes>(signatures[static_cast<std::size_t>(k)]);
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), expected[k])) << k;
  }
}

TEST(Describe, ReachesEveryPixelAndGivesZeroWhereThereIsNone) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const cv::Mat1b picture = clutter(64, 48);
  const Corners edges{{0, 0}, {63, 0}, {0, 47}, {63, 47}, {-0.49F, 47.49F}, {31.6F, 20.4F}};
  for (const Signature& signature : describe(picture, edges)) EXPECT_NE(signature, Signature{});
  const Corners near{{31.6F, 20.4F}}, pixel{{32, 20}};
  EXPECT_EQ(describe(picture, near), describe(picture, pixel));

  const Corners none{{kNan, 10},     {10, kNan},  {kInfinity, 10}, {10, -kInfinity},
                     {-0.6F, 10},    {63.6F, 10}, {10, -0.6F},     {10, 47.6F},
                     {1e30F, 1e30F}, {-1e30F, 5}, {2.2e9F, 10},    {10, -2.2e9F}};
  Corners mixed = none;
  mixed.insert(mixed.begin() + 5, edges[5]);
  std::vector<Signature> expected(none.size(), Signature{});
  EXPECT_EQ(describe(picture, none), expected);
  expected.insert(expected.begin() + 5, describe(picture, near).front());
  EXPECT_EQ(describe(picture, mixed), expected);
}

TEST(Describe, TakesPicturesOfAnySize) {
  EXPECT_TRUE(describe(clutter(64, 48), {}).empty());
  EXPECT_TRUE(describe(cv::Mat1b(), {}).empty());
  const Corners corners{{0, 0}, {5, 3}};
  EXPECT_EQ(describe(cv::Mat1b(), corners), std::vector<Signature>(2));
  const std::vector<Signature> of_a_pixel = describe(cv::Mat1b(1, 1, uchar{7}), corners);
  EXPECT_EQ(of_a_pixel.size(), 2U);
  EXPECT_EQ(of_a_pixel[1], Signature{}) << "is outside";
  for (const cv::Size& size :
       {cv::Size(6, 4), cv::Size(1, 40), cv::Size(40, 1), cv::Size(20, 31)}) {
    EXPECT_EQ(describe(cv::Mat1b(size, uchar{7}), corners).size(), 2U) << size;
  }
}

}  // namespace
}  // namespace lcs
