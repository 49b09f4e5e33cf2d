#include "tools/report/report_page.h"

#include <string>

#include "tools/report/page_writer.h"
#include "tools/report/report_data.h"
#include "tools/report/report_script.h"

namespace lcs::report {

void write_report(const std::filesystem::path& file, const suite::SuiteResult& suite,
                  const suite::SuiteResult* baseline, const std::filesystem::path& suite_folder) {
  const std::string title = "lcs suite: " + suite.detector;
  const std::string data = report_data(suite, baseline, suite_folder);
  write_page(file,
             {.title = title, .data = data, .script = kReportJs, .where_else = suite::kSuiteFile});
}

}  // namespace lcs::report
