/// \file
/// Warnings reported with the metrics of a run: from the simulation (`sim/world/warnings.h`),
/// images with too few corners, and in recordings an implausible motion (`motion_warnings.h`).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/warnings.h"
#include "tools/recording/motion_warnings.h"
#include "tools/recording/recording.h"

namespace lcs::recording {

inline constexpr const char* kWarningsFile = "warnings.json";

/// The least number of corners in a frame: a match needs neighbouring corners to support it.
inline constexpr int kFewCorners = 10;

/// Watches the frames of a run for warnings.
class WarningWatch {
 public:
  explicit WarningWatch(Truth truth) : is_recorded_(truth != Truth::all) {}

  void add(const FrameRecord& frame);

  /// One entry for each warning, in a fixed order, of the frames so far.
  /// \param world the simulation's warnings; absent without a simulation.
  std::vector<Warned> warned(const std::optional<sim::Warnings>& world) const;

 private:
  Warned few_corners() const;

  bool is_recorded_;
  MotionWatch motion_;
  std::int64_t frames_ = 0, few_ = 0;       ///< all, and those with few corners
  std::int64_t start_ns_ = 0, few_ns_ = 0;  ///< times of the first of each
};

/// One readable line for each warning that occurred.
std::vector<std::string> lines_of(const std::vector<Warned>& warnings);

/// Writes all checked warnings, by name. \throws OutputError
void write_warnings(const std::filesystem::path& path, const std::vector<Warned>& warnings);

/// Reads a file of `write_warnings`. \throws input::Error with the file and its fault.
std::vector<Warned> read_warnings(const std::filesystem::path& path);

/// The simulation's warnings in a run; absent if the run's folder has no such file.
/// \throws as `read_warnings`.
std::optional<sim::Warnings> world_warnings(const std::filesystem::path& folder);

}  // namespace lcs::recording
