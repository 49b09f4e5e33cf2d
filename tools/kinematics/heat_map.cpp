#include "tools/kinematics/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/kinematics/sweeps.h"

namespace lcs::kinematics {
namespace {

constexpr int kColumns = 32;
constexpr double kFirstOrder_deg = 5, kPrinted_deg = 1, kMount_deg = 1;

int rows_of(const sim::Pinhole& camera) {
  return std::max(2, kColumns * camera.height_px / camera.width_px);
}

/// Errors of a model at the middle of each cell, at one depth.
HeatMap map_of(const StudyConfig& config, const std::string& name, const sim::Pose& T_CN,
               const EgoMotion& told, const Model& model, double depth_m) {
  const sim::Pinhole& camera = config.camera;
  HeatMap map{name, kColumns, rows_of(camera), {}};
  const PointSet points = geometric_points(camera, std::array{depth_m}, map.columns, map.rows);
  map.errors_px.assign(points.sites.size(), std::nan(""));
  const Step step{step_to(camera, {}, 1, field_of(config.filter)).camera, told,
                  field_of(config.filter)};
  const Predictor predictor(step, model);
  for (const Landmark& landmark : landmarks(points, T_CN, field_of(config.filter))) {
    const auto site = std::find_if(points.sites.begin(), points.sites.end(),
                                   [&](const Site& s) { return s.px == landmark.before_px; });
    map.errors_px[static_cast<std::size_t>(site - points.sites.begin())] =
        predictor.error(landmark);
  }
  return map;
}

}  // namespace

std::vector<HeatMap> geometric_heat_maps(const StudyConfig& config) {
  const double reference_m = field_of(config.filter).reference_depth_m;
  std::vector<HeatMap> maps;
  const auto exact = [&](const sim::Pose& T_CN) {
    return step_to(config.camera, T_CN, config.frame_s(), field_of(config.filter)).motion;
  };
  const auto turns = [&](RotationModel rotation, std::string_view model, double angle_deg) {
    for (int axis = 0; axis < 3; ++axis) {
      const sim::Pose T_CN = turned(axis, angle_deg * kDegree);
      maps.push_back(map_of(config,
                            fmt::format("{}, {} {:g} deg", model, axis_name(axis), angle_deg), T_CN,
                            exact(T_CN), {rotation, DepthSource::truth}, reference_m));
    }
  };
  turns(RotationModel::first_order, "first order", kFirstOrder_deg);
  turns(RotationModel::as_printed, "as printed", kPrinted_deg);
  const sim::Pose forward{Eigen::Matrix3d::Identity(), config.step_C_m()};
  for (const double depth_m : {0.5 * reference_m, 4 * reference_m}) {
    maps.push_back(map_of(config, fmt::format("reference depth, points at {:g} m", depth_m),
                          forward, exact(forward),
                          {RotationModel::homography, DepthSource::reference}, depth_m));
  }
  maps.push_back(map_of(
      config, fmt::format("mount {:g} deg off in pan, points at {:g} m", kMount_deg, reference_m),
      forward, seen_by_wrong_mount(exact(forward), turned(1, kMount_deg * kDegree).R), {},
      reference_m));
  return maps;
}

HeatMap heat_map_of(const std::string& name, const sim::Pinhole& camera,
                    const std::vector<ErrorAt>& errors) {
  HeatMap map{name, kColumns / 2, rows_of(camera) / 2, {}};
  std::vector<double> sums(static_cast<std::size_t>(map.columns * map.rows));
  std::vector<int> counts(sums.size());
  for (const ErrorAt& at : errors) {
    const int column = std::clamp(
        static_cast<int>((at.px.x() + 0.5) * map.columns / camera.width_px), 0, map.columns - 1);
    const int row = std::clamp(static_cast<int>((at.px.y() + 0.5) * map.rows / camera.height_px), 0,
                               map.rows - 1);
    const int cell = row * map.columns + column;
    sums[static_cast<std::size_t>(cell)] += at.error_px;
    ++counts[static_cast<std::size_t>(cell)];
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    map.errors_px.push_back(counts[i] > 0 ? sums[i] / counts[i] : std::nan(""));
  }
  return map;
}

}  // namespace lcs::kinematics
