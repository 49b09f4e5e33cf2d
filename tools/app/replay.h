/// \file
/// Runs detectors on a recording that a request describes instead of a scenario file.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/app/run.h"
#include "tools/files/output.h"

namespace lcs::app {

/// The key of `recording` whose option is a flag.
inline constexpr const char* kNothingMoves = "nothing_moves";

struct ReplayRequest {
  std::string path;                              ///< folder or video of the recording
  std::map<std::string, std::string> recording;  ///< keys and values of a scenario's `recording`
  std::string ego_motion;                        ///< imu or truth; "": the recording's default
  std::string corners;                           ///< their source; "": pictures
  std::string fast_threshold;                    ///< "": the recording's default
  std::string preset;                            ///< "": the recording's default
  std::vector<std::string> sets;                 ///< filter settings, "key=value"
  DetectorChoice detector;
  std::vector<std::string> beside;  ///< as in `RunRequest`
  std::string out;                  ///< folder; "" is `out/<name of the recording>`
  bool no_video = false;
  bool events = false;
  int threads = 1;  ///< as in `RunRequest`
};

/// The option of a key of `recording`: --fps for fps, --image-topic for topics.image, --world-frame
/// for topics.world.
std::string flag_of(const std::string& key);

/// The command line that makes the same request, without `lcs`.
std::vector<std::string> arguments_of(const ReplayRequest& request);

/// \throws as `run`.
RunMade replay(const ReplayRequest& request, Caller& caller);

/// Writes the scenario that the request describes.
/// \throws input::Error, bench::OutputError; then nothing is written.
void write_scenario(const ReplayRequest& request, const std::filesystem::path& path,
                    bench::Overwrite overwrite);

}  // namespace lcs::app
