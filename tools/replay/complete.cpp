// Completes a layout's data by the user's input.

#include <cmath>
#include <map>
#include <system_error>

#include "scenes/worlds/worlds.h"
#include "sim/base/rotation.h"
#include "tools/replay/recorded.h"
#include "tools/sequence/replay_settings.h"

namespace lcs::replay {
namespace {

constexpr const char* kNoTimes = "when its pictures were taken (fps, or times)";

/// \return whether the frames' times are known, not only their order.
bool set_times(const RecordingSource& asked, Recorded& recorded) {
  if (asked.times) {
    time_by_table(*asked.times, asked.time_unit, recorded);
    recorded.took.insert("time_unit");
    return true;
  }
  if (recorded.timed) {
    constexpr double kSame = 0.05;
    if (!asked.fps) return true;
    const std::optional<double> own_hz = usual_rate_hz(stamps_of(recorded.frames));
    if (own_hz && std::abs(*own_hz / *asked.fps - 1) < kSame) {
      recorded.tally.tell("fps has no effect: the recording itself has times of that rate");
      return true;
    }
    refuse(asked.source,
           "the recording itself says when its pictures were taken, {:.3g} a second, and fps says "
           "{:.3g}; remove fps",
           own_hz.value_or(0), *asked.fps);
  }
  const std::optional<double> fps = asked.fps ? asked.fps : recorded.fps;
  if (fps) time_by(*fps, recorded);
  return fps.has_value();
}

/// Pictures without a line are left out.
CameraPoses poses_by_line(const fs::path& path, const PosesFile& file, Recorded& recorded) {
  CameraPoses poses;
  take_rows(path, file.lines.size(), "pose", recorded, [&](RecordedFrame& frame, std::size_t row) {
    const auto& line = file.lines[row];
    if (line) frame.t_ns = line->t_ns.value_or(frame.t_ns);
    if (line) poses.push_back({frame.t_ns, line->T_WC});
    return line.has_value();
  });
  return poses;
}

/// Each line states its picture; between them the motion is linear.
CameraPoses poses_by_number(const fs::path& path, const PosesFile& file, const Recorded& recorded) {
  if (!recorded.numbers.least && recorded.video.empty()) {
    refuse({path},
           "its rows state the numbers of their pictures, and the names of the pictures have none; "
           "give a row of 12 numbers for each picture");
  }
  std::map<std::size_t, std::int64_t> times_ns;
  for (const RecordedFrame& frame : recorded.frames) {
    times_ns[frame.named.value_or(frame.number)] = frame.t_ns;
  }
  CameraPoses poses;
  for (const auto& line : file.lines) {
    const auto found = line ? times_ns.find(*line->number) : times_ns.end();
    if (found != times_ns.end()) poses.push_back({found->second, line->T_WC});
  }
  return poses;
}

/// TUM poses belong to pictures by time; if the pictures have their own clock, the first pose
/// belongs to the first picture.
CameraPoses poses_by_time(const PosesFile& file, bool own_clock) {
  CameraPoses poses;
  for (const auto& line : file.lines) {
    if (line) poses.push_back({line->t_ns.value(), line->T_WC});
  }
  const std::int64_t zero_ns = own_clock ? poses.front().t_ns : 0;
  for (auto& pose : poses) pose.t_ns -= zero_ns;
  return poses;
}

/// Turns poses of the body into poses of the camera.
void join_camera(const RecordingSource& asked, const fs::path& path, PosesFile& file,
                 Recorded& recorded) {
  const std::optional<sim::Pose> T_BC = camera_on_body(asked, recorded.T_BC, recorded);
  if (!T_BC) {
    refuse({path},
           "its poses are the body's (p_RS_R_x); give the camera's place on it, by a calibration "
           "with T_BS or T_cam_imu, or by mount");
  }
  for (auto& line : file.lines) {
    if (line) line->T_WC = line->T_WC * *T_BC;
  }
}

/// Refuses a ground that would be above the picture or behind the camera.
void require_ground_in_view(const RecordingSource& asked, const Recorded& recorded) {
  constexpr double kAbove = 0.2, kBehind = 0.8;  // of up, along y and z of the camera
  const auto up_C = asked.camera_height_m ? recorded.motion->up_C() : std::nullopt;
  if (!up_C || (up_C->y() < kAbove && up_C->z() < kBehind)) return;
  refuse(asked.source,
         "up is ({:.2f}, {:.2f}, {:.2f}) in the camera's axes (x right, y down, z ahead), so that "
         "the ground would not be in the picture; accelerations of iOS (CoreMotion) have the other "
         "sign, so change it; or correct the camera's place on the IMU, or remove camera_height",
         up_C->x(), up_C->y(), up_C->z());
}

/// Refuses readings whose axes are not the vehicle's, by where the accelerometer says up is.
void require_vehicle_axes(const std::vector<sim::ImuSample>& readings, const fs::path& path) {
  constexpr double kUpright = 0.7;  // cosine of the angle to z, for any slope
  Vector3d force = Vector3d::Zero();
  for (const sim::ImuSample& sample : readings) force += sample.accel_mps2;
  const Vector3d up = force.normalized();
  if (up.z() > kUpright) return;
  const std::string file = path.string();
  if (up.z() < -kUpright) {
    refuse({file},
           "its accelerations point down, along -z, and at rest they must point up; change their "
           "sign, or turn the axes so that z is up");
  }
  refuse({file},
         "its axes are not the vehicle's (x ahead, y left, z up): up is ({:.2f}, {:.2f}, {:.2f}) "
         "by its accelerations; turn them, or give the camera's place on the IMU by a calibration "
         "with T_BS or T_cam_imu",
         up.x(), up.y(), up.z());
}

/// From each pose to the next: m and rad.
std::vector<double> ways_of(const CameraPoses& poses) {
  std::vector<double> ways;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const sim::Pose &a = poses[i - 1].T_WC, &b = poses[i].T_WC;
    ways.push_back((b.p - a.p).norm() + (b.R - a.R).norm());
  }
  return ways;
}

/// Removes poses that repeat the one before to the bit, where this is no camera that stands: all
/// are held until the next, or the next is a jump.
void drop_held(CameraPoses& poses, Tally& tally) {
  constexpr double kNearlyAll = 0.8, kJump = 3;
  const std::vector<double> ways = ways_of(poses);
  std::vector<double> moved;
  double after_a_repeat = 0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (ways[i] == 0) continue;
    moved.push_back(ways[i]);
    after_a_repeat += i > 0 && ways[i - 1] == 0;
  }
  const bool are_held = after_a_repeat > kNearlyAll * static_cast<double>(moved.size());
  const double jump = kJump * usual(moved).value_or(0);
  CameraPoses kept;
  double next = 0;  // the next way that is not 0
  for (std::size_t i = poses.size(); i-- > 0;) {
    const bool is_repeat = i > 0 && ways[i - 1] == 0;
    if (is_repeat && next > 0 && (are_held || next > jump)) {
      tally.add("poses repeat the one before while the camera moves, and are left out",
                fmt::format("at {} ns", poses[i].t_ns));
    } else {
      kept.push_back(poses[i]);
    }
    if (i > 0 && ways[i - 1] > 0) next = ways[i - 1];
  }
  std::ranges::reverse(kept);
  poses = std::move(kept);
}

