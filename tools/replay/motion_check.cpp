#include "tools/replay/playback.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "filter/detect/fast.h"
#include "sim/pictures/media.h"
#include "tools/replay/text_table.h"

namespace lcs::replay {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr std::size_t kEnoughSteps = 40, kFewestTracks = 25;
constexpr std::size_t kFewestSteps = 2;
/// To refuse a motion: where another reading of it fits, and where none does.
constexpr int kFewestFrames = 4, kFewestAlone = 6;
constexpr double kStep_px = 5, kLeast_px = 3;  // by which the picture moves in a step
/// A step of which a smaller share of corners is where the motion takes them contradicts it.
constexpr double kContradicts = 0.4;
constexpr double kClose = 0.4;  // of the tolerance: tells conventions apart that are alike

/// Where a motion sees a corner by any depth: from `far` on along a direction, which is 0 where the
/// camera does not move.
struct Sight {
  Vector2d far, along;

  /// \pre `ray` of the point, after the turn, is ahead.
  Sight(const Vector3d& ray, const Vector3d& t_m)
      : far(ray.hnormalized()), along((t_m.head<2>() - far * t_m.z()).stableNormalized()) {}
};

/// Which corners are on the line on which the motion sees them, by any depth.
std::vector<bool> seen_by(const RigidMotion& motion, const auto& tracks, double tolerance) {
  std::vector<bool> seen;
  for (const auto& [before, now] : tracks) {
    const Vector3d ray = motion.R * before.homogeneous();
    const Sight sight(ray, motion.t_m);
    const Vector2d off = now - sight.far;
    const double way = std::max(0.0, off.dot(sight.along));
    seen.push_back(ray.z() > 0 &&
                   (off - way * sight.along).norm() <= tolerance + motion.sway * way);
  }
  return seen;
}

double share_of(const std::vector<bool>& seen) {
  return static_cast<double>(std::ranges::count(seen, true)) / static_cast<double>(seen.size());
}

/// Whether one motion sees more corners than another, by more than chance.
bool sees_more(const std::vector<bool>& seen, const std::vector<bool>& by_other) {
  constexpr double kDeviations = 3;
  int more = 0, differ = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    more += seen[i] - by_other[i];
    differ += seen[i] != by_other[i];
  }
  return more > kDeviations * std::sqrt(differ);
}

/// \param sigma_m standard deviation of the way.
double sway_of(const Vector3d& way_m, double sigma_m) {
  constexpr double kDeviations = 2, kLeast_m = 1e-9;
  return kDeviations * sigma_m / std::max(way_m.norm(), kLeast_m);
}

/// The turn, near a first one, by which the motion sees most corners; bodies that move count
/// little.
Matrix3d fitted_turn(const auto& tracks, RigidMotion motion, double tolerance) {
  constexpr int kRounds = 12;
  for (int round = 0; round < kRounds; ++round) {
    const double scale = tolerance * std::max(1, kRounds / 2 - round);
    Matrix3d normal = 1e-12 * Matrix3d::Identity();
    Vector3d right = Vector3d::Zero();
    for (const auto& [before, now] : tracks) {
      const Vector3d ray = motion.R * before.homogeneous();
      if (ray.z() <= 0) continue;
      const Sight sight(ray, motion.t_m);
      const double x = sight.far.x(), y = sight.far.y();
      Eigen::Matrix<double, 2, 3> by_turn;
      by_turn << -x * y, 1 + x * x, -y, -1 - y * y, x * y, x;
      const Eigen::Matrix2d across =
          Eigen::Matrix2d::Identity() - sight.along * sight.along.transpose();
      const Vector2d off = across * (now - sight.far);
      const double weight = 1 / (1 + off.squaredNorm() / (scale * scale));
      normal += weight * by_turn.transpose() * across * by_turn;
      right += weight * by_turn.transpose() * off;
    }
    const Vector3d turn = normal.ldlt().solve(right);
    motion.R = Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()) * motion.R;
  }
  return motion.R;
}

/// All matrices that permute axes and change their signs: first 1, then those of OpenGL, of
/// vehicles (x ahead, y left, z up; y right, z down) and of Unity, then right-handed ones.
std::vector<Matrix3d> all_axes() {
  std::vector<Matrix3d> all(5);
  all[0] << 1, 0, 0, 0, 1, 0, 0, 0, 1;
  all[1] << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  all[2] << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  all[3] << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  all[4] << 1, 0, 0, 0, -1, 0, 0, 0, 1;
  const auto usual_ones = std::ssize(all);
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3d axes = Matrix3d::Zero();
      for (int i = 0; i < 3; ++i) axes(order[i], i) = (signs >> i) & 1 ? -1 : 1;
      if (std::ranges::count(all, axes) == 0) all.push_back(axes);
    }
  } while (std::ranges::next_permutation(order).found);
  std::stable_partition(all.begin() + usual_ones, all.end(),
                        [](const Matrix3d& axes) { return axes.determinant() > 0; });
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
  began_px_.clear();
  const std::vector<Eigen::Vector2f> corners = FastDetector(std::nullopt).detect(grey);
  const std::size_t every = corners.size() / kMost + 1;
  for (std::size_t i = 0; i < corners.size(); i += every) {
    began_px_.emplace_back(corners[i].x(), corners[i].y());
  }
  at_px_ = began_px_;
}

