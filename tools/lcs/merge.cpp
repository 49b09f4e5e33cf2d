/// \file
/// `lcs merge`: joins the parts of a suite that `lcs suite --shard` made.

#include "tools/app/suite.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/suite_end.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

struct MergeOptions {
  app::MergeRequest request;
  SuiteEndOptions end;
};

constexpr const char* kMergeHelp = R"(Examples:
  lcs suite --worlds train --count 1000 --shard 1/2 --out part1     on one machine
  lcs suite --worlds train --count 1000 --shard 2/2 --out part2     on another
  lcs merge part1 part2 --out out/train

The merged suite has the files of a suite that was made in one go: figures, report, JUnit, tables. The parts
do not change. On one file system their runs are linked, not copied.

Exit codes: as of lcs suite. 2 also if a part is missing or belongs to another suite.
)";

ExitCode merge(const MergeOptions& options) {
  Terminal terminal(options.end.quiet);
  return show_suite(app::merge(options.request, terminal), options.request.place, options.end);
}

app::Options options_of(MergeOptions& options) {
  app::Options all = app::options_of(options.request);
  add_suite_end(all, options.end);
  return all;
}

}  // namespace

Command merge_command() {
  return command_of("Join the parts of a suite that several machines made (lcs suite --shard)",
                    kMergeHelp, &merge);
}

}  // namespace lcs::tools
