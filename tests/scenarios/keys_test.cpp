// The list of keys (scenarios/fields.h): every key can be written, and derived files match it.
#include "scenarios/keys.h"

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/scenarios/scenario_file.h"
#include "tests/scenarios/schema.h"
#include "tests/tools/files.h"

namespace lcs::scenario {
namespace {

namespace fs = std::filesystem;
const fs::path kScenarios = fs::path(LCS_SOURCE_DIR) / "scenarios";

/// Writes the correct schema into the build folder, for copying, if the shipped one differs.
TEST(Keys, TheSchemaFollowsTheList) {
  const std::string right = schema_text();
  if (test::read(kScenarios / "scenario.schema.json") == right) return;
  const fs::path made = fs::path(LCS_BUILD_DIR) / "scenario.schema.json";
  test::write(made, right);
  FAIL() << "scenarios/scenario.schema.json does not follow scenarios/fields.h; cp " << made << " "
         << kScenarios << ", which has:\n"
         << right;
}

/// Every value in its base unit, in the order of the list, none at its default.
constexpr const char* kSimulated = R"(purpose: all keys
groups: [long, night]
scene: room.xml
pose: shut
origin: {family: room, seed: 7, again: 2, features: [slope, weeds]}
seed: 18446744073709551615
ego:
  drive: wheeled
  pose: home
  start: [-3 m, 1.5 m]
  heading: 90 deg
  speed: 0.1 m/s
  acceleration: 0.05 m/s^2
  direction: -90 deg
  yaw_rate: 9.3 deg/s
  phases: [{at: 2 s, speed: 0 m/s, acceleration: -0.1 m/s^2, direction: 1 deg, yaw_rate: 0 deg/s}]
camera:
  size: [1280, 960]
  fovy: 45.1 deg
  rate: 30 Hz
  position: [0.1 m, 0 m, 0.3 m]
  rotation: [1 deg, 0 deg, -3.1 deg]
  told: {height_error: 0.02 m, pitch_error: 0.5 deg}
  groups: [0, 3]
frames: 12
imu:
  preset: tumvi
  gaps: [[1 s, 2 s], [3 s, 4.5 s]]
  rate: 1000 Hz
odometry: {rate: 20 Hz, noise: 0.02 m/s, yaw_noise: 0.1 rad/s, scale_error: 0.01}
truth: {min_depth: 0.3 m}
image:
  light: 2000 lx
  headlights: {intensity: 3000 cd, beam: 15 deg}
  visibility: 200 m
  rain: {rate: 15, lens_drops: 25, drop_life: 3 s}
  blur: 0.7
  exposure: 0.35 ms
  gain: 8.25
  noise: none
  jpeg: 60
ground: {roughness: 0.004 m, wavelength: 0.4 m, centre: [1 m, 2 m], size: [6 m, 3 m]}
actors:
  box1:
    shape: box
    size: [0.5 m, 0.4 m, 0.6 m]
    texture: rects
    class: parcel
    trajectory: {line: {from: [2 m, -2 m], heading: 90 deg, speed: 0 m/s, acceleration: 0.1 m/s^2}}
    start: {time: 1 s, ego_within: 4 m}
  walker: {shape: pedestrian, trajectory: {waypoints: [[0 s, 1 m, 2 m], [0.5 s, 3 m, 4 m]]}}
  door:
    body: front_door
    trajectory: {circle: {centre: [1 m, 1 m], radius: 2 m, start_angle: 0.01 rad, speed: -1 m/s}}
  shelf: {body: shelf, trajectory: {still: {position: [1 m, 2 m], heading: 10 deg}}}
ego_motion: truth
corners: {threshold: auto}
filter: {preset: lab, circle.mu_0: 25}
criteria: [{metric: a, min: 0.5, max: 2, required: false, detector: klt}]
sweep: {ego.speed: [0.2 m/s, 0.4 m/s], camera.size: [[320, 240], [640, 480]]}
)";

constexpr const char* kRecorded =
    "recording: {format: kitti, camera: cam1, fps: 25 Hz, every: 2, speed: 10 m/s, focal: 700 "
    "px, "
    "centre: [320 px, 240 px], distortion: {equidistant: [0.1, 0, 0, 0]}, camera_height: 1.65 m, "
    "mount: [0 deg, 3 deg, 180 deg], at_rest: 2 s, nothing_moves: true, split: test}\n"
    "corners: {threshold: 30}\ngroups: [real, test]\n";

std::map<std::string, std::string> read_and_written(const std::string& text) {
  return input::flattened(
      input::parse_text(input::yaml_text(document_of(load_text(text))), {"written", 1}));
}

/// The keys of a file without file names, because these are resolved paths.
std::map<std::string, std::string> without_files(std::map<std::string, std::string> keys) {
  for (const char* key : {"scene", "recording.path"}) keys.erase(key);
  return keys;
}

TEST(Written, IsTheFileThatWasRead) {
  EXPECT_EQ(without_files(read_and_written(kSimulated)),
            without_files(input::flattened(input::parse_text(kSimulated, {"text", 1}))));
  const std::string way = "frames: 3\nego: {waypoints: [[0 s, 1 m, 2 m], [1 s, 1 m, 3 m]]}\n";
  EXPECT_EQ(without_files(read_and_written("scene: room.xml\n" + way)),
            input::flattened(input::parse_text(way, {"text", 1})));
  const std::string flown =
      "frames: 3\nego: {path: [[0 s, 1 m, 2 m, 3 m, 0 deg, 1 deg, 2 deg], [1 s, 1 m, 3 m, 3 m, 0 "
      "deg, 0 deg, 0 deg]]}\ncamera: {focal: [458.654 px, 457.296 px], centre: [367 px, 248 px], "
      "distortion: [-0.28, 0.07, 0.0002, 0, 0]}\n";
  EXPECT_EQ(without_files(read_and_written("scene: room.xml\n" + flown)),
            input::flattened(input::parse_text(flown, {"text", 1})));
  const std::string rig =
      "frames: 3\nego: {speed: 0.5 m/s}\ncameras: {left: {size: [320, 240], rate: 20 Hz}, right: "
      "{size: [320, 240], rate: 20 Hz, position: [0.2 m, -0.1 m, 0.45 m]}}\nfilter_camera: right\n";
  EXPECT_EQ(without_files(read_and_written("scene: room.xml\n" + rig)),
            input::flattened(input::parse_text(rig, {"text", 1})));
  const std::string recorded = kRecorded;
  std::string with_path = recorded;
  with_path.insert(with_path.find('{') + 1, "path: room.xml, ");
  EXPECT_EQ(without_files(read_and_written(with_path)),
            input::flattened(input::parse_text(recorded, {"text", 1})));
}

TEST(Written, HasTheNoiseOfAnImuThatIsNoPreset) {
  const std::string own = smallest + "imu: {preset: esim, gyroscope_random_walk: 1.23e-5}\n";
  const Imu imu = load_text(own).imu;
  std::string text = input::yaml_text(document_of(load_text(own)));
  text.replace(text.find("scene: "), text.find('\n') - text.find("scene: "), "scene: room.xml");
  EXPECT_EQ(load_text(text).imu.noise, imu.noise) << text;
}

TEST(Written, SaysNothingOfDefaults) {
  const std::map<std::string, std::string> keys{{"frames", "3"}, {"ego.speed", "0.5 m/s"}};
  EXPECT_EQ(without_files(read_and_written(smallest + "odometry: {}\n")).erase("odometry"), 1u);
  EXPECT_EQ(without_files(read_and_written(smallest)), keys);
}

TEST(Keys, AreAllInTheTextForTheTerminal) {
  std::set<std::string> keys;
  std::istringstream text(keys_text());
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with(' ')) keys.insert(line.substr(0, line.find(": ")));
  }
  const std::vector<std::pair<std::regex, const char*>> any{
      {std::regex(R"(^(actors)\.\w+)"), "$1.NAME"},
      {std::regex(R"(^(filter|sweep)\..*)"), "$1"},      // these have keys of their own
      {std::regex(R"((\.equidistant)?(\.\d+)+$)"), ""},  // numbers of one value
      {std::regex(R"(\.\d+)"), ".N"}};
  for (const char* const scenario : {kSimulated, kRecorded}) {
    for (const auto& [written, value] :
         input::flattened(input::parse_text(scenario, {"text", 1}))) {
      std::string key = written;
      for (const auto& [one, name] : any) key = std::regex_replace(key, one, std::string(name));
      EXPECT_TRUE(keys.contains(key)) << key;
    }
  }
  EXPECT_NE(keys_text().find("camera.fovy: vertical field of view, of a centred camera "
                             "without distortion\n"
                             "    default: `60 deg`\n    values: above 0 and below 180 deg\n"),
            std::string::npos);
}

}  // namespace
}  // namespace lcs::scenario
