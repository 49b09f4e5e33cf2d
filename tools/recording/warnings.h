/// \file
/// Warnings reported with the metrics of a run: from the simulation (`sim/world/warnings.h`),
/// images with too few corners, and in recordings signs that the estimated motion is not the
/// camera's, or that the verdicts are useless. The latter use only corners, verdicts and the
/// estimated motion.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/world/warnings.h"
#include "tools/recording/recording.h"

namespace lcs::recording {

inline constexpr const char* kWarningsFile = "warnings.json";

/// The least number of corners in a frame: a match needs neighbouring corners to support it.
inline constexpr int kFewCorners = 10;

struct Warned {
  std::string word;                   ///< "warnings.WORD" is the metric
  std::optional<std::int64_t> count;  ///< absent: not checked in this run
  std::string text;                   ///< first occurrence and remedy; empty if it did not occur
};

/// Frames with a sign, and the first of them.
struct Sign {
  std::int64_t count = 0;
  double first_s = 0;

  void add(double t_s) {
    if (count++ == 0) first_s = t_s;
  }
};

/// Faster than any road vehicle: dead reckoning has diverged, or the unit is wrong.
inline constexpr double kRunawaySpeed_mps = 70;

/// A larger share of rebels is implausible: most of the scene does not move by itself.
inline constexpr double kManyRebels = 0.3;

/// Watches a run for images with too few corners, and a recording for four warnings more, in this
/// order:
///
/// * runaway_speed: estimated speeds above `kRunawaySpeed_mps`;
/// * turn_not_told: most corners have moved by the same vector of 3 px or more, but the estimated
///   motion has neither rotation nor sideways velocity; reported from five such frames on;
/// * still_camera: the estimated motion adds up to 1 m, but nearly all corners stayed in place;
///   reported from three such stretches on, if they are nine in ten;
/// * many_rebels: at least the share `kManyRebels` of the corners are rebels; reported if this
///   holds in more than half of the frames.
class WarningWatch {
 public:
  explicit WarningWatch(Truth truth) : is_recorded_(truth != Truth::all) {}

  void add(const FrameRecord& frame);

  /// One entry for each warning, in a fixed order, of the frames so far.
  /// \param world the simulation's warnings; absent without a simulation.
  std::vector<Warned> warned(const std::optional<sim::Warnings>& world) const;

 private:
  using Corners = std::vector<Eigen::Vector2f>;
  void watch_motion(const FrameRecord& frame, double t_s);
  void watch_rebels(const FrameRecord& frame, double t_s);
  std::vector<Warned> of_frames() const;

  bool is_recorded_;
  Sign few_, runaway_, turns_, stands_, rebels_;
  std::int64_t frames_ = 0;
  std::int64_t start_ns_ = 0;        ///< time of the first frame
  double runaway_mps_ = 0;           ///< the first speed above `kRunawaySpeed_mps`
  Corners previous_px_;              ///< corners of the previous frame
  Corners stretch_px_;               ///< corners at the start of the present stretch
  double gone_m_ = 0;                ///< way in this stretch
  std::int64_t stretches_ = 0;       ///< finished ones
  std::int64_t judged_ = 0;          ///< frames that are judged by their rebels
  int rebel_parts_ = 0, parts_ = 0;  ///< of the picture, in frames with many rebels
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
