/// \file
/// The rows of an experiment, as in its CSV file.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tools/kinematics/points.h"

namespace lcs::kinematics {

/// A word, or a figure; NaN if it is unknown.
using Cell = std::variant<std::string, double>;

class Table {
 public:
  /// \param columns with commas between them.
  explicit Table(const std::string& columns);

  /// Adds a row. \param values of its columns, in order; a model, a summary and an array fill some
  ///   columns each.
  template <class... Values>
  void add(const Values&... values) {
    rows_.emplace_back();
    (put(values), ...);
  }

  /// The figures of a column, of the rows in which other columns have these values.
  using Where = std::vector<std::pair<const char*, Cell>>;
  std::vector<double> figures(const char* column, const Where& where = {}) const;
  /// The first of them. \throws std::logic_error if there is none.
  double figure(const char* column, const Where& where) const;

  /// Comma-separated text without quotes, which no cell needs. Numbers have six significant digits;
  /// unknown ones, and the errors of no points, are empty cells.
  std::string csv() const;

 private:
  std::size_t place_of(const char* column) const;
  void put(const Cell& cell) { rows_.back().push_back(cell); }
  void put(DepthSource depth) { put(name(depth)); }
  void put(const FieldModel& model);
  void put(const double (&three)[3]);
  void put(const ErrorSummary& errors);

  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

}  // namespace lcs::kinematics
