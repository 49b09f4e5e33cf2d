// Camera effects on a picture: each is compared with its physical law.

#include "sim/camera/photograph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "sim/camera/linear_light.h"
#include "sim/simulation.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using scenario::Image;

constexpr float kSky = std::numeric_limits<float>::infinity();

Pinhole camera() {
  return Pinhole::from_fovy(320, 240, 60 * test::kDegree);
}

cv::Mat3b grey(int code) {
  const auto c = static_cast<std::uint8_t>(code);
  return cv::Mat3b(240, 320, cv::Vec3b(c, c, c));
}

cv::Mat1f wall_at(float depth_m) {
  return cv::Mat1f(240, 320, depth_m);  // braces would list three values
}

Image noiseless() {
  Image image;
  image.noise.reset();
  return image;
}

/// By a lens without a point spread of its own, so that a code stays what it is.
cv::Mat3b photograph(Image image, const cv::Mat3b& picture, const cv::Mat1f& depth_m, int k = 0,
                     std::uint64_t seed = 1) {
  cv::Mat3b out;
  image.point_spread_px = 0;
  Photographer(image, camera(), 10, seed).develop(to_linear(picture), depth_m, k, out);
  return out;
}

/// Every code, in a fixed order.
cv::Mat3b all_codes() {
  cv::Mat3b picture(240, 320);
  int n = 0;
  for (cv::Vec3b& pixel : picture) {
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(n++ * 7);
  }
  return picture;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

double linear_at(const cv::Mat3b& picture, int x, int y) {
  return to_linear(picture)(y, x)[0];
}

/// Mean and variance over the picture, in linear light.
cv::Vec2d moments(const cv::Mat3b& picture) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(to_linear(picture), mean, deviation);
  return {mean[0], deviation[0] * deviation[0]};
}

Image noisy(double full_well_e, double read_e) {
  Image image;
  image.noise = Image::Noise{.full_well_e = full_well_e, .read_e = read_e};
  return image;
}

TEST(LinearLight, TakesEveryCodeBackToItself) {
  cv::Mat3b back;
  to_codes(to_linear(all_codes()), back);
  EXPECT_TRUE(same(back, all_codes()));
}

TEST(LinearLight, MiddleGreyIsAFifthOfWhite) {
  EXPECT_NEAR(linear_at(grey(118), 0, 0), 0.18, 0.003);  // sRGB
  EXPECT_EQ(linear_at(grey(255), 0, 0), 1);
}

TEST(Photograph, WithoutNoiseNoBitIsChanged) {
  EXPECT_TRUE(same(photograph(noiseless(), all_codes(), wall_at(3)), all_codes()));
}

TEST(Photograph, CompressionIsThatOfAJpegFileAndBlocksShowAtLowQuality) {
  cv::Mat3b ramp(240, 320);
  for (int y = 0; y < ramp.rows; ++y) {
    for (int x = 0; x < ramp.cols; ++x) ramp(y, x) = cv::Vec3b::all(static_cast<uchar>(x / 2 + 40));
  }
  const auto error = [&](int quality) {
    Image image = noiseless();
    image.jpeg_quality = quality;
    return cv::norm(photograph(image, ramp, wall_at(3)), ramp, cv::NORM_L1) / (3 * 240 * 320);
  };
  EXPECT_LT(error(95), 0.5);
  EXPECT_GT(error(3), 2);
}

TEST(Photograph, ExposureAndGainAndLightScaleAlike) {
  Image image = noiseless();
  image.light_lx = 1000;
  image.exposure_s = 2e-3;
  image.gain = 5;
  EXPECT_TRUE(same(photograph(image, all_codes(), wall_at(3)), all_codes()));
  image.gain = 2.5;
  const cv::Mat3b dark = photograph(image, grey(200), wall_at(3));
  EXPECT_NEAR(linear_at(dark, 5, 5), linear_at(grey(200), 5, 5) / 2, 0.004);
}

TEST(Photograph, LightAboveAFullPixelIsLostWhateverTheGain) {
  Image image = noiseless();
  image.exposure_s = 8e-3;
  image.gain = 0.25;
  const cv::Mat3b burnt = photograph(image, grey(255), wall_at(3));
  EXPECT_NEAR(linear_at(burnt, 5, 5), 0.25, 0.004);
  EXPECT_TRUE(same(burnt, photograph(image, grey(230), wall_at(3))));
}