/// \param is_told whether the layout told already which of its motion's inputs it lacks.
void set_motion(const RecordingSource& asked, bool times_known, bool is_told, Recorded& recorded) {
  if (asked.poses) {
    move_by_poses(asked, *asked.poses, times_known, recorded);
  } else if (asked.imu) {
    if (!times_known) return;
    recorded.took.insert("time_unit");
    TableTimes times{asked.time_unit, kImuRate, kNanosecond_ns};
    SensorReadings readings;
    readings.imu = read_imu_csv(*asked.imu, times, recorded.tally);
    times.rate = kStateRate;
    if (asked.odometry) {
      readings.odometry = read_odometry_csv(*asked.odometry, times, recorded.tally);
    }
    move_by_readings(asked, *asked.imu, std::move(readings), recorded);
  } else if (asked.speed_mps && motion_is_asked(asked)) {
    recorded.motion = std::make_unique<SteadyMotion>(*asked.speed_mps, asked.mount_rpy_rad);
    if (asked.camera_height_m) recorded.took.insert("mount");
  } else if (!recorded.motion && !is_told) {
    recorded.lacks.emplace_back("how the camera moved (poses, imu, or speed: 0 where it stands)");
  }
}

void require_lens(const Lens& lens) {
  constexpr double kMostFocal_px = 1e6, kMostCentre_px = 1e5;
  const Eigen::Array2d focal(lens.fu_px, lens.fv_px), centre(lens.cu_px, lens.cv_px);
  if ((focal >= 1 && focal <= kMostFocal_px && centre.abs() <= kMostCentre_px).all()) return;
  refuse(lens.source,
         "a focal length of {}, {} px and a principal point at {}, {} px fit no camera; correct "
         "the calibration, or give focal",
         lens.fu_px, lens.fv_px, lens.cu_px, lens.cv_px);
}

