#include "sim/camera/photograph.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace lcs::sim {
namespace {

// Falling drops.
constexpr double kNearestDrop_m = 0.3;
constexpr double kFarthest_m = 3;
constexpr double kLeast_mm = 1;
constexpr double kMost_mm = 6;         // larger drops break up
constexpr double kDensity = 8000;      // N_0, per m^3 and mm
constexpr double kMostStreaks = 1e7;   // per frame: seconds of work
constexpr double kAperture_m = 0.002;  // of the lens
constexpr float kSkyInDrop = 0.8F;     // a drop refracts most of the sky: nearly white
constexpr float kBackscatter = 0.05F;  // share of the lamps' light that returns from a drop

// Drops on the window.
constexpr double kWindow_m = 0.08;
constexpr double kLeastRadius_m = 0.0008;
constexpr double kMostRadius_m = 0.004;
constexpr float kThroughDrop = 0.95F;  // transmission
constexpr float kWide = 0.45F;         // share of the image height within a drop's radius
constexpr int kShrink = 8;             // downscaling of the image in drops, which is blurred anyway

/// Exponent of Marshall & Palmer's drop-size distribution, 1/mm.
double decay(double rate_mmph) {
  return 4.1 * std::pow(rate_mmph, -0.21);
}

/// Fall speed by Atlas, Srivastava & Sekhon, m/s.
double fall_speed_mps(double diameter_mm) {
  return std::max(0.1, 9.65 - 10.3 * std::exp(-0.6 * diameter_mm));
}

double cube(double x) {
  return x * x * x;
}

cv::Vec3f sample(const cv::Mat3f& small, float x, float y) {
  x = std::clamp(x, 0.F, static_cast<float>(small.cols - 1));
  y = std::clamp(y, 0.F, static_cast<float>(small.rows - 1));
  const int left = std::min(static_cast<int>(x), std::max(0, small.cols - 2));
  const int top = std::min(static_cast<int>(y), std::max(0, small.rows - 2));
  const int right = std::min(left + 1, small.cols - 1);
  const int bottom = std::min(top + 1, small.rows - 1);
  const float u = x - static_cast<float>(left);
  const float v = y - static_cast<float>(top);
  return (1 - v) * ((1 - u) * small(top, left) + u * small(top, right)) +
         v * ((1 - u) * small(bottom, left) + u * small(bottom, right));
}

/// Pixels whose centres lie in [from, to], clipped to the image.
cv::Range pixels(double from, double to, int size) {
  const int first = static_cast<int>(std::clamp(std::ceil(from), 0.0, static_cast<double>(size)));
  const int last = static_cast<int>(std::clamp(std::floor(to), -1.0, size - 1.0));
  return {first, std::max(first, last + 1)};
}

}  // namespace

struct Rain::Streak {
  double distance_m;
  double x_px, top_px;  ///< column of its middle, and row of its upper end
  double width_px, length_px;
  double share;  ///< of the exposure during which it covers a pixel
};

Rain::Rain(const scenario::Image::Rain& rain, const Pinhole& camera, std::uint64_t scenario_seed)
    : rain_(rain), camera_(camera), seed_(scenario_seed) {
  if (rain_.rate_mmph <= 0) return;
  const double rays = camera_.width_px * camera_.height_px / std::pow(camera_.focal_px, 2);
  const double volume_m3 = rays * (cube(kFarthest_m) - cube(kNearestDrop_m)) / 3;
  const double lambda = decay(rain_.rate_mmph);
  expected_ = volume_m3 * kDensity / lambda * std::exp(-lambda * kLeast_mm);
  if (!(expected_ <= kMostStreaks)) {
    throw std::invalid_argument(
        "the camera is so wide that more than ten million drops of image.rain are in sight; make "
        "camera.fovy less, or rain.rate");
  }
}

Rain::Streak Rain::draw_streak(RandomStream& random, double exposure_s) const {
  const double near3 = cube(kNearestDrop_m);
  const double z = std::cbrt(near3 + random.uniform() * (cube(kFarthest_m) - near3));
  const double diameter_mm =
      std::min(kMost_mm, kLeast_mm - std::log1p(-random.uniform()) / decay(rain_.rate_mmph));
  const double fall_m = fall_speed_mps(diameter_mm) * exposure_s;
  const double diameter_m = diameter_mm / 1000;
  const double px_per_m = camera_.focal_px / z;
  Streak streak{};
  streak.distance_m = z;
  streak.length_px = (fall_m + diameter_m) * px_per_m;
  streak.x_px = random.uniform() * camera_.width_px;
  streak.top_px = random.uniform() * (camera_.height_px + streak.length_px) - streak.length_px;
  // a drop that is narrower than blur and pixel covers a share of them
  const double sharp_px = diameter_m * px_per_m;
  streak.width_px = std::max(1.0, std::hypot(sharp_px, kAperture_m * px_per_m));
  streak.share = std::min(1.0, diameter_m / (fall_m + diameter_m)) * sharp_px / streak.width_px;
  return streak;
}

