#include "tools/comparators/backward_flow.h"

#include <stdexcept>

namespace lcs::comparators {

BackwardFlow::BackwardFlow(const FlowParameters& parameters)
    : flow_(sim::optical_flow()), parameters_(parameters), pyramids_(parameters.baseline_s) {
  const bool window_is_right = parameters.window_px >= 3 && parameters.window_px % 2 == 1;
  if (!window_is_right || parameters.levels < 0 || parameters.max_iterations < 1) {
    throw std::invalid_argument("a parameter of the optical flow is out of its range");
  }
}

const EgoMotion& BackwardFlow::advance(const cv::Mat1b& grey, const EgoMotion& motion) {
  const cv::Size window(parameters_.window_px, parameters_.window_px);
  flow_.build_pyramid(grey, pyramids_.begin(motion), window, parameters_.levels,
                      /*withDerivatives=*/true, cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT,
                      /*tryReuseInputImage=*/false);
  return pyramids_.motion();
}

std::span<const std::optional<Vec2>> BackwardFlow::track(
    std::span<const Eigen::Vector2f> corners_px, std::span<const Vec2> guesses_px) {
  result_.assign(corners_px.size(), std::nullopt);
  if (pyramids_.earlier() == nullptr || corners_px.empty()) return result_;

  corners_.clear();
  before_.clear();
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    corners_.emplace_back(corners_px[i].x(), corners_px[i].y());
    before_.emplace_back(cv::Point2d(guesses_px[i].x(), guesses_px[i].y()));
  }
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS,
                               parameters_.max_iterations, parameters_.least_step_px);
  flow_.lucas_kanade(pyramids_.now(), *pyramids_.earlier(), corners_, before_, found_,
                     cv::noArray(), {parameters_.window_px, parameters_.window_px},
                     parameters_.levels, until, cv::OPTFLOW_USE_INITIAL_FLOW,
                     parameters_.least_eigenvalue);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    if (found_[i]) result_[i] = Vec2(before_[i].x, before_[i].y);
  }
  return result_;
}

}  // namespace lcs::comparators
