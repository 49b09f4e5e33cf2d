#include "tools/kinematics/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <tuple>

#include "tools/files/json_node.h"
#include "tools/files/output_file.h"
#include "tools/kinematics/theory.h"
#include "tools/report/page_writer.h"

namespace lcs::kinematics {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding_px = 1e-6;  // a smaller error comes from rounding alone
constexpr double kLeastTurn_px = 0.1;  // of the picture in a frame; less is no turn
constexpr double kLargest_deg = 10;    // of the sweep of rotations
constexpr int kAxes[] = {1, 0, 2};     // pan, tilt, roll

/// The largest of the figures; 0 without any above.
double worst_of(const std::vector<double>& figures) {
  return std::accumulate(figures.begin(), figures.end(), 0.0,
                         [](double a, double b) { return std::max(a, b); });
}

std::string verdict_on(const Study& study, double error_px, const std::string& of) {
  return fmt::format("{}: {:.2g} px {}", error_px <= study.config.tolerance_px ? "yes" : "no",
                     error_px < kRounding_px ? 0 : error_px, of);
}

std::string verdict_on_rotation(const Study& study, RotationModel rotation) {
  if (study.turn_max_rad * study.config.camera.focal_px < kLeastTurn_px) {
    return "untried: this drive does not turn";
  }
  const double p95_px = study.drives.figure("p95_px", {{"drive", "configured"},
                                                       {"told_by", "truth"},
                                                       {"rotation", name(rotation)},
                                                       {"depth", "truth"}});
  return verdict_on(study, p95_px, "(95 %) on the configured drive");
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
  const double worst_px =
      worst_of(study.rotation.figures("max_px", {{"rotation", "homography"}, {"step_m", 0.0}}));
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
  const double worst_px = worst_of(study.translation.figures("max_px", {{"depth", "truth"}}));
  return {"translation",
          "true depth: the largest error of steps up to half the depth",
          {{"translation.truth.worst", worst_px, "px", 0}},
          verdict_on(study, worst_px, "at the most")};
}

Statement depth_sources(const Study& study) {
  const StudyConfig& config = study.config;
  const auto of = [&](const char* depth, const char* column) {
    return study.drives.figure(column, {{"drive", "straight"},
                                        {"told_by", "truth"},
                                        {"rotation", "homography"},
                                        {"depth", depth}});
  };
  return {"translation",
          fmt::format("rendered, straight on at {:.2g} m/s, {}: V by the reference depth of {:g} "
                      "m, and by the landmark's own V",
                      config.speed_mps, rate_of(study), field_of(config.filter).reference_depth_m),
          {{"translation.reference.median", of("reference", "median_px"), "px",
            of("reference", "expected_median_px")},
           {"translation.reference.p95", of("reference", "p95_px"), "px", kUnknown},
           {"translation.learnt.median", of("learnt", "median_px"), "px", kUnknown},
           {"translation.learnt.p95", of("learnt", "p95_px"), "px", kUnknown}},
          verdict_on(study, of("learnt", "p95_px"), "(95 %) by the landmark's own V")};
}

Statement imu_noise(const Study& study) {
  const scenario::Scenario& scenario = study.config.scenario;
  const std::string name = imus(study.config).front().name;
  const auto of = [&](const char* odometry, const char* column) {
    return study.imu.figure(
        column, {{"imu", name}, {"odometry", odometry}, {"rate_hz", scenario.camera.rate_hz}});
  };
  const bool has_odometry = scenario.odometry.enabled;
  return {"IMU",
          fmt::format("{} at {}, over {:g} s from a known start: without odometry, with odometry, "
                      "and the part of the rotation",
                      name, rate_of(study), kImuDrive_s),
          {{"imu.dead_reckoning.rms", of("no", "rms_px"), "px", of("no", "expected_rms_px")},
           {"imu.odometry.rms", of("yes", "rms_px"), "px", of("yes", "expected_rms_px")},
           {"imu.rotation.rms", of("no", "rotation_rms_px"), "px",
            of("no", "expected_rotation_rms_px")}},
          verdict_on(study, of(has_odometry ? "yes" : "no", "rms_px"),
                     has_odometry ? "with the scenario's odometry" : "without odometry")};
}

Statement mount(const Study& study, const PointSet& points) {
  const auto of = [&](int axis, double pan_deg, const char* column) {
    return study.mount.figure(column, {{"points", points.name},
                                       {"axis", axis_name(axis)},
                                       {"error_deg", 1.0},
                                       {"pan_deg", pan_deg}});
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
      const double rms_px = of(axis, pan_deg, "rms_px");
      worst_px = std::max(worst_px, rms_px);
      s.figures.push_back(
          {fmt::format("mount.{}{}.rms", pan_deg == 0 ? "" : "panning.", axis_name(axis)), rms_px,
           "px",
           mount_rms_px(points.camera, seen, step_C_m, pan_deg * kDegree * Eigen::Vector3d::UnitY(),
                        axis, kDegree)});
    }
  }
  s.figures.push_back({"mount.foe_shift", of(1, 0, "foe_shift_px"), "px",
                       study.config.camera.focal_px * std::tan(kDegree)});
  s.verdict = verdict_on(study, worst_px, "for 1 deg about the worst axis");
  return s;
}

