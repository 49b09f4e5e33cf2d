#include "tools/comparators/homography.h"

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>
#include <stdexcept>

namespace lcs::comparators {

HomographyDetector::HomographyDetector(const HomographyParameters& parameters)
    : parameters_(parameters), flow_(parameters.flow), groups_(parameters.groups) {
  if (parameters.least_corners < 4) {
    throw std::invalid_argument("a homography needs at least 4 corners");
  }
}

const FrameResult& HomographyDetector::step(const bench::DetectorInput& input) {
  const EgoMotion& motion = flow_.advance(input.grey, input.motion);
  guesses_.clear();
  for (const Eigen::Vector2f& corner : input.corners_px) guesses_.push_back(corner.cast<double>());
  const auto tracked = flow_.track(input.corners_px, guesses_);

  before_.clear();
  now_.clear();
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    if (!tracked[i]) continue;
    before_.emplace_back(tracked[i]->x(), tracked[i]->y());
    now_.emplace_back(guesses_[i].x(), guesses_[i].y());
  }
  cv::Mat1d H;
  if (static_cast<int>(now_.size()) >= parameters_.least_corners) {
    // OpenCV seeds its own generator alike in each call: the same corners give the same bits.
    H = cv::findHomography(before_, now_, cv::RANSAC, parameters_.inlier_px, cv::noArray(),
                           parameters_.max_iterations, parameters_.confidence);
  }

  motions_.assign(input.corners_px.size(), {});
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    if (!tracked[i]) continue;
    if (H.empty()) {
      motions_[i].known = true;
      continue;
    }
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> by_rows(H[0]);
    const Eigen::Vector3d moved = by_rows * tracked[i]->homogeneous();
    const Vec2 step = guesses_[i] - moved.hnormalized();
    // A wrong homography may map a corner to infinity.
    if (step.allFinite()) motions_[i] = {true, step.norm() > parameters_.residual_px, step};
  }
  return groups_.group(input.corners_px, motions_, motion.dt_s);
}

}  // namespace lcs::comparators
