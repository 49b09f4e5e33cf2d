#include "tools/replay/motion_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "filter/detect/fast.h"
#include "sim/pictures/media.h"
#include "tools/replay/recorded.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr std::size_t kFewestSteps = 3, kEnoughSteps = 40, kFewestTracks = 25;
constexpr std::size_t kFewestAlone = 6;  // steps, to refuse a motion that no convention mends
/// A step of which a smaller share of corners is where the motion takes them contradicts it.
constexpr double kContradicts = 0.4;
constexpr double kSame = 0.01;  // difference of shares that fit alike

/// Share of the corners that are on the line on which the motion sees them, by any depth.
double explained(const auto& tracks, const RigidMotion& motion, double tolerance) {
  int met = 0;
  for (const auto& [before, now] : tracks) {
    const Vector3d ray = motion.R * before.homogeneous();
    if (ray.z() <= 0) continue;
    const Vector2d far = ray.hnormalized(), off = now - far;
    const Vector2d along = (motion.t_m.head<2>() - far * motion.t_m.z()).stableNormalized();
    met += (off - std::max(0.0, off.dot(along)) * along).norm() <= tolerance;
  }
  return static_cast<double>(met) / static_cast<double>(tracks.size());
}

/// All matrices that permute axes and change their signs: first right-handed ones, first of all 1.
std::vector<Matrix3d> all_axes() {
  std::vector<Matrix3d> all;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3d& axes = all.emplace_back(Matrix3d::Zero());
      for (int i = 0; i < 3; ++i) axes(order[i], i) = (signs >> i) & 1 ? -1 : 1;
    }
  } while (std::ranges::next_permutation(order).found);
  std::ranges::stable_partition(all, [](const Matrix3d& axes) { return axes.determinant() > 0; });
  return all;
}

/// \param axes its columns are the directions of x, y and z in the camera (x right, y down).
std::string directions_of(const Matrix3d& axes) {
  constexpr const char* kNames[3][2] = {{"right", "left"}, {"down", "up"}, {"ahead", "back"}};
  std::string text;
  for (int i = 0; i < 3; ++i) {
    for (int row = 0; row < 3; ++row) {
      if (axes(row, i) == 0) continue;
      text += fmt::format("{}{} {}", i > 0 ? ", " : "", "xyz"[i], kNames[row][axes(row, i) < 0]);
    }
  }
  return text;
}

std::string turn_by(const Matrix3d& axes) {
  std::string rows;
  for (int i = 0; i < 3; ++i) {
    rows += fmt::format("{}[{}, {}, {}]", i > 0 ? ", " : "", axes(0, i), axes(1, i), axes(2, i));
  }
  return axes.determinant() > 0
             ? fmt::format("multiply each rotation from the right by [{}]", rows)
             : fmt::format("they are left-handed: with D = diag(1, -1, 1) give D p and D R [{}]",
                           rows);
}

/// The mean difference of lines, one apart as a share of two apart: above 1 the lines of two
/// pictures, or of two colours, alternate.
double combing(const cv::Mat1b& grey) {
  const auto difference = [&](int apart) {
    return cv::norm(grey.rowRange(apart, grey.rows), grey.rowRange(0, grey.rows - apart),
                    cv::NORM_L1) /
           (grey.rows - apart);
  };
  return grey.rows > 2 ? difference(1) / (difference(2) + 1) : 0;
}

}  // namespace

void MotionCheck::begin(const cv::Mat1b& grey, std::int64_t t_ns) {
  constexpr std::size_t kMost = 200;
  step_ = {};
  step_.from_ns = t_ns;
  pictures_ = 0;
  began_px_.clear();
  const std::vector<Eigen::Vector2f> corners = FastDetector(std::nullopt).detect(grey);
  const std::size_t every = corners.size() / kMost + 1;
  for (std::size_t i = 0; i < corners.size(); i += every) {
    began_px_.emplace_back(corners[i].x(), corners[i].y());
  }
  at_px_ = began_px_;
}

