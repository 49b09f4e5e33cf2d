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
constexpr double kNothing_px = 1e-6;  // less is rounding
constexpr double kLargest_deg = 10;   // of the sweep of rotations
constexpr int kAxes[] = {1, 0, 2};    // as people name them: pan, tilt, roll

/// The row that a condition holds for.
template <class Row, class Condition>
const Row& the(const std::vector<Row>& rows, Condition condition) {
  const auto found = std::find_if(rows.begin(), rows.end(), condition);
  if (found == rows.end()) throw std::logic_error("an experiment lacks a row that is told of");
  return *found;
}

/// Three figures, of pan, tilt and roll, in a text.
template <class Value>
std::string each_axis(const Value& value, const char* unit) {
  std::string text;
  for (const int axis : kAxes) {
    text += fmt::format("{}{:.2g} {} of {}",
                        axis == 1   ? ""
                        : axis == 2 ? " and "
                                    : ", ",
                        value(axis), unit, axis_name(axis));
  }
  return text;
}

/// Of an error in px by the tolerance.
std::string judged(const Study& study, double error_px, const std::string& of) {
  return fmt::format("{}: {:.2g} px {}", error_px <= study.config.tolerance_px ? "yes" : "no",
                     error_px < kNothing_px ? 0 : error_px, of);
}

/// Of a rotation model on the configured drive, which is told exactly and knows all depths.
std::string on_own_drive(const Study& study, RotationModel rotation) {
  const DriveRow& row = the(study.drives, [&](const DriveRow& each) {
    return each.drive == "configured" && each.told == "truth" && each.model.rotation == rotation &&
           each.model.depth == DepthSource::truth;
  });
  return judged(study, row.error.p95_px, "(95 %) on the configured drive");
}

/// "2.1 deg a frame (63 deg/s)" of each axis at the scenario's frame rate.
std::string limits(const Study& study, const double (&limit_deg)[3]) {
  std::string text;
  for (const int axis : kAxes) {
    text += fmt::format("{}{:.2g} deg a frame ({:.2g} deg/s) of {}",
                        axis == 1   ? ""
                        : axis == 2 ? " and "
                                    : ", ",
                        limit_deg[axis], limit_deg[axis] * study.config.scenario.camera.rate_hz,
                        axis_name(axis));
  }
  return text;
}

std::string own_imu(const Study& study) {
  for (const NamedImu& imu : imus(study.config)) {
    if (imu.noise == study.config.scenario.imu.noise) return imu.name;
  }
  throw std::logic_error("the scenario's IMU was not tried");
}

Statement first_order(const Study& study, const PointSet& points) {
  const sim::Pinhole& camera = study.config.camera;
  Statement s{"rotation", "", {}};
  double limit_deg[3];
  for (const int axis : kAxes) {
    limit_deg[axis] =
        rotation_limit_rad(points, field_of(study.config.filter), RotationModel::first_order, axis,
                           study.config.tolerance_px) /
        kDegree;
    s.figures.push_back({fmt::format("first_order.limit.{}", axis_name(axis)), limit_deg[axis],
                         "deg",
                         first_order_limit_rad(camera, axis, study.config.tolerance_px) / kDegree});
  }
  s.text = fmt::format(
      "first order is within {:g} px all over the image up to {}, at {:g} frames/s and f = {:.0f} "
      "px; its error grows with the square of the angle",
      study.config.tolerance_px, limits(study, limit_deg), study.config.scenario.camera.rate_hz,
      camera.focal_px);
  s.verdict = on_own_drive(study, RotationModel::first_order);
  return s;
}

Statement homography(const Study& study) {
  double worst = 0;
  for (const RotationRow& row : study.rotation) {
    if (row.model.rotation == RotationModel::homography && row.step_m == 0) {
      worst = std::max(worst, row.error.max_px);
    }
  }
  return {
      "rotation",
      fmt::format("the homography is exact: within {:.0e} px up to {:g} deg, whatever the depth",
                  worst, kLargest_deg),
      {{"homography.worst", worst, "px", 0}},
      on_own_drive(study, RotationModel::homography)};
}

