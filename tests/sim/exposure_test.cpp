// Automatic exposure and gain: against the closed form of the law, and the noise of the sensor.
#include "sim/camera/exposure_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/camera/linear_light.h"
#include "sim/camera/photograph.h"
#include "sim/observer.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using scenario::Image;

constexpr double kRate_hz = 10;

cv::Mat3b grey(int code) {
  return cv::Mat3b(240, 320, cv::Vec3b::all(static_cast<std::uint8_t>(code)));
}

double light_of(int code) {
  return to_linear(grey(code))(0, 0)[0];
}

/// Mean and variance over the picture, in linear light.
cv::Vec2d moments(const cv::Mat3b& picture) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(to_linear(picture), mean, deviation);
  return {mean[0], deviation[0] * deviation[0]};
}

Image controlled(const Image::AutoExposure& control) {
  Image image;
  image.noise.reset();
  image.auto_exposure = control;
  return image;
}

/// A camera that sees an even picture.
struct EvenView {
  explicit EvenView(const Image& image)
      : photographer(image, Pinhole::from_fovy(320, 240, 1), kRate_hz, 1) {}

  Exposure look(int code) {
    return photographer.develop(to_linear(grey(code)), cv::Mat1f(240, 320, 3.F), k++, picture);
  }

  Photographer photographer;
  cv::Mat3b picture;
  int k = 0;
};

double product(const Exposure& exposure) {
  return exposure.time_s * exposure.gain / Image::kDaylightExposure_s;
}

/// The mean of frame k is target (L p(0) / target)^(e^(-k T / tau)), from each step of the light
/// on.
TEST(AutoExposure, FollowsAStepOfTheLightByTheClosedForm) {
  const Image::AutoExposure control{
      .target = 0.2, .time_constant_s = 0.3, .exposure_s = {}, .gain = {0.1, 50}};
  EvenView view(controlled(control));
  double first = 1;  // p at the step
  for (const int code : {150, 60, 120}) {
    const double light = light_of(code);
    Exposure exposure;
    for (int i = 0; i < 30; ++i) {
      exposure = view.look(code);
      const double mean = control.target *
                          std::pow(light * first / control.target, std::exp(-i / (kRate_hz * 0.3)));
      EXPECT_NEAR(product(exposure) * light / mean, 1, 1e-5);  // floats
      EXPECT_NEAR(moments(view.picture)[0], mean, 0.004);      // codes of 8 bits
      EXPECT_EQ(exposure.time_s, Image::kDaylightExposure_s);  // the gain alone
    }
    EXPECT_NEAR(moments(view.picture)[0], control.target, 0.004);
    first = product(exposure) * std::pow(control.target / (product(exposure) * light),
                                         -std::expm1(-1 / (kRate_hz * 0.3)));
  }
}

TEST(AutoExposure, WithoutATimeConstantSettlesInTheNextFrame) {
  EvenView view(controlled({.target = 0.3, .time_constant_s = 0, .exposure_s = {}}));
  EXPECT_EQ(product(view.look(80)), 1);
  const double by_the_first = product(view.look(200));
  EXPECT_NEAR(by_the_first * light_of(80), 0.3, 1e-5);
  EXPECT_GT(by_the_first * light_of(200), 1) << "all white";
  EXPECT_NEAR(product(view.look(100)), 0.3 * by_the_first, 1e-5);
}

TEST(AutoExposure, ComesOutOfAPictureThatIsAllWhite) {
  Image image = controlled({.target = 0.2, .time_constant_s = 0.1, .exposure_s = {}});
  image.gain = 16;
  EvenView view(image);
  view.look(200);
  EXPECT_NEAR(moments(view.picture)[0], 1, 1e-6);
  // ln p falls by at least (1 - 1/e) ln(1 / target) a frame while all is clipped
  const double before = product(view.look(200));
  EXPECT_NEAR(std::log(16 / before), (1 - std::exp(-1)) * std::log(5), 1e-5);
  for (int i = 0; i < 20; ++i) view.look(200);
  EXPECT_NEAR(moments(view.picture)[0], light_of(200) > 0.2 ? std::max(0.2, light_of(200)) : 0.2,
              0.005);  // a gain below 1 is beyond the bounds
}

