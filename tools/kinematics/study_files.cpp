#include "tools/kinematics/study_files.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/files/json_node.h"
#include "tools/files/output_file.h"
#include "tools/kinematics/answer.h"
#include "tools/kinematics/kinematics_script.h"
#include "tools/report/page_writer.h"

namespace lcs::kinematics {
namespace {

constexpr const char* kAnswerText = "answer.txt";
constexpr const char* kAnswerTable = "answer.csv";
constexpr const char* kPage = "kinematics.html";

/// Comma-separated text without quotes, which no cell needs. Numbers have six significant digits;
/// unknown ones are empty cells.
class Csv {
 public:
  explicit Csv(std::string_view columns, std::string_view more_columns = "")
      : text_(fmt::format("{}{}\n", columns, more_columns)) {}

  template <class... Cells>
  void add(const Cells&... cells) {
    (put(cells), ...);
    text_.back() = '\n';
  }
  const std::string& text() const { return text_; }

 private:
  void put(std::string_view word) { text_ += fmt::format("{},", word); }
  void put(double value) { text_ += std::isfinite(value) ? fmt::format("{:.6g},", value) : ","; }
  void put(int value) { text_ += fmt::format("{},", value); }
  void put(bool value) { put(std::string_view(value ? "yes" : "no")); }
  void put(DepthSource depth) { put(name(depth)); }
  void put(const Model& model) {
    put(name(model.rotation));
    put(name(model.depth));
  }
  void put(const double (&three)[3]) {
    for (const double value : three) put(value);
  }
  void put(const DriftErrors& e) {
    for (const double value :
         {e.tilt_rad, e.heading_rad, e.forward_mps, e.lateral_mps, e.vertical_mps}) {
      put(value);
    }
  }
  void put(const ErrorSummary& e) {
    put(static_cast<double>(e.count));
    for (const double value : {e.median_px, e.p95_px, e.max_px, e.rms_px}) {
      put(e.count > 0 ? value : std::nan(""));
    }
  }

  std::string text_;
};

constexpr std::string_view kErrors = ",points_seen,median_px,p95_px,max_px,rms_px";

std::string rotation_csv(const Study& study) {
  Csv csv("points,axis,angle_deg,step_m,rotation,depth", kErrors);
  for (const RotationRow& r : study.rotation) {
    csv.add(r.points, axis_name(r.axis), r.angle_deg, r.step_m, r.model, r.error);
  }
  return csv.text();
}

std::string translation_csv(const Study& study) {
  Csv csv("points,speed_mps,rate_hz,depth_m,step_over_depth,depth", kErrors);
  for (const TranslationRow& r : study.translation) {
    csv.add(r.points, r.speed_mps, r.rate_hz, r.depth_m, r.step_over_depth, r.depth, r.error);
  }
  return csv.text();
}

std::string foe_distance_csv(const Study& study) {
  Csv csv("points,from_px,to_px,rotation,depth", kErrors);
  for (const FoeRow& r : study.foe) csv.add(r.points, r.from_px, r.to_px, r.model, r.error);
  return csv.text();
}

std::string focal_length_csv(const Study& study) {
  Csv csv(
      "points,fovy_deg,focal_px,"
      "first_order_limit_tilt_deg,first_order_limit_pan_deg,first_order_limit_roll_deg,"
      "theory_limit_tilt_deg,theory_limit_pan_deg,theory_limit_roll_deg,"
      "as_printed_limit_tilt_deg,as_printed_limit_pan_deg,as_printed_limit_roll_deg,"
      "reference_median_px,learnt_median_px");
  for (const FocalRow& r : study.focal) {
    csv.add(r.points, r.fovy_deg, r.focal_px, r.limit_deg, r.theory_deg, r.printed_deg,
            r.reference_median_px, r.learnt_median_px);
  }
  return csv.text();
}

std::string mount_csv(const Study& study) {
  Csv csv("points,axis,error_deg,pan_deg,foe_shift_px", kErrors);
  for (const MountRow& r : study.mount) {
    csv.add(r.points, axis_name(r.axis), r.error_deg, r.pan_deg, r.foe_shift_px, r.error);
  }
  return csv.text();
}

std::string drives_csv(const Study& study) {
  Csv csv("drive,told_by,rotation,depth,expected_median_px", kErrors);
  for (const DriveRow& r : study.drives) {
    csv.add(r.drive, r.told, r.model, r.expected_median_px, r.error);
  }
  return csv.text();
}

std::string imu_csv(const Study& study) {
  Csv csv(
      "imu,rate_hz,odometry,seeds,expected_rms_px,rotation_rms_px,"
      "expected_rotation_rms_px",
      kErrors);
  for (const ImuRow& r : study.imu) {
    csv.add(r.imu, r.rate_hz, r.odometry, r.seeds, r.expected_rms_px, r.rotation_error.rms_px,
            r.expected_rotation_rms_px, r.error);
  }
  return csv.text();
}

std::string bumps_csv(const Study& study) {
  Csv csv(
      "roughness_m,turn_median_deg,turn_p95_deg,turn_max_deg,rotation,told_by,"
      "expected_rms_px",
      kErrors);
  for (const BumpRow& r : study.bumps) {
    csv.add(r.roughness_m, r.turn_median_deg, r.turn_p95_deg, r.turn_max_deg, r.rotation, r.told,
            r.expected_rms_px, r.error);
  }
  return csv.text();
}

std::string drift_csv(const Study& study) {
  Csv csv(
      "imu,odometry,t_s,seeds,tilt_rad,heading_rad,forward_mps,lateral_mps,vertical_mps,"
      "expected_tilt_rad,expected_heading_rad,expected_forward_mps,expected_lateral_mps,"
      "expected_vertical_mps");
  for (const DriftRow& r : study.drift) {
    csv.add(r.imu, r.odometry, r.t_s, r.seeds, r.rms, r.expected);
  }
  return csv.text();
}

std::string answer_csv(const std::vector<Statement>& statements) {
  Csv csv("topic,figure,value,unit,expected");
  for (const Statement& s : statements) {
    for (const Figure& f : s.figures) csv.add(s.topic, f.name, f.value, f.unit, f.expected);
  }
  return csv.text();
}

constexpr struct {
  const char* name;  // of the file, without ".csv"
  std::string (*csv)(const Study&);
} kTables[] = {{"rotation", rotation_csv},
               {"translation", translation_csv},
               {"foe_distance", foe_distance_csv},
               {"focal_length", focal_length_csv},
               {"mount", mount_csv},
               {"drives", drives_csv},
               {"imu", imu_csv},
               {"bumps", bumps_csv},
               {"drift", drift_csv}};

}  // namespace

bench::ResultNames study_files() {
  bench::ResultNames names{kAnswerText, kAnswerTable, kPage};
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
    const std::string csv = table.csv(study);
    bench::write_file(folder / fmt::format("{}.csv", table.name), csv);
    data["tables"][table.name] = csv;
  }
  bench::write_file(folder / kAnswerText, text_of(config, statements));
  bench::write_file(folder / kAnswerTable, answer_csv(statements));
  report::write_page(folder / kPage,
                     {.title = "lcs kinematics: " + config.scenario.name,
                      .data = bench::json_text(data),
                      .script = kKinematicsJs,
                      .where_else = "the CSV files"});
}

}  // namespace lcs::kinematics
