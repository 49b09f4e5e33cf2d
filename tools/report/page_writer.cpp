#include "tools/report/page_writer.h"

#include "tools/files/output_file.h"

namespace lcs::report {

// The files of this folder that every page needs, embedded in the program at build time.
extern const std::string_view kPageHtml;  // has {{title}}, {{style}}, {{data}} and {{script}}
extern const std::string_view kPageCss;
extern const std::string_view kPlotJs;  // helpers for elements, numbers and plots
// The plotting library uPlot, unmodified, and its licence.
extern const std::string_view kUplotJs, kUplotCss, kUplotLicence;

namespace {

/// JSON with every "<" escaped, because "</script>" would end the enclosing element.
std::string embeddable(std::string_view json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json)
    safe += c == '<' ? std::string_view("\\u003c") : std::string_view(&c, 1);
  return safe;
}

/// The template with each {{name}} replaced. Inserted text is not searched for further names.
std::string html_of(const Page& page) {
  const std::string title = escaped(page.title);
  const std::string data = embeddable(page.data);
  const std::string style = fmt::format("{}\n{}", kUplotCss, kPageCss);
  const std::string script =
      fmt::format("/*\n{}*/\n{}\n{}\n{}", kUplotLicence, kUplotJs, kPlotJs, page.script);
  std::string html;
  html.reserve(kPageHtml.size() + style.size() + script.size() + data.size());
  std::string_view rest = kPageHtml;
  for (std::size_t open = rest.find("{{"); open != rest.npos; open = rest.find("{{")) {
    const std::size_t close = rest.find("}}", open);
    const std::string_view name = rest.substr(open + 2, close - open - 2);
    html += rest.substr(0, open);
    html += name == "title"        ? std::string_view(title)
            : name == "style"      ? std::string_view(style)
            : name == "script"     ? std::string_view(script)
            : name == "where_else" ? page.where_else
                                   : std::string_view(data);
    rest.remove_prefix(close + 2);
  }
  html += rest;
  return html;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    html += c == '&'   ? "&amp;"
            : c == '<' ? "&lt;"
            : c == '>' ? "&gt;"
            : c == '"' ? "&quot;"
                       : std::string_view(&c, 1);
  }
  return html;
}

void write_page(const std::filesystem::path& file, const Page& page) {
  files::write_file(file, html_of(page));
}

TextPage::TextPage(std::string_view title, std::string_view style) {
  add("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>{}</title>\n<style>\n{}{}</style>\n</head>\n<body>\n",
      title, Html{std::string(kPageCss)}, Html{std::string(style)});
}

void TextPage::write(const std::filesystem::path& file) const {
  files::write_file(file, html_ + "</body>\n</html>\n");
}

}  // namespace lcs::report
