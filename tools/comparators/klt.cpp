#include "tools/comparators/klt.h"

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

}  // namespace lcs::comparators
