/// \file
/// Writes HTML pages, each a single file that opens from disk without network access: data with a
/// script that lays it out, or text without a script.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace lcs::report {

/// Escapes text for an HTML element or a quoted attribute.
std::string escaped(std::string_view text);

/// Text that is HTML or SVG itself, in which all other text is escaped.
struct Html {
  std::string text;
};

/// The form of a value in a page: numbers and `Html` as they are, all other text escaped.
template <class T>
auto shown(const T& value) {
  if constexpr (std::is_same_v<T, Html>) {
    return std::string_view(value.text);
  } else if constexpr (std::is_arithmetic_v<T>) {
    return value;
  } else {
    return escaped(value);
  }
}

struct Page {
  std::string_view title;
  std::string_view data;        ///< JSON in UTF-8
  std::string_view script;      ///< runs after `plot.js`; reads the data from the element `data`
  std::string_view where_else;  ///< file with the same figures, named if JavaScript is off
};

/// Writes the page. \throws files::OutputError
void write_page(const std::filesystem::path& file, const Page& page);

/// A page without a script, built from top to bottom.
class TextPage {
 public:
  /// \param style CSS that follows the common CSS.
  TextPage(std::string_view title, std::string_view style);

  /// \param format HTML. \param args by `shown`.
  template <class... Args>
  void add(fmt::format_string<decltype(shown(std::declval<const Args&>()))...> format,
           const Args&... args) {
    fmt::format_to(std::back_inserter(html_), format, shown(args)...);
  }

  /// As `write_page`.
  void write(const std::filesystem::path& file) const;

 private:
  std::string html_;
};

}  // namespace lcs::report