void set_lens(const RecordingSource& asked, Recorded& recorded) {
  if (asked.calibration) {
    const SensorCalibration calibration = read_calibration(*asked.calibration, asked.camera);
    if (calibration.has_cameras) recorded.took.insert("camera");
    recorded.lens = calibration.lens;
    if (!recorded.lens) {
      refuse({*asked.calibration}, "holds no calibration of a camera; give one with intrinsics");
    }
  }
  if (asked.focal_px) {
    Lens& lens = recorded.lens.emplace();
    lens.fu_px = asked.focal_px->x();
    lens.fv_px = asked.focal_px->y();
    lens.centred = true;
    lens.source = asked.source;
  } else if (!recorded.lens) {
    recorded.lacks.emplace_back("the focal length of its camera (focal)");
    return;
  }
  Lens& lens = *recorded.lens;
  if (asked.centre_px) {
    lens.cu_px = asked.centre_px->x();
    lens.cv_px = asked.centre_px->y();
    lens.centred = false;
  }
  if (asked.distortion) {
    sim::set_distortion(*asked.distortion, lens);
    lens.source = asked.source;
  }
  require_lens(lens);
}

/// The world of the pictures, according to the generated sequence or run whose folder holds them,
/// in any layout. Absent if they are in neither.
std::optional<scenario::Origin> origin_of(const fs::path& pictures) {
  constexpr int kMostAbove = 4;  // mav0/cam0/data is three below its sequence
  const auto stated = [](const std::optional<scenario::Origin>& origin, const std::string& name) {
    return origin ? origin : worlds::origin_named(name);
  };
  std::error_code error;
  fs::path folder = fs::weakly_canonical(pictures, error);
  for (int i = 0; i <= kMostAbove && !error; ++i, folder = folder.parent_path()) {
    if (std::error_code none; fs::exists(folder / sequence::kSettingsFile, none)) {
      const auto made = sequence::read_settings(folder / sequence::kSettingsFile).scenario;
      return stated(made.origin, made.name);
    }
    if (std::error_code none; fs::exists(recording::stored(folder, recording::kLayersFile), none)) {
      const recording::RunInfo run = recording::read_run_info(folder);
      return stated(run.origin, run.scenario);
    }
  }
  return std::nullopt;
}

/// Refuses what was asked for and has no effect.
void require_effects(const RecordingSource& asked, const RecordingLayout& layout, bool exact_motion,
                     const Recorded& recorded) {
  const RecordingSource::Topics& topics = asked.topics;
  const bool is_bag = layout.name == "bag";
  const bool has_own_lens = asked.focal_px || asked.calibration;
  const bool is_video = !recorded.video.empty();
  constexpr const char* kNotOfBag = "it is of a ROS bag, and this is none";
  constexpr const char* kNoImu = "the camera's motion is not by an IMU whose start is unknown";
  const auto of_bag = [is_bag](const char* why) { return is_bag ? why : kNotOfBag; };
  const struct {
    const char* key;
    bool is_asked;
    const char* why;
    bool has_effect = false;
  } rules[] = {
      {"ego_motion: truth", exact_motion, "no truth of this recording gives the motion"},
      {"camera", !asked.camera.empty(), "the recording has one camera, and no calibration names it",
       layout.has_cameras},
      {"topics.image", !topics.image.empty(), kNotOfBag, is_bag},
      {"topics.camera_info", !topics.camera_info.empty(),
       of_bag("focal or calibration takes its place"), is_bag && !has_own_lens},
      {"topics.imu", !topics.imu.empty(), of_bag("poses or a motion of yours take its place")},
      {"topics.poses", !topics.poses.empty(), of_bag("a motion of yours takes its place")},
      {"topics.odometry", !topics.odometry.empty(),
       of_bag("it is beside an IMU, and none is read")},
      {"topics.world", !topics.world.empty(), of_bag("no poses of the bag are read")},
      {"time_unit", !asked.time_unit.empty(), "no table or name that is read has times in a unit"},
      {"time_offset", asked.time_offset_s.has_value(),
       "the motion of this recording has the clock of its pictures"},
      {"at_rest", asked.at_rest_s.has_value(), kNoImu},
      {"imu_calibration", asked.imu_calibration.has_value(), kNoImu},
      {"calibration", asked.calibration && asked.focal_px,
       "focal takes its place, and the motion needs no place on an IMU"},
      {"mount", asked.mount_rpy_rad.has_value(),
       "the layout states it, or it tells the vertical only, which needs camera_height", false},
      {"labels_video", !asked.labels_video.empty(), "there are no labels",
       asked.labels.has_value()},
      {"bayer", !asked.bayer.empty(), "a video has colours", !is_video},
      {"bits", asked.bits.has_value(), "no picture has 16 bits",
       !is_video && recorded.format.is_deep},
  };
  for (const auto& [key, is_asked, why, has_effect] : rules) {
    const bool is_of_bag = std::string_view(key).starts_with("topics.");
    const bool took = recorded.took.contains(key) && (is_bag || !is_of_bag);
    if (!is_asked || has_effect || took) continue;
    refuse(asked.source, "{} has no effect: {}; remove it", key, why);
  }
}

