#include "tools/likeness/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <set>
#include <stdexcept>

#include "filter/detect/fast.h"
#include "filter/detect/picture_noise.h"
#include "sim/random.h"
#include "tools/comparators/backward_flow.h"
#include "tools/scoring/statistics.h"

namespace lcs::likeness {
namespace {

using Points = std::vector<Eigen::Vector2f>;
constexpr float kMoves_px = 0.5;     // what moves less has no direction
constexpr std::size_t kFewest = 5;   // corners that a figure is taken of
constexpr float kFastMargin_px = 3;  // nearer to a side there are no corners

/// The distance to the nearest of `places`, which are sorted by y, that is farther than `beyond_px`
/// and not farther than `within_px`.
std::optional<float> nearest_px(const Points& places, const Eigen::Vector2f& to, float beyond_px,
                                float within_px) {
  std::optional<float> nearest;
  const auto takes = [&](const Eigen::Vector2f& place) {
    const float most = nearest.value_or(within_px);
    if (std::abs(place.y() - to.y()) > most) return false;  // nor will any that follows
    const float distance = (place - to).norm();
    if (distance > beyond_px && distance <= most) nearest = distance;
    return true;
  };
  const auto middle =
      std::lower_bound(places.begin(), places.end(), to.y(),
                       [](const Eigen::Vector2f& place, float y) { return place.y() < y; });
  for (auto place = middle; place != places.end() && takes(*place);) ++place;
  for (auto place = middle; place != places.begin() && takes(*std::prev(place));) --place;
  return nearest;
}

bool has_corner(const Points& places, const Eigen::Vector2f& at) {
  constexpr float kFound_px = 2;
  return nearest_px(places, at, -1, kFound_px).has_value();
}

void take_directions(const Points& from, const std::vector<Eigen::Vector2f>& motion, cv::Size size,
                     Values& values) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double outward = 0;
  std::size_t count = 0;
  const Eigen::Vector2f middle(0.5F * static_cast<float>(size.width - 1),
                               0.5F * static_cast<float>(size.height - 1));
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (motion[i].norm() < kMoves_px) continue;
    const Eigen::Vector2f way = motion[i].normalized();
    sum += way.cast<double>();
    outward += static_cast<double>(way.dot((from[i] - middle).normalized()));
    ++count;
  }
  if (count < kFewest) return;
  const auto n = static_cast<double>(count);
  values[Measure::direction_deg] = std::atan2(sum.y(), sum.x()) * 180 / std::numbers::pi;
  values[Measure::one_way] = sum.norm() / n;
  values[Measure::outward] = outward / n;
}

}  // namespace

const std::array<MeasureText, kMeasures>& measures() {
  static constexpr std::array<MeasureText, kMeasures> kAll{{
      {"corners", "FAST corners a picture", true},
      {"corners_per_mpx", "likewise, for a million pixels", true},
      {"spacing_px", "from a corner to the nearest other one, px", true},
      {"contrast", "FAST score: the highest threshold at which a corner still is one, grey levels",
       true},
      {"motion_px", "length of the motion to the next picture, px", true},
      {"direction_deg", "mean direction of what moves: 0 to the right, 90 down", false},
      {"one_way", "how much of it goes the same way: 1 all, 0 evenly to all sides", false},
      {"outward", "how much goes away from the picture's middle: 1 all, -1 all towards it", false},
      {"noise", "standard deviation of the noise where the picture is flat, grey levels", true},
      {"followed", "share of corners that optical flow follows to the next picture and back",
       false},
      {"found_again", "share of those with a corner within 2 px of where they went", false},
      {"by_chance", "the same for places 8 to 16 px beside, where nothing says that one is", false},
  }};
  return kAll;
}