TEST(Photograph, HeadlightsFallWithTheSquareOfTheDistance) {
  Image image = noiseless();
  image.light_lx = 0;
  image.headlights = Image::Headlights{.intensity_cd = 40000};
  const double near = linear_at(photograph(image, grey(200), wall_at(3)), 160, 120);
  const double far = linear_at(photograph(image, grey(200), wall_at(6)), 160, 120);
  EXPECT_NEAR(near / far, 4, 0.1);
  EXPECT_NEAR(near / linear_at(grey(200), 0, 0), 40000 / 9.0 / 10000, 0.01);
}

TEST(Photograph, HeadlightsFadeAwayFromTheirAxisAndDoNotReachTheSky) {
  Image image = noiseless();
  image.light_lx = 0;
  image.headlights = Image::Headlights{.intensity_cd = 40000, .beam_rad = 20 * test::kDegree};
  const cv::Mat3b wall = photograph(image, grey(200), wall_at(3));
  // 20 degrees to the right: f tan(20 deg) = 75.7 px; e^-1/2, and cos^3 for distance and slant
  const double cosine = std::cos(20 * test::kDegree);
  EXPECT_NEAR(linear_at(wall, 235, 120) / linear_at(wall, 160, 120),
              std::exp(-0.5) * cosine * cosine * cosine, 0.02);
  EXPECT_EQ(cv::norm(photograph(image, grey(200), wall_at(kSky)), cv::NORM_INF), 0);
}

TEST(Photograph, HeadlightsLightAFloorByTheCosineOfItsSlant) {
  // A floor 0.45 m below the camera: at depth z it is lit by cos(alpha) = 0.45 / distance.
  const Pinhole c = camera();
  cv::Mat1f depth_m = wall_at(kSky);
  for (int y = 121; y < depth_m.rows; ++y) {
    depth_m.row(y) = static_cast<float>(0.45 * c.focal_px / (y - c.centre_px.y()));
  }
  Image image = noiseless();
  image.light_lx = 0;
  image.headlights = Image::Headlights{.intensity_cd = 20000, .beam_rad = 80 * test::kDegree};
  const cv::Mat3b floor = photograph(image, grey(200), depth_m);
  for (const int y : {150, 180, 210}) {
    const Eigen::Vector3d point = c.back_project({160, y}, depth_m(y, 160));
    const double angle = std::atan2(point.head<2>().norm(), point.z()) / (80 * test::kDegree);
    const double expected = 2 * std::exp(-angle * angle / 2) * (0.45 / point.norm()) /
                            point.squaredNorm() * linear_at(grey(200), 0, 0);
    EXPECT_NEAR(linear_at(floor, 160, y) / expected, 1, 0.03) << y;
  }
}

TEST(Photograph, ContrastFallsToTwoPercentAtTheVisibility) {
  Image image = noiseless();
  image.visibility_m = 50;
  const auto contrast = [&](float depth_m) {
    return linear_at(photograph(image, grey(220), wall_at(depth_m)), 160, 120) -
           linear_at(photograph(image, grey(60), wall_at(depth_m)), 160, 120);
  };
  const double clear = linear_at(grey(220), 0, 0) - linear_at(grey(60), 0, 0);
  EXPECT_NEAR(contrast(50) / clear, 0.02, 0.01);
  EXPECT_NEAR(contrast(25) / clear, std::sqrt(0.02), 0.02);
}

TEST(Photograph, NoiseIsTheSeedsAndTheFramesOwn) {
  const Image image = noisy(2000, 5);
  const auto of = [&](int k, std::uint64_t seed) {
    return photograph(image, grey(120), wall_at(3), k, seed);
  };
  EXPECT_TRUE(same(of(4, 1), of(4, 1)));
  EXPECT_FALSE(same(of(4, 1), of(4, 2)));
  EXPECT_FALSE(same(of(4, 1), of(5, 1)));
}

TEST(Photograph, TheVarianceOfShotNoiseIsTheNumberOfElectrons) {
  // n electrons of 1000 have variance n: in linear light L, L / 1000. 76,800 pixels give it to
  // 0.5 %; codes are 0.002 to 0.008 wide here, which adds less than 1 %.
  for (const int code : {100, 140, 180}) {
    const cv::Vec2d noise = moments(photograph(noisy(1000, 0), grey(code), wall_at(3)));
    const double light = linear_at(grey(code), 0, 0);
    EXPECT_NEAR(noise[0] / light, 1, 0.01) << code;
    EXPECT_NEAR(noise[1] / (light / 1000), 1, 0.03) << code;
  }
}