void Rain::add_streaks(cv::Mat3f& picture, const cv::Mat1f& depth_m, const Illumination& light,
                       double exposure_s, int k) const {
  if (rain_.rate_mmph <= 0) return;
  RandomStream random(seed_, "rain.streaks." + std::to_string(k));
  const int count = static_cast<int>(expected_ + random.uniform());
  for (int i = 0; i < count; ++i) {
    const Streak s = draw_streak(random, exposure_s);
    const auto z = static_cast<float>(s.distance_m);
    const cv::Range columns =
        pixels(s.x_px - s.width_px / 2 - 0.5, s.x_px + s.width_px / 2 + 0.5, picture.cols);
    const cv::Range rows = pixels(s.top_px, s.top_px + s.length_px, picture.rows);
    for (int x = columns.start; x < columns.end; ++x) {
      // share of the pixel that the streak covers
      const double edge = s.width_px / 2 + 0.5 - std::abs(x - s.x_px);
      const auto alpha = static_cast<float>(s.share * std::clamp(edge, 0.0, 1.0));
      for (int y = rows.start; y < rows.end; ++y) {
        if (depth_m(y, x) <= z) continue;
        const float own = kSkyInDrop * light.ambient() + kBackscatter * light.lamps(x, y, z);
        picture(y, x) = (1 - alpha) * picture(y, x) + alpha * cv::Vec3f(own, own, own);
      }
    }
  }
}

Rain::Place Rain::dry_place(int number) const {
  const std::string name = "rain.drop." + std::to_string(number);
  Place place{name, RandomStream(seed_, name), 0, 0};
  // the first drop has already been in place for a while
  place.until_s = rain_.drop_life_s * place.lives.uniform();
  return place;
}

std::vector<LensDrop> Rain::lens_drops(double t_s) {
  if (places_.empty() || t_s < places_s_) {
    places_.clear();
    for (int i = 0; i < rain_.lens_drops; ++i) places_.push_back(dry_place(i));
  }
  places_s_ = t_s;
  std::vector<LensDrop> drops;
  const double px_per_m = camera_.focal_px / kWindow_m;
  for (Place& place : places_) {
    for (; place.until_s <= t_s; ++place.generation) {
      place.until_s += rain_.drop_life_s * (0.5 + place.lives.uniform());
    }
    RandomStream random(seed_, place.name + "." + std::to_string(place.generation));
    LensDrop drop;
    drop.centre_px = {static_cast<float>(random.uniform() * camera_.width_px),
                      static_cast<float>(random.uniform() * camera_.height_px)};
    const double large = random.uniform();  // cubed below: large drops are rare
    drop.radius_px = static_cast<float>(
        px_per_m * (kLeastRadius_m + (kMostRadius_m - kLeastRadius_m) * cube(large)));
    drops.push_back(drop);
  }
  return drops;
}

void Rain::look_through_drops(cv::Mat3f& picture, double t_s) {
  if (rain_.lens_drops == 0) return;
  cv::Mat3f small;
  cv::resize(picture, small,
             {std::max(1, picture.cols / kShrink), std::max(1, picture.rows / kShrink)}, 0, 0,
             cv::INTER_AREA);
  cv::GaussianBlur(small, small, {}, 1);
  const float to_small_x = static_cast<float>(small.cols) / static_cast<float>(picture.cols);
  const float to_small_y = static_cast<float>(small.rows) / static_cast<float>(picture.rows);
  // radius of the blur circle of a point on the window
  const auto soft = static_cast<float>(kAperture_m / 2 * camera_.focal_px / kWindow_m);
  const float wide = kWide * static_cast<float>(picture.rows);
  for (const LensDrop& drop : lens_drops(t_s)) {
    const float reach = drop.radius_px + soft;
    const cv::Range columns =
        pixels(drop.centre_px.x - reach, drop.centre_px.x + reach, picture.cols);
    const cv::Range rows = pixels(drop.centre_px.y - reach, drop.centre_px.y + reach, picture.rows);
    for (int y = rows.start; y < rows.end; ++y) {
      for (int x = columns.start; x < columns.end; ++x) {
        const cv::Point2f off =
            cv::Point2f(static_cast<float>(x), static_cast<float>(y)) - drop.centre_px;
        const float distance = std::hypot(off.x, off.y);
        const float t = std::clamp((reach - distance) / (2 * soft), 0.F, 1.F);
        const float inside = t * t * (3 - 2 * t);
        if (inside <= 0) continue;
        const cv::Point2f seen = drop.centre_px - off * (wide / reach);
        picture(y, x) =
            (1 - inside) * picture(y, x) +
            inside * kThroughDrop * sample(small, seen.x * to_small_x, seen.y * to_small_y);
      }
    }
  }
}

}  // namespace lcs::sim
