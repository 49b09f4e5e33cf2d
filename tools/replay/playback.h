/// \file
/// Feeds the frames of a recording, instead of simulated ones, to the bench's loop.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/camera/rectifier.h"
#include "tools/bench/bench.h"
#include "tools/replay/motion_source.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

// Whether the motion that is told is the camera's, by points that are followed from picture to
// picture. It knows nothing of the filter.

/// A static point before the motion is at x, after it at R x + t, both in the camera's axes.
struct RigidMotion {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Vector3d t_m = Vector3d::Zero();
  double sway = 0;  ///< tangent of the angle by which t may be off, as its deviation says
};

/// Follows corners until the picture has moved by some pixels: this is a step, of one frame or of
/// many. A step contradicts the motion if too few of its corners are where any depth would take
/// them, or more than by chance are where this motion takes them by other axes. Where the turn is
/// not told, it may be any.
class MotionCheck {
 public:
  /// \param image of the lens that `rectifier` straightens.
  /// \param told motion since the picture before.
  void add(const cv::Mat3b& image, const sim::Rectifier& rectifier, std::int64_t t_ns,
           const EgoMotion& told);

  /// Judges the step in progress, after the last picture.
  void finish(const sim::Rectifier& rectifier);

  /// Enough steps for a judgement were added by the last call.
  bool is_due() const { return is_due_; }

  /// \param motion that was told. \param where it is from.
  /// \throws input::Error if more than half of the frames contradict it. It names the axes, order
  ///   or sign by which the same data fit, if there are such.
  void require_right(const MotionSource& motion, const input::Source& where) const;

  /// A line for each doubt: frames that contradict, pictures that repeat, lines that alternate.
  std::vector<std::string> remarks() const;

 private:
  /// Places of a corner in units of the focal length.
  using Track = std::pair<Eigen::Vector2d, Eigen::Vector2d>;
  struct Step {
    std::int64_t from_ns = 0, to_ns = 0;
    int frames = 0;
    RigidMotion told;
    bool is_turn_told = true;
    double sigma_m = 0;    ///< of the told way
    double moved_px = 0;   ///< the usual way of a corner
    double tolerance = 0;  ///< in units of the focal length
    std::vector<Track> tracks;
  };
  struct Fit {
    std::string reading;     ///< remedy of another reading; "": as told
    Eigen::Matrix3d axes;    ///< its columns are x, y and z in the camera's axes
    std::vector<bool> seen;  ///< corners, step by step, that are close to where it takes them
  };
  struct Judgement {
    int wrong = 0, frames = 0;  ///< frames that contradict, of those that were judged
    std::vector<Fit> fits;      ///< of the motion as it is told, then by other axes
  };
  struct Change {
    double grey_levels = 0;  ///< mean difference to the picture before
    double way = 0;          ///< told: m and rad
  };

  void begin(const cv::Mat1b& grey, std::int64_t t_ns);
  /// \return false, and leaves the step as it is, if too few corners are found again.
  bool follow(const cv::Mat1b& grey);
  /// By all axes, those of the camera first; where a turn is not told, by these with the best turn.
  std::vector<Fit> fits_of(const auto& motion_in, const std::string& reading) const;
  static const Fit& best_of(const std::vector<Fit>& fits);
  static std::string remedy_of(const Fit& fit);
  /// By how much larger a share other axes fit by chance, most in a short time.
  double by_chance() const;
  Judgement judgement() const;

  std::vector<Step> steps_;
  Step step_;                                  ///< in progress
  std::vector<cv::Point2f> began_px_, at_px_;  ///< of its corners
  cv::Mat1b last_;                             ///< picture; empty after a pause
  int pause_ = 0;                              ///< pictures until the next step begins
  bool is_due_ = false;
  std::vector<Change> changes_;
  int combed_ = 0, looked_at_ = 0;  ///< pictures whose lines alternate, and all that were looked at
};

class Playback : public bench::FrameSource {
 public:
  /// Of the camera, between frames of which the filter knows corners again.
  static constexpr double kMostPeriods = 4;

  /// Reads everything except the pictures, of which it decodes only the first one.
  /// \throws input::Error for unreadable or missing input, std::runtime_error.
  explicit Playback(const scenario::Scenario& asked);

  /// The given scenario, completed by the recording's settings of filter and corners, with the
  /// actual number of frames and frame rate.
  const scenario::Scenario& scenario() const { return scenario_; }
  const sim::Pinhole& camera() const { return rectifier_->camera(); }

  /// The facts of a run of the scenario.
  recording::RunInfo info() const;

  bool next(recording::FrameRecord& frame, cv::Mat3b& image) override;
  std::span<const sim::Event> events() const override { return events_; }
  bool straighten(std::vector<Eigen::Vector2f>& corners_px, cv::Mat& picture) const override;
  void label(recording::FrameRecord& frame) override;
  Diagnostics diagnostics() const override;

  /// Number of unusable pictures so far.
  std::size_t skipped() const { return next_ - static_cast<std::size_t>(index_); }
  /// The faults and missing inputs so far: one readable line each.
  std::vector<std::string> remarks() const;

 private:
  void take_settings();
  void look_at_first_picture();
  void read_mask();
  void read_labels();
  void require_events() const;
  void require_right_motion() const;
  void label_by_truth(const RecordedFrame& recorded, recording::FrameRecord& frame);

  scenario::Scenario scenario_;
  Recorded recorded_;
  PictureReader pictures_;
  std::optional<sim::Rectifier> rectifier_;
  MotionCheck motion_check_;
  recording::Truth truth_;        ///< of corners
  int corners_ = 0, untold_ = 0;  ///< seen so far, and those without truth
  recording::Labels labels_;      ///< of moving objects, if present
  cv::Mat1b mask_;                ///< empty, or non-zero at ignored pixels
  std::size_t next_ = 0;          ///< of the recorded frames
  int index_ = 0;                 ///< of the next frame
  double longest_s_ = 0;          ///< between frames of which the filter knows corners again
  std::size_t events_end_ = 0;    ///< of those that frames had so far
  std::span<const sim::Event> events_;
  bool grounded_ = false;  ///< the last frame has a ground
};

}  // namespace lcs::replay
