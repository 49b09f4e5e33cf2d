
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/files/json_node.h"
#include "tools/files/output_file.h"
#include "tools/kinematics/answer.h"
#include "tools/report/page_writer.h"

namespace lcs::kinematics {

/// The text of `kinematics.js`, which lays out a study on its page.
extern const std::string_view kKinematicsJs;

namespace {

constexpr const char* kAnswerText = "answer.txt";
constexpr const char* kAnswerTable = "answer.csv";
constexpr const char* kPage = "kinematics.html";

/// Comma-separated text without quotes, which no cell needs. Numbers have six significant digits;
/// unknown ones are empty cells.
class Csv {
 public:
  explicit Csv(std::string_view columns) : text_(fmt::format("{}\n", columns)) {}

  template <class... Cells>
  void add(const Cells&... cells) {
    put_all(cells...);
    text_.back() = '\n';
  }
  const std::string& text() const { return text_; }

 private:
  template <class... Cells>
  void put_all(const Cells&... cells) {
    (put(cells), ...);
  }
  void put(std::string_view word) { text_ += fmt::format("{},", word); }
  void put(double value) { text_ += std::isfinite(value) ? fmt::format("{:.6g},", value) : ","; }
  void put(int value) { text_ += fmt::format("{},", value); }
  void put(bool value) { put(std::string_view(value ? "yes" : "no")); }
  void put(DepthSource depth) { put(name(depth)); }
  void put(const FieldModel& model) {
    put(name(model.rotation));
    put(name(model.depth));
  }
  void put(const double (&three)[3]) { put_all(three[0], three[1], three[2]); }
  void put(const DriftErrors& e) {
    const Eigen::Vector3d& v = e.velocity_B_mps;
    put_all(e.tilt_rad, e.heading_rad, v.x(), v.y(), v.z());
  }
  void put(const RotationRow& r) {
    put_all(r.points, axis_name(r.axis), r.angle_deg, r.step_m, r.model, r.error);
  }
  void put(const TranslationRow& r) {
    put_all(r.points, r.speed_mps, r.rate_hz, r.depth_m, r.step_over_depth, r.depth, r.error);
  }
  void put(const FoeRow& r) { put_all(r.points, r.from_px, r.to_px, r.model, r.error); }
  void put(const FocalRow& r) {
    put_all(r.points, r.fovy_deg, r.focal_px, r.limit_deg, r.theory_deg, r.printed_deg,
            r.reference_median_px, r.learnt_median_px);
  }
  void put(const MountRow& r) {
    put_all(r.points, axis_name(r.axis), r.error_deg, r.pan_deg, r.foe_shift_px, r.error);
  }
  void put(const DriveRow& r) { put_all(r.drive, r.told, r.model, r.expected_median_px, r.error); }
  void put(const ImuRow& r) {
    put_all(r.imu, r.rate_hz, r.odometry, r.seeds, r.expected_rms_px, r.rotation_error.rms_px,
            r.expected_rotation_rms_px, r.error);
  }
  void put(const BumpRow& r) {
    put_all(r.roughness_m, r.turn_median_deg, r.turn_p95_deg, r.turn_max_deg, r.rotation, r.told,
            r.expected_rms_px, r.error);
  }
  void put(const DriftRow& r) { put_all(r.imu, r.odometry, r.t_s, r.seeds, r.rms, r.expected); }
  void put(const ErrorSummary& e) {
    put(static_cast<double>(e.count));
    for (const double value : {e.median_px, e.p95_px, e.max_px, e.rms_px}) {
      put(e.count > 0 ? value : std::nan(""));
    }
  }

  std::string text_;
};

std::string answer_csv(const std::vector<Statement>& statements) {
  Csv csv("topic,figure,value,unit,expected");
  for (const Statement& s : statements) {
    for (const Figure& f : s.figures) csv.add(s.topic, f.name, f.value, f.unit, f.expected);
  }
  return csv.text();
}

/// The table of an experiment, with a line for each of its rows.
template <auto kRows>
std::string csv_of(const Study& study, std::string_view columns) {
  Csv csv(columns);
  for (const auto& row : study.*kRows) csv.add(row);
  return csv.text();
}

constexpr struct {
  const char* name;  // of the file, without ".csv"
  std::string (*csv)(const Study&, std::string_view columns);
  const char* columns;
} kTables[] = {
    {"rotation", csv_of<&Study::rotation>,
     "points,axis,angle_deg,step_m,rotation,depth,points_seen,median_px,p95_px,max_px,rms_px"},
    {"translation", csv_of<&Study::translation>,
     "points,speed_mps,rate_hz,depth_m,step_over_depth,depth,points_seen,median_px,p95_px,max_px,"
     "rms_px"},
    {"foe_distance", csv_of<&Study::foe>,
     "points,from_px,to_px,rotation,depth,points_seen,median_px,p95_px,max_px,rms_px"},
    {"focal_length", csv_of<&Study::focal>,
     "points,fovy_deg,focal_px,first_order_limit_tilt_deg,first_order_limit_pan_deg,"
     "first_order_limit_roll_deg,theory_limit_tilt_deg,theory_limit_pan_deg,"
     "theory_limit_roll_deg,as_printed_limit_tilt_deg,as_printed_limit_pan_deg,"
     "as_printed_limit_roll_deg,reference_median_px,learnt_median_px"},
    {"mount", csv_of<&Study::mount>,
     "points,axis,error_deg,pan_deg,foe_shift_px,points_seen,median_px,p95_px,max_px,rms_px"},
    {"drives", csv_of<&Study::drives>,
     "drive,told_by,rotation,depth,expected_median_px,points_seen,median_px,p95_px,max_px,rms_px"},
    {"imu", csv_of<&Study::imu>,
     "imu,rate_hz,odometry,seeds,expected_rms_px,rotation_rms_px,expected_rotation_rms_px,"
     "points_seen,median_px,p95_px,max_px,rms_px"},
    {"bumps", csv_of<&Study::bumps>,
     "roughness_m,turn_median_deg,turn_p95_deg,turn_max_deg,rotation,told_by,expected_rms_px,"
     "points_seen,median_px,p95_px,max_px,rms_px"},
    {"drift", csv_of<&Study::drift>,
     "imu,odometry,t_s,seeds,tilt_rad,heading_rad,forward_mps,lateral_mps,vertical_mps,"
     "expected_tilt_rad,expected_heading_rad,expected_forward_mps,expected_lateral_mps,"
     "expected_vertical_mps"},
};

}  // namespace

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
    const std::string csv = table.csv(study, table.columns);
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
