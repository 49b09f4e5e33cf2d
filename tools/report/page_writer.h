/// \file
/// Data and the script that lays it out as one page. HTML, CSS, script and data are all in the one
/// file: it opens from disk and asks the network for nothing.
#pragma once

#include <filesystem>
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

}  // namespace lcs::report
