#include "tools/recording/motion_warnings.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lcs::bench {
namespace {

using Pixel = Eigen::Vector2i;

constexpr std::size_t kFewestCorners = 20;  // fewest corners for judging an image
constexpr int kSame_px = 1;  // largest offset in x and y between the same corner in two frames

Pixel pixel_of(const Eigen::Vector2f& corner) {
  return {static_cast<int>(std::lround(corner.x())), static_cast<int>(std::lround(corner.y()))};
}

/// A pixel map of an image's corners.
class Places {
 public:
  explicit Places(std::span<const Eigen::Vector2f> corners) {
    for (const Eigen::Vector2f& corner : corners) size_ = size_.cwiseMax(pixel_of(corner));
    size_ += Pixel::Ones();
    has_corner_.assign(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()),
                       0);
    for (const Eigen::Vector2f& corner : corners) {
      for (int dy = -kSame_px; dy <= kSame_px; ++dy) {
        for (int dx = -kSame_px; dx <= kSame_px; ++dx) {
          const Pixel near = pixel_of(corner) + Pixel(dx, dy);
          if (holds(near)) has_corner_[index(near)] = 1;
        }
      }
    }
  }

  /// Share of `pixels` that lie on corners after a shift by `by`; those shifted out of the image
  /// are left out. 0 if half of them or more are.
  double share(std::span<const Pixel> pixels, const Pixel& by) const {
    std::size_t inside = 0, met = 0;
    for (const Pixel& pixel : pixels) {
      const Pixel moved = pixel + by;
      if (!holds(moved)) continue;
      ++inside;
      met += has_corner_[index(moved)];
    }
    if (2 * inside <= pixels.size()) return 0;
    return static_cast<double>(met) / static_cast<double>(inside);
  }

 private:
  bool holds(const Pixel& pixel) const {
    return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < size_.x() && pixel.y() < size_.y();
  }
  std::size_t index(const Pixel& pixel) const {
    return static_cast<std::size_t>(pixel.y()) * static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(pixel.x());
  }
  Pixel size_ = Pixel::Zero();
  std::vector<std::uint8_t> has_corner_;
};

/// A sample of corners, spread evenly over the list and so over the image.
std::vector<Pixel> some(std::span<const Eigen::Vector2f> corners) {
  constexpr std::size_t kMost = 100;
  const std::size_t step = std::max<std::size_t>(1, corners.size() / kMost);
  std::vector<Pixel> chosen;
  for (std::size_t i = 0; i < corners.size(); i += step) chosen.push_back(pixel_of(corners[i]));
  return chosen;
}

/// Whether nearly all corners kept their place. False where corners are too dense to decide.
bool stands(const FrameRecord& before, const FrameRecord& now) {
  constexpr double kNearlyAll = 0.6, kTimesChance = 2;
  if (std::min(before.corners_px.size(), now.corners_px.size()) < kFewestCorners) return false;
  const Places places(now.corners_px);
  const std::vector<Pixel> corners = some(before.corners_px);
  const double chance = 0.5 * (places.share(corners, {11, 7}) + places.share(corners, {-9, -13}));
  const double share = places.share(corners, {0, 0});
  return share >= kNearlyAll && share >= kTimesChance * chance;
}

/// Whether most corners have moved by one vector of at least 3 px.
bool shifted(const FrameRecord& before, const FrameRecord& now) {
  constexpr int kReach_px = 48, kLeast_px = 3;
  constexpr double kMost = 0.5, kTimesOther = 1.6;
  if (std::min(before.corners_px.size(), now.corners_px.size()) < kFewestCorners) return false;
  const Places places(now.corners_px);
  const std::vector<Pixel> corners = some(before.corners_px);
  double best = 0, sum = 0;
  int vectors = 0;
  constexpr int kStep_px = 2 * kSame_px + 1;
  for (int y = -kReach_px; y <= kReach_px; y += kStep_px) {
    for (int x = -kReach_px; x <= kReach_px; x += kStep_px) {
      const double share = places.share(corners, {x, y});
      sum += share;
      ++vectors;
      if (std::hypot(x, y) >= kLeast_px) best = std::max(best, share);
    }
  }
  const double still = places.share(corners, {0, 0});
  return best >= kMost && best >= kTimesOther * std::max(still, sum / vectors);
}

/// No turn is estimated and hardly any sideways motion, which looks like a turn in a distant scene.
bool goes_straight(const EgoMotion& told) {
  constexpr double kNoTurn_rad = 5e-4;
  const double side = told.v_C_mps.head<2>().norm();
  return told.dt_s > 0 && Eigen::AngleAxisd(told.R_cur_prev).angle() < kNoTurn_rad &&
         side <= 0.2 * std::abs(told.v_C_mps.z());
}

/// Seconds since the first frame.
double time_of(const FrameRecord& frame, const Recording& recording) {
  return 1e-9 * static_cast<double>(frame.t_ns - recording.frames.front().t_ns);
}

