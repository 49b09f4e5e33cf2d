/// \file
/// The nine models that are compared with the truth: three rotations, each with three sources of a
/// landmark's depth. All of them are the filter's code (`filter/kinematics/motion_field.h`).
///
/// A landmark is a static point, seen in frame k-1 and again in frame k. Pixels and frames are
/// those of `filter/kinematics/camera.h`.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "filter/kinematics/motion_field.h"

namespace lcs::kinematics {

/// Source of the ratio Z_ref / Z, and so of the image speed V = V_v Z_ref / Z.
enum class DepthSource {
  reference,  ///< none: V = V_v, as if all points were at Z_ref
  learnt,     ///< the landmark's own motion up to frame k-1
  truth,      ///< the true depth
};

struct Model {
  RotationModel rotation = RotationModel::homography;
  DepthSource depth = DepthSource::truth;
};

inline constexpr std::array kRotations = {RotationModel::as_printed, RotationModel::first_order,
                                          RotationModel::homography};
inline constexpr std::array kDepths = {DepthSource::reference, DepthSource::learnt,
                                       DepthSource::truth};

std::string_view name(RotationModel rotation);
std::string_view name(DepthSource depth);

struct Landmark {
  Vec2 before_px = Vec2::Zero();  ///< in frame k-1
  Vec2 after_px = Vec2::Zero();   ///< in frame k: the truth
  double depth_before_m = 0;
  double depth_after_m = 0;
  double learnt_ratio = 1;  ///< Z_ref / Z in frame k-1, estimated from the earlier motion
};

/// The camera, its motion as given to the model, and the filter's parameters of the field.
struct Step {
  Intrinsics camera;
  EgoMotion motion;
  FieldParameters field;
};

/// Predicts one step with one model.
class Predictor {
 public:
  Predictor(const Step& step, const Model& model);

  Vec2 operator()(const Landmark& landmark) const;

  /// End-point error, px.
  double error(const Landmark& landmark) const {
    return ((*this)(landmark)-landmark.after_px).norm();
  }

 private:
  MotionField field_;
  DepthSource depth_;
};

/// End-point errors, px. Without points all figures are 0.
struct ErrorSummary {
  std::size_t count = 0;
  double median_px = 0;
  double p95_px = 0;
  double max_px = 0;
  double rms_px = 0;
};
ErrorSummary summary(std::vector<double> errors_px);

template <class Value>
void append(std::vector<Value>& all, const std::vector<Value>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Errors of one model on landmarks that share a step.
std::vector<double> errors(const Step& step, const Model& model,
                           const std::vector<Landmark>& landmarks);

}  // namespace lcs::kinematics
