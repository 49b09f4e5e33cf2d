/// \file
/// `page.js` of this folder, embedded in the program: the script that lays out a suite's data.
#pragma once

#include <string_view>

namespace lcs::report {

extern const std::string_view kReportJs;

}  // namespace lcs::report
