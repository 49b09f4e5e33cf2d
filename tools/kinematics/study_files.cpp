
#include <fmt/format.h>

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
