/// \file
/// The `lcs` command.

#include <exception>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <string_view>
#include <system_error>

#include "scenarios/input/message.h"
#include "tools/files/output_file.h"
#include "tools/lcs/command_line.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/terminal.h"
#include "tools/suite/child_process.h"

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
  lcs explain RUN FRAME X Y           why the filter called a corner a rebel, or did not
  lcs world FAMILY                    a scenario and its scene, drawn from a seed
  lcs tune out/train                  the filter's numbers, learnt from recorded worlds
  lcs kinematics                      when the motion model holds, for your camera and rover
  lcs run --help                      all about a command
)";

constexpr const char* kNoMemory =
    "not enough memory; raise ulimit -v where it is set, or choose a smaller camera or scene";

}  // namespace

int main(int argc, char** argv) {
  // One thread: results do not depend on the number of cores. OpenCV reports errors by exceptions.
  cv::setNumThreads(0);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  open_standard_descriptors();
  const bool is_child = argc > 0 && std::string_view(argv[0]) == lcs::suite::kChildName;
  try {
    const int exit_code =
        run_command_line({run_command(), preview_command(), replay_command(), score_command(),
                          suite_command(), merge_command(), generate_command(), compare_command(),
                          explain_command(), kinematics_command(), world_command(), tune_command()},
                         kHelp, argc, argv);
    finish_out();
    return exit_code;
  } catch (const Interrupted& interrupted) {
    print_err("lcs: {}\n", interrupted.what());
    return kInterrupted;
  } catch (const std::bad_alloc&) {
    return fail(kNoMemory);
  } catch (const cv::Exception& error) {
    return fail(error.code == cv::Error::StsNoMem ? kNoMemory : error.what());
  } catch (const lcs::files::OutputError& error) {
    fail(error.what());
    return is_child ? lcs::suite::kFaultyDisk : kError;
  } catch (const std::system_error& error) {
    fail(lcs::input::message_of(error));
    return is_child && error.code() == std::errc::io_error ? lcs::suite::kFaultyDisk : kError;
  } catch (const std::exception& error) {
    return fail(lcs::input::message_of(error));
  }
}
