/// \file
/// The page's template and what every page needs: `page.html`, `page.css` and `plot.js` as they lie
/// beside this file, made part of the program when it is built.
#pragma once

#include <string_view>

namespace lcs::report {

extern const std::string_view kPageHtml;  ///< with {{title}}, {{style}}, {{data}} and {{script}}
extern const std::string_view kPageCss;
extern const std::string_view kPlotJs;  ///< elements, numbers, plots

/// uPlot, which draws the plots, as it was published, and its licence.
extern const std::string_view kUplotJs;
extern const std::string_view kUplotCss;
extern const std::string_view kUplotLicence;

}  // namespace lcs::report
