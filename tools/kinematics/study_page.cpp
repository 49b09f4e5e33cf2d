#include "tools/kinematics/study_page.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tools/files/output_file.h"
#include "tools/kinematics/kinematics_script.h"
#include "tools/kinematics/tables.h"
#include "tools/report/page_writer.h"
#include "tools/scoring/events.h"

namespace lcs::kinematics {
namespace {

using Json = nlohmann::json;

std::string png_of(const cv::Mat3b& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes);
  return {bytes.begin(), bytes.end()};
}

/// Six digits are plenty, and keep the page small.
Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  if (value == 0) return 0;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 5);
  return unit > 1e-300 ? std::round(value / unit) * unit : 0;
}

/// By columns.
Json json_of(const Table& table) {
  Json columns = Json::object();
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    Json& column = columns[table.columns[i]] = Json::array();
    for (const auto& row : table.rows) {
      if (const auto* words = std::get_if<std::string>(&row[i]))
        column.push_back(*words);
      else
        column.push_back(number(std::get<double>(row[i])));
    }
  }
  return columns;
}

std::string data_of(const Study& study, const std::vector<Statement>& statements,
                    const std::vector<Table>& all, const std::string& field_png) {
  Json data = {{"subject", subject(study.config)},
               {"statements", Json::array()},
               {"tables", Json::object()},
               {"heat", Json::array()},
               {"bottom_line", bottom_line(study.config, statements)},
               {"reference_depth_m", field_of(study.config.filter).reference_depth_m},
               {"has_movers", !study.field.moving.empty()},
               {"tolerance_px", study.config.tolerance_px},
               {"rate_hz", study.config.scenario.camera.rate_hz},
               {"field_png", field_png.empty() ? "" : bench::base64(field_png)}};
  for (const Statement& s : statements) {
    data["statements"].push_back({{"topic", s.topic}, {"text", s.text}, {"verdict", s.verdict}});
  }
  for (const Table& table : all) {
    if (table.name != "heat") data["tables"][table.name] = json_of(table);
  }
  for (const HeatMap& map : study.heat) {
    Json errors = Json::array();
    for (const double error : map.errors_px) errors.push_back(number(error));
    data["heat"].push_back({{"name", map.name},
                            {"columns", map.columns},
                            {"rows", map.rows},
                            {"errors_px", std::move(errors)}});
  }
  return data.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

bench::ResultNames study_files() {
  bench::ResultNames names{kAnswerFile, kPageFile, kFieldFile};
  for (const char* table : kTables) names.push_back(fmt::format("{}.csv", table));
  return names;
}

void write_study(const std::filesystem::path& folder, const Study& study) {
  const std::vector<Statement> statements = answer(study);
  const std::vector<Table> all = tables(study, statements);
  bench::write_file(folder / kAnswerFile, text_of(study.config, statements));
  for (const Table& table : all) bench::write_file(folder / (table.name + ".csv"), csv_of(table));
  std::string field_png;
  if (!study.field.image.empty()) {
    field_png = png_of(draw_field(study.field));
    bench::write_file(folder / kFieldFile, field_png);
  }
  const std::string title = "lcs kinematics: " + study.config.scenario.name;
  report::write_page(folder / kPageFile, {.title = title,
                                          .data = data_of(study, statements, all, field_png),
                                          .script = kKinematicsJs,
                                          .where_else = "the CSV files"});
}

}  // namespace lcs::kinematics
