#include "tools/comparators/flow_detectors.h"

#include <Eigen/Core>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/pictures/media.h"

namespace lcs::comparators {

KltDetector::KltDetector(const Intrinsics& camera, const KltParameters& parameters)
    : camera_(camera),
      parameters_(parameters),
      flow_(parameters.flow),
      groups_(parameters.groups) {}

const FrameResult& KltDetector::step(const bench::DetectorInput& input) {
  const EgoMotion& motion = flow_.advance(input.grey, input.motion);
  const MotionField field = exact_field(camera_, motion);
  const MotionField back = exact_field(camera_, turned_back(motion));

  guesses_.clear();
  for (const Eigen::Vector2f& corner : input.corners_px) {
    guesses_.push_back(back.rotated(corner.cast<double>()));
  }
  const auto tracked = flow_.track(input.corners_px, guesses_);

  motions_.assign(input.corners_px.size(), {});
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    if (!tracked[i]) continue;
    motions_[i] = epipolar_motion(field, parameters_.residual_px,
                                  input.corners_px[i].cast<double>(), field.rotated(*tracked[i]));
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