/// Reads a layout. Each of its refusals names the folder that any recording can be turned into.
Recorded read_layout(const RecordingLayout& layout, const RecordingSource& asked,
                     bool exact_motion) {
  try {
    return layout.read(asked, exact_motion);
  } catch (const std::system_error&) {  // of this machine
    throw;
  } catch (const std::runtime_error& refusal) {
    const std::string said = refusal.what();
    const bool is_named = said.find("NEUTRAL.md") != said.npos;
    refuse({}, "{}", is_named ? said : fmt::format("{}; {}", said, kNeutralWay));
  }
}

/// With the files of a neutral folder (NEUTRAL.md) in place of keys that are not given.
RecordingSource with_neutral_files(RecordingSource asked) {
  const auto take = [&](const char* name, std::optional<fs::path>& key) {
    const fs::path file = asked.path / name;
    if (!key && fs::exists(file)) key = file;
  };
  if (!asked.poses && !asked.imu && !asked.speed_mps) take("poses.csv", asked.poses);
  if (!asked.poses) take("imu.csv", asked.imu);
  if (!asked.focal_px) take("calibration.yaml", asked.calibration);
  return asked;
}

}  // namespace

std::optional<sim::Pose> camera_on_body(const RecordingSource& asked,
                                        const std::optional<sim::Pose>& otherwise,
                                        Recorded& recorded) {
  if (asked.mount_rpy_rad) {
    recorded.took.insert("mount");
    return sim::Pose{camera_mount(*asked.mount_rpy_rad), Vector3d::Zero()};
  }
  if (!asked.calibration) return otherwise;
  const auto stated = read_calibration(*asked.calibration, asked.camera).T_BS;
  if (stated) recorded.took.insert("calibration");
  return stated ? stated : otherwise;
}

void take_time_offset(const RecordingSource& asked, Recorded& recorded) {
  std::optional<double> offset_s = asked.time_offset_s;
  if (!offset_s && asked.calibration) {
    offset_s = read_calibration(*asked.calibration, asked.camera).time_offset_s;
  }
  recorded.took.insert("time_offset");
  const std::int64_t offset_ns = std::llround(1e9 * offset_s.value_or(0));
  for (RecordedFrame& frame : recorded.frames) frame.t_ns += offset_ns;
}

