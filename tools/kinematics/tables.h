/// \file
/// A study's rows as tables of one form, for CSV files and for the page.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "tools/kinematics/answer.h"

namespace lcs::kinematics {

struct Table {
  using Cell = std::variant<std::string, double>;  ///< NaN: none
  std::string name;                                ///< of the file, without ".csv"
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;
};

/// The names of the tables in the order of the report; the first one holds the answer's figures.
inline constexpr std::array kTables{"answer",       "rotation", "translation", "foe_distance",
                                    "focal_length", "mount",    "drives",      "imu",
                                    "bumps",        "drift",    "heat"};

/// In the order of `kTables`.
std::vector<Table> tables(const Study& study, const std::vector<Statement>& statements);

/// Numbers with six significant digits; no quotes: no cell needs any.
std::string csv_of(const Table& table);

}  // namespace lcs::kinematics
