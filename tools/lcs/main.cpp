/// \file
/// The `lcs` command.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <string>
#include <vector>

#include "tools/app/version.h"
#include "tools/input/message.h"
#include "tools/input/spelling.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/options.h"
#include "tools/lcs/terminal.h"

namespace {

using namespace lcs::tools;

constexpr const char* kHelp =
    R"(A rover drives through a simulated world, the Line-Circle-Square filter watches
through its camera and IMU, and the simulator's truth scores the filter.

  lcs run scenarios/crossing.yaml     run a scenario; results are in out/crossing
  lcs preview SCENARIO                check one before a run: its plan, its problems
  lcs suite                           run all short scenarios, with several seeds each
  lcs merge part1 part2               join the parts of a suite that several machines made
  lcs compare out/before out/suite    the differences of two suites, beyond noise
  lcs generate SCENARIO               a sequence of pictures and truth that other tools read
  lcs replay PATH                     the filter on EuRoC, KITTI, TUM RGB-D, MOT, a video, pictures
  lcs score DIR --detections FILE     someone else's detector, by a run's truth
  lcs world FAMILY                    a scenario and its scene, drawn from a seed
  lcs tune out/train                  the filter's numbers, learnt from recorded worlds
  lcs kinematics                      when the motion model holds, for your camera and rover
  lcs run --help                      all about a command
)";

constexpr const char* kNoMemory =
    "not enough memory; raise ulimit -v where it is set, or choose a smaller camera or scene";

/// Help formatter that lists positional arguments only once, not among the options too.
class Help : public CLI::Formatter {
 public:
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override {
    if (!is_positional) {
      std::erase_if(options, [](const CLI::Option* option) { return option->get_positional(); });
    }
    return Formatter::make_group(group, is_positional, options);
  }
};

int fail(const std::string& message) {
  tell(fmt::format("lcs: {}", message));
  return kError;
}

/// The message for a first argument that is no command; "" if it is one, or none is given.
std::string unknown_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || *argv[1] == '-') return "";
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::ranges::find(names, argv[1]) != names.end()) return "";
  const auto near = lcs::input::nearest(argv[1], names);
  return fmt::format("there is no command '{}'; {}", argv[1],
                     near ? fmt::format("did you mean '{}'?", *near)
                          : fmt::format("the commands are {}", fmt::join(names, ", ")));
}

int run_command_line(int argc, char** argv) {
  CLI::App app("Test bench for the Line-Circle-Square filter", "lcs");
  app.formatter(std::make_shared<Help>());
  app.set_version_flag(
      "--version", lcs::app::version_text,
      "Print the versions of this program (with its commit), MuJoCo, the renderer and OpenCV");
  app.require_subcommand(1);
  app.footer(kHelp);
  const Command commands[] = {
      add_run_command(app),      add_preview_command(app), add_replay_command(app),
      add_score_command(app),    add_suite_command(app),   add_merge_command(app),
      add_generate_command(app), add_compare_command(app), add_kinematics_command(app),
      add_world_command(app),    add_tune_command(app),
  };
  refuse_empty_options(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ExcludesError& error) {
    return fail(fmt::format("{}: the two do not go together; leave one of them out", error.what()));
  } catch (const CLI::RequiresError& error) {
    return fail(fmt::format("{}; give both, or leave the first out", error.what()));
  } catch (const CLI::ParseError& error) {
    if (const std::string unknown = unknown_command(app, argc, argv); !unknown.empty()) {
      return fail(unknown);
    }
    const auto named = app.get_subcommands();  // the sub-command in use, if any
    const std::string command = named.empty() ? "" : named.front()->get_name() + " ";
    return fail(fmt::format("{}; see lcs {}--help", error.what(), command));
  }
  for (const Command& command : commands) {
    if (command.options.parsed()) return command.carry_out();
  }
  return fail("no command was given; see lcs --help");
}

}  // namespace

int main(int argc, char** argv) {
  // One thread: results do not depend on the number of cores. OpenCV reports errors by exceptions.
  cv::setNumThreads(0);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  open_standard_descriptors();
  try {
    const int exit_code = run_command_line(argc, argv);
    finish_out();
    return exit_code;
  } catch (const Interrupted& interrupted) {
    print_err("lcs: {}\n", interrupted.what());
    return kInterrupted;
  } catch (const std::bad_alloc&) {
    return fail(kNoMemory);
  } catch (const cv::Exception& error) {
    return fail(error.code == cv::Error::StsNoMem ? kNoMemory : error.what());
  } catch (const std::exception& error) {
    return fail(lcs::input::message_of(error));
  }
}
