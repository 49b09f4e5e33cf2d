#include "scenarios/load.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "scenarios/scenes.h"
#include "scenarios/sweep.h"
#include "tests/scenarios/scenario_file.h"
#include "tests/tools/files.h"

namespace lcs::scenario {
namespace {

constexpr double pi = std::numbers::pi;

TEST(Load, TheSmallestScenarioHasTheDocumentedDefaults) {
  const Scenario s = load_text(smallest);
  EXPECT_EQ(s.name, "test");
  EXPECT_EQ(s.scene.filename(), "room.xml");
  EXPECT_EQ(s.scene_source.line, 1);
  EXPECT_EQ(s.seed, 1u);
  EXPECT_EQ(s.frames, 3);
  EXPECT_EQ(s.ego.drive, Drive::holonomic);
  EXPECT_EQ(s.ego.start_m, Eigen::Vector2d(0, 0));
  ASSERT_EQ(s.ego.phases.size(), 1u);
  EXPECT_EQ(s.ego.phases[0].at_s, 0);
  EXPECT_EQ(s.ego.phases[0].speed_mps, 0.5);
  EXPECT_EQ(s.ego.phases[0].acceleration_mps2, 0);
  EXPECT_EQ(s.camera.width_px, 640);
  EXPECT_EQ(s.camera.height_px, 480);
  EXPECT_DOUBLE_EQ(s.camera.fovy_rad, pi / 3);
  EXPECT_EQ(s.camera.rate_hz, 10);
  EXPECT_EQ(s.camera.mount_position_m, Eigen::Vector3d(0.2, 0, 0.45));
  EXPECT_EQ(s.camera.mount_rpy_rad, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(s.imu.preset, "adis16448");
  EXPECT_EQ(s.imu.rate_hz, 200);
  EXPECT_EQ(s.imu.noise.accelerometer_random_walk, 3.0e-3);
  EXPECT_FALSE(s.odometry.enabled);
  EXPECT_EQ(s.ego_motion, EgoMotionSource::imu);
  EXPECT_EQ(s.fast_threshold, 20);
  EXPECT_EQ(s.truth_min_depth_m, 0.5);
  EXPECT_TRUE(s.actors.empty());
  EXPECT_TRUE(s.filter.empty());
  EXPECT_TRUE(s.criteria.empty());
}

TEST(Load, LineEndsOfWindowsAndAByteOrderMarkMakeNoDifference) {
  const Scenario s = load_text(
      "\xef\xbb\xbfscene: room.xml\r\npurpose: two words\r\nframes: 3\r\nego:\r\n"
      "  speed: 0.5 m/s\r\n");
  EXPECT_EQ(s.scene.filename(), "room.xml");
  EXPECT_EQ(s.purpose, "two words");
  EXPECT_EQ(s.frames, 3);
  EXPECT_EQ(s.ego.phases.at(0).speed_mps, 0.5);
}

TEST(Load, CornersMayHaveTheThresholdOfEachPicture) {
  constexpr std::string_view kRest = "scene: room.xml\nframes: 1\nego: {start: [0 m, 0 m]}\n";
  EXPECT_EQ(load_text(std::string(kRest)).fast_threshold, 20);
  const Scenario s = load_text(std::string(kRest) + "corners: {threshold: auto}\n");
  EXPECT_EQ(s.fast_threshold, std::nullopt);
}

TEST(Load, EveryKeyOfTheRoverAndItsSensorsArrives) {
  const Scenario s = load_text(R"(
purpose: all keys
scene: room.xml
seed: 18446744073709551615
duration: 2 s
ego:
  drive: wheeled
  start: [-3 m, 150 cm]
  heading: 90 deg
  speed: 36 km/h
  acceleration: 5 cm/s^2
  direction: -90 deg
  yaw_rate: 9 deg/s
camera:
  size: [1280, 960]
  fovy: 45 deg
  rate: 30 Hz
  position: [0.1 m, 0.2 m, 0.3 m]
  rotation: [1 deg, 2 deg, 3 deg]
imu: {preset: tumvi, rate: 1 kHz, gyroscope_random_walk: 1e-5}
odometry: {rate: 20 Hz, noise: 2 cm/s, yaw_noise: 0.1 rad/s, scale_error: 0.01}
ego_motion: truth
corners: {threshold: 30}
truth: {min_depth: 30 cm}
)");
  EXPECT_EQ(s.purpose, "all keys");
  EXPECT_EQ(s.seed, 18446744073709551615u);
  EXPECT_EQ(s.frames, 60);
  EXPECT_EQ(s.ego.drive, Drive::wheeled);
  EXPECT_EQ(s.ego.start_m, Eigen::Vector2d(-3, 1.5));
  EXPECT_EQ(s.ego.heading_rad, pi / 2);
  EXPECT_EQ(s.ego.phases[0].speed_mps, 10);
  EXPECT_EQ(s.ego.phases[0].acceleration_mps2, 0.05);
  EXPECT_EQ(s.ego.phases[0].direction_rad, -pi / 2);
  EXPECT_DOUBLE_EQ(s.ego.phases[0].yaw_rate_radps, pi / 20);
  EXPECT_EQ(s.camera.width_px, 1280);
  EXPECT_EQ(s.camera.height_px, 960);
  EXPECT_EQ(s.camera.fovy_rad, pi / 4);
  EXPECT_EQ(s.camera.rate_hz, 30);
  EXPECT_EQ(s.camera.mount_position_m, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_TRUE(s.camera.mount_rpy_rad.isApprox(Eigen::Vector3d(1, 2, 3) * pi / 180, 1e-15));
  EXPECT_EQ(s.imu.preset, "custom");
  EXPECT_EQ(s.imu.rate_hz, 1000);
  EXPECT_EQ(s.imu.noise.gyroscope_random_walk, 1e-5);
  EXPECT_EQ(s.imu.noise.gyroscope_noise_density, 1.6e-4);
  EXPECT_TRUE(s.odometry.enabled);
  EXPECT_EQ(s.odometry.rate_hz, 20);
  EXPECT_EQ(s.odometry.noise_mps, 0.02);
  EXPECT_EQ(s.odometry.yaw_noise_radps, 0.1);
  EXPECT_EQ(s.odometry.scale_error, 0.01);
  EXPECT_EQ(s.ego_motion, EgoMotionSource::truth);
  EXPECT_EQ(s.fast_threshold, 30);
  EXPECT_EQ(s.truth_min_depth_m, 0.3);
}

TEST(Load, ImuPresetsCarryTheFiguresOfTheirSources) {
  const auto noise = [](const std::string& preset) {
    return load_text(smallest + "imu: {preset: " + preset + "}").imu.noise;
  };
  EXPECT_EQ(noise("adis16448"), (ImuNoise{1.6968e-4, 1.9393e-5, 2.0e-3, 3.0e-3}));
  EXPECT_EQ(noise("tumvi"), (ImuNoise{1.6e-4, 2.2e-5, 2.8e-3, 8.6e-4}));
  EXPECT_EQ(noise("esim"), (ImuNoise{1.86e-4, 2.66e-5, 1.86e-3, 4.33e-4}));
  EXPECT_EQ(noise("ideal"), (ImuNoise{0, 0, 0, 0}));
}

TEST(Load, OdometryWithoutKeysHasItsDefaults) {
  const Scenario s = load_text(smallest + "odometry: {}");
  EXPECT_TRUE(s.odometry.enabled);
  EXPECT_EQ(s.odometry.rate_hz, 50);
  EXPECT_EQ(s.odometry.noise_mps, 0.01);
  EXPECT_EQ(s.odometry.yaw_noise_radps, 0.05);
  EXPECT_EQ(s.odometry.scale_error, 0.005);
}

TEST(Load, DurationMakesTheFramesThatLieBeforeItsEnd) {
  const auto frames = [](const std::string& duration, const std::string& rate) {
    return load_text("scene: room.xml\nego: {}\nduration: " + duration +
                     "\ncamera: {rate: " + rate + "}\n")
        .frames;
  };
  EXPECT_EQ(frames("6 s", "10 Hz"), 60);
  EXPECT_EQ(frames("0.3 s", "10 Hz"), 3);  // 0.1 * 3 is not 0.3 in binary
  EXPECT_EQ(frames("0.31 s", "10 Hz"), 4);
  EXPECT_EQ(frames("1 ms", "10 Hz"), 1);
  EXPECT_EQ(frames("0.7 s", "30 Hz"), 21);
}

TEST(Load, EveryKeyOfTheImageAndTheGroundArrives) {
  const Scenario s = load_text(smallest + R"(
image:
  light: 2 klx
  headlights: {intensity: 3000 cd, beam: 15 deg}
  visibility: 0.2 km
  rain: {rate: 15, lens_drops: 25, drop_life: 3 s}
  blur: 0.7
  exposure: 20 ms
  gain: 8
  noise: {full_well: 8000, read: 3}
  jpeg: 60
ground: {roughness: 4 mm, wavelength: 40 cm, centre: [1 m, 2 m], size: [6 m, 3 m]}
)");
  EXPECT_EQ(s.image.light_lx, 2000);
  EXPECT_EQ(s.image.headlights.value().intensity_cd, 3000);
  EXPECT_DOUBLE_EQ(s.image.headlights->beam_rad, pi / 12);
  EXPECT_EQ(s.image.visibility_m, 200);
  EXPECT_EQ(s.image.rain.value().rate_mmph, 15);
  EXPECT_EQ(s.image.rain->lens_drops, 25);
  EXPECT_EQ(s.image.rain->drop_life_s, 3);
  EXPECT_EQ(s.image.blur_px, 0.7);
  EXPECT_EQ(s.image.exposure_s, 0.02);
  EXPECT_EQ(s.image.gain, 8);
  EXPECT_EQ(s.image.noise.value().full_well_e, 8000);
  EXPECT_EQ(s.image.noise->read_e, 3);
  EXPECT_EQ(s.image.jpeg_quality, 60);
  ASSERT_TRUE(s.ground);
  EXPECT_EQ(s.ground->roughness_m, 0.004);
  EXPECT_EQ(s.ground->wavelength_m, 0.4);
  EXPECT_EQ(s.ground->centre_m, Eigen::Vector2d(1, 2));
  EXPECT_EQ(s.ground->size_m, Eigen::Vector2d(6, 3));
}

TEST(Load, ToldErrorsOfTheCameraArrive) {
  const Scenario s =
      load_text(smallest + "camera: {told: {height_error: -3 cm, pitch_error: 1 deg}}\n");
  EXPECT_EQ(s.camera.told.height_error_m, -0.03);
  EXPECT_DOUBLE_EQ(s.camera.told.pitch_error_rad, pi / 180);
  EXPECT_EQ(s.camera.mount_position_m, load_text(smallest).camera.mount_position_m);
}

TEST(Load, ImageAndGroundHaveTheirDefaults) {
  for (const char* image : {"", "image: {}\n", "image: {noise: {}}\n"}) {
    const Image::Noise noise = load_text(smallest + image).image.noise.value();
    EXPECT_EQ(noise.full_well_e, 10000) << image;
    EXPECT_EQ(noise.read_e, 5) << image;
  }
  EXPECT_FALSE(load_text(smallest + "image: {noise: none}\n").image.noise);
  EXPECT_FALSE(load_text(smallest).ground);
  const Scenario s = load_text(smallest + "ground: {}\n");
  EXPECT_EQ(s.image.light_lx, 10000);
  EXPECT_EQ(s.image.exposure_s, 1e-3);
  EXPECT_EQ(s.image.gain, 1);
  EXPECT_FALSE(s.image.headlights || s.image.rain || s.image.visibility_m || s.image.jpeg_quality);
  EXPECT_EQ(s.ground->roughness_m, 0.01);
  EXPECT_FALSE(s.ground->centre_m);
}

TEST(Load, TurnOnBiasAndGapsOfTheImuArrive) {
  const Scenario s = load_text(
      smallest +
      "imu: {gyroscope_turn_on_bias: 90 deg/s, accelerometer_turn_on_bias: 5 cm/s^2, gaps: "
      "[[1.5 s, 2 s], [3, 3.2]]}\n");
  EXPECT_EQ(s.imu.preset, "custom");
  EXPECT_EQ(s.imu.noise.gyroscope_turn_on_bias_radps, pi / 2);
  EXPECT_EQ(s.imu.noise.accelerometer_turn_on_bias_mps2, 0.05);
  ASSERT_EQ(s.imu.gaps.size(), 2u);
  EXPECT_EQ(s.imu.gaps[0].from_s, 1.5);
  EXPECT_EQ(s.imu.gaps[0].to_s, 2);
  EXPECT_EQ(s.imu.gaps[1].to_s, 3.2);
}

TEST(Load, WrongImageGroundOrGapIsRefusedAtItsLine) {
  const auto said = [](const std::string& line) { return refusal(smallest + line + "\n"); };
  EXPECT_EQ(
      said("image: {light: 5 cd}"),
      "test.yaml:4: image.light: '5 cd' is a luminous intensity; give an illuminance in lx or "
      "klx");
  EXPECT_EQ(
      said("image: {headlights: {beam: 20 deg}}"),
      "test.yaml:4: image.headlights needs 'intensity'; add it (scenarios/README.md shows how)");
  EXPECT_EQ(
      said("image: {rain: {drops: 5}}"),
      "test.yaml:4: unknown key 'drops' in image.rain; known are rate, lens_drops and drop_life");
  EXPECT_EQ(said("image: {exposure: 0}"),
            "test.yaml:4: image.exposure is '0'; it must be above 0 and at most 10 s");
  EXPECT_EQ(said("image: {noise: {full_well: 0}}"),
            "test.yaml:4: image.noise.full_well is '0'; it must be above 0 and at most 1000000");
  EXPECT_EQ(said("ground: {roughness: 0}"),
            "test.yaml:4: ground.roughness is '0'; it must be above 0 and at most 1 m");
  EXPECT_EQ(
      said("imu: {gaps: [[2, 1]]}"),
      "test.yaml:4: imu.gaps.0 is [2, 1]; make the times increase, from each gap to the next");
  EXPECT_EQ(
      said("imu: {gaps: [[1, 2], [1.5, 3]]}"),
      "test.yaml:4: imu.gaps.1 is [1.5, 3]; make the times increase, from each gap to the next");
  EXPECT_EQ(said("imu: {gaps: [[0, 1]]}"),
            "test.yaml:4: imu.gaps.0.0 is '0'; it must be above 0 and at most 100000 s");
}

TEST(Load, APhaseKeepsWhatItDoesNotSay) {
  const Scenario s = load_text(R"(
scene: room.xml
frames: 3
ego:
  speed: 1 m/s
  acceleration: -0.25 m/s^2
  direction: 90 deg
  phases:
    - {at: 2 s, yaw_rate: 90 deg/s}
    - {at: 10 s, acceleration: 0.5 m/s^2}
    - {at: 11 s, speed: 2 m/s, acceleration: 0, direction: 0}
)");
  const auto& phases = s.ego.phases;
  ASSERT_EQ(phases.size(), 4u);
  EXPECT_EQ(phases[1].at_s, 2);
  EXPECT_EQ(phases[1].speed_mps, 0.5);
  EXPECT_EQ(phases[1].acceleration_mps2, -0.25);
  EXPECT_EQ(phases[1].direction_rad, pi / 2);
  EXPECT_EQ(phases[1].yaw_rate_radps, pi / 2);
  EXPECT_EQ(phases[2].speed_mps, 0) << "braking ends at a stand";
  EXPECT_EQ(phases[2].acceleration_mps2, 0.5);
  EXPECT_EQ(phases[3].speed_mps, 2);
  EXPECT_EQ(phases[3].acceleration_mps2, 0);
  EXPECT_EQ(phases[3].direction_rad, 0);
  EXPECT_EQ(phases[3].yaw_rate_radps, pi / 2);
}

TEST(Load, EveryKindOfActorArrives) {
  const ScenarioFolder folder;
  folder.write("brick.png", "");
  const Scenario s = load(folder.write("test.yaml", R"(
scene: room.xml
frames: 3
ego: {}
actors:
  box1:
    shape: box
    size: [0.5 m, 40 cm, 0.6 m]
    texture: rects
    trajectory: {line: {from: [2 m, -2 m], heading: 90 deg, speed: 0.5 m/s, acceleration: -0.1}}
    start: {time: 1 s, ego_within: 4 m}
  pillar:
    shape: cylinder
    texture: brick.png
    trajectory: {still: {position: [1, 2]}}
  walker:
    shape: pedestrian
    trajectory: {waypoints: [[0 s, 1 m, 2 m], [500 ms, 3 m, 4 m]]}
  taxi:
    shape: car
    trajectory: {circle: {centre: [1, 1], radius: 2 m, start_angle: 90 deg, speed: -1 m/s}}
  door:
    body: front_door
    trajectory: {line: {speed: 1 m/s}}
  shelf:
    body: shelf
    trajectory: {still: {}}
)"));
  ASSERT_EQ(s.actors.size(), 6u);
  const Actor& box = s.actors[0];
  EXPECT_EQ(box.name, "box1");
  EXPECT_EQ(box.source.line, 6);
  EXPECT_FALSE(box.body);
  EXPECT_EQ(box.shape, Shape::box);
  EXPECT_EQ(box.size_m.value(), Eigen::Vector3d(0.5, 0.4, 0.6));
  EXPECT_EQ(box.texture, "rects");
  const auto& line = std::get<Line>(box.trajectory);
  EXPECT_EQ(line.from_m.value(), Eigen::Vector2d(2, -2));
  EXPECT_EQ(line.heading_rad.value(), pi / 2);
  EXPECT_EQ(line.speed_mps, 0.5);
  EXPECT_EQ(line.acceleration_mps2, -0.1);
  EXPECT_EQ(box.start.at_s, 1);
  EXPECT_EQ(box.start.ego_within_m.value(), 4);

  const Actor& pillar = s.actors[1];
  EXPECT_EQ(pillar.shape, Shape::cylinder);
  EXPECT_FALSE(pillar.size_m);
  EXPECT_EQ(pillar.texture, (folder.path() / "brick.png").string());
  EXPECT_EQ(std::get<Still>(pillar.trajectory).position_m.value(), Eigen::Vector2d(1, 2));
  EXPECT_EQ(pillar.start.at_s, 0);
  EXPECT_FALSE(pillar.start.ego_within_m);

  const Actor& walker = s.actors[2];
  EXPECT_EQ(walker.shape, Shape::pedestrian);
  const auto& points = std::get<Waypoints>(walker.trajectory);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[1].at_s, 0.5);
  EXPECT_EQ(points[1].position_m, Eigen::Vector2d(3, 4));

  const Actor& taxi = s.actors[3];
  EXPECT_EQ(taxi.shape, Shape::car);
  const auto& circle = std::get<Circular>(taxi.trajectory);
  EXPECT_EQ(circle.centre_m, Eigen::Vector2d(1, 1));
  EXPECT_EQ(circle.radius_m, 2);
  EXPECT_EQ(circle.start_angle_rad, pi / 2);
  EXPECT_EQ(circle.speed_mps, -1);

  EXPECT_EQ(s.actors[4].body.value(), "front_door");
  EXPECT_FALSE(std::get<Line>(s.actors[4].trajectory).from_m);
  EXPECT_FALSE(std::get<Line>(s.actors[4].trajectory).heading_rad);
  EXPECT_FALSE(std::get<Still>(s.actors[5].trajectory).position_m);
}

TEST(Load, TheMatrixOfTheCameraGivesItsPlaceAndRotation) {
  const auto camera = [](const std::string& rows) {
    return load_text(smallest + "camera: {T_BC: [" + rows + ", [0, 0, 0, 1]]}\n").camera;
  };
  // it looks along the rover's x, upright
  const Camera ahead = camera("[0, 0, 1, 0.3], [-1, 0, 0, -0.1], [0, -1, 0, 0.7]");
  EXPECT_EQ(ahead.mount_position_m, Eigen::Vector3d(0.3, -0.1, 0.7));
  EXPECT_LT(ahead.mount_rpy_rad.norm(), 1e-12);
  // straight down, with the top of the picture ahead
  const Camera down = camera("[0, -1, 0, 0], [-1, 0, 0, 0], [0, 0, -1, 1]");
  EXPECT_LT((down.mount_rpy_rad - Eigen::Vector3d(0, pi / 2, 0)).norm(), 1e-7);
  // to the left, 30 deg down
  const Camera left =
      camera("[1, 0, 0, 0], [0, -0.5, 0.8660254038, 0], [0, -0.8660254038, -0.5, 0]");
  EXPECT_LT((left.mount_rpy_rad - Eigen::Vector3d(0, pi / 6, pi / 2)).norm(), 1e-9);
}

TEST(Load, AFocalLengthStandsForTheFieldOfViewThatItMakes) {
  const auto focal_px = [](const Scenario& s) {
    return s.camera.height_px / 2.0 / std::tan(s.camera.fovy_rad / 2);
  };
  const std::string text = smallest + "camera: {focal: 600 px, size: [320, 240]}\n";
  EXPECT_NEAR(focal_px(load_text(text)), 600, 1e-9);
  EXPECT_NEAR(focal_px(load_text(text, {.sets = {"camera.focal=150"}, .seed = {}})), 150, 1e-9);
  EXPECT_NEAR(load_text(text, {.sets = {"camera.focal=120"}, .seed = {}}).camera.fovy_rad, pi / 2,
              1e-12);
  EXPECT_DOUBLE_EQ(
      load_text(text, {.sets = {"camera.focal=", "camera.fovy=45"}, .seed = {}}).camera.fovy_rad,
      pi / 4);

  const ScenarioFolder folder;
  const auto file = folder.write("test.yaml", smallest + "sweep: {camera.focal: [300, 900 px]}\n");
  std::vector<double> swept;
  for (const SweepPoint& point : sweep_points(file)) {
    const auto& [key, value] = point.settings.at(0);
    swept.push_back(focal_px(load(file, {.sets = {key + "=" + value}, .seed = {}})));
  }
  ASSERT_EQ(swept.size(), 2u);
  EXPECT_NEAR(swept[0], 300, 1e-9);
  EXPECT_NEAR(swept[1], 900, 1e-9);
}

TEST(Load, FilterSettingsPassAsWrittenWithTheirLines) {
  const Scenario s =
      load_text(smallest + "filter:\n  preset: lab\n  circle.mu_0: 25\n  line.on: yes\n");
  EXPECT_EQ(s.filter_preset, "lab");
  EXPECT_EQ(s.filter_preset_source.line, 5);
  ASSERT_EQ(s.filter.size(), 2u);
  EXPECT_EQ(s.filter[0].key, "circle.mu_0");
  EXPECT_EQ(s.filter[0].value, "25");
  EXPECT_EQ(s.filter[0].source.line, 6);
  EXPECT_EQ(s.filter[1].value, "yes");
}

TEST(Load, CriteriaArriveWithTheirLines) {
  const Scenario s = load_text(smallest +
                               "criteria:\n"
                               "  - {metric: rebel.f1, min: 0.4}\n"
                               "  - {metric: dimension.mean, min: 1, max: 90, required: false,\n"
                               "     detector: 'lcs:lab'}\n");
  ASSERT_EQ(s.criteria.size(), 2u);
  EXPECT_EQ(s.criteria[0].detector, "") << "the run's own";
  EXPECT_EQ(s.criteria[1].detector, "lcs:lab");
  EXPECT_EQ(s.criteria[0].metric, "rebel.f1");
  EXPECT_EQ(s.criteria[0].min.value(), 0.4);
  EXPECT_FALSE(s.criteria[0].max);
  EXPECT_TRUE(s.criteria[0].required);
  EXPECT_EQ(s.criteria[0].source.line, 5);
  EXPECT_EQ(s.criteria[1].max.value(), 90);
  EXPECT_FALSE(s.criteria[1].required);
  EXPECT_EQ(s.criteria[1].source.line, 6);
}

TEST(Load, ASceneIsFoundByNameWhereTheEnvironmentSays) {
  const ScenarioFolder folder;
  const ScenarioFolder elsewhere;
  ASSERT_EQ(setenv("LCS_SCENES", folder.path().c_str(), 1), 0);
  const Scenario s = load(elsewhere.write("test.yaml", "scene: room\nframes: 1\nego: {}\n"));
  EXPECT_EQ(s.scene, folder.path() / "room.xml");
  ASSERT_EQ(unsetenv("LCS_SCENES"), 0);
}

TEST(Load, OwnRoversAndActorsAreFoundBesideTheScenario) {
  const ScenarioFolder folder;
  folder.write("truck.xml", "<mujoco/>");
  folder.write("rover.xml", "<mujoco/>");
  const std::string actor = "trajectory: {still: {position: [1, 2]}}}\n";
  const Scenario s = load(folder.write(
      "test.yaml", "scene: room.xml\nframes: 3\nego: {drive: rover.xml, speed: 1}\nactors:\n" +
                       ("  a: {shape: truck.xml, " + actor) + "  b: {shape: box, " + actor));
  EXPECT_EQ(s.ego.drive, Drive::own);
  EXPECT_EQ(rover_file(s.ego), folder.path() / "rover.xml");
  EXPECT_EQ(s.ego.source.line, 3);
  EXPECT_EQ(s.actors.at(0).shape, Shape::own);
  EXPECT_EQ(actor_file(s.actors.at(0)), folder.path() / "truck.xml");
  EXPECT_EQ(actor_file(s.actors.at(1)), scenes_folder() / "actors/box.xml");
  EXPECT_EQ(s.world.at("ego.drive"), "rover.xml");
}

TEST(Load, TheEgosWaypointsGiveItsStartAndHeading) {
  const Scenario s = load_text(
      "scene: room.xml\nframes: 3\n"
      "ego: {waypoints: [[0 s, 1 m, 2 m], [1, 1, 2], [2 s, 1 m, 300 cm]]}\n",
      {.sets = {"ego.waypoints.2.0=4"}, .seed = {}});
  ASSERT_EQ(s.ego.waypoints.size(), 3u);
  EXPECT_EQ(s.ego.waypoints[2].at_s, 4);
  EXPECT_EQ(s.ego.waypoints[2].position_m, Eigen::Vector2d(1, 3));
  EXPECT_EQ(s.ego.start_m, Eigen::Vector2d(1, 2));
  EXPECT_DOUBLE_EQ(s.ego.heading_rad, pi / 2);
}

TEST(Load, FilesShadowedByLcsScenesAreTold) {
  const ScenarioFolder folder;
  std::filesystem::create_directories(folder.path() / "ego");
  folder.write("lab.xml", "<mujoco/>");
  folder.write("ego/wheeled.xml", "<mujoco/>");
  const auto file =
      folder.write("test.yaml",
                   "scene: lab\nframes: 1\nego: {}\nactors:\n  a: {shape: box, trajectory: "
                   "{still: {position: [1, 2]}}}\n");
  const std::filesystem::path own = std::filesystem::path(LCS_SOURCE_DIR) / "scenes";
  EXPECT_TRUE(shadowed_files(load(file)).empty());

  ASSERT_EQ(setenv("LCS_SCENES", folder.path().c_str(), 1), 0);
  const Scenario holonomic = load(file);
  const Scenario wheeled = load(file, {.sets = {"ego.drive=wheeled"}, .seed = {}});
  const std::vector<std::string> of_scene = shadowed_files(holonomic);
  const std::vector<std::string> of_both = shadowed_files(wheeled);
  const Scenario by_path = load(file, {.sets = {"scene=room.xml"}, .seed = {}});
  EXPECT_TRUE(shadowed_files(by_path).empty());
  // the project's own scenes under another path are the same
  std::filesystem::create_directory_symlink(own, folder.path() / "same");
  ASSERT_EQ(setenv("LCS_SCENES", (folder.path() / "same").c_str(), 1), 0);
  EXPECT_TRUE(shadowed_files(load(file)).empty());
  ASSERT_EQ(unsetenv("LCS_SCENES"), 0);

  ASSERT_EQ(of_scene.size(), 1u);
  EXPECT_EQ(of_scene[0], (folder.path() / "lab.xml").string() +
                             " is used, as LCS_SCENES says, and not the project's own " +
                             (own / "lab.xml").string() +
                             "; unset LCS_SCENES for that one, or rename the file");
  ASSERT_EQ(of_both.size(), 2u);
  EXPECT_EQ(of_both[0].find((folder.path() / "ego/wheeled.xml").string() + " is used"), 0u);
}

TEST(Load, TheWorldIsAllThatIsWrittenButWhoWatchesAndJudges) {
  const Scenario plain = load_text(smallest);
  const Scenario judged = load_text(
      "purpose: for people\ngroups: [long]\nseed: 4\n" + smallest +
      "filter: {preset: lab}\ncriteria: [{metric: frames, min: 1}]\nsweep: {ego.speed: [1 m/s]}\n");
  EXPECT_EQ(judged.world, plain.world);
  EXPECT_EQ(plain.world.at("scene"), "room.xml");

  const Scenario fast =
      load_text(smallest, {.sets = {"ego.speed=2 m/s", "imu.gaps=[[1 s, 2 s]]"}, .seed = {}});
  EXPECT_EQ(fast.world.at("ego.speed"), "2 m/s");
  EXPECT_EQ(fast.world.at("imu.gaps.0.1"), "2 s");
  EXPECT_NE(fast.world, plain.world);
}

TEST(Load, AnOriginIsTheSameWorldWithAnySeed) {
  const std::string drawn =
      smallest + "origin: {family: room, seed: 7, again: 2, features: [slope, weeds]}\n";
  const Scenario s = load_text(drawn, {.sets = {}, .seed = 3});
  ASSERT_TRUE(s.origin);
  EXPECT_EQ(s.origin->family, "room");
  EXPECT_EQ(s.origin->seed, 7u);
  EXPECT_EQ(s.origin->again, 2u);
  EXPECT_EQ(s.origin->features, (std::vector<std::string>{"slope", "weeds"}));
  EXPECT_EQ(s.origin->source.line, 4);
  EXPECT_EQ(s.seed, 3u);
  EXPECT_EQ(s.world, load_text(smallest).world) << "sensors' data do not depend on it";
  EXPECT_FALSE(load_text(smallest).origin);
}

TEST(Load, TheSeedGivenReplacesTheFiles) {
  EXPECT_EQ(load_text(smallest + "seed: 5", {.sets = {}, .seed = 9}).seed, 9u);
}

class Shipped : public testing::TestWithParam<std::string> {};

TEST_P(Shipped, Loads) {
  const Scenario s = load(std::filesystem::path(LCS_SOURCE_DIR) / "scenarios" / GetParam());
  EXPECT_FALSE(s.purpose.empty());
  EXPECT_GT(s.frames, 0);
  EXPECT_FALSE(sweep_points(s.file).empty());
}

std::vector<std::string> shipped_files() {
  std::vector<std::string> names;
  const std::filesystem::path folder = std::filesystem::path(LCS_SOURCE_DIR) / "scenarios";
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder)) {
    if (file.path().extension() != ".yaml") continue;
    names.push_back(std::filesystem::relative(file.path(), folder).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Scenarios, Shipped, testing::ValuesIn(shipped_files()),
                         [](const auto& test) {
                           return std::filesystem::path(test.param).stem().string();
                         });

TEST(Shipped, EveryScenarioOfTheSuiteHasASizeAndANameOfItsOwn) {
  std::vector<std::string> names;
  for (const std::string& file : shipped_files()) {
    const Scenario s = load(std::filesystem::path(LCS_SOURCE_DIR) / "scenarios" / file);
    names.push_back(s.name);
    const auto sizes = std::count_if(s.groups.begin(), s.groups.end(), [](const std::string& g) {
      return g == "short" || g == "long" || g == "sweep" || g == "probe" || g == "example";
    });
    EXPECT_EQ(sizes, 1) << file;
    EXPECT_EQ(s.sweep.empty(), s.groups.front() != "sweep") << file;
    if (file.starts_with("suite/")) {
      EXPECT_FALSE(s.criteria.empty()) << file;
    }
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

/// The blocks of YAML of scenarios/README.md, from `begin` to `end`, as one text.
std::string yaml_of_the_readme(const std::string& begin, const std::string& end) {
  const std::string readme =
      test::read(std::filesystem::path(LCS_SOURCE_DIR) / "scenarios/README.md");
  const std::size_t from = readme.find(begin), to = readme.find(end, from);
  EXPECT_NE(to, std::string::npos) << begin << " to " << end;
  const std::string fence = "```yaml\n";
  std::string yaml;
  for (std::size_t at = readme.find(fence, from); at < to; at = readme.find(fence, at)) {
    at += fence.size();
    yaml += readme.substr(at, readme.find("```", at) - at);
  }
  return yaml;
}

TEST(Shipped, TheFirstScenarioOfTheReadmeLoads) {
  const ScenarioFolder folder;
  const Scenario s =
      load(folder.write("first.yaml", yaml_of_the_readme("## A first scenario", "## Your own")),
           {.sets = {"ego.speed=0.7", "actors.my_box.start.time=2 s"}, .seed = {}});
  EXPECT_EQ(s.frames, 60);
  EXPECT_EQ(s.ego.phases[0].speed_mps, 0.7);
  ASSERT_EQ(s.actors.size(), 1u);
  EXPECT_EQ(s.actors[0].start.at_s, 2);
}

TEST(Shipped, TheExamplesOfTheReadmesSectionsLoadTogether) {
  const ScenarioFolder folder;
  const Scenario s =
      load(folder.write("sections.yaml", yaml_of_the_readme("## The sections", "### `recording`")));
  EXPECT_EQ(s.actors.size(), 3u);
  EXPECT_EQ(s.ego.phases.size(), 3u);
  EXPECT_EQ(s.criteria.size(), 3u);
  EXPECT_EQ(s.sweep.size(), 2u);
  EXPECT_TRUE(s.odometry.enabled);
  EXPECT_TRUE(s.ground.has_value());
}

TEST(Shipped, TheLabRunIsThePapers) {
  const Scenario s = load(std::filesystem::path(LCS_SOURCE_DIR) / "scenarios/lab.yaml");
  EXPECT_EQ(s.frames, 37);
  EXPECT_EQ(s.camera.rate_hz, 1);
  EXPECT_EQ(s.camera.width_px, 640);
  EXPECT_EQ(s.camera.height_px, 480);
  ASSERT_EQ(s.ego.phases.size(), 1u);
  EXPECT_EQ(s.ego.phases[0].speed_mps, 0.03);
  EXPECT_EQ(s.ego.phases[0].acceleration_mps2, 0.0005);
  EXPECT_TRUE(s.actors.empty());
}

const std::string rig_of_two = smallest +
                               "cameras:\n  left: {rate: 20, position: [0.2, 0.1, 0.5]}\n  right: "
                               "{rate: 20, size: [320, 240]}\n";

TEST(Load, TheCameraOfTheDetectorsIsTheFirstOfARigOrTheNamedOne) {
  const Scenario first = load_text(rig_of_two);
  ASSERT_EQ(first.cameras.size(), 2u);
  EXPECT_EQ(first.cameras[1].name, "right");
  EXPECT_EQ(first.camera.mount_position_m.y(), 0.1);
  EXPECT_EQ(first.camera.rate_hz, 20);
  const Scenario named = load_text(rig_of_two + "filter_camera: right\n");
  EXPECT_EQ(named.camera.width_px, 320);
  EXPECT_EQ(named.rig_place, 1u);
  EXPECT_EQ(seen_by(named, 0).camera.width_px, 640);
  const Scenario lasting =
      load_text(rig_of_two.substr(rig_of_two.find("ego")) + "scene: room.xml\nduration: 1 s\n");
  EXPECT_EQ(lasting.frames, 20) << "by the rate of the rig";
  EXPECT_EQ(load_text(rig_of_two, {.sets = {"cameras.right.size=[160, 120]"}, .seed = {}})
                .cameras[1]
                .camera.width_px,
            160);
}

TEST(Load, AWrongRigIsRefusedAtItsLine) {
  EXPECT_EQ(refusal(rig_of_two + "camera: {rate: 20}\n"),
            "test.yaml:4: both camera and cameras are given; keep one of them");
  EXPECT_EQ(refusal(rig_of_two + "filter_camera: middle\n"),
            "test.yaml:7: filter_camera is 'middle', and no camera of cameras has that name; give "
            "one that has, or remove it");
  EXPECT_EQ(refusal(smallest + "filter_camera: left\n").find("test.yaml:4: filter_camera"), 0u);
  EXPECT_EQ(refusal(rig_of_two + "  slow: {rate: 5}\n"),
            "test.yaml:7: cameras.slow has another rate than the camera before it; give all of a "
            "rig one rate");
  EXPECT_EQ(refusal(rig_of_two + "  late: {rate: 20, time_offset: 5 ms}\n"),
            "test.yaml:7: cameras.late has another time_offset than the camera before it; give all "
            "of a rig one time_offset");
  EXPECT_EQ(refusal(smallest + "cameras: {}\n").find("test.yaml:4: cameras has 0 cameras; give"),
            0u);
  EXPECT_EQ(refusal(rig_of_two + "image: {rain: {rate: 5}}\n").find("test.yaml:7: image.rain"), 0u);
  EXPECT_EQ(refusal(smallest + "cameras: {a b: {}}\n").find("test.yaml:4: the camera's name 'a b'"),
            0u);
}

}  // namespace
}  // namespace lcs::scenario
