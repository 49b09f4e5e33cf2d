#include "scenarios/load.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "scenarios/document.h"
#include "scenarios/imu_presets.h"
#include "scenarios/load_actor.h"
#include "scenarios/load_ego.h"
#include "scenarios/load_image.h"
#include "scenarios/load_recording.h"
#include "scenarios/load_sweep.h"
#include "scenarios/quantities.h"
#include "scenarios/scenes.h"

namespace lcs::scenario {
namespace {

constexpr int kMostFrames = 1'000'000;
constexpr int kSmallestImagePx = 16;
constexpr int kLargestImagePx = 8192;
const Value empty_map(Value::Kind::map, {});

Camera::Told read_told(Reader reader) {
  Camera::Told told;
  reader.read("height_error", kPosition, told.height_error_m);
  reader.read("pitch_error", kAngle, told.pitch_error_rad);
  reader.finish();
  return told;
}

Camera read_camera(Reader reader) {
  Camera camera;
  if (const Value* size = reader.find("size")) {
    const std::string path = reader.path_of("size");
    const std::vector<Value>& list = as_list(*size, path, 2);
    const auto pixels = [&](std::size_t i) {
      return static_cast<int>(
          as_integer(list[i], path + "." + std::to_string(i), kSmallestImagePx, kLargestImagePx));
    };
    camera.width_px = pixels(0);
    camera.height_px = pixels(1);
  }
  if (reader.at_most_one_of({"fovy", "focal"}) == "focal") {
    double focal_px = 0;
    reader.read("focal", kFocal, focal_px);
    camera.fovy_rad = 2 * std::atan(camera.height_px / 2.0 / focal_px);
  }
  reader.read("fovy", kFieldOfView, camera.fovy_rad);
  reader.read("rate", kCameraRate, camera.rate_hz);
  reader.read("position", kPosition, camera.mount_position_m);
  reader.read("rotation", kAngle, camera.mount_rpy_rad);
  if (const Value* told = reader.find("told")) {
    camera.told = read_told({*told, reader.path_of("told")});
  }
  reader.finish();
  return camera;
}

/// The estimator takes the state at 0 from the first reading, so there is one.
std::vector<TimeSpan> read_gaps(const Value& value, const std::string& path) {
  std::vector<TimeSpan> gaps;
  for (const Value& item : as_list(value, path)) {
    const std::string item_path = path + "." + std::to_string(gaps.size());
    const std::vector<Value>& pair = as_list(item, item_path, 2);
    const TimeSpan gap{as_quantity(pair[0], item_path + ".0", kDuration),
                       as_quantity(pair[1], item_path + ".1", kDuration)};
    if (gap.to_s <= gap.from_s || (!gaps.empty() && gap.from_s < gaps.back().to_s)) {
      throw Error(item.where, item_path + " is [" + pair[0].text + ", " + pair[1].text +
                                  "]; make the times increase, from each gap to the next");
    }
    gaps.push_back(gap);
  }
  return gaps;
}

Imu read_imu(Reader reader) {
  Imu imu;
  const std::vector<std::string> presets = imu_preset_names();
  if (const auto preset = reader.choice("preset", presets)) imu.preset = presets[*preset];
  const ImuNoise preset_noise = imu_preset(imu.preset).value();
  imu.noise = preset_noise;
  reader.read("gyroscope_noise_density", kNoiseDensity, imu.noise.gyroscope_noise_density);
  reader.read("gyroscope_random_walk", kNoiseDensity, imu.noise.gyroscope_random_walk);
  reader.read("accelerometer_noise_density", kNoiseDensity, imu.noise.accelerometer_noise_density);
  reader.read("accelerometer_random_walk", kNoiseDensity, imu.noise.accelerometer_random_walk);
  reader.read("gyroscope_turn_on_bias", kTurnOnRate, imu.noise.gyroscope_turn_on_bias_radps);
  reader.read("accelerometer_turn_on_bias", kTurnOnAcceleration,
              imu.noise.accelerometer_turn_on_bias_mps2);
  if (const Value* gaps = reader.find("gaps")) imu.gaps = read_gaps(*gaps, reader.path_of("gaps"));
  reader.read("rate", kSensorRate, imu.rate_hz);
  reader.finish();
  if (imu.noise != preset_noise) imu.preset = "custom";
  return imu;
}

Odometry read_odometry(Reader reader) {
  Odometry odometry;
  odometry.enabled = true;
  reader.read("rate", kSensorRate, odometry.rate_hz);
  reader.read("noise", kSpeed, odometry.noise_mps);
  reader.read("yaw_noise", kYawNoise, odometry.yaw_noise_radps);
  reader.read("scale_error", kRatio, odometry.scale_error);
  reader.finish();
  return odometry;
}

void read_corners(Reader reader, std::optional<int>& threshold) {
  if (const Value* value = reader.find("threshold")) {
    threshold = as_threshold(*value, reader.path_of("threshold"));
  }
  reader.finish();
}

double read_truth(Reader reader) {
  double min_depth_m = Scenario{}.truth_min_depth_m;
  reader.read("min_depth", kDistance, min_depth_m);
  reader.finish();
  return min_depth_m;
}

Origin read_origin(Reader reader) {
  constexpr std::int64_t kMostAgain = 1'000'000;
  Origin origin;
  origin.source = reader.where();
  reader.require("family");
  reader.read("family", origin.family);
  if (const Value* seed = reader.require("seed")) {
    origin.seed = as_seed(*seed, reader.path_of("seed"));
  }
  if (const Value* again = reader.find("again")) {
    origin.again =
        static_cast<std::uint64_t>(as_integer(*again, reader.path_of("again"), 0, kMostAgain));
  }
  if (const Value* features = reader.find("features")) {
    const std::string path = reader.path_of("features");
    for (const Value& item : as_list(*features, path)) {
      origin.features.push_back(as_text(item, path + "." + std::to_string(origin.features.size())));
    }
  }
  reader.finish();
  return origin;
}

/// False for nan and inf, as YAML (".inf") or C++ ("inf") write them.
bool is_finite(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  if (text.starts_with('.')) text.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = end == text.data() + text.size();
  return !whole || (error == std::errc() && std::isfinite(number));
}

/// The names and ranges are the filter's to check; what no number may be is refused here.
void read_filter(const Value& value, Scenario& scenario) {
  const Reader reader(value, "filter");
  for (const Entry& entry : value.entries) {
    const std::string path = reader.path_of(entry.key);
    const std::string& text = as_text(entry.value, path);
    if (entry.key == "preset") {
      scenario.filter_preset = text;
      scenario.filter_preset_source = entry.value.where;
      continue;
    }
    if (!is_finite(text)) {
      throw Error(entry.value.where, path + ": '" + text + "' is not finite; give a number");
    }
    scenario.filter.push_back({entry.key, text, entry.value.where});
  }
}

Criterion read_criterion(Reader reader) {
  Criterion criterion;
  criterion.source = reader.where();
  reader.require("metric");
  reader.read("metric", criterion.metric);
  reader.read("min", kBound, criterion.min);
  reader.read("max", kBound, criterion.max);
  reader.read("required", criterion.required);
  reader.read("detector", criterion.detector);
  reader.finish();
  if (!criterion.min && !criterion.max) {
    throw Error(criterion.source, reader.path() + " has no bound; give min, max or both");
  }
  if (criterion.min && criterion.max && *criterion.min > *criterion.max) {
    throw Error(criterion.source, reader.path() + " has its min above its max; exchange them");
  }
  return criterion;
}

/// Frames at 0, 1/rate, 2/rate, ... that lie before the end.
int frames_before(double duration_s, double rate_hz, const Value& duration) {
  constexpr double rounding = 1e-6;  // 0.3 s at 10 Hz is 3 frames, whatever 0.3 * 10 is in binary
  const double frames = std::ceil(duration_s * rate_hz - rounding);
  if (frames <= kMostFrames) return std::max(1, static_cast<int>(frames));
  throw Error(duration.where, "duration '" + duration.text + "' makes more than " +
                                  std::to_string(kMostFrames) + " frames; shorten it");
}

int read_frames(Reader& reader, double rate_hz) {
  int frames = 0;
  reader.read("frames", 1, kMostFrames, frames);
  double duration_s = 0;
  reader.read("duration", kDuration, duration_s);
  const auto given = reader.exactly_one_of({"frames", "duration"});
  return given == "duration" ? frames_before(duration_s, rate_hz, *reader.find("duration"))
                             : frames;
}

/// A section under its key, when it is given.
void read_section(Reader& reader, std::string_view key, auto&& read, auto& out) {
  if (const Value* value = reader.find(key)) out = read(Reader(*value, reader.path_of(key)));
}

/// What was recorded is not made, and so nothing else can be said of it.
void read_recorded(Reader& reader, const std::filesystem::path& folder, Scenario& scenario) {
  for (const char* key : {"scene", "origin", "seed", "ego", "camera", "imu", "odometry", "truth",
                          "image", "ground", "actors"}) {
    reader.at_most_one_of({"recording", key});
  }
  scenario.recording = read_recording({*reader.find("recording"), "recording"}, folder);
  if (const auto& split = scenario.recording->split) {
    scenario.groups.emplace_back(kSplits.at(static_cast<std::size_t>(*split)));
  }
  reader.read("frames", 1, kMostFrames, scenario.frames);
}

void read_simulated(Reader& reader, const std::filesystem::path& folder, Scenario& scenario) {
  const auto section = [&](std::string_view key, auto&& read, auto& out) {
    read_section(reader, key, read, out);
  };
  if (const Value* scene = reader.find("scene")) {
    scenario.scene = find_scene(*scene, folder);
    scenario.scene_source = scene->where;
  }
  section("origin", read_origin, scenario.origin);
  if (const Value* seed = reader.find("seed")) scenario.seed = as_seed(*seed, "seed");
  if (const Value* ego = reader.require("ego")) scenario.ego = read_ego({*ego, "ego"}, folder);
  section("camera", read_camera, scenario.camera);
  scenario.frames = read_frames(reader, scenario.camera.rate_hz);
  const Value* imu = reader.find("imu");
  scenario.imu = read_imu({imu ? *imu : empty_map, "imu"});
  section("odometry", read_odometry, scenario.odometry);
  section("truth", read_truth, scenario.truth_min_depth_m);
  section("image", read_image, scenario.image);
  section("ground", read_ground, scenario.ground);
  if (const Value* actors = reader.find("actors")) {
    const Reader names(*actors, "actors");
    for (const Entry& entry : actors->entries) {
      scenario.actors.push_back(read_actor(entry, folder));
    }
  }
}

void read_top(Reader& reader, const std::filesystem::path& folder, Scenario& scenario) {
  reader.read("purpose", scenario.purpose);
  if (const Value* groups = reader.find("groups")) scenario.groups = read_groups(*groups);
  const bool is_recorded = reader.exactly_one_of({"scene", "recording"}) == "recording";
  (is_recorded ? read_recorded : read_simulated)(reader, folder, scenario);
  if (const auto source = reader.choice("ego_motion", {"imu", "truth"})) {
    scenario.ego_motion = static_cast<EgoMotionSource>(*source);
  }
  if (is_recorded) scenario.fast_threshold.reset();  // each camera has its own noise
  if (const Value* corners = reader.find("corners")) {
    read_corners({*corners, "corners"}, scenario.fast_threshold);
  }
  if (const Value* filter = reader.find("filter")) read_filter(*filter, scenario);
  if (const Value* criteria = reader.find("criteria")) {
    for (const Value& item : as_list(*criteria, "criteria")) {
      const std::string index = std::to_string(scenario.criteria.size());
      scenario.criteria.push_back(read_criterion({item, "criteria." + index}));
    }
  }
  if (const Value* sweep = reader.find("sweep")) scenario.sweep = read_sweep(*sweep);
}

/// Without what is for people, what it was drawn from, the seeds, and who watches and judges.
std::map<std::string, std::string> world_of(const Value& root) {
  constexpr std::array<std::string_view, 7> kNotOfTheWorld{"purpose", "groups",   "origin", "seed",
                                                           "filter",  "criteria", "sweep"};
  Value world(Value::Kind::map, root.where);
  for (const Entry& entry : root.entries) {
    if (std::find(kNotOfTheWorld.begin(), kNotOfTheWorld.end(), entry.key) == kNotOfTheWorld.end())
      world.entries.push_back(entry);
  }
  return flattened(world);
}

}  // namespace

Scenario load(const std::filesystem::path& file, const LoadOptions& options) {
  return load(parse_file(file), file, options);
}

Scenario load(Value root, const std::filesystem::path& file, const LoadOptions& options) {
  for (const std::string& assignment : options.sets) apply_set(root, assignment);
  Scenario scenario;
  scenario.name = file.stem().string();
  scenario.file = file;
  Reader reader(root, "");
  read_top(reader, file.parent_path(), scenario);
  reader.finish();
  scenario.world = world_of(root);
  if (options.seed && !scenario.recording) scenario.seed = *options.seed;
  return scenario;
}

}  // namespace lcs::scenario
