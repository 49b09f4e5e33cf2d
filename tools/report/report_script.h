/// \file
/// `page.js` as it lies beside this file: what lays out a suite's data.
#pragma once

#include <string_view>

namespace lcs::report {

extern const std::string_view kReportJs;

}  // namespace lcs::report
