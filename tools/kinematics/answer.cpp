#include "tools/kinematics/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tools/kinematics/theory.h"

namespace lcs::kinematics {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding_px = 1e-6;  // a smaller error comes from rounding alone
constexpr double kLeastTurn_px = 0.1;  // of the picture in a frame; less is no turn
constexpr double kLargest_deg = 10;    // of the sweep of rotations
constexpr int kAxes[] = {1, 0, 2};     // pan, tilt, roll

/// The first row for which the condition is true.
template <class Row, class Condition>
const Row& row_where(const std::vector<Row>& rows, Condition condition) {
  const auto found = std::ranges::find_if(rows, condition);
  if (found == rows.end()) throw std::logic_error("an experiment lacks a row of the answer");
  return *found;
}

std::string verdict_on(const Study& study, double error_px, const std::string& of) {
  return fmt::format("{}: {:.2g} px {}", error_px <= study.config.tolerance_px ? "yes" : "no",
                     error_px < kRounding_px ? 0 : error_px, of);
}

const DriveRow& drive_row(const Study& study, std::string_view drive, const FieldModel& model) {
  return row_where(study.drives, [&](const DriveRow& row) {
    return row.drive == drive && row.told == "truth" && row.model.rotation == model.rotation &&
           row.model.depth == model.depth;
  });
}

std::string verdict_on_rotation(const Study& study, RotationModel rotation) {
  const DriveRow& row = drive_row(study, "configured", {rotation, DepthSource::truth});
  if (row.turn_max_rad * study.config.camera.focal_px < kLeastTurn_px) {
    return "untried: this drive does not turn";
  }
  return verdict_on(study, row.error.p95_px, "(95 %) on the configured drive");
}

std::string rate_of(const Study& study) {
  return fmt::format("{:g} frames/s", study.config.scenario.camera.rate_hz);
}

Statement first_order(const Study& study, const PointSet& points) {
  const StudyConfig& config = study.config;
  Statement s{
      "rotation",
      fmt::format(
          "first order: the largest turn in a frame with an error within {:g} px at all points",
          config.tolerance_px),
      {},
      verdict_on_rotation(study, RotationModel::first_order)};
  for (const int axis : kAxes) {
    const double limit_rad = rotation_limit_rad(
        points, field_of(config.filter), RotationModel::first_order, axis, config.tolerance_px);
    s.figures.push_back(
        {fmt::format("first_order.limit.{}", axis_name(axis)), limit_rad / kDegree, "deg",
         first_order_limit_rad(config.camera, axis, config.tolerance_px) / kDegree});
  }
  return s;
}

Statement homography(const Study& study) {
  double worst_px = 0;
  for (const RotationRow& row : study.rotation) {
    if (row.model.rotation == RotationModel::homography && row.step_m == 0) {
      worst_px = std::max(worst_px, row.error.max_px);
    }
  }
  return {"rotation",
          fmt::format("homography: the largest error of turns up to {:g} deg", kLargest_deg),
          {{"homography.worst", worst_px, "px", 0}},
          verdict_on_rotation(study, RotationModel::homography)};
}

Statement as_printed(const Study& study, const PointSet& points) {
  const StudyConfig& config = study.config;
  Statement s{
      "rotation",
      fmt::format("as printed in the paper: the largest turn in a frame with an error within {:g} "
                  "px at all points; \"kindest\" with the better of both signs of the rate",
                  config.tolerance_px),
      {},
      verdict_on_rotation(study, RotationModel::as_printed)};
  for (const int axis : kAxes) {
    const auto limit_deg = [&](double told_sign) {
      return rotation_limit_rad(points, field_of(config.filter), RotationModel::as_printed, axis,
                                config.tolerance_px, told_sign) /
             kDegree;
    };
    const auto expected_deg = [&](double told_sign) {
      return printed_limit_rad(config.camera, axis, config.tolerance_px, told_sign) / kDegree;
    };
    s.figures.push_back({fmt::format("as_printed.limit.{}", axis_name(axis)), limit_deg(1), "deg",
                         expected_deg(1)});
    s.figures.push_back({fmt::format("as_printed.kindest_limit.{}", axis_name(axis)),
                         std::max(limit_deg(1), limit_deg(-1)), "deg",
                         std::max(expected_deg(1), expected_deg(-1))});
  }
  return s;
}

Statement true_depth(const Study& study) {
  double worst_px = 0;
  for (const TranslationRow& row : study.translation) {
    if (row.depth == DepthSource::truth) worst_px = std::max(worst_px, row.error.max_px);
  }
  return {"translation",
          "true depth: the largest error of steps up to half the depth",
          {{"translation.truth.worst", worst_px, "px", 0}},
          verdict_on(study, worst_px, "at the most")};
}

Statement depth_sources(const Study& study) {
  const StudyConfig& config = study.config;
  const auto of = [&](DepthSource depth) -> const DriveRow& {
    return drive_row(study, "straight", {RotationModel::homography, depth});
  };
  const DriveRow &reference = of(DepthSource::reference), &learnt = of(DepthSource::learnt);
  return {"translation",
          fmt::format("rendered, straight on at {:.2g} m/s, {}: V by the reference depth of {:g} "
                      "m, and by the landmark's own V",
                      config.speed_mps, rate_of(study), field_of(config.filter).reference_depth_m),
          {{"translation.reference.median", reference.error.median_px, "px",
            reference.expected_median_px},
           {"translation.reference.p95", reference.error.p95_px, "px", kUnknown},
           {"translation.learnt.median", learnt.error.median_px, "px", kUnknown},
           {"translation.learnt.p95", learnt.error.p95_px, "px", kUnknown}},
          verdict_on(study, learnt.error.p95_px, "(95 %) by the landmark's own V")};
}

Statement imu_noise(const Study& study) {
  const scenario::Scenario& scenario = study.config.scenario;
  const std::string name = imus(study.config).front().name;
  const auto of = [&](bool odometry) -> const ImuRow& {
    return row_where(study.imu, [&](const ImuRow& row) {
      return row.imu == name && row.odometry == odometry && row.rate_hz == scenario.camera.rate_hz;
    });
  };
  const ImuRow &alone = of(false), &held = of(true);
  const bool has_odometry = scenario.odometry.enabled;
  return {"IMU",
          fmt::format("{} at {}, over {:g} s from a known start: without odometry, with odometry, "
                      "and the part of the rotation",
                      name, rate_of(study), kImuDrive_s),
          {{"imu.dead_reckoning.rms", alone.error.rms_px, "px", alone.expected_rms_px},
           {"imu.odometry.rms", held.error.rms_px, "px", held.expected_rms_px},
           {"imu.rotation.rms", alone.rotation_error.rms_px, "px", alone.expected_rotation_rms_px}},
          verdict_on(study, (has_odometry ? held : alone).error.rms_px,
                     has_odometry ? "with the scenario's odometry" : "without odometry")};
}

Statement mount(const Study& study, const PointSet& points) {
  const auto of = [&](int axis, double pan_deg) -> const MountRow& {
    return row_where(study.mount, [&](const MountRow& row) {
      return row.points == points.name && row.axis == axis && row.error_deg == 1 &&
             row.pan_deg == pan_deg;
    });
  };
  const Eigen::Vector3d step_C_m = study.config.step_C_m();
  Statement s{"mount",
              fmt::format("1 deg off, {:.2g} m a frame ({}), points at 1 m to 16 m: straight on, "
                          "panning by {:g} deg a frame, and the shift of the focus of expansion",
                          step_C_m.norm(), rate_of(study), kMountPan_deg),
              {},
              ""};
  double worst_px = 0;
  for (const double pan_deg : {0.0, kMountPan_deg}) {
    const std::vector<Landmark> seen =
        landmarks(points, turned(1, pan_deg * kDegree, step_C_m), field_of(study.config.filter));
    for (const int axis : kAxes) {
      const double rms_px = of(axis, pan_deg).error.rms_px;
      worst_px = std::max(worst_px, rms_px);
      s.figures.push_back(
          {fmt::format("mount.{}{}.rms", pan_deg == 0 ? "" : "panning.", axis_name(axis)), rms_px,
           "px",
           mount_rms_px(points.camera, seen, step_C_m, pan_deg * kDegree * Eigen::Vector3d::UnitY(),
                        axis, kDegree)});
    }
  }
  s.figures.push_back({"mount.foe_shift", of(1, 0).foe_shift_px, "px",
                       study.config.camera.focal_px * std::tan(kDegree)});
  s.verdict = verdict_on(study, worst_px, "for 1 deg about the worst axis");
  return s;
}

Statement bumps(const Study& study) {
  constexpr double kRough_m = 5e-3;
  const auto of = [&](std::string_view rotation, std::string_view told) -> const BumpRow& {
    return row_where(study.bumps, [&](const BumpRow& row) {
      return row.roughness_m == kRough_m && row.rotation == rotation && row.told == told;
    });
  };
  const BumpRow &none = of("none", "truth"), &first = of("first_order", "truth"),
                &exact = of("homography", "truth"), &imu = of("homography", "imu");
  return {"bumps",
          fmt::format("wheels on bumps of {:g} mm, {}: the turn in a frame, and the error with the "
                      "rotation left in, by first order, by the homography, and told by the IMU",
                      1e3 * kRough_m, rate_of(study)),
          {{"bumps.turn.p95", none.turn_p95_deg, "deg", kUnknown},
           {"bumps.none.rms", none.error.rms_px, "px", none.expected_rms_px},
           {"bumps.first_order.rms", first.error.rms_px, "px", first.expected_rms_px},
           {"bumps.homography.rms", exact.error.rms_px, "px", 0},
           {"bumps.imu.rms", imu.error.rms_px, "px", kUnknown}},
          verdict_on(study, imu.error.rms_px, "told by the IMU")};
}

/// The time until which the velocity error stays within the tolerance, at the reference depth.
std::string verdict_on_drift(const Study& study, const std::string& imu) {
  const StudyConfig& config = study.config;
  const bool odometry = config.scenario.odometry.enabled;
  const double px_for_mps =
      config.camera.focal_px * config.frame_s() / field_of(config.filter).reference_depth_m;
  double until_s = 0;
  bool is_over = false;
  for (const DriftRow& row : study.drift) {
    if (row.imu != imu || row.odometry != odometry || is_over) continue;
    is_over = px_for_mps * std::max(row.rms.velocity_B_mps.y(), row.rms.velocity_B_mps.z()) >
              config.tolerance_px;
    if (!is_over) until_s = row.t_s;
  }
  return fmt::format("{} {:g} s by the velocity {} odometry, at {:g} m",
                     is_over ? "no: for" : "yes: for all", until_s,
                     odometry ? "with the scenario's" : "without",
                     field_of(config.filter).reference_depth_m);
}

/// The statement on one IMU at the end of the drive.
Statement drift(const Study& study, const std::string& imu) {
  const double end_s = std::floor(study.config.effort.drift_s);
  Statement s{"drift",
              fmt::format("{} after {:g} s: velocity, tilt and heading, without and with odometry",
                          imu, end_s),
              {},
              verdict_on_drift(study, imu)};
  for (const bool odometry : {false, true}) {
    const DriftRow& row = row_where(study.drift, [&](const DriftRow& each) {
      return each.imu == imu && each.odometry == odometry && each.t_s >= end_s;
    });
    const auto add = [&](const char* what, double rms, const char* unit, double expected) {
      s.figures.push_back({fmt::format("drift.{}.{}{}", imu, odometry ? "odometry." : "", what),
                           rms, unit, expected});
    };
    const Eigen::Vector3d &v = row.rms.velocity_B_mps, &v_expected = row.expected.velocity_B_mps;
    add("forward", v.x(), "m/s", v_expected.x());
    add("lateral", v.y(), "m/s", v_expected.y());
    add("vertical", v.z(), "m/s", v_expected.z());
    add("tilt", row.rms.tilt_rad, "rad", row.expected.tilt_rad);
    add("heading", row.rms.heading_rad, "rad", row.expected.heading_rad);
  }
  return s;
}

/// The cost of each property of a real camera that the model of a pinhole in an instant leaves out.
Statement real_camera(const Study& study) {
  const LeftOut& left_out = study.left_out;
  const double worst_px =
      std::max({left_out.distortion_px, left_out.readout_px, left_out.offset_px});
  return {"camera",
          fmt::format("configured drive: error (95 %) of points at 1 m to 16 m if the distortion, "
                      "a readout of {:g} ms, or an offset of the clocks of {:g} ms is left in",
                      1e3 * left_out.readout_s, 1e3 * left_out.offset_s),
          {{"camera.distortion.p95", left_out.distortion_px, "px", kUnknown},
           {"camera.rolling_shutter.p95", left_out.readout_px, "px", left_out.expected_readout_px},
           {"camera.time_offset.p95", left_out.offset_px, "px", left_out.expected_offset_px}},
          verdict_on(study, worst_px, "for the worst of them")};
}

}  // namespace