void MotionCheck::add(const cv::Mat3b& image, const sim::Rectifier& rectifier, std::int64_t t_ns,
                      const EgoMotion& told) {
  constexpr double kStep_px = 5, kLeast_px = 3;
  constexpr int kMostPictures = 10;
  is_due_ = false;
  if (pause_ > 0 && --pause_ > 0) return;
  cv::Mat1b grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  ++looked_at_;
  combed_ += combing(grey) > 1;
  if (last_.size() != grey.size() || told.unseen_turn_rad > 0 || !(told.dt_s > 0)) {
    begin(grey, t_ns);
    last_ = grey;
    return;
  }
  const double turn_rad = Eigen::AngleAxisd(told.R_cur_prev).angle();
  changes_.push_back({cv::norm(grey, last_, cv::NORM_L1) / static_cast<double>(grey.total()),
                      told.v_C_mps.norm() * told.dt_s + turn_rad});
  step_.told.R = told.R_cur_prev * step_.told.R;
  step_.told.t_m = told.R_cur_prev * step_.told.t_m - told.v_C_mps * told.dt_s;
  ++pictures_;
  std::vector<double> moved_px;
  if (began_px_.size() >= kFewestTracks) {
    std::vector<cv::Point2f> next_px, back_px;
    std::vector<unsigned char> is_found, is_back;
    const auto& follow = *sim::optical_flow().lucas_kanade;
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01);
    follow(last_, grey, at_px_, next_px, is_found, cv::noArray(), {21, 21}, 3, until, 0, 1e-4);
    follow(grey, last_, next_px, back_px, is_back, cv::noArray(), {21, 21}, 3, until, 0, 1e-4);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < at_px_.size(); ++i) {
      if (!is_found[i] || !is_back[i] || cv::norm(back_px[i] - at_px_[i]) > 1) continue;
      began_px_[kept] = began_px_[i];
      at_px_[kept] = next_px[i];
      moved_px.push_back(cv::norm(next_px[i] - began_px_[i]));
      ++kept;
    }
    began_px_.resize(kept);
    at_px_.resize(kept);
  }
  last_ = grey;
  const double usual_px = usual(moved_px).value_or(0);
  const bool is_long = pictures_ >= kMostPictures;
  const bool has_moved = usual_px >= (is_long ? kLeast_px : kStep_px);
  if (began_px_.size() >= kFewestTracks && has_moved) finish(rectifier, t_ns, usual_px);
  if (began_px_.size() < kFewestTracks || has_moved || is_long) begin(grey, t_ns);
}

void MotionCheck::finish(const sim::Rectifier& rectifier, std::int64_t t_ns, double moved_px) {
  constexpr double kLeast_px = 1.5, kShare = 0.12;
  constexpr int kPause = 20;
  const sim::Pinhole& camera = rectifier.camera();
  step_.to_ns = t_ns;
  step_.tolerance = std::max(kLeast_px, kShare * moved_px) / camera.focal_px;
  for (std::size_t i = 0; i < began_px_.size(); ++i) {
    std::vector<Eigen::Vector2f> before{{began_px_[i].x, began_px_[i].y}};
    std::vector<Eigen::Vector2f> now{{at_px_[i].x, at_px_[i].y}};
    rectifier.rectify(before);
    rectifier.rectify(now);
    if (before.empty() || now.empty()) continue;
    const auto place = [&](const Eigen::Vector2f& px) {
      return Vector2d((px.cast<double>() - camera.centre_px) / camera.focal_px);
    };
    step_.tracks.emplace_back(place(before[0]), place(now[0]));
  }
  if (step_.tracks.size() < kFewestTracks) return;
  steps_.push_back(step_);
  told_.push_back(step_.told);
  is_due_ = steps_.size() % kEnoughSteps == 0;
  if (steps_.size() >= kEnoughSteps) pause_ = kPause;
}

double MotionCheck::share(const std::vector<RigidMotion>& motions, const Matrix3d& axes) const {
  constexpr double kClose = 0.4;  // of the tolerance: tells conventions apart that are alike
  double sum = 0;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const RigidMotion turned{axes * motions[i].R * axes.transpose(), axes * motions[i].t_m};
    sum += explained(steps_[i].tracks, turned, kClose * steps_[i].tolerance);
  }
  return sum / static_cast<double>(steps_.size());
}