TEST(Photograph, ReadNoiseIsThereInTheDarkAndGainMagnifiesIt) {
  // 40 e- of 4000 are 0.01. Values below 0 are clipped, which leaves half of a normal distribution:
  // variance (1/2 - 1/(2 pi)) sigma^2.
  Image image = noisy(4000, 40);
  image.gain = 4;
  const double half = 0.5 - 0.5 / std::numbers::pi;
  EXPECT_NEAR(moments(photograph(image, grey(0), wall_at(3)))[1] / (half * 0.04 * 0.04), 1, 0.05);
}

Image rainy(double rate_mmph, int drops) {
  Image image = noiseless();
  image.rain = Image::Rain{.rate_mmph = rate_mmph, .lens_drops = drops, .drop_life_s = 4};
  return image;
}

/// Left dark, right light: drops are visible in both halves.
cv::Mat3b halves() {
  cv::Mat3b picture = grey(60);
  picture.colRange(160, 320) = cv::Vec3b(200, 200, 200);
  return picture;
}

cv::Mat1b changed(const cv::Mat3b& a, const cv::Mat3b& b) {
  cv::Mat1b mask(a.size());
  for (int y = 0; y < a.rows; ++y) {
    for (int x = 0; x < a.cols; ++x) mask(y, x) = a(y, x) != b(y, x);
  }
  return mask;
}

TEST(Photograph, DropsOnTheLensStayWhereTheyAreFromFrameToFrame) {
  Rain rain(*rainy(0, 20).rain, camera(), 1);
  const std::vector<LensDrop> first = rain.lens_drops(0);
  ASSERT_EQ(first.size(), 20u);
  // lives last 4 s on average and at least 2 s: in 0.1 s one or two end, in 20 s all
  const auto staying = [&](double t_s) {
    const std::vector<LensDrop> later = rain.lens_drops(t_s);
    int count = 0;
    for (std::size_t i = 0; i < first.size(); ++i)
      count += later[i].centre_px == first[i].centre_px;
    return count;
  };
  EXPECT_EQ(staying(0), 20);
  EXPECT_GE(staying(0.1), 17);
  EXPECT_LT(staying(2), 20);
  EXPECT_EQ(staying(20), 0);
}

TEST(Photograph, MoreDropsThanCanBeDrawnAreRefused) {
  for (const double fovy_deg : {179.0, 179.9}) {
    auto s = test::scenario_in("lab", 0, 1);
    s.image = rainy(200, 0);
    s.camera.fovy_rad = fovy_deg * test::kDegree;
    const std::string message = test::scenario_error([&] { Simulation simulation(s); });
    EXPECT_NE(message.find("ten million drops"), std::string::npos) << message;
  }
}

TEST(Photograph, DropsAreAFunctionOfTimeWhateverWasAskedBefore) {
  Rain rain(*rainy(0, 20).rain, camera(), 1);
  for (const double t_s : {0.0, 3.0, 3.0, 25.0, 1.0, 30.0}) {
    const std::vector<LensDrop> drops = rain.lens_drops(t_s);
    const std::vector<LensDrop> anew = Rain(*rainy(0, 20).rain, camera(), 1).lens_drops(t_s);
    for (std::size_t i = 0; i < drops.size(); ++i) {
      EXPECT_EQ(drops[i].centre_px, anew[i].centre_px) << t_s;
      EXPECT_EQ(drops[i].radius_px, anew[i].radius_px) << t_s;
    }
  }
}

TEST(Photograph, DropsChangeThePictureWhereTheyLieAndNowhereElse) {
  const Image image = rainy(0, 10);
  const cv::Mat1b mask = changed(photograph(image, halves(), wall_at(3)), halves());
  const std::vector<LensDrop> drops = Rain(*image.rain, camera(), 1).lens_drops(0);
  const double soft_px = 0.001 * camera().focal_px / 0.08;
  EXPECT_GT(cv::countNonZero(mask), 200);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (!mask(y, x)) continue;
      const bool on_a_drop = std::any_of(drops.begin(), drops.end(), [&](const LensDrop& drop) {
        const cv::Point2f off = cv::Point2f(cv::Point(x, y)) - drop.centre_px;
        return std::hypot(off.x, off.y) <= drop.radius_px + soft_px;
      });
      ASSERT_TRUE(on_a_drop) << x << " " << y;
    }
  }
}

