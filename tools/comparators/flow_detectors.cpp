#include "tools/comparators/flow_detectors.h"

#include <Eigen/Core>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include "filter/kinematics/geometry.h"

namespace lcs::comparators {
namespace {

/// The inverse of a motion's rotation, without translation: its `exact_field` rotates a location of
/// this frame to the earlier one.
EgoMotion turned_back(const EgoMotion& motion) {
  EgoMotion back;
  back.dt_s = motion.dt_s;
  back.R_cur_prev = motion.R_cur_prev.transpose();
  return back;
}

/// Motion of a corner that was at `before_px`, rotation removed. It is off if its distance from the
/// segment exceeds `residual_px`.
CornerMotion epipolar_motion(const MotionField& field, double residual_px, const Vec2& now_px,
                             const Vec2& before_px) {
  return {.known = true,
          .off = epipolar_distance(field, now_px, before_px) > residual_px,
          .step_px = now_px - before_px};
}

}  // namespace

MotionField exact_field(const Intrinsics& camera, const EgoMotion& motion) {
  constexpr double kNearest_m = 0.8;  // a static point is not nearer (README.md)
  return {camera, motion, {.rotation = RotationModel::homography, .nearest_depth_m = kNearest_m}};
}

double epipolar_distance(const MotionField& field, const Vec2& now_px, const Vec2& before_px) {
  const Eigen::Vector3d displacement_C_m = field.displacement_C_m();
  // z_min holds in both frames: in reverse, the point was nearer in the earlier one.
  const double nearest_ratio = 1 / (1 / field.max_ratio() + std::max(0.0, -displacement_C_m.z()) /
                                                                field.reference_depth_m());
  // No static point lies below the ground, with slack for its tilt.
  const double ground_ratio = field.ground_ratio(now_px).value_or(0) - field.ground_slack();
  const double farthest_ratio = std::clamp(ground_ratio, 0.0, nearest_ratio);
  return distance_to_segment(before_px, field.earlier(now_px, farthest_ratio, displacement_C_m),
                             field.earlier(now_px, nearest_ratio, displacement_C_m));
}

KltDetector::KltDetector(const Intrinsics& camera, const KltParameters& parameters)
    : camera_(camera),
      parameters_(parameters),
      flow_(sim::optical_flow()),
      pyramids_(parameters.baseline_s),
      groups_(parameters.groups) {
  const bool window_is_right = parameters.window_px >= 3 && parameters.window_px % 2 == 1;
  if (!window_is_right || parameters.levels < 0 || parameters.max_iterations < 1) {
    throw std::invalid_argument("a parameter of the optical flow is out of its range");
  }
}

const FrameResult& KltDetector::step(const bench::DetectorInput& input) {
  const cv::Size window(parameters_.window_px, parameters_.window_px);
  flow_.build_pyramid(input.grey, pyramids_.begin(input.motion), window, parameters_.levels,
                      /*withDerivatives=*/true, cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT,
                      /*tryReuseInputImage=*/false);
  const EgoMotion& motion = pyramids_.motion();
  const MotionField field = exact_field(camera_, motion);
  const MotionField back = exact_field(camera_, turned_back(motion));

  corners_.clear();
  before_.clear();
  for (const Eigen::Vector2f& corner : input.corners_px) {
    const Vec2 guess = back.rotated(corner.cast<double>());
    corners_.emplace_back(corner.x(), corner.y());
    before_.emplace_back(cv::Point2d(guess.x(), guess.y()));
  }
  found_.assign(corners_.size(), 0);
  if (const auto* earlier = pyramids_.earlier(); earlier != nullptr && !corners_.empty()) {
    const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS,
                                 parameters_.max_iterations, parameters_.least_step_px);
    flow_.lucas_kanade(pyramids_.now(), *earlier, corners_, before_, found_, cv::noArray(), window,
                       parameters_.levels, until, cv::OPTFLOW_USE_INITIAL_FLOW,
                       parameters_.least_eigenvalue);
  }
  motions_.assign(corners_.size(), {});
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    if (!found_[i]) continue;
    motions_[i] =
        epipolar_motion(field, parameters_.residual_px, input.corners_px[i].cast<double>(),
                        field.rotated(Vec2(before_[i].x, before_[i].y)));
  }
  return groups_.group(input.corners_px, motions_, motion.dt_s);
}

DisDetector::DisDetector(const Intrinsics& camera, const DisParameters& parameters)
    : camera_(camera),
      parameters_(parameters),
      pictures_(parameters.baseline_s),
      flow_(sim::optical_flow().dis(cv::DISOpticalFlow::PRESET_MEDIUM)),
      groups_(parameters.groups) {}

const FrameResult& DisDetector::step(const bench::DetectorInput& input) {
  input.grey.copyTo(pictures_.begin(input.motion));
  const EgoMotion& motion = pictures_.motion();
  motions_.assign(input.corners_px.size(), {});
  if (const cv::Mat1b* earlier = pictures_.earlier(); earlier != nullptr) {
    cv::Matx33d rotation;
    cv::eigen2cv(rotation_homography(camera_, motion.R_cur_prev), rotation);
    cv::warpPerspective(*earlier, derotated_, rotation, earlier->size(), cv::INTER_LINEAR,
                        cv::BORDER_REPLICATE);
    flow_->calc(input.grey, derotated_, to_earlier_);

    const MotionField field = exact_field(camera_, motion);
    const MotionField back = exact_field(camera_, turned_back(motion));
    const Pixels picture{camera_.width_px, camera_.height_px};
    for (std::size_t i = 0; i < motions_.size(); ++i) {
      const Vec2 now = input.corners_px[i].cast<double>();
      if (!picture.contain(now)) continue;
      const cv::Vec2f step = to_earlier_(cvRound(now.y()), cvRound(now.x()));
      const Vec2 before = now + Vec2(step[0], step[1]);
      // Flow that leaves the earlier picture is lost.
      if (!picture.contain(back.rotated(before))) continue;
      motions_[i] = epipolar_motion(field, parameters_.residual_px, now, before);
    }
  }
  return groups_.group(input.corners_px, motions_, motion.dt_s);
}

}  // namespace lcs::comparators
