/// \file
/// A recorded sequence in any layout, as input of `Playback`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/camera/optics.h"
#include "sim/events/event.h"
#include "tools/recording/recording_io.h"
#include "tools/replay/motion_source.h"
#include "tools/replay/picture_reader.h"

namespace lcs::replay {

/// Counts the faults that a reader met; they are reported at the end.
class Tally {
 public:
  /// \param what a plural phrase, as "pictures that the list names are missing".
  /// \param example of it; only the first one is reported.
  void add(const std::string& what, const std::string& example, int count = 1);
  /// A line that stands for itself.
  void tell(std::string line) { told_.push_back(std::move(line)); }
  /// Lines such as "3 pictures that ... are missing (the first: 12.png)".
  std::vector<std::string> lines() const;

 private:
  struct Entry {
    std::string what, example;
    int count;
  };
  std::vector<Entry> entries_;
  std::vector<std::string> told_;
};

using sim::Lens;

struct RecordedFrame {
  std::int64_t t_ns = 0;
  std::filesystem::path picture;  ///< empty: in the video
  std::size_t number = 0;         ///< index among all pictures of the recording, from 0
  std::size_t events = 0;         ///< number of the recording's events up to its time

  std::string name() const;  ///< for people: the file's, or "picture 7"
};

struct Recorded {
  /// At least one. If `timed` is false, they are in order and their times are unknown.
  std::vector<RecordedFrame> frames;
  bool timed = true;               ///< sorted by time, without duplicate times
  bool has_own_clock = false;      ///< times count from the first picture: sensors begin with it
  bool took_time_offset = false;   ///< `take_time_offset` was called
  std::optional<double> fps;       ///< of an untimed recording, if the layout has it
  std::vector<sim::Event> events;  ///< by time, with the clock of the layout
  std::filesystem::path video;     ///< contains the pictures; empty: they are files
  std::optional<Lens> lens;        ///< absent: the layout has no calibration
  std::optional<sim::Pose> T_BC;   ///< of the camera on the body, if the layout states it
  PictureFormat format;            ///< of the files
  /// Detection, filter, noise. Defaults apply where the recording has no setting, except that each
  /// picture determines the corner threshold.
  scenario::Scenario settings = [] {
    scenario::Scenario unsaid;
    unsaid.fast_threshold.reset();
    return unsaid;
  }();
  /// The truth of corners and objects, if known. Each of its frames belongs to the picture named by
  /// its time.
  std::optional<bench::SeenReader> truth;
  std::unique_ptr<MotionSource> motion;  ///< null: the layout has no motion of the camera
  std::vector<std::string> lacks;        ///< inputs that only the user can provide, and their keys
  Tally tally;
  std::shared_ptr<void> keep = {};  ///< files that are read from, and removed with the recording
};

/// A layout of a recording on disk.
struct Layout {
  std::string_view name;
  std::string_view purpose;  ///< one readable line
  bool (*fits)(const std::filesystem::path& path);
  /// Reads the layout's own data, except where the user overrides it.
  /// \param exact_motion take the motion from the truth, not the IMU, if both are present.
  /// \throws std::runtime_error with file and line.
  Recorded (*read)(const scenario::Recorded& asked, bool exact_motion);
};

/// All layouts, in the order in which they are tried.
const std::vector<Layout>& layouts();

/// The layout named by `asked.format`, or else the first one that fits.
/// \throws input::Error if none fits.
const Layout& layout_of(const scenario::Recorded& asked);

/// Reads the layout with the user's values in place of its own: the selected frames with their
/// times, a lens or at least a focal length, and a motion.
/// \throws input::Error; one message lists all missing inputs.
Recorded read_recorded(const scenario::Scenario& asked);

/// Whether the user provides the camera's motion.
bool motion_is_asked(const scenario::Recorded& asked);

/// \name The readers.
///@{
bool is_euroc(const std::filesystem::path& folder);
Recorded read_euroc(const scenario::Recorded& asked, bool exact_motion);
bool is_kitti(const std::filesystem::path& folder);
Recorded read_kitti(const scenario::Recorded& asked, bool exact_motion);
bool is_kitti_odometry(const std::filesystem::path& folder);
Recorded read_kitti_odometry(const scenario::Recorded& asked, bool exact_motion);
bool is_robotcar(const std::filesystem::path& folder);
Recorded read_robotcar(const scenario::Recorded& asked, bool exact_motion);
bool is_tum_rgbd(const std::filesystem::path& folder);
Recorded read_tum_rgbd(const scenario::Recorded& asked, bool exact_motion);
bool is_rpg_events(const std::filesystem::path& folder);
Recorded read_rpg_events(const scenario::Recorded& asked, bool exact_motion);
bool is_mot(const std::filesystem::path& folder);
Recorded read_mot(const scenario::Recorded& asked, bool exact_motion);
bool is_kitti_tracking(const std::filesystem::path& folder);
Recorded read_kitti_tracking(const scenario::Recorded& asked, bool exact_motion);
bool is_kitti_360(const std::filesystem::path& folder);
Recorded read_kitti_360(const scenario::Recorded& asked, bool exact_motion);
bool is_listed(const std::filesystem::path& folder);
Recorded read_listed(const scenario::Recorded& asked, bool exact_motion);
bool is_bag(const std::filesystem::path& path);
Recorded read_bag(const scenario::Recorded& asked, bool exact_motion);
bool is_video(const std::filesystem::path& file);
Recorded read_video(const scenario::Recorded& asked, bool exact_motion);
bool is_pictures(const std::filesystem::path& folder);
Recorded read_pictures(const scenario::Recorded& asked, bool exact_motion);
///@}

/// Sets the frames' times to those of the IMU's clock, by `asked.time_offset_s` or else the
/// `timeshift_cam_imu` of `asked.calibration`.
void take_time_offset(const scenario::Recorded& asked, Recorded& recorded);

/// Takes the noise densities of `asked.imu_calibration`, if given. \throws input::Error
void take_imu_noise(const scenario::Recorded& asked, Recorded& recorded);

/// Gives the pictures times at a constant rate, beginning at 0.
void time_by(double fps, Recorded& recorded);

/// Sets the frames to the pictures of a folder in the order of the numbers in their names, with the
/// times that the names state, if they do.
void take_pictures(const std::filesystem::path& folder, const std::string& time_unit,
                   Recorded& recorded);

/// Sorts frames by time, and removes all but the first of those with the same time; counts both.
/// \param list file of the frames. \throws input::Error if it has none.
void put_in_order(std::vector<RecordedFrame>& frames, const std::filesystem::path& list,
                  Tally& tally);

/// Removes frames outside a time span, and counts them.
/// \throws std::runtime_error if none is left.
void keep_within(std::int64_t first_ns, std::int64_t last_ns, const char* what, Recorded& recorded);

/// Largest time of a picture after the last reading, which is held until then.
inline constexpr std::int64_t kBehindReadings_ns = 500'000'000;

/// Sets the motion from `asked.poses`. \param times_known of the pictures.
/// \throws input::Error for unreadable poses, and for those of a body without the camera's place.
void move_by_poses(const scenario::Recorded& asked, bool times_known, Recorded& recorded);

/// Sets the motion from a layout's file of poses with their times. \param up_W of its world frame.
/// \throws input::Error for unreadable poses, and for those without times.
void move_by_timed_poses(const scenario::Recorded& asked, const std::filesystem::path& file,
                         const Eigen::Vector3d& up_W, Recorded& recorded);

/// Sets the motion from readings of an IMU, whose axes are those of the vehicle, which starts
/// upright; or any, if `asked.calibration` states the camera's place on it.
/// \param file of the readings, for messages.
void move_by_readings(const scenario::Recorded& asked, const std::filesystem::path& file,
                      SensorReadings readings, Recorded& recorded);

/// Sets the motion from a navigation unit's states: sorts them, removes duplicate times, and
/// removes frames outside their time span. \throws std::runtime_error for fewer than two states.
void move_by_navigation(std::vector<NavigationState> states, const sim::Pose& T_BC,
                        Recorded& recorded);

}  // namespace lcs::replay
