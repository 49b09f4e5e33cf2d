#include "tools/lcs/likeness.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "scenarios/load.h"
#include "sim/simulation.h"
#include "tools/files/output.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/options.h"
#include "tools/lcs/progress.h"
#include "tools/lcs/terminal.h"
#include "tools/likeness/measure.h"
#include "tools/likeness/page.h"
#include "tools/replay/picture_stream.h"
#include "tools/replay/recorded.h"
#include "tools/replay/rectifier.h"
#include "tools/suite/plan.h"

namespace lcs::tools {
namespace {

namespace fs = std::filesystem;
using likeness::Origin;

constexpr const char* kHelp = R"(Examples:
  lcs likeness --worlds validate --count 36 --suite
  lcs likeness --worlds validate --recording street=drive --recording lab=photographs
  lcs likeness --recording mine=pictures --fast-threshold 30

Are pictures of worlds like those of real cameras, as corners see them? Of each run some pairs of neighbouring
pictures are taken, spread evenly. Each pair gives one number a measure: how many corners there are, how near
to each other, of what contrast; how far and where they move, by optical flow there and back; the noise where
the picture is flat; the share of corners that flow can follow, that of those with a corner within 2 px of
where they went, and the same share for places beside, where nothing says that there is one. Measures are the
same for pictures of any origin (tools/likeness/measure.h).

Worlds and scenarios have corners by their own threshold, recordings by --fast-threshold. A recording is any
folder that `lcs replay` reads; of pictures alone nothing else need be known.

Files written to the folder, all or none:
  page.html     the distributions side by side, and a table; open it in a browser
  likeness.csv  a row a pair

Exit codes:
  0  fine
  2  error: nothing was written, an earlier result is as it was
  130  interrupted (Ctrl-C): likewise
)";

cv::Mat1b grey_of(const cv::Mat3b& picture) {
  cv::Mat1b grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

likeness::Run simulated(const scenario::Scenario& scenario, Origin origin,
                        const std::string& group) {
  likeness::Run run{origin, group, scenario.name, scenario.frames, scenario.fast_threshold, {}};
  run.picture = [scenario, simulation = std::shared_ptr<sim::Simulation>(),
                 next = 0](int frame) mutable -> cv::Mat1b {
    check_interrupted();
    if (!simulation) simulation = std::make_shared<sim::Simulation>(scenario);
    for (; next < frame; ++next) simulation->skip();
    ++next;
    return grey_of(simulation->next()->image);
  };
  return run;
}

/// As a filter would be given it: without its colours, straightened.
likeness::Run recorded(const std::string& name, const fs::path& folder, int threshold) {
  // what pictures do not say has no part in what is measured
  scenario::Recorded asked;
  asked.source = {folder.string(), 0};
  asked.path = folder;
  asked.speed_mps = 0;
  const auto recording =
      std::make_shared<const replay::Recorded>(replay::layout_of(asked).read(asked, false));
  likeness::Run run{Origin::recording, name, name, static_cast<int>(recording->frames.size()),
                    threshold,         {}};
  run.picture = [recording, reader = replay::PictureStream(*recording),
                 rectifier = std::shared_ptr<replay::Rectifier>()](int frame) mutable -> cv::Mat1b {
    check_interrupted();
    std::optional<cv::Mat3b> picture =
        reader.read(recording->frames[static_cast<std::size_t>(frame)]);
    if (!picture) return {};
    if (recording->lens && !rectifier) {
      rectifier = std::make_shared<replay::Rectifier>(*recording->lens, picture->size());
    }
    if (rectifier) rectifier->rectify(*picture);
    return grey_of(*picture);
  };
  return run;
}

std::vector<likeness::Run> runs_of(const LikenessOptions& options) {
  std::vector<likeness::Run> runs;
  std::set<std::string> names;
  for (const std::string& text : options.recordings) {  // what is wrong with them comes first
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == text.npos || text.find_first_of(",\n") < equals) {
      throw std::invalid_argument(
          fmt::format("--recording takes NAME=FOLDER, as street=drive, not '{}'", text));
    }
    const std::string name = text.substr(0, equals);
    if (!names.insert(name).second) {
      throw std::invalid_argument(
          fmt::format("--recording {}: there is one of that name; give another name", text));
    }
    runs.push_back(recorded(name, text.substr(equals + 1), options.fast_threshold));
  }
  if (options.suite) {
    for (const suite::PlannedScenario& planned : suite::plan(suite::PlanOptions())) {
      if (!planned.scenario) throw std::runtime_error(planned.error);
      runs.push_back(simulated(*planned.scenario, Origin::suite, "suite"));
    }
  }
  if (!options.worlds.split.empty()) {
    for (const std::string& file :
         make_worlds(options.worlds, std::max(1U, std::thread::hardware_concurrency()))) {
      const scenario::Scenario scenario = scenario::load(file);
      runs.push_back(
          simulated(scenario, Origin::world, scenario.name.substr(0, scenario.name.find('_'))));
    }
  }
  if (runs.empty()) {
    throw std::invalid_argument(
        "there is nothing to compare; give --worlds SPLIT, --suite or --recording NAME=FOLDER");
  }
  return runs;
}

}  // namespace

CLI::App& add_likeness_command(CLI::App& app, LikenessOptions& options) {
  CLI::App& command = *app.add_subcommand(
      "likeness", "Compare the corners of worlds, the project's scenarios and recordings");
  add_worlds_options(command, options.worlds, "Measure worlds");
  command.add_flag("--suite", options.suite, "Measure the project's short scenarios");
  command
      .add_option("--recording", options.recordings,
                  "Measure a folder that `lcs replay` reads; may be repeated")
      ->type_name("NAME=FOLDER")
      ->allow_extra_args(false);
  add_integer_option(command, "--fast-threshold", options.fast_threshold,
                     "Contrast of a recording's corners, 1 to 254 grey levels; 20 if not given", 1,
                     254)
      ->type_name("N");
  add_integer_option(command, "--pairs", options.pairs,
                     "Pairs of pictures of each run; 12 if not given", 1, 10'000)
      ->type_name("N");
  add_out_option(command, options.out, "out/likeness");
  add_quiet_option(command, options.quiet);
  command.footer(kHelp);
  return command;
}

ExitCode likeness(const LikenessOptions& options) {
  std::vector<likeness::Run> runs = runs_of(options);
  bench::Output folder(options.out, likeness::likeness_files());
  std::vector<likeness::Row> rows;
  {
    Progress progress("likeness", static_cast<int>(runs.size()), options.quiet, "runs");
    for (std::size_t i = 0; i < runs.size(); ++i) {
      progress.show(static_cast<int>(i) + 1);
      const likeness::Run run = std::move(runs[i]);  // its simulation ends with it
      const auto measured = likeness::measure(run, options.pairs);
      rows.insert(rows.end(), measured.begin(), measured.end());
    }
  }
  likeness::write_likeness(folder.staging(), rows);
  check_interrupted();
  folder.commit();
  if (!options.quiet) {
    print_out("{}results in {}\n", likeness::text_of(likeness::groups_of(rows)),
              folder.target().string());
  }
  return kFine;
}

}  // namespace lcs::tools