std::vector<Statement> answer(const Study& study) {
  const PointSet points = study_points(study.config.camera);
  std::vector<Statement> all = {
      first_order(study, points), homography(study), as_printed(study, points), true_depth(study),
      depth_sources(study),       imu_noise(study),  mount(study, points),      bumps(study)};
  for (const NamedImu& imu : imus(study.config)) all.push_back(drift(study, imu.name));
  all.push_back(real_camera(study));
  // The filter's rotation, the learnt depth, and the first statement of each other topic.
  const bool is_exact = field_of(study.config.filter).rotation == RotationModel::homography;
  for (const std::size_t own : {is_exact ? 1U : 0U, 4U, 5U, 6U, 7U, 8U}) all[own].is_own = true;
  return all;
}

std::string subject(const StudyConfig& config) {
  const scenario::Scenario& s = config.scenario;
  return fmt::format("{}: {}x{}, f = {:.1f} px, {:g} frames/s, {:.2g} m/s{}, IMU {} at {:g} Hz",
                     s.name, s.camera.width_px, s.camera.height_px, config.camera.focal_px,
                     s.camera.rate_hz, config.speed_mps,
                     config.stands ? " (in place of standing)" : "", s.imu.preset, s.imu.rate_hz);
}

std::string bottom_line(const StudyConfig& config, const std::vector<Statement>& statements) {
  std::string within, beyond, untried;
  for (const Statement& s : statements) {
    if (!s.is_own) continue;
    const bool holds = s.verdict.starts_with("yes");
    std::string& list = holds ? within : s.verdict.starts_with("untried") ? untried : beyond;
    list += (list.empty() ? "" : ", ") + s.topic;
    if (!holds) list += fmt::format(" ({})", s.verdict.substr(s.verdict.find(':') + 2));
  }
  return fmt::format("within {:g} px: {}; beyond: {}{}", config.tolerance_px,
                     within.empty() ? "nothing" : within, beyond.empty() ? "nothing" : beyond,
                     untried.empty() ? "" : "; untried: " + untried);
}

std::string text_of(const StudyConfig& config, const std::vector<Statement>& statements) {
  std::string text = fmt::format("{}\n{}\n", subject(config), bottom_line(config, statements));
  for (const Statement& s : statements) {
    text += fmt::format("\n{}, {}\n", s.topic, s.text);
    for (const Figure& f : s.figures) {
      const std::string expected =
          std::isnan(f.expected) ? "" : fmt::format(", expected {:.3g}", f.expected);
      text += fmt::format("  {:<32}{:>10.3g} {}{}\n", f.name, f.value, f.unit, expected);
    }
    text += fmt::format("  within {:g} px? {}\n", config.tolerance_px, s.verdict);
  }
  return text;
}

}  // namespace lcs::kinematics
