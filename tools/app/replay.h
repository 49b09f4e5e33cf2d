/// \file
/// Runs detectors on a recording that a request describes instead of a scenario file.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "tools/app/option.h"
#include "tools/app/run.h"
#include "tools/files/output.h"

namespace lcs::app {

/// A key of `recording` that an option of its own sets. The scenario loader checks its value.
struct RecordingKey {
  const char* key;
  const char* type;  ///< "FILE": a path; with commas: a list; "": a flag
};

/// All but `format`, whose help text lists the layouts.
std::span<const RecordingKey> recording_keys();

struct ReplayRequest {
  std::string path = {};                              ///< folder or video of the recording
  std::map<std::string, std::string> recording = {};  ///< of a scenario's `recording`
  std::string ego_motion = {};                        ///< imu or truth; "": the recording's default
  std::string corners = {};                           ///< their source; "": pictures
  std::string fast_threshold = {};                    ///< "": the recording's default
  std::string preset = {};                            ///< "": the recording's default
  std::vector<std::string> sets = {};                 ///< filter settings, "key=value"
  /// Its `detector`, `beside`, `video`, `events`, `threads`, and `out`; "" is `out/<recording>`.
  RunRequest run = {};
};

Options options_of(ReplayRequest& request);

/// The option of a key of `recording`: --fps for fps, --image-topic for topics.image, --world-frame
/// for topics.world.
std::string flag_of(const std::string& key);

/// \throws as `run`.
RunMade replay(const ReplayRequest& request, Caller& caller);

/// Writes the scenario that the request describes.
/// \throws input::Error, files::OutputError; then nothing is written.
void write_scenario(const ReplayRequest& request, const std::filesystem::path& path,
                    files::Overwrite overwrite);

}  // namespace lcs::app
