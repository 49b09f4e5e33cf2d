// EuRoC ASL: mav0/ with cam0, imu0 and optionally a truth for the start; also from `lcs generate`.
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <system_error>

#include "scenarios/input/input_file.h"
#include "scenarios/input/message.h"
#include "scenarios/shipped.h"
#include "tools/files/json_node.h"
#include "tools/process/child.h"
#include "tools/replay/recorded.h"
#include "tools/sequence/replay_settings.h"

namespace lcs::replay {
namespace {

constexpr const char* kTruthFolder = "state_groundtruth_estimate0";
constexpr const char* kMotionCapture = "mocap0";  // of TUM-VI
constexpr double kGravity_mps2 = 9.81;

/// The folder that holds cam0: DIR/mav0, or DIR itself.
fs::path mav_of(const fs::path& folder) {
  return fs::is_directory(folder / "mav0") ? folder / "mav0" : folder;
}

/// The sensor's calibration in its folder; empty if it has none.
SensorCalibration calibration_in(const fs::path& sensor) {
  const fs::path file = sensor / "sensor.yaml";
  return fs::exists(file) ? read_calibration(file) : SensorCalibration{};
}

/// EuRoC's tables have ns, unless something else is stated.
TableTimes times_of(const fs::path& sensor, const SensorCalibration& calibration,
                    const RecordingSource& asked, ExpectedRate rate) {
  rate.stated_hz = calibration.rate_hz;
  rate.stated_by = (sensor / "sensor.yaml").string();
  return {asked.time_unit, rate, kNanosecond_ns};
}

void read_frames(const fs::path& camera, const TableTimes& times, Recorded& recorded) {
  const TextTable table = read_table(camera / "data.csv");
  const auto picture = [&](const TextTable::Row& row) {
    const bool is_named = row.fields.size() > 1 && !row.fields[1].empty();
    return camera / "data" / (is_named ? row.fields[1] : row.fields[0] + ".png");
  };
  take_list(table, times.unit_ns(table, 0, recorded.tally), picture, recorded);
}

/// A generated sequence repeats `lcs.json` in each sensor.yaml for other readers. Throws if an edit
/// made the two differ.
void require_same(const fs::path& mav, const std::string& camera,
                  const sequence::ReplaySettings& exact) {
  const auto is_same = [](double said, double number) {
    constexpr double kRounding = 1e-9;
    return std::abs(said - number) <= kRounding * std::max(1.0, std::abs(number));
  };
  fs::path file;
  SensorCalibration said;  // in it
  const auto require = [&](bool same, const char* key) {
    if (same) return;
    const auto at = said.keys.find(key);
    refuse(at == said.keys.end() ? input::Source{file.string(), 0} : at->second,
           "{0} is not as {1} of the sequence says; generate the sequence again, or take {1} away "
           "to replay it by its other files alone",
           key, sequence::kSettingsFile);
  };
  const auto read = [&](const std::string& sensor, const sim::Pose& T_BS) {
    file = mav / sensor / "sensor.yaml";
    if (!fs::exists(file)) return false;
    said = read_calibration(file);
    require(
        said.T_BS && said.T_BS->R.isApprox(T_BS.R, 1e-9) && (said.T_BS->p - T_BS.p).norm() < 1e-9,
        "T_BS");
    return true;
  };
  const sim::Calibration& told = exact.calibration;
  if (read(camera, told.T_BS.inverse() * told.T_BC)) {
    const double rate_hz = exact.scenario.camera.rate_hz;
    require(is_same(said.rate_hz.value_or(rate_hz), rate_hz), "rate_hz");
    Lens own = exact.lens, lens = said.lens.value_or(own);
    require(is_same(lens.fu_px, own.fu_px) && is_same(lens.fv_px, own.fv_px) &&
                is_same(lens.cu_px, own.cu_px) && is_same(lens.cv_px, own.cv_px),
            "intrinsics");
    const cv::Size size_px(lens.width_px, lens.height_px);
    require(size_px.empty() || size_px == cv::Size(own.width_px, own.height_px), "resolution");
    constexpr auto kFisheye = Lens::Distortion::equidistant;
    require((own.distortion == kFisheye) == (lens.distortion == kFisheye), "distortion_model");
    own.coefficients.resize(std::max(lens.coefficients.size(), own.coefficients.size()));
    lens.coefficients.resize(own.coefficients.size());
    require(std::ranges::equal(lens.coefficients, own.coefficients, is_same),
            "distortion_coefficients");
  }
  if (read("imu0", {}) && said.noise) {
    for (const auto& [key, member] : sequence::kImuNoise) {
      if (!said.keys.contains(key)) continue;  // turn-on biases, which Kalibr lacks
      require((*said.noise).*member == exact.scenario.imu.noise.*member, key);
    }
  }
  read("odometry0", told.T_BS.inverse());
  read(kTruthFolder, {});
}

/// Sets the motion of a generated sequence from its own settings: the same bits as in the run.
void move_as_run(const fs::path& mav, const std::string& camera,
                 const sequence::ReplaySettings& exact, Recorded& recorded) {
  SensorReadings readings;
  const TableTimes times{"ns", {}, {}};
  readings.imu = read_imu_csv(mav / "imu0" / "data.csv", times, recorded.tally);
  if (exact.scenario.odometry.enabled) {
    const fs::path file = mav / "odometry0" / "data.csv";
    readings.odometry = read_odometry_csv(file, times, recorded.tally);
    if (readings.odometry.empty()) {
      refuse({file},
             "holds no reading of the odometry that {} says there is; generate the sequence again",
             sequence::kSettingsFile);
    }
  }
  const fs::path poses = mav / camera / "pose.csv";
  if (recorded.settings.ego_motion == scenario::EgoMotionSource::truth || fs::exists(poses)) {
    readings.poses = read_pose_csv(poses, recorded.tally);
  }
  // A run's clock begins at 0.
  for (sim::ImuSample& sample : readings.imu) sample.t_ns -= exact.start_ns;
  for (sim::OdometrySample& sample : readings.odometry) sample.t_ns -= exact.start_ns;
  const std::int64_t camera_ns =
      exact.start_ns - std::llround(1e9 * exact.calibration.time_offset_s);
  for (CameraPose& pose : readings.poses) pose.t_ns -= camera_ns;
  for (RecordedFrame& frame : recorded.frames) frame.t_ns -= camera_ns;
  recorded.motion =
      std::make_unique<SensorMotion>(recorded.settings, exact.calibration, std::move(readings));
}

/// The camera of a generated rig by its folder or its name in the scenario; if none is asked for,
/// the run's camera. Puts its lens and pose into the settings. \return its folder.
std::string choose_camera(const RecordingSource& asked, sequence::ReplaySettings& exact) {
  std::string names;
  for (std::size_t place = 0; place < exact.cameras.size(); ++place) {
    const sequence::ReplaySettings::Camera& one = exact.cameras[place];
    const std::string folder = sequence::camera_name(place);
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", one.name, folder);
    const bool is_it = asked.camera.empty() ? place == exact.filter_place
                                            : asked.camera == one.name || asked.camera == folder;
    if (!is_it) continue;
    exact.lens = one.lens;
    exact.calibration.T_BC = one.T_BC;
    return folder;
  }
  refuse(asked.source, "no camera of the rig is called '{}'; give one of {}", asked.camera, names);
}

std::vector<TrueState> read_truth(const fs::path& mav, const RecordingSource& asked, Tally& tally) {
  for (const char* name : {kTruthFolder, kMotionCapture}) {
    const fs::path file = mav / name / "data.csv";
    if (!fs::exists(file)) continue;
    const SensorCalibration calibration = calibration_in(mav / name);
    return read_truth_csv(file, times_of(mav / name, calibration, asked, kStateRate),
                          name == kTruthFolder, tally);
  }
  return {};
}

/// The accelerometer measures the acceleration against gravity: at rest it points up.
void require_gravity_down(const TrueState& start, const std::vector<sim::ImuSample>& imu,
                          const fs::path& file) {
  constexpr double kSpan_s = 1;
  Vector3d force_S = Vector3d::Zero();
  for (const sim::ImuSample& sample : imu) {
    const double since_s = seconds(sample.t_ns - start.t_ns);
    if (since_s >= 0 && since_s <= kSpan_s) force_S += sample.accel_mps2;
  }
  if ((start.q_WB * force_S).z() >= 0) return;
  refuse({file},
         "by the attitude of the truth its accelerations point down, and at rest they must point "
         "up; change their sign");
}

/// Sets the motion from EuRoC's own files. The body frame is B.
/// \param T_BC_known pose of the camera, if anything states it.
void move_by_files(const fs::path& mav, const std::optional<sim::Pose>& T_BC_known,
                   bool exact_motion, const RecordingSource& asked, Recorded& recorded) {
  if (!T_BC_known) {
    recorded.lacks.emplace_back(
        "where the camera is on the IMU (T_BS or T_cam_imu in a calibration, or mount)");
    return;
  }
  const sim::Pose T_BC = *T_BC_known;
  recorded.took.insert({"time_unit", "topics.imu"});
  take_time_offset(asked, recorded);
  const std::vector<TrueState> truth = read_truth(mav, asked, recorded.tally);
  if (exact_motion) {
    recorded.took.insert("ego_motion: truth");
    if (truth.size() < 2) {
      refuse({}, "{} has no truth to tell the motion from; leave --ego-motion truth out",
             mav.string());
    }
    move_by_navigation({truth.begin(), truth.end()}, T_BC, recorded);
    return;
  }
  SensorReadings readings;
  const fs::path imu_file = mav / "imu0" / "data.csv";
  const SensorCalibration imu = calibration_in(mav / "imu0");
  const TableTimes times = times_of(mav / "imu0", imu, asked, kImuRate);
  readings.imu = read_imu_csv(imu_file, times, recorded.tally);
  if (imu.noise) recorded.settings.imu.noise = *imu.noise;
  take_imu_noise(asked, recorded);
  sim::Calibration calibration;
  calibration.T_BS = imu.T_BS.value_or(sim::Pose{});  // the body frame is the IMU's frame
  calibration.T_BC = T_BC;
  calibration.gravity_mps2 = kGravity_mps2;
  // The truth is of the body; it may begin after the first picture.
  std::int64_t first_ns = std::max(recorded.frames.front().t_ns, readings.imu.front().t_ns);
  if (!truth.empty()) first_ns = std::max(first_ns, truth.front().t_ns);
  keep_within({stamps_of(readings.imu), "IMU's readings",
               "pictures are from before the truth or outside of the IMU's time",
               kBehindReadings_ns, first_ns},
              recorded);
  if (truth.empty()) recorded.took.insert("at_rest");
  TrueState start{{first_ns}};
  if (const auto known = std::ranges::lower_bound(truth, first_ns, {}, &TrueState::t_ns);
      !truth.empty()) {
    start = known == truth.end() ? truth.back() : *known;
    require_gravity_down(start, readings.imu, imu_file);
  }
  if (const fs::path file = mav / "odometry0" / "data.csv"; fs::exists(file)) {
    const SensorCalibration wheels = calibration_in(mav / "odometry0");
    readings.odometry = read_odometry_csv(
        file, times_of(mav / "odometry0", wheels, asked, kStateRate), recorded.tally);
    recorded.took.insert("topics.odometry");
    const sim::Pose T_BO = wheels.T_BS.value_or(sim::Pose{});
    for (sim::OdometrySample& sample : readings.odometry) {
      sample.velocity_mps = T_BO.R * sample.velocity_mps;
    }
    if (readings.odometry.empty()) {
      recorded.tally.add("tables of odometry hold no reading and are not used", file.string());
    }
  }

  // Readings before the start are dropped; times count from it.
  begin_at(start.t_ns, readings);
  for (RecordedFrame& frame : recorded.frames) frame.t_ns -= start.t_ns;
  if (truth.empty()) {
    start = start_of(readings.imu, asked, T_BC.R, kGravity_mps2, false, recorded.tally);
  }
  move_from(start, calibration, std::move(readings), recorded);
}

// ROS 1 bags, rosbag2 (.db3) and MCAP. read_bag.py writes them as a folder in EuRoC's layout, by
// PyPI's rosbags, and that folder is read.

constexpr const char* kPosesFile = "poses.txt";
constexpr input::FileKind kMessages{input::kMebibyte, "run it again"};

/// A folder that is removed with all that is in it.
std::shared_ptr<const fs::path> temporary_folder() {
  std::string name = (fs::temp_directory_path() / "lcs-bag-XXXXXX").string();
  if (!::mkdtemp(name.data())) {
    throw std::system_error(errno, std::generic_category(), name + " cannot be made");
  }
  return {new fs::path(name), [](const fs::path* path) {
            std::error_code error;
            fs::remove_all(*path, error);
            delete path;
          }};
}

/// Runs read_bag.py. \throws input::Error with its message if it fails.
void run_reader(const std::vector<std::string>& arguments, int out, const input::Source& where) {
  const process::PythonEnd end =
      process::run_python(scenario::shipped_folder("tools/replay") / "read_bag.py", arguments, out);
  if (end.is_fine) return;
  std::string said = end.err;
  constexpr std::string_view kPrefix = "error: ";
  if (said.starts_with(kPrefix)) said.erase(0, kPrefix.size());
  const std::string& bag = arguments.front();  // its whole path
  if (said.starts_with(bag + ": ") && fs::absolute(where.file) == bag) {
    said.erase(0, bag.size() + 2);
  }
  refuse(where, "{}",
         said.empty() ? "the bag was not read to its end; run it again" : input::one_line(said));
}

}  // namespace

bool is_euroc(const fs::path& folder) {
  const fs::path camera = mav_of(folder) / "cam0";
  return fs::exists(camera / "data.csv") || fs::is_directory(camera / "data");
}

Recorded read_euroc(const RecordingSource& asked, bool exact_motion) {
  const fs::path mav = mav_of(asked.path);
  const fs::path settings_file = asked.path / sequence::kSettingsFile;
  std::optional<sequence::ReplaySettings> exact;
  if (fs::exists(settings_file)) exact = sequence::read_settings(settings_file);
  std::string camera = asked.camera.empty() ? "cam0" : asked.camera;
  if (exact && !exact->cameras.empty()) camera = choose_camera(asked, *exact);
  const fs::path camera_folder = mav / camera;
  if (!fs::is_directory(camera_folder)) {
    refuse(asked.source, "{} is not there; name another camera", camera_folder.string());
  }
  const SensorCalibration sensor = calibration_in(camera_folder);
  Recorded recorded;
  if (fs::exists(camera_folder / "data.csv")) {
    read_frames(camera_folder, times_of(camera_folder, sensor, asked, kCameraRate), recorded);
  } else {
    take_pictures(camera_folder / "data", asked.time_unit, recorded);
  }
  if (exact) {
    require_same(mav, camera, *exact);
    recorded.settings = exact->scenario;
    if (exact_motion && !motion_is_asked(asked)) {
      recorded.settings.ego_motion = scenario::EgoMotionSource::truth;
      recorded.took.insert("ego_motion: truth");
    }
    recorded.lens = exact->lens;
    // The truth holds motions from each picture to the next.
    const bool is_first = camera == sequence::camera_name(0);
    const fs::path truth_file =
        (is_first ? asked.path : asked.path / camera) / sequence::kTruthFile;
    if (asked.every == 1 && fs::exists(truth_file)) {
      recorded.truth.emplace(truth_file);
    }
    if (!motion_is_asked(asked)) move_as_run(mav, camera, *exact, recorded);
    return recorded;
  }
  recorded.lens = sensor.lens;
  recorded.T_BC = sensor.T_BS;
  if (motion_is_asked(asked)) return recorded;
  move_by_files(mav, camera_on_body(asked, sensor.T_BS, recorded), exact_motion, asked, recorded);
  return recorded;
}

bool is_bag(const fs::path& path) {
  static const std::set<std::string> kEndings{".bag", ".mcap", ".db3"};
  if (fs::is_regular_file(path)) return kEndings.contains(path.extension().string());
  std::error_code error;
  return std::any_of(fs::directory_iterator(path, error), {}, [](const fs::directory_entry& entry) {
    return entry.path().extension() == ".mcap" || entry.path().extension() == ".db3";
  });
}

Recorded read_bag(const RecordingSource& asked, bool exact_motion) {
  const auto folder = temporary_folder();
  const fs::path made = *folder / "recording";
  const RecordingSource::Topics& topics = asked.topics;
  std::vector<std::string> arguments{fs::absolute(asked.path).string()};
  if (topics.image.empty()) {
    run_reader(arguments, STDOUT_FILENO, asked.source);
    refuse(asked.source,
           "{} is a bag with the topics above; name the topic of its pictures (topics.image, or "
           "--image-topic), and of an IMU or poses",
           asked.path.string());
  }
  const std::pair<const char*, const std::string&> options[] = {
      {"--image-topic", topics.image},       {"--camera-info-topic", topics.camera_info},
      {"--imu-topic", topics.imu},           {"--poses-topic", topics.poses},
      {"--odometry-topic", topics.odometry}, {"--world-frame", topics.world},
  };
  for (const auto& [option, topic] : options) {
    if (!topic.empty()) arguments.push_back(fmt::format("{}={}", option, topic));
  }
  if (motion_is_asked(asked)) arguments.emplace_back("--own-motion");
  arguments.push_back("--out=" + made.string());
  run_reader(arguments, -1, asked.source);

  RecordingSource inner = asked;
  inner.path = made;
  inner.camera.clear();
  const bool by_imu = topics.poses.empty() && fs::exists(made / "mav0" / "imu0");
  const bool by_poses = !motion_is_asked(asked) && !by_imu && fs::exists(made / kPosesFile);
  // With poses EuRoC's own motion is not read; without any motion there is none to read.
  if (!motion_is_asked(asked) && !by_imu) inner.poses = made / kPosesFile;
  Recorded recorded = [&] {
    try {
      Recorded read = read_euroc(inner, exact_motion);
      if (by_poses) {
        move_by_poses(inner, made / kPosesFile, true, read);
        read.took.insert({"topics.poses", "topics.world"});
      }
      return read;
    } catch (const input::Error& error) {
      std::string said = error.what();
      if (!said.starts_with(folder->string())) throw;
      // People do not have that file, and a bag has no header that could state a unit.
      said.erase(0, said.find(": ") + 2);
      said.erase(std::min(said.size(), said.find(", or put their unit into the header")));
      const std::string& topic = by_poses ? topics.poses : topics.imu;
      refuse(asked.source, "{}, of the bag's {}: correct the bag's messages", said,
             topic.empty() ? "only such topic" : topic);
    }
  }();
  recorded.keep = folder;
  files::read_json(made / "bag.json", kMessages, [&](const files::JsonNode& json) {
    json["told"].each([&](const files::JsonNode& line) { recorded.tally.tell("{}", line.text()); });
    if (json.has("bayer")) recorded.format.demosaic = demosaic_of(json["bayer"].text());
    return 0;
  });
  return recorded;
}

}  // namespace lcs::replay
