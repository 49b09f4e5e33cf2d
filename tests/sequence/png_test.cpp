// Written files, read back by OpenCV with libpng.
#include "tools/sequence/png.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <vector>

namespace lcs::sequence {
namespace {

cv::Mat decode(const std::string& bytes, int flags) {
  return cv::imdecode(std::vector<unsigned char>(bytes.begin(), bytes.end()), flags);
}

cv::Mat noise(int type, double most) {
  cv::Mat image(37, 53, type);  // a prime size
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, most);
  return image;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

class PngOfEachFilter : public testing::TestWithParam<PngFilter> {};
INSTANTIATE_TEST_SUITE_P(Filters, PngOfEachFilter,
                         testing::Values(PngFilter::none, PngFilter::sub, PngFilter::up));

TEST_P(PngOfEachFilter, GivesBackEveryPixelOfEveryKind) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1}) {
    const cv::Mat image = noise(type, CV_MAT_DEPTH(type) == CV_8U ? 256 : 65536);
    EXPECT_TRUE(same(decode(encode_png(image, GetParam()), cv::IMREAD_UNCHANGED), image)) << type;
  }
}

TEST_P(PngOfEachFilter, Has16BitChannelsInTheOrderGivenWhichOpenCvReversesToBgr) {
  const cv::Mat image = noise(CV_16UC3, 65536);
  const cv::Mat read = decode(encode_png(image, GetParam()), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(read.type(), CV_16UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const cv::Vec3w& in = image.at<cv::Vec3w>(y, x);
      EXPECT_EQ(read.at<cv::Vec3w>(y, x), cv::Vec3w(in[2], in[1], in[0]));
    }
  }
}

TEST(IndexedPng, ShowsTheColoursOfItsPalette) {
  std::vector<Rgb> palette(256);
  for (int i = 0; i < 256; ++i) {
    const auto at = static_cast<std::size_t>(i);
    palette[at] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(255 - i), 7};
  }
  const cv::Mat1b indices = noise(CV_8UC1, 256);
  const cv::Mat3b read = decode(encode_png(indices, palette), cv::IMREAD_COLOR);
  for (int y = 0; y < indices.rows; ++y) {
    for (int x = 0; x < indices.cols; ++x) {
      const unsigned char i = indices(y, x);
      EXPECT_EQ(read(y, x), cv::Vec3b(7, static_cast<unsigned char>(255 - i), i));
    }
  }
}

TEST(Png, RefusesWhatTheFormatDoesNotHold) {
  EXPECT_THROW(encode_png(cv::Mat(), PngFilter::none), std::invalid_argument);
  EXPECT_THROW(encode_png(cv::Mat1f(2, 2, 0.F), PngFilter::none), std::invalid_argument);
  EXPECT_THROW(encode_png(cv::Mat2b(2, 2), PngFilter::none), std::invalid_argument);
  EXPECT_THROW(encode_png(cv::Mat1b(2, 2), std::vector<Rgb>(3)), std::invalid_argument);
}

}  // namespace
}  // namespace lcs::sequence
