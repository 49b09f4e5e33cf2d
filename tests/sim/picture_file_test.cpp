// Sizes read from headers against OpenCV's, and pictures that are rejected before decoding.
#include "sim/pictures/picture_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <map>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "tests/tools/refusal.h"

namespace lcs::sim {
namespace {

using lcs::test::refusal_of;

std::string encoded(const std::string& format, const cv::Mat& picture,
                    const std::vector<int>& how = {}) {
  std::vector<unsigned char> bytes;
  EXPECT_TRUE(cv::imencode(format, picture, bytes, how)) << format;
  return {bytes.begin(), bytes.end()};
}

cv::Mat3b drawn(int width, int height) {
  cv::Mat3b picture(height, width);
  cv::theRNG().state = 1;
  cv::randu(picture, 0, 255);
  return picture;
}

/// One picture of each format, all of one size.
std::map<std::string, std::string> pictures(int width, int height) {
  const cv::Mat3b colours = drawn(width, height);
  cv::Mat1b grey;
  cv::cvtColor(colours, grey, cv::COLOR_BGR2GRAY);
  cv::Mat4b clear;
  cv::cvtColor(colours, clear, cv::COLOR_BGR2BGRA);
  cv::Mat3w deep;
  colours.convertTo(deep, CV_16U, 256);
  return {
      {"png", encoded(".png", colours)},
      {"deep png", encoded(".png", deep)},
      {"clear png", encoded(".png", clear)},
      {"jpeg", encoded(".jpg", colours)},
      {"grey jpeg", encoded(".jpg", grey)},
      {"progressive jpeg", encoded(".jpg", colours, {cv::IMWRITE_JPEG_PROGRESSIVE, 1})},
      {"jpeg with restarts", encoded(".jpg", colours, {cv::IMWRITE_JPEG_RST_INTERVAL, 2})},
      {"bmp", encoded(".bmp", colours)},
      {"grey bmp", encoded(".bmp", grey)},
      {"ppm", encoded(".ppm", colours)},
      {"pgm as text", encoded(".pgm", grey, {cv::IMWRITE_PXM_BINARY, 0})},
      {"pbm", encoded(".pbm", grey)},
      {"webp", encoded(".webp", colours, {cv::IMWRITE_WEBP_QUALITY, 80})},
      {"lossless webp", encoded(".webp", colours, {cv::IMWRITE_WEBP_QUALITY, 101})},
      {"clear webp", encoded(".webp", clear, {cv::IMWRITE_WEBP_QUALITY, 80})},
      {"tiff", encoded(".tiff", colours)},
      {"deep tiff", encoded(".tiff", deep, {cv::IMWRITE_TIFF_COMPRESSION, 1})},
  };
}

std::string refusal(const std::string& bytes) {
  return refusal_of<PictureError>([&] { decode_picture(bytes, cv::IMREAD_COLOR); });
}

void put(std::string& bytes, std::size_t at, std::uint32_t number, int length, bool big_endian) {
  for (int i = 0; i < length; ++i) {
    const int shift = 8 * (big_endian ? length - 1 - i : i);
    bytes.at(at + static_cast<std::size_t>(i)) = static_cast<char>(number >> shift);
  }
}

TEST(Picture, SizeIsThatOfTheDecodedOne) {
  for (const cv::Size size : {cv::Size(37, 21), cv::Size(1, 1), cv::Size(300, 2)}) {
    for (const auto& [kind, bytes] : pictures(size.width, size.height)) {
      EXPECT_EQ(picture_size(bytes).value_or(cv::Size2l()), cv::Size2l(size)) << kind;
      EXPECT_EQ(decode_picture(bytes, cv::IMREAD_COLOR).size(), size) << kind;
    }
  }
}

TEST(Picture, OfTooManyPixelsIsRefusedByItsHeader) {
  constexpr std::uint32_t kSide = 32'000;
  auto all = pictures(37, 21);
  std::map<std::string, std::string> huge;
  for (const char* kind : {"png", "deep png"}) {
    huge[kind] = all[kind];
    put(huge[kind], 16, kSide, 4, true);
    put(huge[kind], 20, kSide, 4, true);
  }
  for (const char* kind : {"jpeg", "grey jpeg", "progressive jpeg", "jpeg with restarts"}) {
    std::string& bytes = huge[kind] = all[kind];
    const std::size_t frame =
        bytes.find(kind == std::string("progressive jpeg") ? "\xff\xc2" : "\xff\xc0");
    ASSERT_NE(frame, std::string::npos) << kind;
    put(bytes, frame + 5, kSide, 2, true);
    put(bytes, frame + 7, kSide, 2, true);
  }
  huge["bmp"] = all["bmp"];
  put(huge["bmp"], 18, kSide, 4, false);
  put(huge["bmp"], 22, -kSide, 4, false);  // with rows from top to bottom
  huge["ppm"] = "P6\n# of a camera\n32000 # wide\n32000\n255\n" + std::string(100, 'x');
  huge["pbm"] = "P4 32000 32000\n" + std::string(100, 'x');
  for (const auto& [kind, bytes] : huge) {
    EXPECT_NE(refusal(bytes).find("32000 x 32000 pixels, and can have 67 million in all; give a"),
              std::string::npos)
        << kind << ": " << refusal(bytes);
  }
  EXPECT_NE(refusal("P5 99999999999999999999999 99999999999999999999999\n255\n").find("pixels"),
            std::string::npos);
}

/// Byte offset of a tag's value in a TIFF of OpenCV.
std::size_t value_of(const std::string& tiff, std::uint16_t tag) {
  const auto number = [&](std::size_t at, int length) {
    std::size_t value = 0;
    for (int i = length - 1; i >= 0; --i) {
      value = value << 8 | static_cast<unsigned char>(tiff.at(at + static_cast<std::size_t>(i)));
    }
    return value;
  };
  const std::size_t directory = number(4, 4);
  for (std::size_t i = 0; i < number(directory, 2); ++i) {
    const std::size_t entry = directory + 2 + 12 * i;
    if (number(entry, 2) == tag) return entry + 8;
  }
  throw std::runtime_error("there is no such tag");
}

TEST(Picture, OfAsManyPixelsInAStripIsRefusedLikewise) {
  constexpr std::uint16_t kColumns = 256, kRowsOfStrip = 278;
  for (const auto& [tag, side] :
       {std::pair{kColumns, "4000000 x 21"}, std::pair{kRowsOfStrip, "37 x 4000000"}}) {
    std::string bytes = pictures(37, 21)["tiff"];
    const std::size_t value = value_of(bytes, tag);
    put(bytes, value - 6, 4, 2, false);  // a 32-bit number
    put(bytes, value, 4'000'000, 4, false);
    EXPECT_NE(refusal(bytes).find(side), std::string::npos) << refusal(bytes);
  }
}

TEST(Picture, OfAnotherFormatIsRefusedWithThoseThatAreRead) {
  const cv::Mat3b colours = drawn(37, 21);
  for (const std::string& bytes :
       {std::string(), std::string("no picture"), std::string("GIF89a\x10\x00\x10\x00", 10),
        std::string("\xff\xd8\xff"), std::string("P5"), std::string("BM"), encoded(".ras", colours),
        encoded(".hdr", colours)}) {
    EXPECT_EQ(refusal(bytes),
              "this is no picture that can be read; give a PNG, JPEG, BMP, TIFF, WebP, PGM or PPM");
  }
}

TEST(Picture, TruncatedFileIsRefusedWithoutALibrarysText) {
  for (const auto& [kind, bytes] : pictures(37, 21)) {
    for (const double part : {0.5, 0.9}) {
      const auto length = static_cast<std::size_t>(part * static_cast<double>(bytes.size()));
      testing::internal::CaptureStderr();
      const std::string told = refusal(bytes.substr(0, length));
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << kind;
      EXPECT_TRUE(told.ends_with("; give a whole one") || told.starts_with("this is no picture"))
          << kind << " " << part << ": " << told;
    }
  }
}

TEST(Picture, DamagedFileIsRefusedWithoutALibrarysText) {
  auto all = pictures(80, 60);
  for (const char* kind : {"png", "deep png", "jpeg", "grey jpeg", "jpeg with restarts"}) {
    std::string bytes = all[kind];
    const std::size_t middle = bytes.size() / 2;
    bytes.replace(middle, 40, std::string(40, '\xff') + "");
    testing::internal::CaptureStderr();
    EXPECT_EQ(refusal(bytes), "the picture is broken; give a whole one") << kind;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << kind;
  }
}

TEST(Picture, DamageIsToldApartFromStderrOfAnotherThread) {
  std::string bytes = pictures(80, 60)["jpeg"];
  bytes.replace(bytes.size() / 2, 40, std::string(40, '\xff'));
  constexpr int kLines = 300;
  testing::internal::CaptureStderr();
  std::atomic<bool> is_done = false;
  std::thread writer([&] {
    for (int i = 0; i < kLines; ++i) {
      const std::lock_guard lock(stderr_mutex());
      std::fputs("progress\n", stderr);
    }
    is_done = true;
  });
  do {
    EXPECT_EQ(refusal(bytes), "the picture is broken; give a whole one");
  } while (!is_done);
  writer.join();
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), kLines);
}

