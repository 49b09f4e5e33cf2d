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
                         kProgramHelp, argc, argv);
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
