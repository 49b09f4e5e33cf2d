/// \file
/// The files of this folder that every page needs, `page.html`, `page.css` and `plot.js`, embedded
/// in the program at build time.
#pragma once

#include <string_view>

namespace lcs::report {

extern const std::string_view kPageHtml;  ///< has {{title}}, {{style}}, {{data}} and {{script}}
extern const std::string_view kPageCss;
extern const std::string_view kPlotJs;  ///< helpers for elements, numbers and plots

/// The plotting library uPlot, unmodified, and its licence.
extern const std::string_view kUplotJs;
extern const std::string_view kUplotCss;
extern const std::string_view kUplotLicence;

}  // namespace lcs::report
