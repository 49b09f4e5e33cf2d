#include "tools/recording/warnings.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <span>
#include <utility>

#include "tools/files/json_node.h"
#include "tools/files/output_file.h"

namespace lcs::recording {
namespace {

using Pixel = cv::Point;

constexpr std::size_t kFewestCorners = 20;  // fewest corners for judging an image
constexpr int kSame_px = 1;  // largest offset in x and y between the same corner in two frames

Pixel pixel_of(const Eigen::Vector2f& corner) {
  return {static_cast<int>(std::lround(corner.x())), static_cast<int>(std::lround(corner.y()))};
}

/// Not 0 at the pixels on which a corner is, up to `kSame_px`.
cv::Mat1b places_of(std::span<const Eigen::Vector2f> corners) {
  Pixel most;
  for (const Eigen::Vector2f& corner : corners) {
    const Pixel pixel = pixel_of(corner);
    most = {std::max(most.x, pixel.x), std::max(most.y, pixel.y)};
  }
  cv::Mat1b places(most.y + 1, most.x + 1, std::uint8_t{0});
  const cv::Rect all({}, places.size());
  const cv::Size around(2 * kSame_px + 1, 2 * kSame_px + 1);
  for (const Eigen::Vector2f& corner : corners) {
    places(cv::Rect(pixel_of(corner) - Pixel(kSame_px, kSame_px), around) & all) = 1;
  }
  return places;
}

/// Share of `pixels` that lie on corners after a shift by `by`; those shifted out of the image are
/// left out. 0 if half of them or more are.
double share(std::span<const Pixel> pixels, const Pixel& by, const cv::Mat1b& places) {
  const cv::Rect all({}, places.size());
  std::size_t inside = 0, met = 0;
  for (const Pixel& pixel : pixels) {
    if (!all.contains(pixel + by)) continue;
    ++inside;
    met += places(pixel + by);
  }
  if (2 * inside <= pixels.size()) return 0;
  return static_cast<double>(met) / static_cast<double>(inside);
}

/// A sample of corners, spread evenly over the list and so over the image.
std::vector<Pixel> some(std::span<const Eigen::Vector2f> corners) {
  constexpr std::size_t kMost = 100;
  const std::size_t step = std::max<std::size_t>(1, corners.size() / kMost);
  std::vector<Pixel> chosen;
  for (std::size_t i = 0; i < corners.size(); i += step) chosen.push_back(pixel_of(corners[i]));
  return chosen;
}

/// Whether nearly all corners kept their place. False where corners are too dense to decide.
bool stands(std::span<const Eigen::Vector2f> before, std::span<const Eigen::Vector2f> now) {
  constexpr double kNearlyAll = 0.6, kTimesChance = 2;
  if (std::min(before.size(), now.size()) < kFewestCorners) return false;
  const cv::Mat1b places = places_of(now);
  const std::vector<Pixel> corners = some(before);
  const double chance = 0.5 * (share(corners, {11, 7}, places) + share(corners, {-9, -13}, places));
  const double still = share(corners, {}, places);
  return still >= kNearlyAll && still >= kTimesChance * chance;
}

/// Whether most corners have moved by one vector of at least 3 px.
bool shifted(std::span<const Eigen::Vector2f> before, std::span<const Eigen::Vector2f> now) {
  constexpr int kReach_px = 48, kLeast_px = 3;
  constexpr double kMost = 0.5, kTimesOther = 1.6;
  if (std::min(before.size(), now.size()) < kFewestCorners) return false;
  const cv::Mat1b places = places_of(now);
  const std::vector<Pixel> corners = some(before);
  double best = 0, sum = 0;
  int vectors = 0;
  constexpr int kStep_px = 2 * kSame_px + 1;
  for (int y = -kReach_px; y <= kReach_px; y += kStep_px) {
    for (int x = -kReach_px; x <= kReach_px; x += kStep_px) {
      const double moved = share(corners, {x, y}, places);
      sum += moved;
      ++vectors;
      if (std::hypot(x, y) >= kLeast_px) best = std::max(best, moved);
    }
  }
  const double still = share(corners, {}, places);
  return best >= kMost && best >= kTimesOther * std::max(still, sum / vectors);
}

/// No turn is estimated and hardly any sideways motion, which looks like a turn in a distant scene.
bool goes_straight(const EgoMotion& told) {
  constexpr double kNoTurn_rad = 5e-4;
  const double side = told.v_C_mps.head<2>().norm();
  return told.dt_s > 0 && Eigen::AngleAxisd(told.R_cur_prev).angle() < kNoTurn_rad &&
         side <= 0.2 * std::abs(told.v_C_mps.z());
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

}  // namespace

void WarningWatch::add(const FrameRecord& frame) {
  if (frames_++ == 0) start_ns_ = frame.t_ns;
  const double t_s = 1e-9 * static_cast<double>(frame.t_ns - start_ns_);
  if (frame.corners_px.size() < kFewCorners) few_.add(t_s);
  if (!is_recorded_) return;
  watch_motion(frame, t_s);
  watch_rebels(frame, t_s);
}

void WarningWatch::watch_motion(const FrameRecord& frame, double t_s) {
  constexpr double kStep_m = 1;
  const double speed_mps = frame.motion.v_C_mps.norm();
  if (speed_mps > kRunawaySpeed_mps) {
    if (runaway_.count == 0) runaway_mps_ = speed_mps;
    runaway_.add(t_s);
  }
  if (frames_ == 1) {
    stretch_px_ = frame.corners_px;
  } else {
    if (goes_straight(frame.motion) && shifted(previous_px_, frame.corners_px)) turns_.add(t_s);
    gone_m_ += speed_mps * std::max(0.0, frame.motion.dt_s);
    if (!(gone_m_ < kStep_m)) {
      ++stretches_;
      if (stands(stretch_px_, frame.corners_px)) stands_.add(t_s);
      stretch_px_ = frame.corners_px;
      gone_m_ = 0;
    }
  }
  previous_px_ = frame.corners_px;
}

void WarningWatch::watch_rebels(const FrameRecord& frame, double t_s) {
  if (frame.index < kSightings || frame.verdicts.size() < kFewestCorners) return;
  ++judged_;
  const auto rebels = std::ranges::count(frame.verdicts, Verdict::rebel);
  if (static_cast<double>(rebels) < kManyRebels * static_cast<double>(frame.verdicts.size())) {
    return;
  }
  rebels_.add(t_s);
  const auto [rebel, all] = rebel_parts(frame);
  rebel_parts_ += rebel;
  parts_ += all;
}

std::vector<Warned> WarningWatch::of_frames() const {
  constexpr std::int64_t kFewestTurns = 5, kFewestStretches = 3;
  constexpr double kNearlyAlways = 0.9, kWhole = 0.7;
  const auto warned = [&](const char* word, const Sign& sign, bool is_met, std::string text) {
    const bool is_checked = frames_ > 0 && (is_recorded_ || &sign == &few_);
    if (!is_checked) return Warned{word, std::nullopt, ""};
    return is_met ? Warned{word, sign.count, std::move(text)} : Warned{word, 0, ""};
  };
  const bool is_always =
      static_cast<double>(stands_.count) >= kNearlyAlways * static_cast<double>(stretches_);
  const double share = parts_ > 0 ? static_cast<double>(rebel_parts_) / parts_ : 0;
  return {
      warned("few_corners", few_, 2 * few_.count > frames_,
             fmt::format("fewer than {} corners are in {} of {} frames, first at {:.2f} s: see "
                         "what the camera sees (video.mp4), or lower corners.threshold",
                         kFewCorners, few_.count, frames_, few_.first_s)),
      warned("runaway_speed", runaway_, runaway_.count > 0,
             fmt::format("the camera is told to move at {:.0f} m/s at {:.2f} s: give the IMU's "
                         "biases by a time at rest, a start with its speed, or readings in m/s",
                         runaway_mps_, runaway_.first_s)),
      warned("turn_not_told", turns_, turns_.count >= kFewestTurns,
             fmt::format("the whole picture turns in {} of {} frames, first at {:.2f} s, and no "
                         "turn is told: give the camera's poses or its IMU",
                         turns_.count, frames_, turns_.first_s)),
      warned("still_camera", stands_, stands_.count >= kFewestStretches && is_always,
             fmt::format("the camera is told to move, and its pictures stand still, first at "
                         "{:.2f} s: give the speed of this recording, 0 for a camera that stands",
                         stands_.first_s)),
      warned("many_rebels", rebels_, 2 * rebels_.count > judged_,
             fmt::format("{:.0f} % and more of the corners are rebels in {} of {} frames, first at "
                         "{:.2f} s, and most corners in {:.0f} % of the picture's parts: {}",
                         100 * kManyRebels, rebels_.count, judged_, rebels_.first_s, 100 * share,
                         share > kWhole
                             ? "the motion or the focal length that is told is not the camera's"
                             : "bodies that move may fill the view; else the motion or the focal "
                               "length that is told is not the camera's")),
  };
}

std::vector<Warned> WarningWatch::warned(const std::optional<sim::Warnings>& world) const {
  std::vector<Warned> all;
  for (std::size_t i = 0; i < sim::kWarnings.size(); ++i) {
    all.push_back({sim::kWarnings[i].word, std::nullopt, ""});
    if (!world) continue;
    const sim::Warnings::Met& met = world->of(static_cast<sim::Warning>(i));
    all.back() = {sim::kWarnings[i].word, met.count, met.first};
  }
  std::ranges::move(of_frames(), std::back_inserter(all));
  return all;
}

std::vector<std::string> lines_of(const std::vector<Warned>& warnings) {
  std::vector<std::string> lines;
  for (const Warned& warned : warnings) {
    if (warned.count.value_or(0) == 0) continue;
    lines.push_back(fmt::format("{} (warnings.{}: {})", warned.text, warned.word, *warned.count));
  }
  return lines;
}

void write_warnings(const std::filesystem::path& path, const std::vector<Warned>& warnings) {
  files::Json json;
  for (const Warned& warned : warnings) {
    if (warned.count) json[warned.word] = {{"count", *warned.count}, {"first", warned.text}};
  }
  // A body's name may hold any bytes; JSON holds UTF-8 only.
  files::write_file(path, files::json_text(json, 1) + '\n');
}

std::vector<Warned> read_warnings(const std::filesystem::path& path) {
  constexpr input::FileKind kWarningsDocument{input::kMebibyte,
                                              "name the folder of a whole run, or run it again"};
  return files::read_json(path, kWarningsDocument, [](const files::JsonNode& node) {
    std::vector<Warned> all;
    node.each_entry([&](const std::string& word, const files::JsonNode& warned) {
      const auto count = warned["count"].natural<std::int64_t>();
      const std::string first = warned["first"].text();
      warned["first"].require(count == 0 || !first.empty(), "what is told of the first time");
      all.push_back({word, count, first});
    });
    return all;
  });
}

std::optional<sim::Warnings> world_warnings(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kWarningsFile;
  if (!std::filesystem::exists(path)) return std::nullopt;
  sim::Warnings warnings;
  for (const Warned& warned : read_warnings(path)) {
    for (std::size_t i = 0; i < sim::kWarnings.size(); ++i) {
      if (warned.word == sim::kWarnings[i].word) {
        warnings.of(static_cast<sim::Warning>(i)) = {*warned.count, warned.text, {}};
      }
    }
  }
  return warnings;
}

}  // namespace lcs::recording