TEST(AutoExposure, LengthensTheExposureBeforeItRaisesTheGain) {
  const Image::AutoExposure control{.target = 0.2,
                                    .time_constant_s = 0,
                                    .exposure_s = Eigen::Vector2d(1e-4, 4e-3),
                                    .gain = {1, 8}};
  const auto settled = [&](double light_lx) {
    Image image = controlled(control);
    image.light_lx = light_lx;
    EvenView view(image);
    for (int i = 0; i < 10; ++i) view.look(120);
    return view.look(120);
  };
  const double needed = 0.2 / light_of(120);  // p in daylight
  const Exposure bright = settled(20000);
  EXPECT_NEAR(bright.time_s, needed / 2 * 1e-3, 1e-8);
  EXPECT_EQ(bright.gain, 1);
  const Exposure dim = settled(1000);
  EXPECT_EQ(dim.time_s, 4e-3);
  EXPECT_NEAR(dim.gain, needed * 10 / 4, 1e-4);
  const Exposure dark = settled(100);
  EXPECT_EQ(dark.time_s, 4e-3);
  EXPECT_EQ(dark.gain, 8);
}

/// A gain g that keeps the mean m multiplies shot noise: m / g of the full well are g m /
/// full_well, and the read noise r counts g^2 r^2.
TEST(AutoExposure, RaisesTheNoiseWithTheGain) {
  for (const double light_lx : {10000., 2000., 700.}) {
    Image image = controlled({.target = 0.2, .time_constant_s = 0.1, .exposure_s = {}});
    image.light_lx = light_lx;
    image.noise = Image::Noise{.full_well_e = 1000, .read_e = 4};
    EvenView view(image);
    for (int i = 0; i < 20; ++i) view.look(120);
    const double gain = view.look(120).gain;
    const cv::Vec2d seen = moments(view.picture);
    const double expected = gain * 0.2 / 1000 + gain * gain * 0.004 * 0.004;
    EXPECT_NEAR(gain, 0.2 / light_of(120) * 10000 / light_lx, 0.02 * gain);
    EXPECT_NEAR(seen[0], 0.2, 0.004);
    // 230,400 samples give the variance to 0.3 %; at the highest gain 1 % of them are clipped at 0
    EXPECT_NEAR(seen[1] / expected, 1, 0.05) << light_lx;
  }
}

TEST(AutoExposure, IsTheSameAfterSkippedFramesAndLeavesTheTruthAlone) {
  auto s = test::scenario_in("lab", 0.5, 4);
  s.camera.width_px = 160;
  s.camera.height_px = 120;
  s.image.noise = Image::Noise{};
  Observer plain(s, WrongStart::refused);
  s.image.light_lx = 1000;
  s.image.auto_exposure.emplace();
  Observer all(s, WrongStart::refused), skipping(s, WrongStart::refused);
  skipping.advance();
  skipping.advance();
  for (int k = 0; k < 4; ++k) {
    const Observation seen = all.observe(), even = plain.observe();
    EXPECT_EQ(cv::norm(seen.truth.depth_m, even.truth.depth_m, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(seen.truth.object, even.truth.object, cv::NORM_INF), 0);
    EXPECT_GT(k == 0 ? 2 : seen.exposure.gain, 1.5);
    if (k < 2) continue;
    const Observation again = skipping.observe();
    EXPECT_EQ(again.exposure.gain, seen.exposure.gain);
    EXPECT_EQ(cv::norm(again.image, seen.image, cv::NORM_INF), 0);
  }
}

}  // namespace
}  // namespace lcs::sim
