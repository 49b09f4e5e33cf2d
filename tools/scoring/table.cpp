#include "tools/scoring/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

namespace lcs::scoring {
namespace {

constexpr std::array<std::string_view, 4> kFormats{"text", "markdown", "csv", "latex"};

constexpr std::string_view kSign = "±";

std::string number_of(const TableFigure& figure) {
  return figure.is_signed ? fmt::format("{:+.{}f}", figure.mean, figure.decimals)
                          : fmt::format("{:.{}f}", figure.mean, figure.decimals);
}

/// Such as "±.05"; empty if the half rounds to zero.
std::string half_of(const TableFigure& figure) {
  constexpr std::size_t kMostDigits = 3;
  std::string digits = fmt::format("{:.{}f}", figure.half.value_or(0), figure.decimals);
  if (digits.find_first_not_of("0.") == std::string::npos) return "";
  if (figure.decimals >= 2 && digits.starts_with("0.")) digits.erase(0, 1);
  if (digits.size() > kMostDigits && figure.decimals == 1) {
    digits = fmt::format("{:.0f}", *figure.half);
  }
  return fmt::format("{}{}", kSign, digits);
}

std::string escaped(const std::string& words, const std::map<char, std::string>& by) {
  std::string text;
  for (const char c : words) {
    const auto found = by.find(c);
    text += found == by.end() ? std::string(1, c) : found->second;
  }
  return text;
}

/// Words of a cell.
std::string words_in(const std::string& words, Format format) {
  static const std::map<char, std::string> latex{{'&', "\\&"},
                                                 {'%', "\\%"},
                                                 {'$', "\\$"},
                                                 {'#', "\\#"},
                                                 {'_', "\\_"},
                                                 {'{', "\\{"},
                                                 {'}', "\\}"},
                                                 {'\n', " "},
                                                 {'~', "\\textasciitilde{}"},
                                                 {'<', "$<$"},
                                                 {'>', "$>$"},
                                                 {'|', "$|$"},
                                                 {'^', "\\textasciicircum{}"},
                                                 {'\\', "\\textbackslash{}"}};
  static const std::map<char, std::string> csv{{'"', "\"\""}};
  if (format == Format::markdown) return in_markdown(words);
  if (format == Format::latex) return escaped(words, latex);
  if (words.find_first_of(",\"\r\n") == std::string::npos) return words;
  return '"' + escaped(words, csv) + '"';
}

/// The fields of a row, in CSV with a further field after each figure of a column with halves.
std::vector<std::string> fields_of(const std::vector<Cell>& row, const std::vector<bool>& with_half,
                                   Format format) {
  std::vector<std::string> fields;
  for (std::size_t c = 0; c < row.size(); ++c) {
    const TableFigure* figure = std::get_if<TableFigure>(&row[c]);
    const auto* words = std::get_if<std::string>(&row[c]);
    if (words != nullptr) {
      fields.push_back(words_in(*words, format));
    } else if (format == Format::csv) {
      fields.push_back(figure ? fmt::format("{}", figure->mean) : "");
      if (with_half[c])
        fields.push_back(figure && figure->half ? fmt::format("{}", *figure->half) : "");
    } else if (figure == nullptr) {
      fields.emplace_back("-");
    } else if (format == Format::latex) {
      const std::string half = half_of(*figure);
      fields.push_back(fmt::format("${}{}$", number_of(*figure),
                                   half.empty() ? "" : " \\pm " + half.substr(kSign.size())));
    } else {
      fields.push_back(number_of(*figure) + half_of(*figure));
    }
  }
  return fields;
}

/// Columns of a terminal that UTF-8 takes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool is_right = false) {
  const std::string blanks(width - std::min(width, width_of(text)), ' ');
  return is_right ? blanks + text : text + blanks;
}

/// The widths of a column on a terminal, in characters.
struct Width {
  std::size_t words = 0;   ///< of cells without a figure
  std::size_t number = 0;  ///< of figures, up to the half
  std::size_t half = 0;
  std::size_t heading = 0;

  bool is_of_words() const { return number == 0; }
  std::size_t cell() const { return std::max({words, number + half, heading}); }
};

std::vector<Width> widths_of(const FigureTable& table) {
  std::vector<Width> widths;
  for (const TableColumn& column : table.columns) {
    widths.push_back({.heading = width_of(column.heading)});
  }
  for (const std::vector<Cell>& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      Width& width = widths[c];
      if (const auto* figure = std::get_if<TableFigure>(&row[c])) {
        width.number = std::max(width.number, width_of(number_of(*figure)));
        width.half = std::max(width.half, width_of(half_of(*figure)));
      } else if (const auto* words = std::get_if<std::string>(&row[c])) {
        width.words = std::max(width.words, width_of(*words));
      }
    }
  }
  return widths;
}

