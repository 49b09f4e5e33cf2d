/// \file
/// A recorded sequence, whatever layout it had on disk: what `lcs replay` runs a detector on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/replay/motion_source.h"

namespace lcs::replay {

/// What a reader met that is not as it should be, counted; told to the user in the end.
class Tally {
 public:
  /// \param what a plural, as "pictures that the list names are missing".
  /// \param example of it; the first one is told.
  void add(const std::string& what, const std::string& example, int count = 1);
  /// As "3 pictures that ... are missing (the first: 12.png)".
  std::vector<std::string> lines() const;

 private:
  struct Entry {
    std::string what, example;
    int count;
  };
  std::vector<Entry> entries_;
};

/// A camera as calibrations describe it, in pixels with (0, 0) at the centre of the top-left one.
struct Lens {
  enum class Distortion { none, radial_tangential, equidistant };
  double fu_px = 0, fv_px = 0, cu_px = 0, cv_px = 0;
  Distortion distortion = Distortion::none;
  std::vector<double> coefficients;  ///< in OpenCV's order
  int width_px = 0, height_px = 0;   ///< of the pictures that it is of; 0: not said
  scenario::Source source = {};      ///< to be blamed when these are others
};

struct RecordedFrame {
  std::int64_t t_ns = 0;
  std::filesystem::path picture;
};

struct Recorded {
  std::vector<RecordedFrame> frames;  ///< by time, each time once, at least one
  std::optional<Lens> lens;           ///< none: the layout has no calibration
  std::optional<int> demosaic;        ///< OpenCV's colour conversion for raw pictures
  /// Detection, filter, noise; where the recording does not say, as they are by default, but
  /// corners' threshold is each picture's own.
  scenario::Scenario settings = [] {
    scenario::Scenario unsaid;
    unsaid.fast_threshold.reset();
    return unsaid;
  }();
  std::unique_ptr<MotionSource> motion;
  Tally tally;
};

/// What the user adds to a recording, for what its layout does not say.
struct ReadOptions {
  std::filesystem::path folder = {};
  std::string camera = {};  ///< which of several; "" is the layout's first
  std::optional<double> fps = {};
  std::optional<double> speed_mps = {};
  std::optional<std::filesystem::path> imu = {};
  std::optional<Eigen::Vector3d> mount_rpy_rad =
      {};                     ///< of the camera, as `scenario::Camera` has it
  bool exact_motion = false;  ///< from the recording's truth, not its IMU
};

/// A way of putting a recording into a folder.
struct Layout {
  std::string_view name;
  std::string_view purpose;  ///< one line for people
  bool (*fits)(const std::filesystem::path& folder);
  /// \throws std::runtime_error naming file and line.
  Recorded (*read)(const ReadOptions& options);
};

/// All there are, in the order in which they are tried.
const std::vector<Layout>& layouts();

/// \param name "auto": the first one that fits the folder.
/// \throws std::runtime_error for an unknown name, or a folder that none fits.
const Layout& layout_of(const std::string& name, const std::filesystem::path& folder);

/// \name The readers.
///@{
bool is_euroc(const std::filesystem::path& folder);
Recorded read_euroc(const ReadOptions& options);
bool is_kitti(const std::filesystem::path& folder);
Recorded read_kitti(const ReadOptions& options);
bool is_robotcar(const std::filesystem::path& folder);
Recorded read_robotcar(const ReadOptions& options);
bool is_pictures(const std::filesystem::path& folder);
Recorded read_pictures(const ReadOptions& options);
///@}

/// Sorts frames by time, and takes out what has a time that another one has; counts both.
/// \param list that they are from. \throws scenario::Error where it has none.
void put_in_order(std::vector<RecordedFrame>& frames, const std::filesystem::path& list,
                  Tally& tally);

/// Takes out frames outside of a time span, and counts them.
/// \throws std::runtime_error if none is left.
void keep_within(std::int64_t first_ns, std::int64_t last_ns, const char* what, Recorded& recorded);

/// Motion by states of a navigation unit, sorted first, each time once; frames outside of their
/// time are taken out. \throws std::runtime_error for fewer than two states.
void move_by_navigation(std::vector<NavigationState> states, const sim::Pose& T_BC,
                        Recorded& recorded);

}  // namespace lcs::replay