/// Parts of the picture, of 16, in which most corners are rebels; and those with corners.
std::pair<int, int> rebel_parts(const FrameRecord& frame) {
  constexpr int kSide = 4, kFew = 3;
  std::array<std::array<int, 2>, kSide * kSide> counts{};  // corners, rebels
  Eigen::Vector2f most = Eigen::Vector2f::Ones();
  for (const Eigen::Vector2f& px : frame.corners_px) most = most.cwiseMax(px);
  for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
    const Eigen::Vector2f at = frame.corners_px[i].cwiseQuotient(most) * (kSide - 0.01F);
    auto& [corners, rebels] =
        counts[static_cast<std::size_t>(at.y()) * kSide + static_cast<std::size_t>(at.x())];
    ++corners;
    rebels += frame.verdicts[i] == Verdict::rebel;
  }
  std::pair<int, int> parts;
  for (const auto& [corners, rebels] : counts) {
    if (corners < kFew) continue;
    parts.first += 2 * rebels > corners;
    ++parts.second;
  }
  return parts;
}

MotionWarning runaway_speed(const Recording& recording) {
  MotionWarning warning{"runaway_speed", 0, ""};
  for (const FrameRecord& frame : recording.frames) {
    const double speed_mps = frame.motion.v_C_mps.norm();
    if (!(speed_mps > kRunawaySpeed_mps)) continue;
    if (++warning.count > 1) continue;
    warning.text = fmt::format(
        "the camera is told to move at {:.0f} m/s at {:.2f} s: give the IMU's biases by a time at "
        "rest, a start with its speed, or readings in m/s",
        speed_mps, time_of(frame, recording));
  }
  return warning;
}

MotionWarning turn_not_told(const Recording& recording) {
  constexpr std::int64_t kFewest = 5;
  MotionWarning warning{"turn_not_told", 0, ""};
  std::optional<double> first_s;
  for (std::size_t k = 1; k < recording.frames.size(); ++k) {
    const FrameRecord& frame = recording.frames[k];
    if (!goes_straight(frame.motion) || !shifted(recording.frames[k - 1], frame)) continue;
    ++warning.count;
    if (!first_s) first_s = time_of(frame, recording);
  }
  if (warning.count < kFewest) return {warning.word, 0, ""};
  warning.text = fmt::format(
      "the whole picture turns in {} of {} frames, first at {:.2f} s, and no turn is told: give "
      "the camera's poses or its IMU",
      warning.count, recording.frames.size(), *first_s);
  return warning;
}

MotionWarning still_camera(const Recording& recording) {
  constexpr double kStep_m = 1, kNearlyAlways = 0.9;
  constexpr std::int64_t kFewest = 3;
  MotionWarning warning{"still_camera", 0, ""};
  std::int64_t steps = 0;
  std::optional<double> first_s;
  double gone_m = 0;
  for (std::size_t k = 1, from = 0; k < recording.frames.size(); ++k) {
    const FrameRecord& frame = recording.frames[k];
    gone_m += frame.motion.v_C_mps.norm() * std::max(0.0, frame.motion.dt_s);
    if (gone_m < kStep_m) continue;
    ++steps;
    if (stands(recording.frames[from], frame)) {
      ++warning.count;
      if (!first_s) first_s = time_of(frame, recording);
    }
    from = k;
    gone_m = 0;
  }
  const bool is_always =
      static_cast<double>(warning.count) >= kNearlyAlways * static_cast<double>(steps);
  if (warning.count < kFewest || !is_always) return {warning.word, 0, ""};
  warning.text = fmt::format(
      "the camera is told to move, and its pictures stand still, first at {:.2f} s: give the speed "
      "of this recording, 0 for a camera that stands",
      *first_s);
  return warning;
}

MotionWarning many_rebels(const Recording& recording) {
  MotionWarning warning{"many_rebels", 0, ""};
  std::optional<double> first_s;
  int rebel_cells = 0, cells = 0;
  std::int64_t frames = 0;
  for (const FrameRecord& frame : recording.frames) {
    if (frame.index < kSightings || frame.verdicts.size() < kFewestCorners) continue;
    ++frames;
    const auto rebels = std::count(frame.verdicts.begin(), frame.verdicts.end(), Verdict::rebel);
    if (static_cast<double>(rebels) < kManyRebels * static_cast<double>(frame.verdicts.size())) {
      continue;
    }
    ++warning.count;
    if (!first_s) first_s = time_of(frame, recording);
    const auto [rebel, all] = rebel_parts(frame);
    rebel_cells += rebel;
    cells += all;
  }
  if (2 * warning.count <= frames) return {warning.word, 0, ""};
  constexpr double kWhole = 0.7;
  const double share = cells > 0 ? static_cast<double>(rebel_cells) / cells : 0;
  warning.text = fmt::format(
      "{:.0f} % and more of the corners are rebels in {} of {} frames, first at {:.2f} s, and most "
      "corners in {:.0f} % of the picture's parts: {}",
      100 * kManyRebels, warning.count, frames, *first_s, 100 * share,
      share > kWhole ? "the motion or the focal length that is told is not the camera's"
                     : "bodies that move may fill the view; else the motion or the focal length "
                       "that is told is not the camera's");
  return warning;
}

}  // namespace

std::array<MotionWarning, 4> motion_warnings(const Recording& recording) {
  return {runaway_speed(recording), turn_not_told(recording), still_camera(recording),
          many_rebels(recording)};
}

}  // namespace lcs::bench