TEST(Picture, AsJpegHasTheBytesAndThePixelsOfOpenCvs) {
  for (const int quality : {1, 72, 100}) {
    const cv::Mat3b all = drawn(80, 60), picture = all(cv::Rect(3, 5, 37, 21));
    const std::string bytes = encode_jpeg(picture, quality);
    EXPECT_EQ(bytes, encoded(".jpg", picture, {cv::IMWRITE_JPEG_QUALITY, quality}));
    EXPECT_EQ(cv::norm(decode_jpeg(bytes), decode_picture(bytes, cv::IMREAD_COLOR), cv::NORM_INF),
              0);
    for (const std::string& broken :
         {std::string(), bytes.substr(0, bytes.size() / 2),
          std::string(bytes).replace(bytes.size() - 60, 40, std::string(40, '\xff'))}) {
      testing::internal::CaptureStderr();
      EXPECT_THROW(decode_jpeg(broken), PictureError);
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    }
  }
}

TEST(Picture, BytesBehindItsEndDoNoHarmAndStderrIsGivenBack) {
  testing::internal::CaptureStderr();
  for (const auto& [kind, bytes] : pictures(37, 21)) {
    EXPECT_EQ(decode_picture(bytes + "\xff\xd9 more", cv::IMREAD_COLOR).cols, 37) << kind;
  }
  std::fputs("heard", stderr);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "heard");
}

}  // namespace
}  // namespace lcs::sim
