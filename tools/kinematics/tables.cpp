#include "tools/kinematics/tables.h"

#include <fmt/format.h>

#include <cmath>

namespace lcs::kinematics {
namespace {

using Cell = Table::Cell;
using Cells = std::vector<Cell>;

const std::vector<std::string> kErrorColumns = {"points_seen", "median_px", "p95_px", "max_px",
                                                "rms_px"};

Table table(const std::string& name, std::vector<std::string> columns, bool with_errors) {
  if (with_errors) columns.insert(columns.end(), kErrorColumns.begin(), kErrorColumns.end());
  return {name, std::move(columns), {}};
}

Cells with_errors(Cells cells, const ErrorSummary& e) {
  cells.emplace_back(static_cast<double>(e.count));
  for (const double value : {e.median_px, e.p95_px, e.max_px, e.rms_px}) {
    cells.emplace_back(e.count > 0 ? value : std::nan(""));
  }
  return cells;
}

Cell text(std::string_view value) {
  return std::string(value);
}

Table answer_table(const std::vector<Statement>& statements) {
  Table t = table("answer", {"topic", "figure", "value", "unit", "expected"}, false);
  for (const Statement& s : statements) {
    for (const Figure& f : s.figures)
      t.rows.push_back({s.topic, f.name, f.value, f.unit, f.expected});
  }
  return t;
}

Table rotation_table(const Study& study) {
  Table t = table("rotation", {"points", "axis", "angle_deg", "step_m", "rotation", "depth"}, true);
  for (const RotationRow& r : study.rotation) {
    t.rows.push_back(with_errors({r.points, text(axis_name(r.axis)), r.angle_deg, r.step_m,
                                  text(name(r.model.rotation)), text(name(r.model.depth))},
                                 r.error));
  }
  return t;
}

Table translation_table(const Study& study) {
  Table t = table("translation",
                  {"points", "speed_mps", "rate_hz", "depth_m", "step_over_depth", "depth"}, true);
  for (const TranslationRow& r : study.translation) {
    t.rows.push_back(with_errors(
        {r.points, r.speed_mps, r.rate_hz, r.depth_m, r.step_over_depth, text(name(r.depth))},
        r.error));
  }
  return t;
}

Table foe_table(const Study& study) {
  Table t = table("foe_distance", {"points", "from_px", "to_px", "rotation", "depth"}, true);
  for (const FoeRow& r : study.foe) {
    t.rows.push_back(with_errors(
        {r.points, r.from_px, r.to_px, text(name(r.model.rotation)), text(name(r.model.depth))},
        r.error));
  }
  return t;
}

Table focal_table(const Study& study) {
  Table t = table("focal_length", {"points", "fovy_deg", "focal_px"}, false);
  for (const char* what : {"first_order", "theory", "as_printed"}) {
    for (int axis = 0; axis < 3; ++axis) {
      t.columns.push_back(fmt::format("{}_limit_{}_deg", what, axis_name(axis)));
    }
  }
  t.columns.insert(t.columns.end(), {"reference_median_px", "learnt_median_px"});
  for (const FocalRow& r : study.focal) {
    Cells cells = {r.points, r.fovy_deg, r.focal_px};
    for (const auto* limits : {&r.limit_deg, &r.theory_deg, &r.printed_deg}) {
      cells.insert(cells.end(), std::begin(*limits), std::end(*limits));
    }
    cells.insert(cells.end(), {r.reference_median_px, r.learnt_median_px});
    t.rows.push_back(std::move(cells));
  }
  return t;
}

Table mount_table(const Study& study) {
  Table t = table("mount", {"points", "axis", "error_deg", "pan_deg", "foe_shift_px"}, true);
  for (const MountRow& r : study.mount) {
    t.rows.push_back(with_errors(
        {r.points, text(axis_name(r.axis)), r.error_deg, r.pan_deg, r.foe_shift_px}, r.error));
  }
  return t;
}

Table drive_table(const Study& study) {
  Table t = table("drives", {"drive", "told_by", "rotation", "depth", "expected_median_px"}, true);
  for (const DriveRow& r : study.drives) {
    t.rows.push_back(with_errors({r.drive, r.told, text(name(r.model.rotation)),
                                  text(name(r.model.depth)), r.expected_median_px},
                                 r.error));
  }
  return t;
}

Table imu_table(const Study& study) {
  Table t = table("imu",
                  {"imu", "rate_hz", "odometry", "seeds", "expected_rms_px", "rotation_rms_px",
                   "expected_rotation_rms_px"},
                  true);
  for (const ImuRow& r : study.imu) {
    t.rows.push_back(with_errors(
        {r.imu, r.rate_hz, text(r.odometry ? "yes" : "no"), static_cast<double>(r.seeds),
         r.expected_rms_px, r.rotation_error.rms_px, r.expected_rotation_rms_px},
        r.error));
  }
  return t;
}

Table bump_table(const Study& study) {
  Table t = table("bumps",
                  {"roughness_m", "turn_median_deg", "turn_p95_deg", "turn_max_deg", "rotation",
                   "told_by", "expected_rms_px"},
                  true);
  for (const BumpRow& r : study.bumps) {
    t.rows.push_back(with_errors({r.roughness_m, r.turn_median_deg, r.turn_p95_deg, r.turn_max_deg,
                                  r.rotation, r.told, r.expected_rms_px},
                                 r.error));
  }
  return t;
}

Table drift_table(const Study& study) {
  Table t = table("drift", {"imu", "odometry", "t_s", "seeds"}, false);
  for (const char* of : {"", "expected_"}) {
    for (const char* what :
         {"tilt_rad", "heading_rad", "forward_mps", "lateral_mps", "vertical_mps"}) {
      t.columns.push_back(fmt::format("{}{}", of, what));
    }
  }
  for (const DriftRow& r : study.drift) {
    t.rows.push_back({r.imu, text(r.odometry ? "yes" : "no"), r.t_s, static_cast<double>(r.seeds),
                      r.tilt_rad, r.heading_rad, r.forward_mps, r.lateral_mps, r.vertical_mps,
                      r.expected_tilt_rad, r.expected_heading_rad, r.expected_forward_mps,
                      r.expected_lateral_mps, r.expected_vertical_mps});
  }
  return t;
}

Table heat_table(const Study& study) {
  Table t = table("heat", {"map", "column", "row", "columns", "rows", "error_px"}, false);
  for (const HeatMap& map : study.heat) {
    std::string name = map.name;  // its commas would be the table's
    std::erase(name, ',');
    for (int i = 0; i < map.columns * map.rows; ++i) {
      const int column = i % map.columns, row = i / map.columns;
      t.rows.push_back({name, static_cast<double>(column), static_cast<double>(row),
                        static_cast<double>(map.columns), static_cast<double>(map.rows),
                        map.errors_px[static_cast<std::size_t>(i)]});
    }
  }
  return t;
}

}  // namespace

std::vector<Table> tables(const Study& study, const std::vector<Statement>& statements) {
  return {answer_table(statements), rotation_table(study), translation_table(study),
          foe_table(study),         focal_table(study),    mount_table(study),
          drive_table(study),       imu_table(study),      bump_table(study),
          drift_table(study),       heat_table(study)};
}

std::string csv_of(const Table& table) {
  std::string csv = fmt::format("{}\n", fmt::join(table.columns, ","));
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) csv += ',';
      if (const auto* words = std::get_if<std::string>(&row[i])) {
        csv += *words;
      } else if (const double value = std::get<double>(row[i]); std::isfinite(value)) {
        csv += fmt::format("{:.6g}", value);
      }
    }
    csv += '\n';
  }
  return csv;
}

}  // namespace lcs::kinematics