Statement as_printed(const Study& study, const PointSet& points) {
  Statement s{"rotation", "", {}};
  double limit_deg[3], kindest_deg[3];
  for (const int axis : kAxes) {
    const auto limit = [&](double told_sign) {
      return rotation_limit_rad(points, field_of(study.config.filter), RotationModel::as_printed,
                                axis, study.config.tolerance_px, told_sign) /
             kDegree;
    };
    limit_deg[axis] = limit(1);
    kindest_deg[axis] = std::max(limit(1), limit(-1));
    const auto expected = [&](double told_sign) {
      return printed_limit_rad(study.config.camera, axis, study.config.tolerance_px, told_sign) /
             kDegree;
    };
    s.figures.push_back(
        {fmt::format("as_printed.limit.{}", axis_name(axis)), limit_deg[axis], "deg", expected(1)});
    s.figures.push_back({fmt::format("as_printed.kindest_limit.{}", axis_name(axis)),
                         kindest_deg[axis], "deg", std::max(expected(1), expected(-1))});
  }
  s.text = fmt::format(
      "as printed the paper's rotation is within {:g} px only up to {} at {:g} frames/s, and with "
      "the sign of each rate that suits it best up to {} a frame: it is wrong at first order",
      study.config.tolerance_px, limits(study, limit_deg), study.config.scenario.camera.rate_hz,
      each_axis([&](int axis) { return kindest_deg[axis]; }, "deg"));
  s.verdict = on_own_drive(study, RotationModel::as_printed);
  return s;
}

Statement true_depth(const Study& study) {
  double worst = 0;
  for (const TranslationRow& row : study.translation) {
    if (row.depth == DepthSource::truth) worst = std::max(worst, row.error.max_px);
  }
  return {"translation",
          fmt::format("with the true depth the translation is exact: within {:.0e} px up to a step "
                      "of half the depth",
                      worst),
          {{"translation.truth.worst", worst, "px", 0}},
          judged(study, worst, "at the most")};
}

Statement depth_sources(const Study& study) {
  const auto of = [&](DepthSource depth) -> const DriveRow& {
    return the(study.drives, [&](const DriveRow& row) {
      return row.drive == "straight" && row.told == "truth" &&
             row.model.rotation == RotationModel::homography && row.model.depth == depth;
    });
  };
  const ErrorSummary &reference = of(DepthSource::reference).error,
                     &learnt = of(DepthSource::learnt).error, &truth = of(DepthSource::truth).error;
  return {"translation",
          fmt::format(
              "straight on at {:.2g} m/s, {:g} frames/s, rendered: V by the reference depth of "
              "{:g} m errs by {:.2g} px (95 %: {:.2g}), by the landmark's own V by {:.2g} px (95 "
              "%: {:.2g}), by the true depth by less than {:.0e} px",
              study.config.speed_mps, study.config.scenario.camera.rate_hz,
              field_of(study.config.filter).reference_depth_m, reference.median_px,
              reference.p95_px, learnt.median_px, learnt.p95_px, truth.max_px),
          {{"translation.reference.median", reference.median_px, "px",
            of(DepthSource::reference).expected_median_px},
           {"translation.reference.p95", reference.p95_px, "px", kUnknown},
           {"translation.learnt.median", learnt.median_px, "px", kUnknown},
           {"translation.learnt.p95", learnt.p95_px, "px", kUnknown}},
          judged(study, learnt.p95_px, "(95 %) by the landmark's own V")};
}

Statement imu_noise(const Study& study) {
  const std::string name = own_imu(study);
  const auto of = [&](bool odometry) -> const ImuRow& {
    return the(study.imu, [&](const ImuRow& row) {
      return row.imu == name && row.odometry == odometry &&
             row.rate_hz == study.config.scenario.camera.rate_hz;
    });
  };
  const ImuRow &alone = of(false), &held = of(true);
  const bool has_odometry = study.config.scenario.odometry.enabled;
  return {
      "IMU",
      fmt::format(
          "noise of {} costs {:.2g} px (root mean square) at {:g} frames/s, over {:g} s from a "
          "known start ({:.2g} expected); {:.2g} px with odometry ({:.2g}); {:.2g} px of it by the "
          "rotation ({:.2g})",
          name, alone.error.rms_px, alone.rate_hz, kImuDrive_s, alone.expected_rms_px,
          held.error.rms_px, held.expected_rms_px, alone.rotation_error.rms_px,
          alone.expected_rotation_rms_px),
      {{"imu.dead_reckoning.rms", alone.error.rms_px, "px", alone.expected_rms_px},
       {"imu.odometry.rms", held.error.rms_px, "px", held.expected_rms_px},
       {"imu.rotation.rms", alone.rotation_error.rms_px, "px", alone.expected_rotation_rms_px}},
      judged(study, (has_odometry ? held : alone).error.rms_px,
             has_odometry ? "with the scenario's odometry" : "without odometry")};
}

