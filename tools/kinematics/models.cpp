#include "tools/kinematics/points.h"

#include <cmath>

#include "tools/scoring/statistics.h"

namespace lcs::kinematics {
namespace {

FieldParameters with_rotation(FieldParameters field, RotationModel rotation) {
  field.rotation = rotation;
  return field;
}

}  // namespace

std::string_view name(RotationModel rotation) {
  return rotation == RotationModel::as_printed    ? "as_printed"
         : rotation == RotationModel::first_order ? "first_order"
                                                  : "homography";
}

std::string_view name(DepthSource depth) {
  return depth == DepthSource::reference ? "reference"
         : depth == DepthSource::learnt  ? "learnt"
                                         : "truth";
}

Predictor::Predictor(const Step& step, const Model& model)
    : field_(step.camera, step.motion, with_rotation(step.field, model.rotation)),
      depth_(model.depth) {}

Vec2 Predictor::operator()(const Landmark& landmark) const {
  // The field takes the ratio at the end of the interval; the learnt one is from its start.
  const double ratio = depth_ == DepthSource::reference ? 1
                       : depth_ == DepthSource::learnt
                           ? field_.advanced_ratio(landmark.learnt_ratio)
                           : field_.reference_depth_m() / landmark.depth_after_m;
  return field_.translated(field_.rotated(landmark.before_px), ratio);
}

ErrorSummary summary(std::vector<double> errors_px) {
  if (errors_px.empty()) return {};
  double squares = 0;
  for (const double error : errors_px) squares += error * error;
  ErrorSummary result;
  result.count = errors_px.size();
  result.rms_px = std::sqrt(squares / static_cast<double>(errors_px.size()));
  result.median_px = *bench::median(errors_px);
  result.p95_px = *bench::quantile(errors_px, 0.95);
  result.max_px = *std::ranges::max_element(errors_px);
  return result;
}

std::vector<double> errors(const Step& step, const Model& model,
                           const std::vector<Landmark>& landmarks) {
  const Predictor predictor(step, model);
  std::vector<double> all;
  all.reserve(landmarks.size());
  for (const Landmark& landmark : landmarks) all.push_back(predictor.error(landmark));
  return all;
}

}  // namespace lcs::kinematics