TEST(Photograph, ADropShowsTheSceneUpsideDown) {
  cv::Mat3b picture = grey(20);
  picture.rowRange(0, 120) = cv::Vec3b(220, 220, 220);
  const Image image = rainy(0, 30);
  int seen = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const cv::Mat3b wet = photograph(image, picture, wall_at(3), 0, seed);
    for (const LensDrop& drop : Rain(*image.rain, camera(), seed).lens_drops(0)) {
      const cv::Point centre(drop.centre_px);
      const int off = static_cast<int>(drop.radius_px / 2);
      // near the horizon, so that the drop refracts both sides of it
      if (off < 3 || std::abs(centre.y - 120) > 15 || std::abs(centre.x - 160) > 150) continue;
      ++seen;
      EXPECT_GT(wet(centre.y + off, centre.x)[0], wet(centre.y - off, centre.x)[0]);
    }
  }
  EXPECT_GE(seen, 3);
}

TEST(Photograph, StreaksAreNewInEachFrameAndMoreInHeavierRain) {
  const auto wet = [&](double rate, int k) {
    return changed(photograph(rainy(rate, 0), grey(60), wall_at(50), k), grey(60));
  };
  EXPECT_TRUE(same(wet(20, 3), wet(20, 3)));
  EXPECT_FALSE(same(wet(20, 3), wet(20, 4)));
  EXPECT_GT(cv::countNonZero(wet(20, 3)), 2 * cv::countNonZero(wet(1, 3)));
  EXPECT_EQ(cv::countNonZero(wet(0, 3)), 0);
}

TEST(Photograph, NoDropFallsBehindAWall) {
  EXPECT_TRUE(same(photograph(rainy(50, 0), grey(60), wall_at(0.25F)), grey(60)));
}

TEST(Photograph, BlurTakesContrastFromAnEdgeAndLeavesEvenLight) {
  Image image = noiseless();
  image.blur_px = 3;
  EXPECT_TRUE(same(photograph(image, grey(90), wall_at(3)), grey(90)));
  const cv::Mat3b edge = photograph(image, halves(), wall_at(3));
  EXPECT_EQ(edge(120, 130), halves()(120, 130));
  EXPECT_LT(edge(120, 162)[0], 200);
  EXPECT_GT(edge(120, 157)[0], 60);
}

TEST(Photograph, LeavesTruthAndReadingsOfARunAlone) {
  auto s = test::scenario_in("lab", 0.5, 3);
  s.imu.noise = {1.7e-4, 1.9e-5, 2.0e-3, 3.0e-3};
  auto wet = s;
  wet.image = noisy(1000, 5);
  wet.image.rain = Image::Rain{.rate_mmph = 10, .lens_drops = 10};
  Simulation dry_run(s), wet_run(wet);
  while (const auto dry = dry_run.next()) {
    const auto other = wet_run.next();
    ASSERT_TRUE(other);
    EXPECT_FALSE(same(dry->image, other->image));
    EXPECT_TRUE(same(dry->truth.object, other->truth.object));
    EXPECT_EQ(cv::countNonZero(dry->truth.depth_m != other->truth.depth_m), 0);
    ASSERT_EQ(dry->imu.size(), other->imu.size());
    EXPECT_EQ(dry->imu.back().gyro_radps, other->imu.back().gyro_radps);
  }
}

TEST(Photograph, ARunHasTheNoiseOfARealSensorUnlessToldOtherwise) {
  auto s = test::scenario_in("lab", 0.5, 1);
  Simulation noiseless_run(s);
  s.image = {};
  s.image.samples = 1;
  Simulation run(s);
  cv::Mat1f difference;
  cv::Mat1b grey, expected;
  cv::cvtColor(run.next()->image, grey, cv::COLOR_BGR2GRAY);
  cv::cvtColor(noiseless_run.next()->image, expected, cv::COLOR_BGR2GRAY);
  cv::subtract(grey, expected, difference, cv::noArray(), CV_32F);
  cv::Scalar mean, deviation;
  cv::meanStdDev(difference, mean, deviation);
  EXPECT_NEAR(mean[0], 0, 0.2);  // clipped at black and white, and mapped by a curve
  EXPECT_GT(deviation[0], 0.7);  // grey levels; machine vision and street recordings have 0.5 to 2
  EXPECT_LT(deviation[0], 1.2);
}

}  // namespace
}  // namespace lcs::sim
