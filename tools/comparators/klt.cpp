#include "tools/comparators/klt.h"

#include <algorithm>
#include <stdexcept>

#include "filter/geometry.h"

namespace lcs::comparators {
namespace {

/// The exact rotation, and depth ratios that are inverse depths, 1/m.
FieldParameters field_parameters(double nearest_depth_m) {
  FieldParameters parameters;
  parameters.rotation = RotationModel::homography;
  parameters.reference_depth_m = 1;
  parameters.nearest_depth_m = nearest_depth_m;
  return parameters;
}

EgoMotion turned_back(const EgoMotion& motion) {
  EgoMotion back;
  back.dt_s = motion.dt_s;
  back.R_cur_prev = motion.R_cur_prev.transpose();
  return back;
}

}  // namespace

double epipolar_distance(const MotionField& field, double nearest_depth_m, const Vec2& now_px,
                         const Vec2& before_px) {
  const Eigen::Vector3d displacement_C_m = field.displacement_C_m();
  // The nearest depth holds in both frames: in reverse, a point was nearer in the last one.
  const double nearest_now_m = nearest_depth_m + std::max(0.0, -displacement_C_m.z());
  const double ratio = field.reference_depth_m() / nearest_now_m;
  return distance_to_segment(before_px, now_px, field.earlier(now_px, ratio, displacement_C_m));
}

KltTracker::KltTracker(const sim::Pinhole& camera, const KltParameters& parameters)
    : camera_(bench::intrinsics(camera)),
      parameters_(parameters),
      flow_(parameters.flow),
      groups_(parameters.groups) {
  if (!(parameters.nearest_depth_m > 0)) {
    throw std::invalid_argument("the nearest depth of a static point must be above 0");
  }
}

const FrameResult& KltTracker::step(const bench::TrackerInput& input) {
  const FieldParameters exact = field_parameters(parameters_.nearest_depth_m);
  const MotionField field(camera_, input.motion, exact);
  const MotionField back(camera_, turned_back(input.motion), exact);

  guesses_.clear();
  for (const Eigen::Vector2f& corner : input.corners_px) {
    guesses_.push_back(back.rotated(corner.cast<double>()));
  }
  const auto tracked = flow_.track(input.grey, input.corners_px, guesses_);

  motions_.assign(input.corners_px.size(), {});
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    if (!tracked[i]) continue;
    const Vec2 now = input.corners_px[i].cast<double>();
    const Vec2 before = field.rotated(*tracked[i]);
    CornerMotion& motion = motions_[i];
    motion.known = true;
    motion.step_px = now - before;
    motion.off = epipolar_distance(field, parameters_.nearest_depth_m, now, before) >
                 parameters_.residual_px;
  }
  return groups_.group(input.corners_px, motions_, input.motion.dt_s);
}

}  // namespace lcs::comparators
