#include "tools/report/report_page.h"

#include <fmt/format.h>
#include <unistd.h>

#include <string>
#include <string_view>
#include <system_error>

#include "tools/bench/output_file.h"
#include "tools/report/page_template.h"
#include "tools/report/report_data.h"

namespace lcs::report {
namespace {

namespace fs = std::filesystem;

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

/// The template with each {{name}} replaced, once. What is put in is not looked at again.
std::string page(const suite::SuiteResult& suite, std::string_view data) {
  const std::string title = escaped("lcs suite: " + suite.detector);
  std::string html;
  html.reserve(kPageHtml.size() + kPageCss.size() + kPageJs.size() + data.size());
  std::string_view rest = kPageHtml;
  for (std::size_t open = rest.find("{{"); open != rest.npos; open = rest.find("{{")) {
    const std::size_t close = rest.find("}}", open);
    const std::string_view name = rest.substr(open + 2, close - open - 2);
    html += rest.substr(0, open);
    html += name == "title"    ? title
            : name == "style"  ? kPageCss
            : name == "script" ? kPageJs
                               : data;
    rest.remove_prefix(close + 2);
  }
  html += rest;
  return html;
}

}  // namespace

void write_report(const fs::path& file, const suite::SuiteResult& suite,
                  const suite::SuiteResult* baseline, const fs::path& suite_folder) {
  const std::string html = page(suite, report_data(suite, baseline, suite_folder));
  fs::path beside = file;
  beside += fmt::format(".partial-{}", ::getpid());
  std::error_code error;
  try {
    bench::OutputFile out(beside);
    out.write(html);
    out.close();
    fs::rename(beside, file, error);
    if (error) {
      throw bench::OutputError(fmt::format("cannot write {}: {}", file.string(), error.message()));
    }
  } catch (...) {
    fs::remove(beside, error);
    throw;
  }
}

}  // namespace lcs::report
