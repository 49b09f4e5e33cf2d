/// \file
/// A recorded sequence, whatever layout it had on disk: what `Playback` runs a detector on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/recording/recording.h"
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
  bool centred = false;              ///< the principal point is the middle of the picture
  int width_px = 0, height_px = 0;   ///< of the pictures that it is of; 0: not said
  scenario::Source source = {};      ///< to be blamed when these are others
};

struct RecordedFrame {
  std::int64_t t_ns = 0;
  std::filesystem::path picture;  ///< empty: of the video
  std::size_t number = 0;         ///< its place among all pictures of the recording, from 0
};

struct Recorded {
  /// At least one. Where `timed` is false they are in order, and their times are not known.
  std::vector<RecordedFrame> frames;
  bool timed = true;            ///< by time, each time once
  std::optional<double> fps;    ///< of what is not timed, where the layout says it
  std::filesystem::path video;  ///< whose pictures they are; empty: they are files
  std::optional<Lens> lens;     ///< none: the layout has no calibration
  std::optional<int> demosaic;  ///< OpenCV's colour conversion for raw pictures
  /// Detection, filter, noise; where the recording does not say, as they are by default, but
  /// corners' threshold is each picture's own.
  scenario::Scenario settings = [] {
    scenario::Scenario unsaid;
    unsaid.fast_threshold.reset();
    return unsaid;
  }();
  /// The truth of corners and objects, where it is known. Each of its frames belongs to the picture
  /// that is named by its time.
  std::optional<bench::Recording> truth;
  std::unique_ptr<MotionSource> motion;  ///< null: the layout does not say how the camera moved
  std::vector<std::string> lacks;  ///< what nobody can know but the user, and the keys that say it
  Tally tally;
};

/// A way of putting a recording into a folder.
struct Layout {
  std::string_view name;
  std::string_view purpose;  ///< one line for people
  bool (*fits)(const std::filesystem::path& path);
  /// What the layout itself says, as far as the user does not say it.
  /// \param exact_motion from the recording's truth, not its IMU, where it has both.
  /// \throws std::runtime_error naming file and line.
  Recorded (*read)(const scenario::Recorded& asked, bool exact_motion);
};

/// All there are, in the order in which they are tried.
const std::vector<Layout>& layouts();

/// That of `asked.format`, or else the first one that fits.
/// \throws scenario::Error where none does.
const Layout& layout_of(const scenario::Recorded& asked);

/// What the layout says, with what the user says in its place: frames with their times, those that
/// are wanted, a lens or at least its focal length, a motion.
/// \throws scenario::Error; of all that nobody has said in one message.
Recorded read_recorded(const scenario::Scenario& asked);

/// Whether the user says how the camera moved.
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
bool is_mot(const std::filesystem::path& folder);
Recorded read_mot(const scenario::Recorded& asked, bool exact_motion);
bool is_video(const std::filesystem::path& file);
Recorded read_video(const scenario::Recorded& asked, bool exact_motion);
bool is_pictures(const std::filesystem::path& folder);
Recorded read_pictures(const scenario::Recorded& asked, bool exact_motion);
///@}

/// Pictures at a constant rate, the first one at 0.
void time_by(double fps, Recorded& recorded);

/// The pictures of a folder, in the order of their numbers, without times.
std::vector<RecordedFrame> frames_in(const std::filesystem::path& folder);

/// Sorts frames by time, and removes all but the first of those with the same time; counts both.
/// \param list file of the frames. \throws scenario::Error where it has none.
void put_in_order(std::vector<RecordedFrame>& frames, const std::filesystem::path& list,
                  Tally& tally);

/// Takes out frames outside of a time span, and counts them.
/// \throws std::runtime_error if none is left.
void keep_within(std::int64_t first_ns, std::int64_t last_ns, const char* what, Recorded& recorded);

/// Pictures may be taken as long as this behind the last reading, which is held.
inline constexpr std::int64_t kBehindReadings_ns = 500'000'000;

/// Motion by states of a navigation unit, sorted first, each time once; frames outside of their
/// time are taken out. \throws std::runtime_error for fewer than two states.
void move_by_navigation(std::vector<NavigationState> states, const sim::Pose& T_BC,
                        Recorded& recorded);

}  // namespace lcs::replay
