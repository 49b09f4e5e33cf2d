#include "tools/report/report_page.h"

#include <string>

#include "tools/report/page_writer.h"
#include "tools/report/report_data.h"
#include "tools/report/report_script.h"
#include "tools/scoring/figures_file.h"

namespace lcs::report {

void write_report(const std::filesystem::path& file, const suite::SuiteInFolder& suite,
                  const suite::Verdict& verdict, const Against* against) {
  const std::string title = "lcs suite: " + suite.suite.detector;
  const std::string data = report_data(suite, verdict, against);
  write_page(file,
             {.title = title, .data = data, .script = kReportJs, .where_else = suite::kSuiteFile});
}

void write_run_report(const std::filesystem::path& file, const suite::SuiteInFolder& suite) {
  const std::string title = "lcs run: " + suite.suite.scenarios.at(0).name;
  const std::string data = run_report_data(suite);
  write_page(
      file, {.title = title, .data = data, .script = kReportJs, .where_else = bench::kMetricsFile});
}

}  // namespace lcs::report