Statement bumps(const Study& study) {
  constexpr double kRough_m = 5e-3;
  const auto of = [&](const char* rotation, const char* told_by, const char* column) {
    return study.bumps.figure(
        column, {{"roughness_m", kRough_m}, {"rotation", rotation}, {"told_by", told_by}});
  };
  const double told_px = of("homography", "imu", "rms_px");
  return {"bumps",
          fmt::format("wheels on bumps of {:g} mm, {}: the turn in a frame, and the error with the "
                      "rotation left in, by first order, by the homography, and told by the IMU",
                      1e3 * kRough_m, rate_of(study)),
          {{"bumps.turn.p95", of("none", "truth", "turn_p95_deg"), "deg", kUnknown},
           {"bumps.none.rms", of("none", "truth", "rms_px"), "px",
            of("none", "truth", "expected_rms_px")},
           {"bumps.first_order.rms", of("first_order", "truth", "rms_px"), "px",
            of("first_order", "truth", "expected_rms_px")},
           {"bumps.homography.rms", of("homography", "truth", "rms_px"), "px", 0},
           {"bumps.imu.rms", told_px, "px", kUnknown}},
          verdict_on(study, told_px, "told by the IMU")};
}

/// The time until which the velocity error stays within the tolerance, at the reference depth.
std::string verdict_on_drift(const Study& study, const std::string& imu) {
  const StudyConfig& config = study.config;
  const bool odometry = config.scenario.odometry.enabled;
  const double px_for_mps =
      config.camera.focal_px * config.frame_s() / field_of(config.filter).reference_depth_m;
  const Table::Where own{{"imu", imu}, {"odometry", odometry ? "yes" : "no"}};
  const auto lateral_mps = study.drift.figures("lateral_mps", own);
  const auto vertical_mps = study.drift.figures("vertical_mps", own);
  const auto t_s = study.drift.figures("t_s", own);
  double until_s = 0;
  bool is_over = false;
  for (std::size_t i = 0; i < t_s.size() && !is_over; ++i) {
    is_over = px_for_mps * std::max(lateral_mps[i], vertical_mps[i]) > config.tolerance_px;
    if (!is_over) until_s = t_s[i];
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
    const Table::Where end{{"imu", imu}, {"odometry", odometry ? "yes" : "no"}, {"t_s", end_s}};
    for (const auto& [what, column, expected, unit] :
         {std::tuple("forward", "forward_mps", "expected_forward_mps", "m/s"),
          {"lateral", "lateral_mps", "expected_lateral_mps", "m/s"},
          {"vertical", "vertical_mps", "expected_vertical_mps", "m/s"},
          {"tilt", "tilt_rad", "expected_tilt_rad", "rad"},
          {"heading", "heading_rad", "expected_heading_rad", "rad"}}) {
      s.figures.push_back({fmt::format("drift.{}.{}{}", imu, odometry ? "odometry." : "", what),
                           study.drift.figure(column, end), unit,
                           study.drift.figure(expected, end)});
    }
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

constexpr const char* kAnswerText = "answer.txt";
constexpr const char* kAnswerTable = "answer.csv";
constexpr const char* kPage = "kinematics.html";

std::string answer_csv(const std::vector<Statement>& statements) {
  Table table("topic,figure,value,unit,expected");
  for (const Statement& s : statements) {
    for (const Figure& f : s.figures) table.add(s.topic, f.name, f.value, f.unit, f.expected);
  }
  return table.csv();
}

constexpr struct {
  const char* name;  // of the file, without ".csv"
  Table Study::*rows;
} kTables[] = {{"rotation", &Study::rotation}, {"translation", &Study::translation},
               {"foe_distance", &Study::foe},  {"focal_length", &Study::focal},
               {"mount", &Study::mount},       {"drives", &Study::drives},
               {"imu", &Study::imu},           {"bumps", &Study::bumps},
               {"drift", &Study::drift}};

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

/// The text of `kinematics.js`, which lays out a study on its page.
extern const std::string_view kKinematicsJs;

files::ResultNames study_files() {
  files::ResultNames names{kAnswerText, kAnswerTable, kPage};
  for (const auto& table : kTables) names.push_back(fmt::format("{}.csv", table.name));
  return names;
}

void write_study(const std::filesystem::path& folder, const Study& study) {
  const StudyConfig& config = study.config;
  const std::vector<Statement> statements = answer(study);
  nlohmann::json data = {{"subject", subject(config)},
                         {"bottom_line", bottom_line(config, statements)},
                         {"tolerance_px", config.tolerance_px},
                         {"reference_depth_m", field_of(config.filter).reference_depth_m},
                         {"tables", {{"answer", answer_csv(statements)}}}};
  for (const Statement& s : statements) {
    data["statements"].push_back({{"topic", s.topic}, {"text", s.text}, {"verdict", s.verdict}});
  }
  for (const auto& table : kTables) {
    const std::string csv = (study.*table.rows).csv();
    files::write_file(folder / fmt::format("{}.csv", table.name), csv);
    data["tables"][table.name] = csv;
  }
  files::write_file(folder / kAnswerText, text_of(config, statements));
  files::write_file(folder / kAnswerTable, answer_csv(statements));
  report::write_page(folder / kPage, {.title = "lcs kinematics: " + config.scenario.name,
                                      .data = files::json_text(data),
                                      .script = kKinematicsJs,
                                      .where_else = "the CSV files"});
}

}  // namespace lcs::kinematics
