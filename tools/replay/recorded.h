/// \file
/// A recorded sequence in any layout, as input of `Playback`.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/base/optics.h"
#include "sim/base/pose.h"
#include "sim/events/event.h"
#include "sim/imu/imu.h"
#include "tools/recording/recording_io.h"
#include "tools/replay/motion_source.h"
#include "tools/replay/text_table.h"

namespace lcs::replay {

using scenario::RecordingSource;

/// The properties that the pictures of a recording have in common.
struct PictureFormat {
  cv::Size size_px;             ///< empty: the first picture's size
  int bits = 16;                ///< in use where a picture has 16
  bool is_deep = false;         ///< some picture has 16
  std::optional<int> demosaic;  ///< OpenCV's colour conversion of raw pictures, with one channel
};

/// OpenCV's conversion for a pattern, from the top left pixel on: rggb, bggr, grbg or gbrg.
int demosaic_of(const std::string& pattern);

struct RecordedFrame;

/// Reads pictures of one size, from files or a video.
class PictureReader {
 public:
  /// \param video contains the pictures; empty: they are files.
  explicit PictureReader(const PictureFormat& format, const fs::path& video = {});

  /// \param frame later in a video than those before it.
  /// \return the BGR picture, of 8 bits; absent if it is missing, unreadable or of another size.
  /// `skipped` then gives the reason.
  std::optional<cv::Mat3b> read(const RecordedFrame& frame);

  /// One line for each skipped picture.
  const std::vector<std::string>& skipped() const { return skipped_; }

 private:
  std::optional<cv::Mat3b> read_file(const fs::path& file);
  std::optional<cv::Mat3b> read_video(const RecordedFrame& frame);

  PictureFormat format_;
  fs::path video_;
  std::unique_ptr<cv::VideoCapture> capture_;
  std::size_t next_ = 0;  ///< index of the next picture in the video
  bool has_ended_ = false;
  std::vector<std::string> skipped_;
};

/// \name The pictures of a folder: their order, and their times where their names are times
///@{
/// Whether a name has the ending of a PNG, JPEG, BMP, TIFF, WebP, PGM or PPM file.
bool is_picture(const fs::path& file);

/// The PNG, JPEG, BMP, TIFF, WebP, PGM and PPM files of a folder, in any order.
/// \throws std::runtime_error for a folder that cannot be read or has no picture.
std::vector<fs::path> pictures_in(const fs::path& folder);

/// The number in each name that counts the pictures, where only one varies: 20 in frame_000020.png.
/// Empty if no number does, if two names have the same one, or if one exceeds a hundred million, as
/// times do.
std::vector<std::size_t> numbers_in(const std::vector<fs::path>& files);

struct OrderedPictures {
  std::vector<fs::path> files;
  std::vector<std::int64_t> t_ns;  ///< increasing; empty if the names are no times
};

/// Sorts pictures by the numbers in their names: frame2.png precedes frame10.png. A number may have
/// a fraction. Names are times if they are seconds with a fraction, seconds and nanoseconds, or ms,
/// us or ns since 1970, at the rate of a camera; or if `time_unit` (s, ms, us or ns) is given.
/// \throws input::Error that names the folder if two orders are possible: two numbers vary
/// independently, two names have the same numbers, or only some names have numbers.
OrderedPictures in_order(std::vector<fs::path> files, const std::string& time_unit);
///@}

/// The most frequent size of some of the files, spread over all, and the least of 8, 10, 12, 14 and
/// 16 bits that their values keep to; the size is empty if none can be read.
PictureFormat common_format(const std::vector<std::filesystem::path>& files);

/// Counts the faults that a reader met; they are reported at the end.
class Tally {
 public:
  /// \param what a plural phrase, as "pictures that the list names are missing".
  /// \param example of it; only the first one is reported.
  void add(const std::string& what, const std::string& example, int count = 1);
  /// A line that stands for itself; the same one is told once.
  template <class... Arguments>
  void tell(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    std::string line = fmt::format(text, std::forward<Arguments>(arguments)...);
    if (std::ranges::count(remarks_, line) == 0) remarks_.push_back(std::move(line));
  }
  /// A message behind the faults that may explain it.
  std::string before(const std::string& message) const {
    return fmt::format("{}{}{}", fmt::join(lines(), "; "), lines().empty() ? "" : "; ", message);
  }
  /// Lines such as "3 pictures that ... are missing (the first: 12.png)".
  std::vector<std::string> lines() const;

