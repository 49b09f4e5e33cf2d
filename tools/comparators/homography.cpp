#include "tools/comparators/homography.h"

#include <opencv2/calib3d.hpp>

namespace lcs::comparators {

HomographyTracker::HomographyTracker(const HomographyParameters& parameters)
    : parameters_(parameters), flow_(parameters.flow), groups_(parameters.groups) {}

const FrameResult& HomographyTracker::step(const bench::TrackerInput& input) {
  guesses_.clear();
  for (const Eigen::Vector2f& corner : input.corners_px) guesses_.push_back(corner.cast<double>());
  const auto tracked = flow_.track(input.grey, input.corners_px, guesses_);

  before_.clear();
  now_.clear();
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    if (!tracked[i]) continue;
    before_.emplace_back(tracked[i]->x(), tracked[i]->y());
    now_.emplace_back(guesses_[i].x(), guesses_[i].y());
  }
  cv::Mat1d H;
  if (static_cast<int>(now_.size()) >= parameters_.least_corners) {
    // Draws from a generator of its own, seeded alike in every call: the same corners give the
    // same bits.
    H = cv::findHomography(before_, now_, cv::RANSAC, parameters_.inlier_px, cv::noArray(),
                           parameters_.max_iterations, parameters_.confidence);
  }

  motions_.assign(input.corners_px.size(), {});
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    if (!tracked[i]) continue;
    motions_[i].known = true;
    if (H.empty()) continue;
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> by_rows(H[0]);
    const Eigen::Vector3d moved = by_rows * tracked[i]->homogeneous();
    motions_[i].step_px = guesses_[i] - moved.hnormalized();
    motions_[i].off = motions_[i].step_px.norm() > parameters_.residual_px;
  }
  return groups_.group(input.corners_px, motions_, input.motion.dt_s);
}

}  // namespace lcs::comparators