void move_by_poses(const RecordingSource& asked, const fs::path& path, bool times_known,
                   Recorded& recorded, const std::optional<Vector3d>& up_W, const sim::Pose& T_PC) {
  PosesFile file = read_poses(path, asked.time_unit, recorded.tally);
  if (file.timed) recorded.took.insert("time_unit");
  if (file.of_body) join_camera(asked, path, file, recorded);
  const bool by_line = !file.timed || !times_known;
  if (!times_known && !file.timed) return;  // the missing times are reported elsewhere
  if (!times_known && file.lines.size() != recorded.frames.size()) {
    recorded.lacks.push_back(
        fmt::format("which of {} poses belong to its {} pictures (fps, if the first pose belongs "
                    "to the first picture)",
                    file.lines.size(), recorded.frames.size()));
    return;
  }
  auto poses = file.numbered ? poses_by_number(path, file, recorded)
               : by_line     ? poses_by_line(path, file, recorded)
                             : poses_by_time(file, recorded.has_own_clock);
  if (poses.empty()) {
    refuse({path}, "{}",
           recorded.tally.before(
               "none of the poses belongs to a picture; give a line for each picture"));
  }
  if (!by_line && !file.numbered) {
    require_start(recorded, poses.back().t_ns - poses.front().t_ns, path);
  }
  if (!times_known) sort_by_time(recorded.frames, "pictures", path.string(), recorded.tally);
  sort_by_time(poses, "poses", path.string(), recorded.tally);
  drop_held(poses, recorded.tally);
  for (CameraPose& pose : poses) pose.T_WC = pose.T_WC * T_PC;
  const std::vector<double> ways = ways_of(poses);
  const double usual_way = usual(ways).value_or(0);
  ReadingTimes times{stamps_of(poses), "poses",
                     "pictures are outside of the poses' time and are left out"};
  times.is_known = [&](std::size_t i) { return ways[i - 1] <= 1.5 * usual_way; };
  std::optional<Vector3d> up = up_W;
  // KITTI's world frame is the first camera frame.
  if (!up && !file.timed) up = Vector3d(0, -1, 0);
  // The vehicle on which the camera is mounted is upright at the first pose.
  if (asked.mount_rpy_rad) {
    if (asked.camera_height_m) recorded.took.insert("mount");
    up = poses.front().T_WC.R * camera_mount(*asked.mount_rpy_rad).row(2).transpose();
  }
  recorded.motion = std::make_unique<PosesMotion>(std::move(poses), up);
  keep_within(times, recorded);
}

void move_by_readings(const RecordingSource& asked, const fs::path& file, SensorReadings readings,
                      Recorded& recorded) {
  take_imu_noise(asked, recorded);
  take_time_offset(asked, recorded);
  // Pictures without a clock begin at the first reading.
  const std::int64_t first_ns = readings.imu.front().t_ns;
  const std::int64_t zero_ns = recorded.has_own_clock ? first_ns : 0;
  require_start(recorded, readings.imu.back().t_ns - first_ns, file);
  for (RecordedFrame& frame : recorded.frames) frame.t_ns += zero_ns;
  const std::int64_t start_ns = std::max(first_ns, recorded.frames.front().t_ns);
  keep_within(
      {stamps_of(readings.imu), "IMU's readings",
       "pictures are outside of the IMU's time and are left out", kBehindReadings_ns, start_ns},
      recorded);
  for (RecordedFrame& frame : recorded.frames) frame.t_ns -= start_ns;
  begin_at(start_ns, readings);
  sim::Calibration calibration;
  const auto T_BC = asked.calibration ? camera_on_body(asked, {}, recorded) : std::nullopt;
  calibration.T_BC.R =
      T_BC ? T_BC->R : camera_mount(asked.mount_rpy_rad.value_or(Vector3d::Zero()));
  const bool is_vehicle = !T_BC || asked.mount_rpy_rad;
  if (is_vehicle) {
    require_vehicle_axes(readings.imu, file);
  } else {
    calibration.T_BC.p = T_BC->p;
  }
  recorded.took.insert({"at_rest", "mount"});
  const TrueState start = start_of(readings.imu, asked, calibration.T_BC.R,
                                   calibration.gravity_mps2, is_vehicle, recorded.tally);
  move_from(start, calibration, std::move(readings), recorded);
}

void move_from(const TrueState& start, sim::Calibration calibration, SensorReadings readings,
               Recorded& recorded) {
  for (sim::ImuSample& sample : readings.imu) {
    sample.gyro_radps -= start.gyro_bias_radps;
    sample.accel_mps2 -= start.accel_bias_mps2;
  }
  calibration.T_WB_start.R = start.q_WB.toRotationMatrix();
  calibration.v_WB_start_mps = start.v_WB_mps;
  recorded.settings.odometry.enabled = !readings.odometry.empty();
  recorded.motion =
      std::make_unique<SensorMotion>(recorded.settings, calibration, std::move(readings));
}

void take_imu_noise(const RecordingSource& asked, Recorded& recorded) {
  if (!asked.imu_calibration && recorded.settings.imu.noise == scenario::ImuNoise{}) {
    recorded.tally.tell("the noise of the IMU is not stated, and counts as none: imu_calibration");
  }
  if (!asked.imu_calibration) return;
  recorded.took.insert("imu_calibration");
  const auto noise = read_calibration(*asked.imu_calibration).noise;
  if (!noise) {
    refuse({*asked.imu_calibration},
           "holds no noise densities; give a file with them, as Kalibr's imu.yaml");
  }
  recorded.settings.imu.noise = *noise;
}