Statement mount(const Study& study, const PointSet& points) {
  const auto of = [&](int axis, double pan_deg) -> const MountRow& {
    return the(study.mount, [&](const MountRow& row) {
      return row.points == points.name && row.axis == axis && row.error_deg == 1 &&
             row.pan_deg == pan_deg;
    });
  };
  const Eigen::Vector3d step_C_m = study.config.step_C_m();
  Statement s{"mount", "", {}};
  for (const double pan_deg : {0.0, kMountPan_deg}) {
    const std::vector<Landmark> seen =
        landmarks(points, turned(1, pan_deg * kDegree, step_C_m), field_of(study.config.filter));
    for (const int axis : kAxes) {
      s.figures.push_back(
          {fmt::format("mount.{}{}.rms", pan_deg == 0 ? "" : "panning.", axis_name(axis)),
           of(axis, pan_deg).error.rms_px, "px",
           mount_rms_px(points.camera, seen, step_C_m, pan_deg * kDegree * Eigen::Vector3d::UnitY(),
                        axis, kDegree)});
    }
  }
  const MountRow& pan = of(1, 0);
  s.figures.push_back({"mount.foe_shift", pan.foe_shift_px, "px",
                       study.config.camera.focal_px * std::tan(kDegree)});
  const auto costs = [&](double pan_deg) {
    return each_axis(
        [&](int axis) {
          const double rms_px = of(axis, pan_deg).error.rms_px;
          return rms_px < kNothing_px ? 0 : rms_px;
        },
        "px");
  };
  s.text = fmt::format(
      "1 deg off costs {} (root mean square) at {:.2g} m a frame ({:g} frames/s) and depths from 1 "
      "m "
      "to 16 m; {} where the camera also pans by {:g} deg a frame; it moves the focus of expansion "
      "by {:.2g} px",
      costs(0), step_C_m.norm(), study.config.scenario.camera.rate_hz, costs(kMountPan_deg),
      kMountPan_deg, pan.foe_shift_px);
  double worst_px = 0;
  for (const int axis : kAxes) {
    worst_px = std::max({worst_px, of(axis, 0).error.rms_px, of(axis, kMountPan_deg).error.rms_px});
  }
  s.verdict = judged(study, worst_px, "for 1 deg about the worst axis");
  return s;
}

Statement bumps(const Study& study) {
  constexpr double kRough_m = 5e-3;
  const auto of = [&](std::string_view rotation, std::string_view told) -> const BumpRow& {
    return the(study.bumps, [&](const BumpRow& row) {
      return row.roughness_m == kRough_m && row.rotation == rotation && row.told == told;
    });
  };
  const BumpRow &none = of("none", "truth"), &first = of("first_order", "truth"),
                &exact = of("homography", "truth"), &imu = of("homography", "imu");
  return {"bumps",
          fmt::format(
              "rolling over bumps of {:g} mm turns the camera by up to {:.2g} deg a frame (95 "
              "%: {:.2g}) at {:g} frames/s; left in, that costs {:.2g} px (root mean square), "
              "first order leaves {:.1g} px, the homography {:.0e} px, told by the IMU {:.2g} px",
              1e3 * kRough_m, none.turn_max_deg, none.turn_p95_deg,
              study.config.scenario.camera.rate_hz, none.error.rms_px, first.error.rms_px,
              exact.error.rms_px, imu.error.rms_px),
          {{"bumps.turn.p95", none.turn_p95_deg, "deg", kUnknown},
           {"bumps.none.rms", none.error.rms_px, "px", none.expected_rms_px},
           {"bumps.first_order.rms", first.error.rms_px, "px", first.expected_rms_px},
           {"bumps.homography.rms", exact.error.rms_px, "px", 0},
           {"bumps.imu.rms", imu.error.rms_px, "px", kUnknown}},
          judged(study, imu.error.rms_px, "told by the IMU")};
}

/// Until when the velocity costs no more than the tolerance, at the reference depth.
std::string drift_verdict(const Study& study, const std::string& name) {
  const StudyConfig& config = study.config;
  const bool odometry = config.scenario.odometry.enabled;
  const double px_for_mps =
      config.camera.focal_px * config.frame_s() / field_of(config.filter).reference_depth_m;
  double until_s = 0, end_s = 0;
  bool is_over = false;
  for (const DriftRow& row : study.drift) {
    if (row.imu != name || row.odometry != odometry) continue;
    end_s = std::max(end_s, row.t_s);
    is_over |= px_for_mps * std::max(row.lateral_mps, row.vertical_mps) > config.tolerance_px;
    if (!is_over) until_s = row.t_s;
  }
  return fmt::format("{}: {} {:g} s by the velocity {} odometry, at {:g} m", is_over ? "no" : "yes",
                     is_over ? "for" : "for all", is_over ? until_s : end_s,
                     odometry ? "with the scenario's" : "without",
                     field_of(config.filter).reference_depth_m);
}