Values measure(const cv::Mat1b& now, const cv::Mat1b& next, std::optional<int> threshold) {
  Values values;
  const FastDetector detector(threshold);
  const Points there = detector.detect(next);
  Points here;
  std::vector<double> spacing, contrast;
  for (const cv::KeyPoint& corner : detector.detect_scored(now)) {
    here.emplace_back(corner.pt.x, corner.pt.y);
    contrast.push_back(corner.response);
  }
  values[Measure::corners] = static_cast<double>(here.size());
  values[Measure::corners_per_mpx] =
      1e6 * static_cast<double>(here.size()) / static_cast<double>(now.total());
  values[Measure::noise] = noise_levels(now);
  if (here.size() < kFewest) return values;

  for (const Eigen::Vector2f& place : here) {
    spacing.push_back(*nearest_px(here, place, 0, static_cast<float>(now.cols + now.rows)));
  }
  values[Measure::spacing_px] = bench::median(spacing);
  values[Measure::contrast] = bench::median(contrast);

  // From this picture's corners to the next one, which takes the place of the one before.
  comparators::BackwardFlow flow(
      {.baseline_s = 0, .round_trip_px = static_cast<double>(kMoves_px)});
  EgoMotion any;
  flow.see(next, any);
  any.dt_s = 0.1;
  flow.see(now, any);
  std::vector<Vec2> guesses;
  for (const Eigen::Vector2f& place : here) guesses.push_back(place.cast<double>());
  const auto ends = flow.track(here, guesses);
  const auto is_inside = [&](const Eigen::Vector2f& place) {
    return place.minCoeff() >= kFastMargin_px &&
           place.x() <= static_cast<float>(now.cols - 1) - kFastMargin_px &&
           place.y() <= static_cast<float>(now.rows - 1) - kFastMargin_px;
  };
  sim::RandomStream random(1, "likeness");
  Points from;
  std::vector<Eigen::Vector2f> motion;
  std::vector<double> lengths;
  int asked = 0, found = 0, asked_beside = 0, found_beside = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (!ends[i]) continue;
    const Eigen::Vector2f end = ends[i]->cast<float>();
    from.push_back(here[i]);
    motion.push_back(end - here[i]);
    lengths.push_back(motion.back().norm());
    if (is_inside(end)) {
      ++asked;
      found += has_corner(there, end);
    }
    const double angle = 2 * std::numbers::pi * random.uniform();
    const double aside = 8 + 8 * random.uniform();
    const Eigen::Vector2f beside =
        end + (aside * Eigen::Vector2d(std::cos(angle), std::sin(angle))).cast<float>();
    if (is_inside(beside)) {
      ++asked_beside;
      found_beside += has_corner(there, beside);
    }
  }
  values[Measure::followed] = static_cast<double>(from.size()) / static_cast<double>(here.size());
  if (from.size() < kFewest) return values;
  values[Measure::motion_px] = bench::median(lengths);
  take_directions(from, motion, now.size(), values);
  values[Measure::found_again] = bench::ratio(found, asked);
  values[Measure::by_chance] = bench::ratio(found_beside, asked_beside);
  return values;
}

std::vector<int> spread(int frames, int pairs) {
  std::set<int> firsts;
  const int last = frames - 2;
  for (int i = 0; i < pairs && last >= 0; ++i) {
    const double share = pairs == 1 ? 0.5 : static_cast<double>(i) / (pairs - 1);
    firsts.insert(static_cast<int>(std::lround(share * last)));
  }
  return {firsts.begin(), firsts.end()};
}

std::vector<Row> measure(const Run& run, int pairs) {
  std::vector<Row> rows;
  cv::Mat1b last;
  int last_frame = -1;
  const auto get = [&](int frame) {
    if (frame != last_frame) last = run.picture(frame);
    last_frame = frame;
    return last;
  };
  for (const int frame : spread(run.frames, pairs)) {
    const cv::Mat1b now = get(frame), next = get(frame + 1);
    if (now.empty() || next.empty()) continue;
    rows.push_back({run.origin, run.group, run.name, frame, measure(now, next, run.threshold)});
  }
  if (rows.empty()) {
    throw std::runtime_error(fmt::format(
        "{} has no two neighbouring pictures that can be read; give two or more", run.name));
  }
  return rows;
}

}  // namespace lcs::likeness
