#include "tools/kinematics/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/files/csv.h"

namespace lcs::kinematics {
namespace {

constexpr const char* kPointsSeen = "points_seen";  // the first column of a summary, the last ones

std::string text_of(const Cell& cell) {
  const auto* const figure = std::get_if<double>(&cell);
  if (figure == nullptr) return std::get<std::string>(cell);
  return std::isfinite(*figure) ? fmt::format("{:.6g}", *figure) : "";
}

}  // namespace

Table::Table(const std::string& columns) {
  for (const std::string_view column : files::fields_of(columns)) columns_.emplace_back(column);
}

std::size_t Table::place_of(const char* column) const {
  const auto found = std::ranges::find(columns_, column);
  if (found == columns_.end()) throw std::logic_error("an experiment lacks a column of the answer");
  return static_cast<std::size_t>(found - columns_.begin());
}

std::vector<double> Table::figures(const char* column, const Where& where) const {
  std::vector<double> all;
  for (const std::vector<Cell>& row : rows_) {
    const auto fits = [&](const auto& each) { return row[place_of(each.first)] == each.second; };
    if (std::ranges::all_of(where, fits)) all.push_back(std::get<double>(row[place_of(column)]));
  }
  return all;
}

double Table::figure(const char* column, const Where& where) const {
  const std::vector<double> all = figures(column, where);
  if (all.empty()) throw std::logic_error("an experiment lacks a row of the answer");
  return all.front();
}

std::string Table::csv() const {
  std::string text = fmt::format("{}\n", fmt::join(columns_, ","));
  for (const std::vector<Cell>& row : rows_) {
    bool is_seen = true;
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += fmt::format("{}{}", i > 0 ? "," : "", is_seen ? text_of(row[i]) : "");
      if (columns_[i] == kPointsSeen) is_seen = row[i] != Cell(0.0);
    }
    text += '\n';
  }
  return text;
}

void Table::put(const FieldModel& model) {
  put(name(model.rotation));
  put(name(model.depth));
}

void Table::put(const double (&three)[3]) {
  for (const double figure : three) put(figure);
}

void Table::put(const ErrorSummary& e) {
  for (const double figure :
       {static_cast<double>(e.count), e.median_px, e.p95_px, e.max_px, e.rms_px}) {
    put(figure);
  }
}

}  // namespace lcs::kinematics
