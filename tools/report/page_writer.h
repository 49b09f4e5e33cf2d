/// \file
/// Pages in one file each, which opens from disk and asks the network for nothing: data with the
/// script that lays it out, or text that needs no script.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>

namespace lcs::report {

/// Text as it stands in an element or between quotes of an attribute.
std::string escaped(std::string_view text);

struct Page {
  std::string_view title;
  std::string_view data;        ///< JSON in UTF-8
  std::string_view script;      ///< runs after `plot.js`; finds the data in the element `data`
  std::string_view where_else;  ///< file with the same figures, for a browser without JavaScript
};

/// Written beside its place, then renamed: the file appears whole or not at all.
/// \throws bench::OutputError
void write_page(const std::filesystem::path& file, const Page& page);

/// A page without a script, written from its top on.
class TextPage {
 public:
  /// \param style CSS behind that of all pages.
  TextPage(std::string_view title, std::string_view style);

  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(html_), format, std::forward<Args>(args)...);
  }

  /// As `write_page`.
  void write(const std::filesystem::path& file) const;

 private:
  std::string html_;
};

}  // namespace lcs::report
