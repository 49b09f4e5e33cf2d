/// \file
/// Whether the motion that is told is the camera's, by points that are followed from picture to
/// picture. It knows nothing of the filter.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "sim/camera/rectifier.h"
#include "tools/replay/motion_source.h"

namespace lcs::replay {

/// A static point before the motion is at x, after it at R x + t, both in the camera's axes.
struct RigidMotion {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Vector3d t_m = Vector3d::Zero();
};

/// Follows corners until the picture has moved by some pixels: this is a step. A step contradicts
/// the motion if too few of its corners are where any depth would take them.
class MotionCheck {
 public:
  /// \param image of the lens that `rectifier` straightens.
  /// \param told motion since the picture before.
  void add(const cv::Mat3b& image, const sim::Rectifier& rectifier, std::int64_t t_ns,
           const EgoMotion& told);

  /// Enough steps for a judgement were added by the last call.
  bool is_due() const { return is_due_; }

  /// \param motion that was told. \param where it is from.
  /// \throws input::Error if more than half of the steps contradict it. It names the axes, order or
  ///   sign by which the same data fit, if there are such.
  void require_right(const MotionSource& motion, const input::Source& where) const;

  /// A line for each doubt: steps that contradict, pictures that repeat, lines that alternate.
  std::vector<std::string> remarks() const;

 private:
  /// Places of a corner in units of the focal length.
  using Track = std::pair<Eigen::Vector2d, Eigen::Vector2d>;
  struct Step {
    std::int64_t from_ns = 0, to_ns = 0;
    RigidMotion told;
    double tolerance = 0;  ///< in units of the focal length
    std::vector<Track> tracks;
  };
  struct Fit {
    double share;
    Eigen::Matrix3d axes;  ///< its columns are x, y and z in the camera's axes
  };
  struct Change {
    double grey_levels = 0;  ///< mean difference to the picture before
    double way = 0;          ///< told: m and rad
  };

  void begin(const cv::Mat1b& grey, std::int64_t t_ns);
  void finish(const sim::Rectifier& rectifier, std::int64_t t_ns, double moved_px);
  /// Share of the corners that are close to where motions of these axes take them.
  double share(const std::vector<RigidMotion>& motions, const Eigen::Matrix3d& axes) const;
  Fit best_fit(const std::vector<RigidMotion>& motions) const;
  int contradicted() const;

  std::vector<Step> steps_;
  std::vector<RigidMotion> told_;              ///< in each of them
  Step step_;                                  ///< in progress
  std::vector<cv::Point2f> began_px_, at_px_;  ///< of its corners
  cv::Mat1b last_;                             ///< picture
  int pictures_ = 0;                           ///< in this step
  int pause_ = 0;                              ///< pictures until the next step begins
  bool is_due_ = false;
  std::vector<Change> changes_;
  int combed_ = 0, looked_at_ = 0;  ///< pictures whose lines alternate, and all that were looked at
};

}  // namespace lcs::replay