 private:
  struct Entry {
    std::string what, example;
    int count;
  };
  std::vector<Entry> entries_;
  std::vector<std::string> remarks_;
};

/// Refuses times in the order of a table's rows whose clock falls back, so that sorting would mix
/// two parts, and times of which nine tenths have the time of another. \throws input::Error
void require_one_clock(const std::vector<std::int64_t>& t_ns, const std::string& source);

/// Times of items with `t_ns`.
template <class Timed>
std::vector<std::int64_t> stamps_of(const std::vector<Timed>& items) {
  std::vector<std::int64_t> times_ns;
  for (const Timed& item : items) times_ns.push_back(item.t_ns);
  return times_ns;
}

/// Sorts items by `t_ns`, and removes all but the first of those with the same time; counts both in
/// `tally`. \param plural of the items, as "poses". \param source name of the table.
/// \throws as `require_one_clock`.
template <class Timed>
void sort_by_time(std::vector<Timed>& items, const std::string& plural, const std::string& source,
                  Tally& tally) {
  require_one_clock(stamps_of(items), source);
  const auto earlier = [](const Timed& a, const Timed& b) { return a.t_ns < b.t_ns; };
  const auto same = [](const Timed& a, const Timed& b) { return a.t_ns == b.t_ns; };
  if (!std::ranges::is_sorted(items, earlier)) {
    tally.add("tables are not in the order of time and are sorted", source);
    std::ranges::stable_sort(items, earlier);
  }
  const auto twice = std::unique(items.begin(), items.end(), same);
  if (twice == items.end()) return;
  tally.add(plural + " have the time of another one and are left out",
            fmt::format("at {} ns", twice->t_ns), static_cast<int>(items.end() - twice));
  items.erase(twice, items.end());
}

using sim::Lens;

/// A lens without distortion. \param n fu, fv, cu, cv, in pixels. \param source of them.
inline Lens pinhole(const std::array<double, 4>& n, const input::Source& source) {
  return {n[0], n[1], n[2], n[3], {}, {}, 0, 0, false, 0, 0, source};
}

struct RecordedFrame {
  std::int64_t t_ns = 0;
  fs::path picture;                       ///< empty: in the video
  std::size_t number = 0;                 ///< index among all pictures of the recording, from 0
  std::size_t events = 0;                 ///< number of the recording's events up to its time
  std::optional<std::size_t> named = {};  ///< number in its name, if `PictureNumbers` are known

  std::string name() const;  ///< for people: the file's, or "picture 7"
};

/// The numbers in the names of all pictures of a recording, before any was left out.
struct PictureNumbers {
  std::size_t pictures = 0;
  std::optional<std::size_t> least, greatest;  ///< absent: the names do not count the pictures
  std::size_t step = 0;  ///< between pictures, of which half are there; 0: they have no such step
  std::optional<std::size_t> first;  ///< that the layout gives its first picture; absent: 0 or 1
  std::int64_t before_ns = 0;  ///< from number 0 to the first picture, if that is above 1 and known