void time_by(double fps, Recorded& recorded) {
  const PictureNumbers& all = recorded.numbers;
  if (all.least && *all.greatest - *all.least + 1 != all.pictures) {
    const std::string steps = fmt::format("them in steps of {}, missing ones too", all.step);
    recorded.tally.tell("{} pictures have the numbers {} to {} in their names: fps counts {}",
                        all.pictures, *all.least, *all.greatest,
                        all.step > 0 ? steps : "the pictures alone");
  }
  for (RecordedFrame& frame : recorded.frames) {
    const std::size_t place = all.step > 0 ? (*frame.named - *all.least) / all.step : frame.number;
    const double t_ns = static_cast<double>(place) * 1e9 / fps;
    if (!(t_ns <= static_cast<double>(kFarthest_ns))) {
      refuse({},
             "at {} pictures a second the recording takes more than 146 years; give a higher fps",
             fps);
    }
    frame.t_ns = std::llround(t_ns);
  }
  recorded.has_own_clock = true;
  if (all.step > 0 && *all.least > 1) {
    const double before_ns = static_cast<double>(*all.least / all.step) * 1e9 / fps;
    recorded.numbers.before_ns =
        std::llround(std::min(before_ns, static_cast<double>(kFarthest_ns)));
  }
}

/// The properties of the pictures, with the user's in place of those that they show.
void set_format(const RecordingSource& asked, Recorded& recorded) {
  std::vector<fs::path> files;
  for (const RecordedFrame& frame : recorded.frames) files.push_back(frame.picture);
  if (recorded.video.empty()) {
    const auto demosaic = recorded.format.demosaic;
    recorded.format = common_format(files);
    recorded.format.demosaic = demosaic;
  }
  if (!asked.bayer.empty()) recorded.format.demosaic = demosaic_of(asked.bayer);
  if (asked.bits) {
    recorded.format.bits = *asked.bits;
  } else if (recorded.format.bits > 8 && recorded.format.bits < 16) {
    recorded.tally.add("pictures of 16 bits use fewer, and are scaled by these (bits)",
                       fmt::format("{} bits", recorded.format.bits));
  }
}

Recorded read_recorded(const scenario::Scenario& scenario) {
  const RecordingLayout& layout = layout_of(scenario.recording.value());
  const RecordingSource asked = layout.name == "listed"
                                    ? with_neutral_files(scenario.recording.value())
                                    : scenario.recording.value();
  const bool exact_motion = scenario.ego_motion == scenario::EgoMotionSource::truth;
  Recorded recorded = read_layout(layout, asked, exact_motion);
  recorded.settings.origin = origin_of(asked.path);
  // Without a calibration the cameras of KITTI look as the mount says.
  if (layout.name == "kitti" && !recorded.lens) recorded.took.insert("mount");
  const bool is_told = !recorded.lacks.empty();
  const bool times_known = set_times(asked, recorded);
  if (!times_known && !asked.poses) recorded.lacks.emplace_back(kNoTimes);
  set_motion(asked, times_known, is_told, recorded);
  if (!times_known && asked.poses && !recorded.motion && recorded.lacks.empty()) {
    recorded.lacks.emplace_back(kNoTimes);
  }
  set_lens(asked, recorded);
  if (recorded.motion) require_ground_in_view(asked, recorded);
  if (!recorded.lacks.empty()) {
    refuse(asked.source,
           "{} does not say {}; give these keys of recording, or the options of lcs replay; {}",
           asked.path.string(), fmt::join(recorded.lacks, ", and "), kNeutralWay);
  }
  std::vector<RecordedFrame>& frames = recorded.frames;
  const auto every = static_cast<std::size_t>(asked.every),
             most = static_cast<std::size_t>(scenario.frames);
  std::erase_if(frames, [&](const RecordedFrame& frame) { return frame.number % every != 0; });
  if (scenario.frames > 0) frames.resize(std::min(frames.size(), most));
  if (frames.empty()) {
    refuse(asked.source, "no picture is left; give a smaller every");
  }
  set_format(asked, recorded);
  require_effects(asked, layout, exact_motion, recorded);
  return recorded;
}

}  // namespace lcs::replay