/// The table for a terminal.
std::string aligned(const FigureTable& table) {
  constexpr std::size_t kTerminal = 120, kLeastName = 8;
  const std::vector<Width> widths = widths_of(table);
  std::size_t figures = 0;
  for (std::size_t c = 1; c < widths.size(); ++c) figures += widths[c].cell();
  const std::size_t longest = widths.front().cell(), gaps = widths.size() - 1;
  const std::size_t gap = longest + figures + 2 * gaps <= kTerminal ? 2 : 1;
  const std::size_t taken = std::min(figures + gap * gaps, kTerminal - kLeastName);
  const std::size_t name_width = std::min(longest, kTerminal - taken);
  std::string text;
  const auto add_line = [&](const std::string& name, const auto& text_in) {
    std::string line = padded(name, name_width);
    if (width_of(name) > name_width) line += '\n' + std::string(name_width, ' ');
    for (std::size_t c = 1; c < widths.size(); ++c) line += std::string(gap, ' ') + text_in(c);
    while (line.ends_with(' ')) line.pop_back();
    text += line + '\n';
  };
  add_line(table.columns.front().heading, [&](std::size_t c) {
    // A heading ends above the numbers; it extends over the halves only if it is longer.
    const Width& width = widths[c];
    const bool is_right = !width.is_of_words();
    const std::size_t numbers = width.cell() - width.half;
    return padded(padded(table.columns[c].heading, is_right ? numbers : 0, is_right), width.cell());
  });
  for (const std::vector<Cell>& row : table.rows) {
    add_line(std::get<std::string>(row.front()), [&](std::size_t c) {
      const Width& width = widths[c];
      const std::size_t numbers = width.cell() - width.half;
      const auto* figure = std::get_if<TableFigure>(&row[c]);
      const auto* words = std::get_if<std::string>(&row[c]);
      if (words != nullptr) return padded(*words, width.cell());
      const std::string number = figure ? number_of(*figure) : "-";
      return padded(
          padded(number, numbers, !width.is_of_words()) + (figure ? half_of(*figure) : ""),
          width.cell());
    });
  }
  return text;
}

}  // namespace

Format format_of(std::string_view word) {
  const auto found = std::ranges::find(kFormats, word);
  if (found != kFormats.end()) return static_cast<Format>(found - kFormats.begin());
  throw std::invalid_argument(
      fmt::format("--format is '{}'; it takes {}", word, fmt::join(kFormats, ", ")));
}

std::string in_markdown(const std::string& words) {
  return escaped(words, {{'|', "\\|"}, {'<', "\\<"}, {'\n', " "}});
}

std::string table_text(const FigureTable& table, Format format) {
  if (format == Format::text) return aligned(table);
  struct Line {
    std::string_view before, between, after;
  };
  constexpr Line kMarkdown{"| ", " | ", " |\n"}, kCsv{"", ",", "\n"}, kLatex{"", " & ", " \\\\\n"};
  const Line& line = format == Format::markdown ? kMarkdown : format == Format::csv ? kCsv : kLatex;
  std::vector<bool> with_half(table.columns.size());
  std::vector<Cell> keys, headings;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    with_half[c] = std::ranges::any_of(table.rows, [&](const std::vector<Cell>& row) {
      const auto* figure = std::get_if<TableFigure>(&row[c]);
      return figure != nullptr && figure->half.has_value();
    });
    const auto& [key, heading] = table.columns[c];
    keys.emplace_back(key);
    headings.emplace_back(heading);
    if (with_half[c] && format == Format::csv) keys.emplace_back(key + "_half");
  }
  std::string text;
  const auto add = [&](const std::vector<Cell>& row) {
    text += fmt::format("{}{}{}", line.before,
                        fmt::join(fields_of(row, with_half, format), line.between), line.after);
  };
  const std::size_t further = table.columns.size() - 1;
  if (format == Format::latex) {
    text = fmt::format("\\begin{{tabular}}{{l{}}}\n\\toprule\n", std::string(further, 'r'));
  }
  add(format == Format::csv ? keys : headings);
  if (format == Format::markdown) {
    text += '|';
    for (std::size_t c = 0; c <= further; ++c) text += "---|";
    text += '\n';
  }
  if (format == Format::latex) text += "\\midrule\n";
  std::ranges::for_each(table.rows, add);
  if (format == Format::latex) text += "\\bottomrule\n\\end{tabular}\n";
  return text;
}

}  // namespace lcs::scoring