/// Of one IMU at the end of the drive.
Statement drift(const Study& study, const std::string& name) {
  const auto of = [&](bool odometry) -> const DriftRow& {
    return the(study.drift, [&](const DriftRow& row) {
      return row.imu == name && row.odometry == odometry &&
             row.t_s >= std::floor(study.config.effort.drift_s);
    });
  };
  const DriftRow &alone = of(false), &held = of(true);
  const auto figure = [&](const char* what, double value, const char* unit, double expected) {
    return Figure{fmt::format("drift.{}.{}", name, what), value, unit, expected};
  };
  return {"drift",
          fmt::format("{} after {:g} s: velocity off by {:.2g} m/s ({:.2g} expected), attitude by "
                      "{:.2g} deg ({:.2g}); with odometry {:.2g} m/s ahead ({:.2g}), {:.2g} aside "
                      "({:.2g}), tilt {:.2g} deg, heading {:.2g} deg",
                      name, alone.t_s, alone.forward_mps, alone.expected_forward_mps,
                      alone.tilt_rad / kDegree, alone.expected_tilt_rad / kDegree, held.forward_mps,
                      held.expected_forward_mps, held.lateral_mps, held.expected_lateral_mps,
                      held.tilt_rad / kDegree, held.heading_rad / kDegree),
          {figure("forward", alone.forward_mps, "m/s", alone.expected_forward_mps),
           figure("lateral", alone.lateral_mps, "m/s", alone.expected_lateral_mps),
           figure("vertical", alone.vertical_mps, "m/s", alone.expected_vertical_mps),
           figure("tilt", alone.tilt_rad, "rad", alone.expected_tilt_rad),
           figure("heading", alone.heading_rad, "rad", alone.expected_heading_rad),
           figure("odometry.forward", held.forward_mps, "m/s", held.expected_forward_mps),
           figure("odometry.lateral", held.lateral_mps, "m/s", held.expected_lateral_mps),
           figure("odometry.vertical", held.vertical_mps, "m/s", held.expected_vertical_mps),
           figure("odometry.tilt", held.tilt_rad, "rad", held.expected_tilt_rad),
           figure("odometry.heading", held.heading_rad, "rad", held.expected_heading_rad)},
          drift_verdict(study, name)};
}

}  // namespace

std::vector<Statement> answer(const Study& study) {
  const PointSet points = study_points(study.config.camera);
  std::vector<Statement> all = {
      first_order(study, points), homography(study), as_printed(study, points), true_depth(study),
      depth_sources(study),       imu_noise(study),  mount(study, points),      bumps(study)};
  std::vector<NamedImu> others = imus(study.config);
  std::ranges::stable_partition(
      others, [&, own = own_imu(study)](const NamedImu& imu) { return imu.name == own; });
  for (const NamedImu& imu : others) all.push_back(drift(study, imu.name));
  // a topic's own is its first statement, but of rotations the filter's, and of depths the learnt
  // one
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
  std::string within, beyond;
  for (const Statement& s : statements) {
    if (!s.is_own) continue;
    const std::size_t colon = s.verdict.find(':');
    const bool holds = s.verdict.starts_with("yes");
    std::string& list = holds ? within : beyond;
    list += (list.empty() ? "" : ", ") + s.topic;
    if (!holds) list += fmt::format(" ({})", s.verdict.substr(colon + 2));
  }
  return fmt::format("within {:g} px: {}; beyond: {}", config.tolerance_px,
                     within.empty() ? "nothing" : within, beyond.empty() ? "nothing" : beyond);
}

std::string text_of(const StudyConfig& config, const std::vector<Statement>& statements) {
  std::string text = fmt::format("{}\n{}\n\n", subject(config), bottom_line(config, statements));
  std::string topic;
  for (const Statement& s : statements) {
    text += fmt::format("  {:<12} {}\n", s.topic == topic ? "" : s.topic, s.text);
    if (!s.verdict.empty()) {
      text += fmt::format("  {:<12} within {:g} px? {}\n", "", config.tolerance_px, s.verdict);
    }
    topic = s.topic;
  }
  return text;
}

}  // namespace lcs::kinematics
