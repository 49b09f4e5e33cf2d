/// \file
/// Tables of figures, each as text for a terminal, Markdown, CSV or LaTeX.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lcs::scoring {

struct TableFigure {
  double mean = 0;
  std::optional<double> half = {};  ///< half width of an interval or a range
  int decimals = 2;                 ///< of both; CSV has all digits
  bool is_signed = false;           ///< shows a plus, too
};

/// An undefined figure, words, or a figure.
using Cell = std::variant<std::monostate, std::string, TableFigure>;

struct TableColumn {
  std::string key;      ///< its name in CSV
  std::string heading;  ///< its name for people
};

struct FigureTable {
  std::vector<TableColumn> columns;          ///< the first one names the rows
  std::vector<std::vector<Cell>> rows = {};  ///< each as long as `columns`, the first cell words
};

enum class Format { text, markdown, csv, latex };

/// \throws std::invalid_argument, naming the words, for a word that is none of `Format`.
Format format_of(std::string_view word);

/// The table, which ends with a newline. An undefined figure is "-", in CSV an empty field.
/// * Text has aligned columns: 120 columns of a terminal if the figures leave room. A longer name
///   has a line of its own.
/// * CSV quotes as RFC 4180. A column with halves has a second one beside it, named KEY_half.
/// * LaTeX is a tabular, which needs the package booktabs.
std::string table_text(const FigureTable& table, Format format);

/// Words in one line of Markdown, as in a cell of such a table.
std::string in_markdown(const std::string& words);

}  // namespace lcs::scoring