  /// The number of the first picture; absent if the numbers begin with another one, as of a part.
  std::optional<std::size_t> begin() const {
    if (!least || *least == 0) return least;
    return first || *least > 1 ? first : least;
  }
};

struct Recorded {
  /// At least one. If `timed` is false, they are in order and their times are unknown.
  std::vector<RecordedFrame> frames;
  PictureNumbers numbers;
  bool timed = true;           ///< sorted by time, without duplicate times
  bool has_own_clock = false;  ///< times count from the first picture: sensors begin with it
  std::set<std::string, std::less<>> took = {};  ///< what was asked for and had an effect
  std::optional<double> fps;                     ///< of an untimed recording, if the layout has it
  std::vector<sim::Event> events;                ///< by time, with the clock of the layout
  fs::path video;                                ///< contains the pictures; empty: they are files
  std::optional<Lens> lens;                      ///< absent: the layout has no calibration
  std::optional<sim::Pose> T_BC;  ///< of the camera on the body, if the layout states it
  PictureFormat format;           ///< of the files
  /// Detection, filter, noise. Defaults apply where the recording has no setting, except that each
  /// picture determines the corner threshold.
  scenario::Scenario settings = [] {
    scenario::Scenario unsaid;
    unsaid.fast_threshold.reset();
    return unsaid;
  }();
  /// The truth of corners and objects, if known. Each of its frames belongs to the picture named by
  /// its time.
  std::optional<recording::SeenReader> truth;
  std::unique_ptr<MotionSource> motion;  ///< null: the layout has no motion of the camera
  std::vector<std::string> lacks;        ///< inputs that only the user can provide, and their keys
  Tally tally;
  std::shared_ptr<const void> keep =
      {};  ///< files that are read from, and removed with the recording
};

/// For recordings that no layout fits: ends the message that refuses one.
inline constexpr const char* kNeutralWay =
    "tools/replay/NEUTRAL.md has a folder that any recording can be turned into";

/// Whether a path holds a recording of a layout.
using Fits = bool(const fs::path& path);

/// Reads the layout's own data, except where the user overrides it.
/// \param exact_motion take the motion from the truth, not the IMU, if both are present.
/// \throws std::runtime_error with file and line.
using Read = Recorded(const RecordingSource& asked, bool exact_motion);

/// A layout of a recording on disk.
struct RecordingLayout {
  std::string_view name;
  std::string_view purpose;  ///< one readable line
  Fits* fits;
  Read* read;
  bool has_cameras = false;  ///< it can have several, which `camera` tells apart
};

/// All layouts, in the order in which they are tried.
const std::vector<RecordingLayout>& layouts();

/// The layout named by `asked.format`, or else the first one that fits.
/// \throws input::Error if none fits.
const RecordingLayout& layout_of(const RecordingSource& asked);

/// Reads the layout with the user's values in place of its own: the selected frames with their
/// times, a lens or at least a focal length, and a motion.
/// \throws input::Error; one message lists all missing inputs.
Recorded read_recorded(const scenario::Scenario& asked);

/// Whether the user provides the camera's motion. A speed beside a topic of an IMU is its start.
bool motion_is_asked(const RecordingSource& asked);

/// \name The readers.
///@{
Fits is_euroc, is_kitti, is_kitti_odometry, is_robotcar, is_tum_rgbd, is_rpg_events, is_mot,
    is_kitti_tracking, is_kitti_360, is_listed, is_bag, is_video, is_pictures;
Read read_euroc, read_kitti, read_kitti_odometry, read_robotcar, read_tum_rgbd, read_rpg_events,
    read_mot, read_kitti_tracking, read_kitti_360, read_listed, read_bag, read_video, read_pictures;
///@}

/// The pose of the camera on the body or the IMU by a mount or a calibration of the user.
std::optional<sim::Pose> camera_on_body(const RecordingSource& asked,
                                        const std::optional<sim::Pose>& otherwise,
                                        Recorded& recorded);

/// Moves the frames' times to the IMU's clock, by `asked.time_offset_s` or else the offset that
/// `asked.calibration` states.
void take_time_offset(const RecordingSource& asked, Recorded& recorded);

/// Takes the noise densities of `asked.imu_calibration`, if given. \throws input::Error
void take_imu_noise(const RecordingSource& asked, Recorded& recorded);

/// Finds the numbers of all pictures, which the frames are. \param are_times the names are times.
void number_frames(Recorded& recorded, bool are_times);

/// Calls `use(frame, row)` with the row (from 0) of a table for each frame; frames without one, or
/// whose row `use` does not take, are left out. As many rows as pictures are theirs in order. Else
/// row k is of number `first + k`: `first` is the layout's, or 0 if a picture has it, or lets the
/// table end with the last picture. Tells how many rows are used.
/// \param what the rows state, as "time". \throws input::Error if there is no such number or row.
void take_rows(const fs::path& table, std::size_t rows, const char* what, Recorded& recorded,
               const std::function<bool(RecordedFrame&, std::size_t)>& use);

/// Refuses pictures without times whose numbers begin above 1 if readings last long enough to begin
/// with number 0. \param file of the readings.
void require_start(Recorded& recorded, std::int64_t lasts_ns, const fs::path& file);

/// Gives the pictures times at a constant rate, beginning at 0; for a number without a picture the
/// time passes.
void time_by(double fps, Recorded& recorded);

/// Gives each frame the time that a table has for it. If a column holds names of the pictures, a
/// row belongs to the picture of its name, else as in `take_rows`. The times are in the column
/// that the header calls so, else in the first one that holds neither names nor counts 0, 1, 2, ...
/// Frames without a row are left out and counted.
/// \param time_unit s, ms, us or ns; "": as the table states it, or as a camera's rate needs it.
/// \throws input::Error if the table has no such column, or no row for a frame.
void time_by_table(const fs::path& file, const std::string& time_unit, Recorded& recorded);

/// Sets the frames to the pictures of a folder in the order of the numbers in their names, with the
/// times that the names state, if they do.
void take_pictures(const fs::path& folder, const std::string& time_unit, Recorded& recorded);

/// Sets the frames to the rows of a list: the first field is the time, and `picture_of` gives the
/// picture, or "" for a row without one. Rows that cannot be read are counted.
void take_list(const TextTable& list, std::int64_t unit_ns,
               const std::function<fs::path(const TextTable::Row&)>& picture_of,
               Recorded& recorded);

/// Sorts frames by time, and removes all but the first of those with the same time; counts both.
/// \param list file of the frames. \throws input::Error if it has none.
void put_in_order(std::vector<RecordedFrame>& frames, const fs::path& list, Tally& tally);

/// Readings that tell the motion, for which frames are kept.
struct ReadingTimes {
  std::vector<std::int64_t> t_ns;
  std::string name;                      ///< as "poses"
  const char* outside;                   ///< what is told of the frames outside
  std::int64_t behind_ns = 0;            ///< for which the last reading is held
  std::int64_t first_ns = t_ns.front();  ///< of the frames that are kept
  /// Whether the motion over the gap before a reading is known, by its index: the camera stands.
  std::function<bool(std::size_t)> is_known = [](std::size_t) { return false; };
};
/// Removes frames outside the time of readings and in gaps between them, and counts them. A gap is
/// longer than four usual periods of the readings, and than two of the frames.
/// \throws std::runtime_error if none is left.
void keep_within(const ReadingTimes& readings, Recorded& recorded);

/// Largest time of a picture after the last reading of an IMU, which is held until then.
inline constexpr std::int64_t kBehindReadings_ns = 500'000'000;

/// Sets the motion from the user's or a layout's poses. \param times_known of the pictures.
/// \param up_W of their world frame, if the layout says so. \param T_PC of the camera on the one
/// whose poses they are.
/// \throws input::Error for unreadable poses, and for a body's poses without the camera's place.
void move_by_poses(const RecordingSource& asked, const fs::path& path, bool times_known,
                   Recorded& recorded, const std::optional<Vector3d>& up_W = {},
                   const sim::Pose& T_PC = {});

/// Sets the motion from readings of an IMU. Its axes are the vehicle's axes, and the vehicle starts
/// upright; or any, if `asked.calibration` states the camera's place on it.
/// \param file of the readings, for messages.
void move_by_readings(const RecordingSource& asked, const fs::path& file, SensorReadings readings,
                      Recorded& recorded);

/// Sets the motion from a navigation unit's states: sorts them, removes duplicate times, and
/// removes frames outside their time span. \throws std::runtime_error for fewer than two states.
void move_by_navigation(std::vector<NavigationState> states, const sim::Pose& T_BC,
                        Recorded& recorded);

// ---- Tables that tell a motion: poses of TUM's RGB-D benchmark, KITTI's odometry, KITTI-360 and
// EuRoC's truth; sensors' tables in EuRoC's ASL format. Unreadable rows are left out, rows out of
// order sorted, and duplicate times used once; all of this is counted.
//
// Calibrations of a camera and an IMU, as several tools write them: EuRoC's sensor.yaml, Kalibr's
// and OpenVINS's camchain and IMU, ROS's camera_info, OpenCV, ORB-SLAM, VINS (camodocal).

/// Camera frame C with x right, y down, z ahead; the world frame is the file's own.
struct PosesFile {
  struct Line {
    std::optional<std::int64_t> t_ns;   ///< if `timed`
    std::optional<std::size_t> number;  ///< of the picture, if `numbered`
    sim::Pose T_WC;                     ///< `of_body`: T_WB
  };
  /// In file order; an unreadable line is empty, so that the others keep their index.
  std::vector<std::optional<Line>> lines;
  bool timed = false;
  bool numbered = false;  ///< each line states its picture (KITTI-360)
  bool of_body = false;   ///< EuRoC's columns p_RS_R_x ...: poses of the body, not of the camera
};

/// Lines of 8 numbers (TUM: t x y z qx qy qz qw), 12 or 16 (rows of a matrix; KITTI), 17 (the
/// picture's number before 16; KITTI-360), or a table whose header names position, quaternion and
/// time. Counts unreadable lines.
/// \param time_unit s, ms, us or ns; "": as the header states it, or s (TUM), ns (EuRoC).
/// \throws input::Error for a file that is unreadable, without a pose, or in another format.
PosesFile read_poses(const fs::path& file, const std::string& time_unit, Tally& tally);

/// A rotation close to a rounded rotation matrix; absent if it is no rotation.
std::optional<Eigen::Matrix3d> rotation_of(const Eigen::Matrix3d& R);

/// Columns are as in EuRoC, or have other usual names (ROS, Kalibr, loggers of phones), with
/// units in the header; without a header: time, angular rates in rad/s, accelerations in m/s^2.
/// \param places of the angular rates and accelerations without a header.
/// \throws input::Error if the file is unreadable, has no reading, or has readings that no IMU can
/// have: rates in deg/s, accelerations in g or without gravity, the two interchanged.
std::vector<sim::ImuSample> read_imu_csv(const fs::path& file, const TableTimes& times,
                                         Tally& tally,
                                         const std::array<std::size_t, 6>& places = {1, 2, 3, 4, 5,
                                                                                     6});

/// Yaw rates are in an optional fifth column.
std::vector<sim::OdometrySample> read_odometry_csv(const fs::path& file, const TableTimes& times,
                                                   Tally& tally);

/// Exact poses of the camera, as written by `lcs generate`.
CameraPoses read_pose_csv(const fs::path& file, Tally& tally);

/// \param has_velocities with biases, as EuRoC; else from poses alone (columns of EuRoC up to
/// q_RS_z):
///   velocities are their differences, biases are 0; both is told.
std::vector<TrueState> read_truth_csv(const fs::path& file, const TableTimes& times,
                                      bool has_velocities, Tally& tally);

struct SensorCalibration {
  std::optional<Lens> lens;  ///< of a camera
  /// Pose of the sensor in the body frame B: EuRoC's T_BS; of a camera also Kalibr's T_cam_imu,
  /// inverted, OpenVINS's T_imu_cam, ORB-SLAM's T_b_c1, and VINS's body_T_cam0. Then B is the IMU.
  std::optional<sim::Pose> T_BS;
  std::optional<double> rate_hz;
  std::optional<double> time_offset_s;      ///< of a camera: Kalibr's timeshift_cam_imu, VINS's td
  bool has_cameras = false;                 ///< the name of a camera chose one of several
  std::optional<scenario::ImuNoise> noise;  ///< of an IMU; turn-on biases are 0
  std::map<std::string, input::Source> keys = {};  ///< top-level keys and their places
};

/// \param camera one of several in a file, by its name there, as "cam1"; another name: the first.
/// \throws input::Error with file and line, also if it is of none of the known kinds.
SensorCalibration read_calibration(const fs::path& file, const std::string& camera = "");

}  // namespace lcs::replay