bool MotionCheck::follow(const cv::Mat1b& grey) {
  if (at_px_.size() < kFewestTracks) return false;
  std::vector<cv::Point2f> next_px, back_px;
  std::vector<unsigned char> is_found, is_back;
  const auto& follow = *sim::optical_flow().lucas_kanade;
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01);
  follow(last_, grey, at_px_, next_px, is_found, cv::noArray(), {21, 21}, 3, until, 0, 1e-4);
  follow(grey, last_, next_px, back_px, is_back, cv::noArray(), {21, 21}, 3, until, 0, 1e-4);
  std::vector<cv::Point2f> began_px, at_px;
  for (std::size_t i = 0; i < at_px_.size(); ++i) {
    if (!is_found[i] || !is_back[i] || cv::norm(back_px[i] - at_px_[i]) > 1) continue;
    began_px.push_back(began_px_[i]);
    at_px.push_back(next_px[i]);
  }
  if (at_px.size() < kFewestTracks) return false;
  began_px_ = std::move(began_px);
  at_px_ = std::move(at_px);
  return true;
}

void MotionCheck::add(const cv::Mat3b& image, const sim::Rectifier& rectifier, std::int64_t t_ns,
                      const EgoMotion& told) {
  is_due_ = false;
  if (pause_ > 0 && --pause_ > 0) return last_.release();
  cv::Mat1b grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  ++looked_at_;
  combed_ += combing(grey) > 1;
  const bool goes_on = last_.size() == grey.size() && told.dt_s > 0;
  if (goes_on) {
    const double turn_rad = Eigen::AngleAxisd(told.R_cur_prev).angle();
    changes_.push_back({cv::norm(grey, last_, cv::NORM_L1) / static_cast<double>(grey.total()),
                        told.v_C_mps.norm() * told.dt_s + turn_rad});
  }
  const bool is_followed = goes_on && follow(grey);
  if (is_followed) {
    step_.told.R = told.R_cur_prev * step_.told.R;
    step_.told.t_m = told.R_cur_prev * step_.told.t_m - told.v_C_mps * told.dt_s;
    step_.sigma_m += told.velocity_sigma_mps * told.dt_s;
    step_.is_turn_told &= told.unseen_turn_rad <= 0;
    step_.to_ns = t_ns;
    ++step_.frames;
    std::vector<double> moved_px;
    for (std::size_t i = 0; i < at_px_.size(); ++i) {
      moved_px.push_back(cv::norm(at_px_[i] - began_px_[i]));
    }
    step_.moved_px = *usual(std::move(moved_px));
  }
  if (!is_followed || step_.moved_px >= kStep_px) {
    finish(rectifier);
    begin(grey, t_ns);
  }
  last_ = grey;
}

void MotionCheck::finish(const sim::Rectifier& rectifier) {
  constexpr double kLeastOff_px = 1.5, kShare = 0.12;
  constexpr int kPause = 20;
  if (step_.moved_px < kLeast_px) return;
  const sim::Pinhole& camera = rectifier.camera();
  step_.tolerance = std::max(kLeastOff_px, kShare * step_.moved_px) / camera.focal_px;
  step_.moved_px = 0;  // it is judged once
  step_.told.sway = sway_of(step_.told.t_m, step_.sigma_m);
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
  if (!step_.is_turn_told) {
    step_.told.R = fitted_turn(step_.tracks, step_.told, step_.tolerance);
  }
  steps_.push_back(step_);
  is_due_ = steps_.size() % kEnoughSteps == 0;
  if (steps_.size() >= kEnoughSteps) pause_ = kPause;
}

std::vector<MotionCheck::Fit> MotionCheck::fits_of(const auto& motion_in,
                                                   const std::string& reading) const {
  std::vector<RigidMotion> motions;
  for (const Step& step : steps_) {
    RigidMotion& motion = motions.emplace_back(motion_in(step));
    if (!step.is_turn_told) motion.R = fitted_turn(step.tracks, motion, step.tolerance);
  }
  const bool are_turns_told = std::ranges::all_of(steps_, &Step::is_turn_told);
  std::vector<Fit> fits;
  for (const Matrix3d& axes : all_axes()) {
    Fit& fit = fits.emplace_back(Fit{reading, axes, {}});
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const auto& [R, t_m, sway] = motions[i];
      const RigidMotion motion{axes * R * axes.transpose(), axes * t_m, sway};
      std::ranges::copy(seen_by(motion, steps_[i].tracks, kClose * steps_[i].tolerance),
                        std::back_inserter(fit.seen));
    }
    if (!are_turns_told) break;  // they were fitted with these axes
  }
  return fits;
}

