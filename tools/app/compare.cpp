#include "tools/app/compare.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

#include "tools/app/suite_end.h"
#include "tools/files/output.h"
#include "tools/suite/merge_request.h"
#include "tools/suite/plan.h"

namespace lcs::app {

Compared compare(const CompareRequest& request) {
  const suite::Pattern wanted(request.metric, "--metric", "rebel.*f1");
  Compared compared{
      .before = suite::read_suite(request.before),
      .after = suite::read_suite(request.after),
      .warnings = other_inputs(suite::folder_of(request.before), suite::folder_of(request.after))};
  compared.comparison =
      suite::compare(compared.before, compared.after,
                     [&](std::string_view metric) { return wanted.is_in(metric); });
  if (request.allow_missing) compared.comparison.missing.clear();
  if (compared.comparison.scenarios.empty()) {
    throw std::runtime_error(
        fmt::format("{} and {} have no scenario in common; give two suites of the same scenarios",
                    request.before, request.after));
  }
  const bool is_text_asked = !request.markdown.empty();  // which shows the events
  const auto in_folder = [&](const suite::SuiteResult& suite, const std::string& named) {
    return suite::SuiteInFolder{suite, is_text_asked ? suite::folder_of(named) : ""};
  };
  const suite::SuiteInFolder before = in_folder(compared.before, request.before),
                             after = in_folder(compared.after, request.after);
  compared.verdict = suite::verdict_of(after, &before, &compared.comparison);
  if (is_text_asked) {
    files::Output folder(request.markdown,
                         {suite::kSummaryFile, suite::kBeforePicture, suite::kAfterPicture});
    suite::write_merge_request(folder.staging(), before, after, compared.comparison,
                               compared.verdict, request.pictures_at);
    folder.commit();
  }
  return compared;
}

}  // namespace lcs::app
