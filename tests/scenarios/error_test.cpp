// Every error in a scenario gives one message: its place, the fault, and the remedy.

#include <gtest/gtest.h>

#include <ostream>

#include "scenarios/input/spelling.h"
#include "tests/scenarios/scenario_file.h"
#include "tests/tools/refusal.h"

namespace lcs::scenario {
namespace {

struct Mistake {
  std::string name;
  std::string text;
  std::string message;
};

void PrintTo(const Mistake& mistake, std::ostream* out) {
  *out << mistake.text;
}

std::string name_of(const testing::TestParamInfo<Mistake>& test) {
  return test.param.name;
}

/// A mistake after the three lines of the smallest scenario: line 4 is the first.
Mistake added(const std::string& name, const std::string& lines, const std::string& message) {
  return {name, smallest + lines, "test.yaml:" + message};
}

/// An actor in lines 5 to 7: "  a:", "    shape: box", and its trajectory.
Mistake actor(const std::string& name, const std::string& trajectory, const std::string& message) {
  return added(name, "actors:\n  a:\n    shape: box\n    trajectory: " + trajectory + "\n",
               message);
}

Mistake whole(const std::string& name, const std::string& text, const std::string& message) {
  return {name, text, message};
}

class Refused : public testing::TestWithParam<Mistake> {};

TEST_P(Refused, WithOneMessage) {
  EXPECT_EQ(refusal(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Keys, Refused,
    testing::Values(
        added("UnknownNear", "sede: 5\n", "4: unknown key 'sede'; did you mean 'seed'?"),
        added(
            "UnknownFar", "weather: rain\n",
            "4: unknown key 'weather'; known are purpose, groups, scene, pose, recording, origin, "
            "seed, "
            "ego, camera, cameras, filter_camera, frames, duration, imu, odometry, events, truth, "
            "image, "
            "ground, actors, "
            "ego_motion, "
            "corners, filter, criteria and sweep"),
        added("UnknownInSection", "camera:\n  rate: 5\n  fov: 60\n",
              "6: unknown key 'fov' in camera; did you mean 'fovy'?"),
        added("UnknownBeforeMissing",
              "actors:\n  a: {shape: box, trajectroy: {still: {position: [0, 0]}}}\n",
              "5: unknown key 'trajectroy' in actors.a; did you mean 'trajectory'?"),
        added("UnknownBesideTrajectories", "actors:\n  a: {shape: box, trajectory: {lien: {}}}\n",
              "5: unknown key 'lien' in actors.a.trajectory; did you mean 'line'?"),
        added("Twice", "seed: 5\nseed: 6\n",
              "5: key 'seed' is given twice, first in line 4; remove one"),
        added("TwiceInSection", "camera: {rate: 5, size: [640, 480], rate: 6}\n",
              "4: key 'rate' is given twice, first in line 4; remove one"),
        added("OriginWithoutSeed", "origin:\n  family: room\n",
              "4: origin needs 'seed'; add it (scenarios/README.md shows how)"),
        added("CornersOfNoEvents", "corners: {from: events}\n",
              "4: corners.from is 'events', and the camera has no event pixels; add 'events: {}'"),
        added("EventsInRain", "events: {}\nimage: {rain: {rate: 5}}\n",
              "4: events see no rain, and image.rain is given; remove one of the two"),
        added("ThresholdOfEvents", "events: {}\ncorners: {from: events, threshold: 20}\n",
              "5: both corners.from and corners.threshold are given; keep one of them"),
        added("NoName", "? [a, b]\n: 5\n", "4: a key is a list; give a name"),
        added("NoValue", "seed:\n", "4: seed has no value; give one or remove the key"),
        added("NoSection", "odometry:\n", "4: odometry has no value; give one or remove the key"),
        whole("NoScene", "frames: 3\nego: {}\n",
              "test.yaml:1: the scenario needs 'scene' or 'recording'; add it (scenarios/README.md "
              "shows how)"),
        whole("NoEgo", "scene: room.xml\nframes: 3\n",
              "test.yaml:1: the scenario needs 'ego'; add it (scenarios/README.md shows how)"),
        whole("NoLength", "scene: room.xml\nego: {}\n",
              "test.yaml:1: the scenario needs 'frames' or 'duration'; add it "
              "(scenarios/README.md shows how)"),
        added("BothLengths", "duration: 1 s\n",
              "4: both frames and duration are given; keep one of them")),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Types, Refused,
    testing::Values(
        added("ListForNumber", "camera: {rate: [10]}\n",
              "4: camera.rate is a list; give a number in Hz"),
        added("MapForNumber", "camera: {rate: {x: 1}}\n",
              "4: camera.rate is a map; give a number in Hz"),
        added("NumberForSection", "camera: 5\n",
              "4: camera is a single value; give a map, as in {key: value}"),
        added("ListForSection", "camera: [5]\n",
              "4: camera is a list; give a map, as in {key: value}"),
        added("NumberForList", "camera: {position: 5}\n",
              "4: camera.position is a single value; give a list of 3, as in [0, 0, 0]"),
        added("ShortList", "camera: {position: [1 m, 2 m]}\n",
              "4: camera.position is a list of 2; give a list of 3, as in [0, 0, 0]"),
        added("NullInList", "camera: {position: [1 m, 2 m, ~]}\n",
              "4: camera.position.2 is nothing; give a number in m"),
        added("WordForNumber", "camera: {rate: fast}\n",
              "4: camera.rate: 'fast' is not a number; give a frequency in Hz or kHz"),
        added("WrongUnit", "camera: {rate: 10 m}\n",
              "4: camera.rate: '10 m' is a length; give a frequency in Hz or kHz"),
        added("UnitForPixels", "camera: {size: [640 px, 480]}\n",
              "4: camera.size.0 is '640 px'; give a whole number from 16 to 8192"),
        added("FractionForPixels", "camera: {size: [640.5, 480]}\n",
              "4: camera.size.0 is '640.5'; give a whole number from 16 to 8192"),
        added("NegativeSeed", "seed: -1\n",
              "4: seed is '-1'; give a whole number from 0 to 18446744073709551615"),
        added("UnknownDrive", "imu: {preset: mpu6050}\n",
              "4: imu.preset is 'mpu6050'; give adis16448, tumvi, esim or ideal"),
        added("UnknownSource", "ego_motion: gps\n", "4: ego_motion is 'gps'; give imu or truth"),
        added("NoTruthValue", "criteria: [{metric: a, min: 1, required: maybe}]\n",
              "4: criteria.0.required is 'maybe'; give false or true"),
        added("MapForActors", "actors: [{shape: box}]\n",
              "4: actors is a list; give a map, as in {key: value}"),
        added("NamelessDetector", "criteria: [{metric: a, min: 1, detector: ''}]\n",
              "4: criteria.0.detector is empty; give a text"),
        added("EmptyText", "purpose: ''\n", "4: purpose is empty; give a text"),
        added("ValueOnALaterLine", "camera:\n  rate:\n    fast\n",
              "6: camera.rate: 'fast' is not a number; give a frequency in Hz or kHz")),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Ranges, Refused,
    testing::Values(
        whole("NoFrames", "scene: room.xml\nframes: 0\nego: {}\n",
              "test.yaml:2: frames is '0'; give a whole number from 1 to 1000000"),
        whole("NoDuration", "scene: room.xml\nduration: 0 s\nego: {}\n",
              "test.yaml:2: duration is '0 s'; it must be above 0 and at most 100000 s"),
        whole("EndlessDuration",
              "scene: room.xml\nduration: 90000 s\nego: {}\ncamera: {rate: 100}\n",
              "test.yaml:2: duration '90000 s' makes more than 1000000 frames; shorten it"),
        whole("BackwardSpeed", "scene: room.xml\nframes: 1\nego: {speed: -1 m/s}\n",
              "test.yaml:3: ego.speed is '-1 m/s'; it must be at least 0 and at most 100 m/s"),
        added("CameraRateZero", "camera: {rate: 0}\n",
              "4: camera.rate is '0'; it must be at least 0.1 and at most 1000 Hz"),
        added("CameraRateNegative", "camera: {rate: -10 Hz}\n",
              "4: camera.rate is '-10 Hz'; it must be at least 0.1 and at most 1000 Hz"),
        added("CameraThatHardlyLooks", "camera: {rate: 1e-6 Hz}\n",
              "4: camera.rate is '1e-6 Hz'; it must be at least 0.1 and at most 1000 Hz"),
        added("DropsThatDoNotStay", "image: {rain: {lens_drops: 500, drop_life: 1e-9 s}}\n",
              "4: image.rain.drop_life is '1e-9 s'; it must be at least 0.01 and at most 100000 s"),
        added("JpegZero", "image: {jpeg: 0}\n",
              "4: image.jpeg is '0'; give a whole number from 1 to 100"),
        added("ToldInPixels", "camera: {told: {height_error: 2 px}}\n",
              "4: camera.told.height_error: '2 px' is a number of pixels; give a length in m, cm, "
              "mm or km"),
        added("ImuRateZero", "imu: {rate: 0 Hz}\n",
              "4: imu.rate is '0 Hz'; it must be above 0 and at most 10000 Hz"),
        added("OdometryRateZero", "odometry: {rate: 0 Hz}\n",
              "4: odometry.rate is '0 Hz'; it must be above 0 and at most 10000 Hz"),
        added("KeyOfACalibration", "camera: {fx: 458}\n",
              "4: unknown key 'fx'; give camera.focal: [fx, fy]"),
        added("SensorThatIsNot", "camera: {lens_flare_intensity: 0.1}\n",
              "4: unknown key 'lens_flare_intensity'; the simulator has none of it "
              "(scenarios/README.md, 'What the simulator has, and has not'); remove it"),
        added("KeyOfAnotherSimulator", "camera: {readout_time: 20 ms}\n",
              "4: unknown key 'readout_time'; give camera.rolling_shutter"),
        added("ExposureOfAnotherMap", "camera: {auto_exposure: true}\n",
              "4: unknown key 'auto_exposure'; give image.auto_exposure"),
        added("ShadowsWithHeadlights",
              "image:\n  shadows: true\n  headlights: {intensity: 3000 cd}\n",
              "6: image.headlights light places that the shadows of other lights leave dark, which "
              "the simulator does not draw; remove them, or image.shadows"),
        added("GainOutOfItsBounds", "image:\n  gain: 4\n  auto_exposure: {gain: [8, 16]}\n",
              "6: image.auto_exposure.gain is [8, 16] without the 4 of image.gain, which the first "
              "picture has; give [least, most] round it"),
        added("ExposuresFromMostToLeast", "image:\n  auto_exposure: {exposure: [10 ms, 0.1 ms]}\n",
              "5: image.auto_exposure.exposure is [0.01, 0.0001] without the 0.001 of "
              "image.exposure, which the first picture has; give [least, most] round it"),
        added(
            "ExposureThatSmearsAndChanges",
            "image: {auto_exposure: {exposure: [0.1 ms, 10 ms]}}\ncamera: {exposure: 5 ms}\n",
            "4: image.auto_exposure.exposure changes the exposure, and camera.exposure smears for "
            "a constant time; remove one of them (without the first the gain alone changes)"),
        added("KeyOfAnotherMap", "accelerometer_noise_density: 2e-3\n",
              "4: unknown key 'accelerometer_noise_density'; give imu.accelerometer_noise_density"),
        added("ShutterLongerThanAFrame",
              "camera:\n  rate: 20\n  rolling_shutter: 40 ms\n  exposure: 11 ms\n",
              "6: camera.rolling_shutter and exposure together take more than the 0.05 s from one "
              "frame to the next; make it shorter, or the rate lower"),
        added("ExposureLongerThanAFrame", "camera: {rate: 20, exposure: 60 ms}\n",
              "4: camera.exposure takes more than the 0.05 s from one frame to the next; make it "
              "shorter, or the rate lower"),
        added("ClockFramesAhead", "camera: {rate: 10, told: {time_offset_error: 0.2 s}}\n",
              "4: camera.told.time_offset_error is more than the 0.1 s from one frame to the next; "
              "make it smaller"),
        added(
            "ScalesAboveTheDiagonal",
            "imu: {accelerometers: {M: [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]}}\n",
            "4: imu.accelerometers.M is not lower triangular with a diagonal above 0, as Kalibr's "
            "is; give [[x, 0, 0], [yx, y, 0], [zx, zy, z]], with 1 for an exact scale"),
        added("GyroscopesThatStretch",
              "imu: {gyroscopes: {C_gyro_i: [[2, 0, 0], [0, 1, 0], [0, 0, 1]]}}\n",
              "4: imu.gyroscopes.C_gyro_i is no rotation; give three rows of one, as Kalibr writes "
              "them"),
        added("FourCoefficients", "camera: {distortion: [0.1, 0, 0, 0]}\n",
              "4: camera.distortion is a list of 4; give a list of 5, as in [0, 0, 0, 0, 0]"),
        added("MountOfThreeRows", "camera: {T_BC: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]}\n",
              "4: camera.T_BC is no rigid transform; give four rows: a rotation beside a "
              "translation, and 0 0 0 1"),
        added("MountThatScales",
              "camera: {T_BC: [[2, 0, 0, 0], [0, 2, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]}\n",
              "4: camera.T_BC is no rigid transform; give four rows: a rotation beside a "
              "translation, and 0 0 0 1"),
        added("NoFieldOfView", "camera: {fovy: 0 deg}\n",
              "4: camera.fovy is '0 deg'; it must be above 0 and below 180 deg"),
        added("TwoLenses", "camera: {focal: 500, fovy: 60 deg}\n",
              "4: both camera.fovy and camera.focal are given; keep one of them"),
        added("NoFocalLength", "camera: {focal: 0}\n",
              "4: camera.focal is '0'; it must be at least 1 and at most 1000000 px"),
        added("FocalLengthOfTheLens", "camera: {focal: 4 mm}\n",
              "4: camera.focal: '4 mm' is a length; give a number of pixels in px"),
        added("HalfTheWorld", "camera: {fovy: 180 deg}\n",
              "4: camera.fovy is '180 deg'; it must be above 0 and below 180 deg"),
        added("RadiansByMistake", "camera: {fovy: 4 rad}\n",
              "4: camera.fovy is '4 rad'; it must be above 0 and below 180 deg"),
        added("NegativePixels", "camera: {size: [-640, 480]}\n",
              "4: camera.size.0 is '-640'; give a whole number from 16 to 8192"),
        added("NegativeNoise", "imu: {gyroscope_noise_density: -1e-4}\n",
              "4: imu.gyroscope_noise_density is '-1e-4'; it must be at least 0 and at most 1000"),
        added("ThresholdZero", "corners: {threshold: 0}\n",
              "4: corners.threshold is '0'; give a whole number from 1 to 254 or auto"),
        added("DepthZero", "truth: {min_depth: 0 m}\n",
              "4: truth.min_depth is '0 m'; it must be above 0 and at most 10000 m"),
        added("YawNoiseBelowZero", "odometry: {yaw_noise: -1 rad/s}\n",
              "4: odometry.yaw_noise is '-1 rad/s'; it must be at least 0 and at most 720 deg/s"),
        added("ScaleErrorAboveOne", "odometry: {scale_error: 5}\n",
              "4: odometry.scale_error is '5'; it must be at least 0 and at most 1"),
        added("NotANumber", "camera: {rate: .nan}\n",
              "4: camera.rate: '.nan' is not a number; give a frequency in Hz or kHz"),
        added("Nan", "camera: {position: [nan, 0, 0]}\n",
              "4: camera.position.0: 'nan' is not finite; give a length in m, cm, mm or km"),
        added("Infinite", "camera: {position: [0, inf m, 0]}\n",
              "4: camera.position.1: 'inf m' is not finite; give a length in m, cm, mm or km"),
        added(
            "Huge", "camera: {position: [0, 1e999 m, 0]}\n",
            "4: camera.position.1: '1e999 m' does not fit a double; give a length in m, cm, mm or "
            "km"),
        added("ListForTheFilter", "filter: {circle.mu_0: [1]}\n",
              "4: filter.circle.mu_0 is a list; give a text"),
        added("NanBound", "criteria: [{metric: a, min: nan}]\n",
              "4: criteria.0.min: 'nan' is not finite; give a number without a unit"),
        added("NoBound", "criteria:\n  - {metric: a}\n",
              "5: criteria.0 has no bound; give min, max or both"),
        added("CrossedBounds", "criteria:\n  - {metric: a, min: 2, max: 1}\n",
              "5: criteria.0 has its min above its max; exchange them"),
        added("NoMetric", "criteria:\n  - {min: 1}\n",
              "5: criteria.0 needs 'metric'; add it (scenarios/README.md shows how)")),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Phases, Refused,
    testing::Values(
        whole("AtZero", "scene: room.xml\nframes: 1\nego:\n  phases:\n    - {at: 0 s}\n",
              "test.yaml:5: ego.phases.0.at is '0 s', not after the phase before (0 s); make the "
              "times increase"),
        whole("NotIncreasing",
              "scene: room.xml\nframes: 1\nego:\n  phases:\n    - {at: 2 s}\n    - {at: 2 s}\n",
              "test.yaml:6: ego.phases.1.at is '2 s', not after the phase before (2 s); make the "
              "times increase"),
        whole("NoTime", "scene: room.xml\nframes: 1\nego:\n  phases:\n    - {speed: 1}\n",
              "test.yaml:5: ego.phases.0 needs 'at'; add it (scenarios/README.md shows how)"),
        whole("NotAList", "scene: room.xml\nframes: 1\nego: {phases: {at: 1}}\n",
              "test.yaml:3: ego.phases is a map; give a list, as in [...]")),
    name_of);

Mistake ego(const std::string& name, const std::string& keys, const std::string& message) {
  return whole(name, "scene: room.xml\nframes: 1\nego: " + keys + "\n", "test.yaml:3: " + message);
}

INSTANTIATE_TEST_SUITE_P(
    Ego, Refused,
    testing::Values(
        ego("UnknownDrive", "{drive: tracks}",
            "ego.drive is 'tracks'; give holonomic, wheeled or the path of an .xml file (with size "
            "and ground; it may attach a .urdf)"),
        ego("NoOwnRover", "{drive: r.xml}",
            "ego.drive: there is no file r.xml; give its path relative to the scenario file"),
        ego("WaypointsAndSpeed", "{speed: 1, waypoints: [[0, 0, 0], [1, 1, 1]]}",
            "both ego.speed and ego.waypoints are given; keep one of them"),
        ego("WaypointsAndStart", "{start: [0, 0], waypoints: [[0, 0, 0], [1, 1, 1]]}",
            "both ego.start and ego.waypoints are given; keep one of them"),
        ego("WaypointsAndPhases", "{waypoints: [[0, 0, 0], [1, 1, 1]], phases: [{at: 1}]}",
            "both ego.phases and ego.waypoints are given; keep one of them"),
        ego("WaypointsNowhere", "{waypoints: [[0, 1, 2], [1, 1, 2]]}",
            "ego.waypoints lead nowhere: all are one place; make one of them another, or give "
            "start and heading for a rover that stands"),
        ego("PathAndDrive",
            "{drive: wheeled, path: [[0, 0, 0, 0, 0, 0, 0], [1, 1, 0, 0, 0, 0, 0]]}",
            "both ego.drive and ego.path are given; keep one of them"),
        ego("PathOfOnePose", "{path: [[0, 0, 0, 0, 0, 0, 0]]}",
            "ego.path has fewer than two poses; give two or more [time, x, y, z, roll, pitch, "
            "yaw]"),
        ego("PathBackInTime", "{path: [[1, 0, 0, 0, 0, 0, 0], [0.5, 1, 0, 0, 0, 0, 0]]}",
            "ego.path.1 is at '0.5', not after the one before; make the times increase"),
        ego("EgoAtOneWaypoint", "{waypoints: [[0, 1, 2]]}",
            "ego.waypoints has fewer than two waypoints; give two or more [time, x, y]")),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Actors, Refused,
    testing::Values(
        added("ShapeAndBody", "actors:\n  a: {shape: box, body: b, trajectory: {still: {}}}\n",
              "5: both actors.a.shape and actors.a.body are given; keep one of them"),
        added("NeitherShapeNorBody", "actors:\n  a: {trajectory: {still: {}}}\n",
              "5: actors.a needs 'shape' or 'body'; add it (scenarios/README.md shows how)"),
        added(
            "UnknownShape", "actors:\n  a: {shape: ball, trajectory: {still: {}}}\n",
            "5: actors.a.shape is 'ball'; give box, cylinder, pedestrian, car, walker or the path "
            "of an .xml file (with size and ground; it may attach a .urdf)"),
        added("JointWithoutNames", "actors:\n  a: {body: door, joint: {}}\n",
              "5: actors.a.joint has no joint; give {NAME: [[0 s, 0 deg], [2 s, 80 deg]]}"),
        added(
            "JointThatStandsStill", "actors:\n  a: {body: door, joint: {hinge: [[0 s, 0 deg]]}}\n",
            "5: actors.a.joint.hinge has fewer than two waypoints; give two or more [time, angle] "
            "of a hinge, or [time, length] of a slide"),
        added("JointOfAShape",
              "actors:\n  a: {shape: box, joint: {hinge: [[0 s, 0 deg], [1 s, 9 deg]]}}\n",
              "5: both actors.a.shape and actors.a.joint are given; keep one of them"),
        added("NoOwnShape", "actors:\n  a: {shape: truck.xml, trajectory: {still: {}}}\n",
              "5: actors.a.shape: there is no file truck.xml; give its path relative to the "
              "scenario file"),
        added("NamedAsTheRover", "actors:\n  ego: {shape: box, trajectory: {still: {}}}\n",
              "5: an actor is called 'ego', which is the rover's name; rename it"),
        added("SizeOfABody", "actors:\n  a: {body: b, size: [1, 1, 1], trajectory: {still: {}}}\n",
              "5: actors.a.size is given for a body of the scene, which has its own; remove it, or "
              "give 'shape' in place of 'body'"),
        added("NegativeSize",
              "actors:\n  a: {shape: box, size: [1, -1 m, 1], trajectory: {still: {}}}\n",
              "5: actors.a.size.1 is '-1 m'; it must be above 0 and at most 100 m"),
        added("NoSize", "actors:\n  a: {shape: box, size: [1, 0, 1], trajectory: {still: {}}}\n",
              "5: actors.a.size.1 is '0'; it must be above 0 and at most 100 m"),
        added(
            "NoPicture",
            "actors:\n  a: {shape: box, texture: b.png, trajectory: {still: {position: [0, 0]}}}\n",
            "5: actors.a.texture: there is no picture b.png; give its path relative to the "
            "scenario file"),
        added("NameWithDot", "actors:\n  a.b: {shape: box, trajectory: {still: {}}}\n",
              "5: the actor's name 'a.b' has other characters than letters, digits, '_' and '-'; "
              "rename it"),
        added("NothingInIt", "actors:\n  a:\n",
              "5: actors.a is nothing; give a map, as in {key: value}, or {} for its defaults"),
        actor(
            "TwoTrajectories", "{still: {}, line: {speed: 1}}",
            "7: both actors.a.trajectory.still and actors.a.trajectory.line are given; keep one of "
            "them"),
        actor("NoTrajectory", "{}",
              "7: actors.a.trajectory needs 'still', 'line', 'waypoints' or 'circle'; add it "
              "(scenarios/README.md shows how)"),
        actor("StillWithoutPlace", "{still: {}}",
              "5: actors.a has a shape of its own and so needs trajectory.still.position; add it "
              "(only a body of the scene has a place there)"),
        actor(
            "LineWithoutStart", "{line: {heading: 0, speed: 1}}",
            "5: actors.a has a shape of its own and so needs trajectory.line.from; add it (only a "
            "body of the scene has a place there)"),
        actor(
            "LineWithoutHeading", "{line: {from: [0, 0], speed: 1}}",
            "5: actors.a has a shape of its own and so needs trajectory.line.heading; add it (only "
            "a body of the scene has a place there)"),
        actor("LineWithoutSpeed", "{line: {from: [0, 0], heading: 0}}",
              "7: actors.a.trajectory.line needs 'speed'; add it (scenarios/README.md shows how)"),
        actor("OneWaypoint", "{waypoints: [[0, 1, 2]]}",
              "7: actors.a.trajectory.waypoints has fewer than two waypoints; give two or more "
              "[time, x, y]"),
        actor("WaypointsBackInTime", "{waypoints: [[1, 1, 2], [0.5, 2, 2]]}",
              "7: actors.a.trajectory.waypoints.1 is at '0.5', not after the one before; make the "
              "times increase"),
        actor(
            "WaypointWithoutTime", "{waypoints: [[1, 2], [2, 2]]}",
            "7: actors.a.trajectory.waypoints.0 is a list of 2; give a list of 3, as in [0, 0, 0]"),
        actor(
            "CircleOfNothing", "{circle: {centre: [0, 0], radius: 0, speed: 1}}",
            "7: actors.a.trajectory.circle.radius is '0'; it must be above 0 and at most 10000 m"),
        actor("CircleWithoutCentre", "{circle: {radius: 1, speed: 1}}",
              "7: actors.a.trajectory.circle needs 'centre'; add it (scenarios/README.md shows "
              "how)")),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Yaml, Refused,
    testing::Values(
        added("Tab", "camera:\n\trate: 5\n", "5: a tab indents this line; indent with spaces"),
        added("Alias", "camera: &c {rate: 5}\nimu: *c\n",
              "5: YAML aliases are not known here; write the value out"),
        added("Tag", "seed: !!int 5\n",
              "4: YAML tags such as 'tag:yaml.org,2002:int' are not known here; remove it"),
        added("TwoDocuments", "---\nscene: room.xml\n",
              "1: there is more than one YAML document; keep one (remove '---')"),
        whole("Empty", "",
              "test.yaml: the file is empty; see scenarios/README.md for a first scenario"),
        whole("OnlyAComment", "# nothing\n",
              "test.yaml: the file is empty; see scenarios/README.md for a first scenario"),
        whole("AList", "- scene: room.xml\n",
              "test.yaml:1: a scenario is a map of keys, and this is a list; begin as in 'scene: "
              "lab'"),
        whole("AWord", "lab\n",
              "test.yaml:1: a scenario is a map of keys, and this is a single value; begin as in "
              "'scene: lab'"),
        added("Latin1", "purpose: caf\xe9\n", "4: this is not UTF-8; save the file as UTF-8"),
        added("OverlongUtf8", "purpose: \xc0\xaf\n",
              "4: this is not UTF-8; save the file as UTF-8"),
        added("CutUtf8", "purpose: \xe2\x82", "4: this is not UTF-8; save the file as UTF-8"),
        added("Surrogate", "purpose: \xed\xa0\x80\n",
              "4: this is not UTF-8; save the file as UTF-8"),
        added("Control", "purpose: a\x04z\n",
              "4: there is a control character; is this a text file? remove it"),
        whole("Utf16", std::string("s\0c\0", 4),
              "test.yaml:1: there is a control character; is this a text file? remove it")),
    name_of);

TEST(Refused, WhenTheFileIsMissingAFolderOrHuge) {
  const ScenarioFolder folder;
  const auto message = [](const std::filesystem::path& file) {
    return test::refusal_of<input::Error>([&] { load(file); });
  };
  const std::filesystem::path missing = folder.path() / "missing.yaml";
  EXPECT_EQ(message(missing),
            missing.string() + ": there is no such file; give the path of a scenario file (.yaml)");
  EXPECT_EQ(
      message(folder.path()),
      folder.path().string() + ": this is a folder; give the path of a scenario file (.yaml)");
  const auto huge = folder.write("huge.yaml", std::string((1 << 20) + 1, '#'));
  EXPECT_EQ(
      message(huge),
      huge.string() + ": the file is larger than 1 MiB; give the path of a scenario file (.yaml)");
}

TEST(Refused, AMebibyteOfUnknownKeysAtTheFirst) {
  std::string text = "scene: room.xml\nframes: 1\nego: {}\n";
  for (int i = 0; i < 90000; ++i) text.append("k").append(std::to_string(i)).append(": 1\n");
  EXPECT_TRUE(refusal(text).starts_with("test.yaml:4: unknown key 'k0'; ")) << refusal(text);
}

TEST(Refused, AMissingSceneSaysWhereItWasLookedFor) {
  EXPECT_EQ(refusal("frames: 1\nego: {}\nscene: hall.xml\n"),
            "test.yaml:3: there is no scene file hall.xml; give its path relative to the scenario "
            "file");
  const ScenarioFolder scenes;
  scenes.write("street.xml", "<mujoco/>");
  ASSERT_EQ(setenv("LCS_SCENES", scenes.path().c_str(), 1), 0);
  EXPECT_EQ(
      refusal("scene: hall\nframes: 1\nego: {}\n"),
      "test.yaml:1: there is no scene 'hall' at " + scenes.path().string() +
          "/hall.xml; give the name of a scene in that folder (it has room, street) or a path "
          "that ends in .xml");
  ASSERT_EQ(unsetenv("LCS_SCENES"), 0);
}

// The middle of these messages comes from yaml-cpp.
TEST(Refused, BrokenYamlWithItsLine) {
  const auto expect_not_yaml = [](const std::string& text, int line) {
    const std::string message = refusal(text);
    const std::string begin = "test.yaml:" + std::to_string(line) + ": this is not YAML: ";
    EXPECT_EQ(message.substr(0, begin.size()), begin) << message;
    EXPECT_NE(message.find("; check indentation, brackets and quotes near column "),
              std::string::npos)
        << message;
  };
  expect_not_yaml(smallest + "camera: {rate: 5\n", 4);
  expect_not_yaml(smallest + "camera:\n  rate: 5\n   size: 5\n", 6);
  expect_not_yaml(smallest + "purpose: 'no end\nseed: 4\n", 5);
  expect_not_yaml(smallest + "imu: *not_defined\n", 4);
  expect_not_yaml("scene: " + std::string(100'000, '['), 1);
}

TEST(Nearest, FindsAMisspellingAndNothingElse) {
  const std::vector<std::string> names = {"speed", "heading", "yaw_rate", "at"};
  EXPECT_EQ(input::nearest("sped", names), "speed");
  EXPECT_EQ(input::nearest("speeed", names), "speed");
  EXPECT_EQ(input::nearest("yawrate", names), "yaw_rate");
  EXPECT_EQ(input::nearest("haeding", names), "heading");
  EXPECT_EQ(input::nearest("colour", names), std::nullopt);
  const std::vector<std::string> nested{"circle.gap", "hypotheses.coupling", "rebel.f1",
                                        "rebel.f1_clear"};
  EXPECT_EQ(input::nearest("coupling", nested), "hypotheses.coupling");
  EXPECT_EQ(input::nearest("copling", nested), "hypotheses.coupling");
  EXPECT_EQ(input::nearest_first("coupling", nested).front(), "hypotheses.coupling");
  EXPECT_EQ(input::nearest("rebel.f1_score", nested), "rebel.f1");
  EXPECT_EQ(input::nearest("rebel.f1_claer", nested), "rebel.f1_clear");
  EXPECT_EQ(input::nearest("x", names), std::nullopt);
  EXPECT_EQ(input::nearest("", names), std::nullopt);
  EXPECT_EQ(input::nearest("speed", {}), std::nullopt);
}

TEST(Refused, ASceneThatNoFileCanBeCalled) {
  const std::string said = refusal("scene: " + std::string(300, 'a') + "\nframes: 1\n");
  EXPECT_TRUE(said.starts_with("test.yaml:1: there is no scene 'aaa")) << said;
}

}  // namespace
}  // namespace lcs::scenario