double MotionCheck::by_chance() const {
  constexpr std::size_t kFew = 10;
  return steps_.size() < kFew ? 0.18 : 0.03;
}

MotionCheck::Judgement MotionCheck::judgement() const {
  Judgement all{.fits = fits_of([](const Step& step) { return step.told; }, "")};
  const std::vector<bool>& seen = all.fits.front().seen;
  const std::vector<bool>& by_other = best_of(all.fits).seen;
  const bool is_better = share_of(by_other) > share_of(seen) + by_chance();
  std::ptrdiff_t at = 0;
  for (const Step& step : steps_) {
    const auto part = [&, end = at + std::ssize(step.tracks)](const std::vector<bool>& of) {
      return std::vector<bool>(of.begin() + at, of.begin() + end);
    };
    const bool is_wrong =
        share_of(seen_by(step.told, step.tracks, step.tolerance)) < kContradicts ||
        (is_better && step.sigma_m == 0 && sees_more(part(by_other), part(seen)));
    at += std::ssize(step.tracks);
    all.frames += step.frames;
    if (is_wrong) all.wrong += step.frames;
  }
  return all;
}

const MotionCheck::Fit& MotionCheck::best_of(const std::vector<Fit>& fits) {
  return *std::ranges::max_element(fits, {}, [](const Fit& fit) { return share_of(fit.seen); });
}

void MotionCheck::require_right(const MotionSource& motion, const input::Source& where) const {
  constexpr double kFits = 0.4;
  constexpr std::size_t kMostNamed = 2;
  if (steps_.size() < kFewestSteps) return;
  auto [wrong, frames, fits] = judgement();
  if (2 * wrong <= frames || frames < kFewestFrames) return;
  for (const MotionSource::Reading& other : motion.other_readings()) {
    std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
    const auto motion_in = [&](const Step& step) {
      if (step.from_ns > last_ns) other.motion->at(step.from_ns);
      const EgoMotion moved = other.motion->at(last_ns = step.to_ns);
      const Vector3d way_m = -moved.v_C_mps * moved.dt_s;
      return RigidMotion{moved.R_cur_prev, way_m,
                         sway_of(way_m, moved.velocity_sigma_mps * moved.dt_s)};
    };
    std::ranges::move(fits_of(motion_in, other.remedy), std::back_inserter(fits));
  }
  const double as_told = share_of(fits.front().seen);
  std::stable_partition(fits.begin(), fits.end(),
                        [](const Fit& fit) { return fit.axes.isIdentity(); });
  const Fit& best = best_of(fits);
  std::vector<std::string> remedies;
  if (share_of(best.seen) >= std::max(kFits, as_told + by_chance())) {
    for (const Fit& fit : fits) {
      const bool fits_alike = share_of(fit.seen) >= share_of(best.seen) - by_chance();
      if (fits_alike && remedies.size() < kMostNamed) remedies.push_back(remedy_of(fit));
    }
  } else if (frames < kFewestAlone) {
    return;
  } else {
    remedies.push_back(fmt::format(
        "no other axes, order or sign of it fit: give the motion of these pictures by the clock of "
        "the pictures, with an IMU its speed at the start, and their focal length; {}",
        kNeutralWay));
  }
  refuse(where, "the pictures contradict its motion in {} of {} frames; {}", wrong, frames,
         fmt::join(remedies, "; or "));
}

std::string MotionCheck::remedy_of(const Fit& fit) {
  if (fit.axes.isIdentity()) return fit.reading;
  return fmt::format("{}{}its axes are {}, and must be x right, y down, z ahead: {}", fit.reading,
                     fit.reading.empty() ? "" : "; ", directions_of(fit.axes), turn_by(fit.axes));
}

std::vector<std::string> MotionCheck::remarks() const {
  constexpr double kRepeats = 0.1, kClear = 0.1;
  std::vector<std::string> lines;
  if (steps_.size() >= kFewestSteps) {
    const Judgement told = judgement();
    const Fit& best = best_of(told.fits);
    const double as_told = share_of(told.fits.front().seen), otherwise = share_of(best.seen);
    if (told.wrong > kClear * told.frames) {
      lines.push_back(fmt::format(
          "the pictures contradict the motion in {} of {} frames{}", told.wrong, told.frames,
          otherwise < as_told + by_chance()
              ? ""
              : fmt::format("; read otherwise it fits {:.0f} % of the "
                            "corners, in place of {:.0f} %: perhaps {}",
                            100 * otherwise, 100 * as_told, remedy_of(best))));
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