MotionCheck::Fit MotionCheck::best_fit(const std::vector<RigidMotion>& motions) const {
  Fit best{share(motions, Matrix3d::Identity()), Matrix3d::Identity()};
  for (const Matrix3d& axes : all_axes()) {
    const double found = share(motions, axes);
    if (found > best.share + kSame) best = {found, axes};
  }
  return best;
}

int MotionCheck::contradicted() const {
  return static_cast<int>(std::ranges::count_if(steps_, [](const Step& step) {
    return explained(step.tracks, step.told, step.tolerance) < kContradicts;
  }));
}

void MotionCheck::require_right(const MotionSource& motion, const input::Source& where) const {
  constexpr double kFits = 0.4, kBetter = 0.1, kOtherAxes = 0.2;
  if (steps_.size() < kFewestSteps) return;
  const double as_told = share(told_, Matrix3d::Identity());
  const int wrong = contradicted();
  Fit best = best_fit(told_);
  // Left-handed axes are right as far as the camera moves in their plane.
  const bool are_axes_wrong = best.share > as_told + kOtherAxes;
  if (2 * static_cast<std::size_t>(wrong) <= steps_.size() && !are_axes_wrong) return;
  std::string remedy;
  for (const MotionSource::Reading& other : motion.other_readings()) {
    std::vector<RigidMotion> motions;
    std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
    for (const Step& step : steps_) {
      if (step.from_ns > last_ns) other.motion->at(step.from_ns);
      const EgoMotion moved = other.motion->at(step.to_ns);
      motions.push_back({moved.R_cur_prev, -moved.v_C_mps * moved.dt_s});
      last_ns = step.to_ns;
    }
    if (const Fit fit = best_fit(motions); fit.share > best.share + kSame) {
      best = fit;
      remedy = other.remedy;
    }
  }
  if (best.share < kFits || best.share < as_told + kBetter) {
    if (steps_.size() < kFewestAlone) return;
    remedy = fmt::format(
        "no other axes, order or sign of it fit: give the motion of these pictures by the clock of "
        "the pictures, with an IMU its speed at the start, and their focal length; {}",
        kNeutralWay);
  } else if (best.axes != Matrix3d::Identity()) {
    remedy += fmt::format("{}its axes are {}, and must be x right, y down, z ahead: {}",
                          remedy.empty() ? "" : "; ", directions_of(best.axes), turn_by(best.axes));
  }
  throw input::Error(where, "the pictures contradict its motion in {} of {} steps; {}", wrong,
                     steps_.size(), remedy);
}

std::vector<std::string> MotionCheck::remarks() const {
  constexpr double kRepeats = 0.1, kBetter = 0.06;
  constexpr std::size_t kFewest = 10;
  std::vector<std::string> lines;
  if (const int wrong = contradicted(); wrong > 0) {
    lines.push_back(
        fmt::format("the pictures contradict the motion in {} of {} steps", wrong, steps_.size()));
  }
  if (steps_.size() >= kFewest) {
    const double as_told = share(told_, Matrix3d::Identity());
    const Fit best = best_fit(told_);
    if (best.share > as_told + kBetter) {
      lines.push_back(fmt::format(
          "the motion fits {:.0f} % of the corners, and with the axes {} it fits "
          "{:.0f} %: if they are those, {}",
          100 * as_told, directions_of(best.axes), 100 * best.share, turn_by(best.axes)));
    }
  }
  std::vector<double> levels, ways;
  for (const Change& change : changes_) {
    levels.push_back(change.grey_levels);
    ways.push_back(change.way);
  }
  const double level = usual(levels).value_or(0), way = usual(ways).value_or(0);
  const auto repeated = std::ranges::count_if(changes_, [&](const Change& change) {
    return change.grey_levels < kRepeats * level && 2 * change.way > way;
  });
  if (repeated > 0) {
    lines.push_back(
        fmt::format("{} of {} pictures repeat the one before, and the camera is told to move: "
                    "leave them out, with their times",
                    repeated, changes_.size()));
  }
  if (2 * combed_ > looked_at_) {
    lines.push_back(
        fmt::format("the lines alternate in {} of {} pictures: they are interlaced, so take every "
                    "second line; or raw, so give bayer",
                    combed_, looked_at_));
  }
  return lines;
}

}  // namespace lcs::replay
