#include "tools/app/compare.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

#include "tools/files/output.h"
#include "tools/suite/merge_request.h"
#include "tools/suite/pattern.h"

namespace lcs::app {

Compared compare(const CompareRequest& request) {
  const suite::Pattern wanted(request.metric, "--metric", "rebel.*f1");
  Compared compared{.before = suite::read_suite(request.before),
                    .after = suite::read_suite(request.after),
                    .comparison = {},
                    .verdict = {}};
  compared.comparison =
      suite::compare(compared.before, compared.after,
                     [&](std::string_view metric) { return wanted.is_in(metric); });
  if (compared.comparison.scenarios.empty()) {
    throw std::runtime_error(
        fmt::format("{} and {} have no scenario in common; give two suites of the same "
                    "scenarios",
                    request.before, request.after));
  }
  compared.verdict = suite::verdict_of({compared.after, {}}, nullptr, &compared.comparison);
  if (!request.markdown.empty()) {
    bench::Output folder(request.markdown,
                         {suite::kSummaryFile, suite::kBeforePicture, suite::kAfterPicture});
    suite::write_merge_request(folder.staging(),
                               {compared.before, suite::folder_of(request.before)},
                               {compared.after, suite::folder_of(request.after)},
                               compared.comparison, request.pictures_at);
    folder.commit();
  }
  return compared;
}

}  // namespace lcs::app
