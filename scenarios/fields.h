/// \file
/// The single list of all keys of a scenario file. Reading (`load.cpp`), writing (`written.h`), the
/// text of `lcs run --keys` (`keys.cpp`) and `scenario.schema.json` (tests/scenarios) use it.
///
/// Each `fields` lists the keys of one map: it calls `visit(key, member, form)` for each key in the
/// order of output. A form is needed where the member's type does not determine the accepted
/// values. Each `fields` binds all members of the struct by name, so that a new member that is
/// missing here fails to compile.
///
/// A visitor must also have
///   at_most_one_of({"a", "b"}), exactly_one_of({"a", "b"})   mutually exclusive keys
///   in_place_of("a", {"b", "c"})                             a excludes b and c
///
/// Some keys have no member of their own (`focal`, `duration`). They are local variables that only
/// reading fills.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/imu_presets.h"
#include "scenarios/input/reader.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

// Accepted ranges of a scenario's numbers. The outer bounds are generous: they catch wrong units
// (km for m) without limiting large experiments.

inline constexpr input::Quantity kPosition{input::Dimension::length, {-10000, 10000}};
inline constexpr input::Quantity kSize{input::Dimension::length, {0, 100, true}};
inline constexpr input::Quantity kDistance{input::Dimension::length, {0, 10000, true}};
inline constexpr input::Quantity kTime{input::Dimension::time, {0, 100000}};
inline constexpr input::Quantity kDuration{input::Dimension::time, {0, 100000, true}};
inline constexpr input::Quantity kSpeed{input::Dimension::speed, {0, 100}};
inline constexpr input::Quantity kSignedSpeed{input::Dimension::speed, {-100, 100}};
inline constexpr input::Quantity kAcceleration{input::Dimension::acceleration, {-100, 100}};
inline constexpr input::Quantity kAngle{input::Dimension::angle, {-360, 360}};
inline constexpr input::Quantity kJointAngle{input::Dimension::angle, {-36000, 36000}};
inline constexpr input::Quantity kFieldOfView{input::Dimension::angle, {0, 180, true, true}};
inline constexpr input::Quantity kFocal{input::Dimension::pixels, {1, 1e6}};
inline constexpr input::Quantity kInPicture{input::Dimension::pixels, {-100000, 100000}};
inline constexpr input::Quantity kCoefficient{input::Dimension::number, {-1000, 1000}};
inline constexpr input::Quantity kAngularRate{input::Dimension::angular_rate, {-720, 720}};
/// Of the camera. At the lowest rate, ten seconds of physics lie between two frames.
inline constexpr input::Quantity kCameraRate{input::Dimension::frequency, {0.1, 1000}};
inline constexpr input::Quantity kSensorRate{input::Dimension::frequency, {0, 10000, true}};
inline constexpr input::Quantity kNoiseDensity{input::Dimension::number, {0, 1000}};
inline constexpr input::Quantity kIlluminance{input::Dimension::illuminance, {0, 200000}};
inline constexpr input::Quantity kIntensity{input::Dimension::intensity, {0, 1000000}};
inline constexpr input::Quantity kContrast{input::Dimension::number, {0.01, 10}};
inline constexpr input::Quantity kNoiseRate{input::Dimension::frequency, {0, 10000}};
inline constexpr input::Quantity kDarkLight{input::Dimension::illuminance, {1e-6, 200000}};
inline constexpr input::Quantity kBeam{input::Dimension::angle, {0, 90, true}};
inline constexpr input::Quantity kBlur{input::Dimension::number, {0, 50}};
inline constexpr input::Quantity kDropLife{input::Dimension::time, {0.01, 100000}};
inline constexpr input::Quantity kRainRate{input::Dimension::number, {0, 200}};
inline constexpr input::Quantity kExposure{input::Dimension::time, {0, 10, true}};
inline constexpr input::Quantity kShutter{input::Dimension::time, {0, 10}};
inline constexpr input::Quantity kTimeOffset{input::Dimension::time, {-10, 10}};
inline constexpr input::Quantity kGain{input::Dimension::number, {0, 1000, true}};
inline constexpr input::Quantity kElectrons{input::Dimension::number, {0, 1000000}};
inline constexpr input::Quantity kFullWell{input::Dimension::number, {0, 1000000, true}};
inline constexpr input::Quantity kYawNoise{input::Dimension::angular_rate, {0, 720}};
inline constexpr input::Quantity kTurnOnRate{input::Dimension::angular_rate, {0, 720}};
inline constexpr input::Quantity kTurnOnAcceleration{input::Dimension::acceleration, {0, 100}};
inline constexpr input::Quantity kImuRate{input::Dimension::angular_rate, {0, 36000, true}};
inline constexpr input::Quantity kImuAcceleration{input::Dimension::acceleration, {0, 10000, true}};
inline constexpr input::Quantity kRoughness{input::Dimension::length, {0, 1, true}};
inline constexpr input::Quantity kRatio{input::Dimension::number, {0, 1}};
inline constexpr input::Quantity kShare{input::Dimension::number, {0, 1, true, true}};
inline constexpr input::Quantity kBound{input::Dimension::number, {}};

/// \name `Key::without` of required keys.
///@{
inline constexpr std::string_view kRequired = "required";
inline constexpr std::string_view kOneOfThese = "one of these is required";
///@}

struct Key {
  std::string_view name;
  std::string_view meaning;       ///< Markdown, in one line
  std::string_view without = "";  ///< effect of omitting the key; "": the member's default
};

inline constexpr int kMostFrames = 1'000'000;
inline constexpr std::size_t kMostCameras = 8;  // each has a GL context

/// The type of a member that is one of several words.
template <class T>
concept Enumeration = std::is_enum_v<T>;

/// \name Forms of values
///@{
struct Plain {};  ///< the member's type determines the accepted values
struct Whole {    ///< a whole number in [low, high]
  std::int64_t low;
  std::int64_t high;
};
struct In : input::Quantity {  ///< written in a unit other than its base unit
  std::string_view unit;
};
struct Words {  ///< one of the words: an enumerator by its number, or a text
  std::vector<std::string> words;
};
template <class Form>
struct OrWord {  ///< a word that means an optional member without a value
  Form form;
  std::string_view word;
};
struct OneOrTwo {  ///< a number for x and y, or [x, y]
  input::Quantity quantity;
};
struct OwnFileOr {  ///< one of the words, or a file ("rover.xml") for the enumerator `own`
  std::vector<std::string> words;
  std::filesystem::path& file;
};
struct SceneName {  ///< name of a shipped scene, or a file ("room.xml")
  input::Source& source;
};
struct File {};            ///< must exist
struct FolderOrFile {};    ///< must exist
struct StyleOrPicture {};  ///< name of a texture style, or a file ("brick.png")
struct GroupNames {};      ///< one or more distinct group names
struct GroupList {};       ///< one or more distinct numbers of geom groups
struct FilterParameters {  ///< any key
  std::string& preset;
  input::Source& source;
};
struct FramesBefore {  ///< a duration, converted to the number of frames before its end
  double rate_hz;
};
///@}

// --- the rover

void motion_fields(EgoPhase& phase, std::string_view without, auto&& visit) {
  visit({"speed", "at the start", without}, phase.speed_mps, kSpeed);
  visit({"acceleration", "along the direction of travel; a speed that falls to 0 stays 0", without},
        phase.acceleration_mps2, kAcceleration);
  visit({"direction", "of travel, from the heading: 90 deg is to the left, 180 deg is backwards",
         without},
        phase.direction_rad, kAngle);
  visit({"yaw_rate", "of the heading", without}, phase.yaw_rate_radps, kAngularRate);
}

void fields(EgoPhase& phase, auto&& visit) {
  [[maybe_unused]] auto& [at_s, speed, acceleration, direction, yaw_rate] = phase;
  visit({"at", "the phase begins; times increase", kRequired}, at_s, kTime);
  motion_fields(phase, "as before", visit);
}

void fields(Ego& ego, auto&& visit) {
  auto& [source, drive, drive_file, pose, start_m, heading_rad, phases, waypoints, path] = ego;
  if (phases.empty()) phases.emplace_back();
  visit({"drive",
         "`holonomic`: a planar base that follows any command; `wheeled`: two driven wheels on "
         "contacts; or a rover of one's own (scenes/README.md): a path relative to this file"},
        drive, OwnFileOr{{"holonomic", "wheeled"}, drive_file});
  visit({"pose",
         "of the joints beside the drive, as of an arm: they stay as in this keyframe of the "
         "rover's file, or at `zero`",
         "they are loose"},
        pose);
  visit({"start", "[x, y]"}, start_m, kPosition);
  visit({"heading", "the direction that the rover faces at the start"}, heading_rad, kAngle);
  motion_fields(phases.front(), "", visit);
  visit({"phases",
         "new commands, each from a time on. A key that a phase leaves out keeps its value, the "
         "speed after acceleration included",
         "none"},
        phases);
  visit({"waypoints",
         "`[[time, x, y], ...]`, two or more: places and the times to be there, which increase. In "
         "place of all other keys but `pose` and `drive`, which is holonomic",
         "none"},
        waypoints);
  visit.in_place_of("waypoints", {"start", "heading", "speed", "acceleration", "direction",
                                  "yaw_rate", "phases"});
  visit({"path",
         "`[[time, x, y, z, roll, pitch, yaw], ...]`, two or more: poses of a camera that is "
         "carried or flies, and the times to be there, which increase; smooth in between, at rest "
         "at both ends. In place of all other keys",
         "none"},
        path);
  visit.in_place_of("path", {"drive", "pose", "start", "heading", "speed", "acceleration",
                             "direction", "yaw_rate", "phases", "waypoints"});
}

// --- its sensors

inline constexpr std::string_view kDistortionKey =
    "`[k1, k2, p1, p2, k3]`, or `{equidistant: [k1, k2, k3, k4]}`, as OpenCV has them";

void fields(Camera::Told& told, auto&& visit) {
  auto& [height_error_m, pitch_error_rad, time_offset_error_s] = told;
  visit({"height_error", "added to the camera's true height"}, height_error_m, kPosition);
  visit({"pitch_error", "added to its true pitch"}, pitch_error_rad, kAngle);
  visit({"time_offset_error", "added to its true `time_offset`"}, time_offset_error_s, kTimeOffset);
}

void fields(Camera& camera, auto&& visit) {
  auto& [source, width_px, height_px, fovy_rad, focal_px, centre_px, distortion, rate_hz,
         position_m, rotation_rad, told, time_offset_s, rolling_shutter_s, exposure_s, groups] =
      camera;
  Eigen::Vector2i size_px(width_px, height_px);
  visit({"size", "[width, height] in pixels"}, size_px, Whole{16, 8192});
  width_px = size_px.x();
  height_px = size_px.y();
  std::optional<Eigen::Vector2d> focal = focal_px;
  visit({"fovy", "vertical field of view, of a centred camera without distortion"}, fovy_rad,
        kFieldOfView);
  visit({"focal",
         "in place of `fovy`: the focal length, half the height by tan(fovy / 2); `[fx, fy]` for "
         "pixels that are not square",
         "by `fovy`"},
        focal, OneOrTwo{kFocal});
  visit.in_place_of("focal", {"fovy"});
  visit({"centre", "`[cx, cy]`: principal point; (0, 0) is the centre of the top-left pixel",
         "the picture's middle"},
        centre_px, kInPicture);
  visit({"distortion", kDistortionKey, "none"}, distortion);
  if (focal) {
    fovy_rad = 2 * std::atan(height_px / 2.0 / focal->y());
    if (focal->x() != focal->y() || centre_px || distortion) focal_px = focal;
  }
  visit({"rate", "frames a second"}, rate_hz, kCameraRate);
  visit({"position", "[x, y, z] of the camera in the rover"}, position_m, kPosition);
  visit({"rotation",
         "[roll, pitch, yaw] about the rover's fixed x, y, z in this order; positive pitch looks "
         "down, positive yaw to the left"},
        rotation_rad, kAngle);
  std::vector<Eigen::Vector4d> T_BC;  // only reading fills it, and the two above from it
  visit({"T_BC",
         "in place of both: `[[r, r, r, x], [r, r, r, y], [r, r, r, z], [0, 0, 0, 1]]`, the matrix "
         "that takes camera coordinates (x right, y down, z forward) to the rover's",
         "by `position` and `rotation`"},
        T_BC, kCoefficient);
  visit.in_place_of("T_BC", {"position", "rotation"});
  visit({"told",
         "`{height_error: 2 cm, pitch_error: 0.5 deg, time_offset_error: 5 ms}`: errors of the "
         "calibration that the filter is given",
         "none"},
        told);
  visit({"time_offset",
         "Kalibr's `timeshift_cam_imu`: a picture with the stamp t shows the time t + "
         "`time_offset` of the IMU's clock"},
        time_offset_s, kTimeOffset);
  visit({"rolling_shutter",
         "time from the first row to the end of the last row; the first row is of the frame's "
         "time, and row y of h comes y / h of this later; 0: all rows at once"},
        rolling_shutter_s, kShutter);
  visit({"exposure",
         "each row is the mean of the light of this long, half of it before the row's time; 0: an "
         "instant. What moves is smeared; `image.exposure` alone sets the brightness"},
        exposure_s, kShutter);
  visit({"groups", "of geoms that are drawn: MuJoCo's `group`, 0 to 5"}, groups, GroupList{});
}

void fields(Gyroscopes& gyroscopes, auto&& visit) {
  auto& [M, C_gyro_i, A, range_radps, resolution_radps] = gyroscopes;
  visit({"M", "Kalibr's matrix of scales and misalignments, three rows: lower triangular"}, M,
        kCoefficient);
  visit({"C_gyro_i", "Kalibr's rotation from the IMU's frame to the gyroscopes'"}, C_gyro_i,
        kCoefficient);
  visit({"A", "Kalibr's effect of the specific force on the gyroscopes, (rad/s)/(m/s^2)"}, A,
        kCoefficient);
  visit({"range", "largest reading of an axis, of either sign", "unlimited"}, range_radps,
        kImuRate);
  visit({"resolution", "readings are multiples of it", "unlimited"}, resolution_radps, kImuRate);
}

void fields(Accelerometers& accelerometers, auto&& visit) {
  auto& [M, range_mps2, resolution_mps2] = accelerometers;
  visit({"M", "as `M` of the gyroscopes"}, M, kCoefficient);
  visit({"range", "largest reading of an axis, of either sign: 16 g is 156.9", "unlimited"},
        range_mps2, kImuAcceleration);
  visit({"resolution", "readings are multiples of it", "unlimited"}, resolution_mps2,
        kImuAcceleration);
}

void fields(Imu& imu, auto&& visit) {
  auto& [preset, noise, gyroscopes, accelerometers, position_m, rpy_rad, reading, rate_hz, gaps] =
      imu;
  auto& [gyroscope_density, gyroscope_walk, accelerometer_density, accelerometer_walk,
         gyroscope_bias_radps, accelerometer_bias_mps2] = noise;
  std::string known = imu_preset(preset) ? preset : "ideal";
  const std::string before = known;
  visit(
      {"preset",
       "noise of a known IMU: `adis16448` (EuRoC), `tumvi` (BMI160), `esim`, or `ideal` for none"},
      known, Words{imu_preset_names()});
  if (known != before) {
    preset = known;
    noise = *imu_preset(known);
  }
  visit({"gyroscope_noise_density", "rad/s/sqrt(Hz)", "the preset's"}, gyroscope_density,
        kNoiseDensity);
  visit({"gyroscope_random_walk", "rad/s^2/sqrt(Hz)", "the preset's"}, gyroscope_walk,
        kNoiseDensity);
  visit({"accelerometer_noise_density", "m/s^2/sqrt(Hz)", "the preset's"}, accelerometer_density,
        kNoiseDensity);
  visit({"accelerometer_random_walk", "m/s^3/sqrt(Hz)", "the preset's"}, accelerometer_walk,
        kNoiseDensity);
  visit({"gyroscope_turn_on_bias",
         "standard deviation of a constant bias, drawn for each axis once a run"},
        gyroscope_bias_radps, kTurnOnRate);
  visit({"accelerometer_turn_on_bias", "likewise"}, accelerometer_bias_mps2, kTurnOnAcceleration);
  visit({"gyroscopes", "their errors beside noise and bias", "none"}, gyroscopes);
  visit({"accelerometers", "likewise", "none"}, accelerometers);
  visit({"position", "[x, y, z] of the IMU in the rover", "from the site `imu` in its file"},
        position_m, kPosition);
  visit({"rotation", "[roll, pitch, yaw] of the IMU's axes in the rover, as `camera.rotation`",
         "from the site `imu` in its file"},
        rpy_rad, kAngle);
  visit({"reading",
         "`mean` over the period before its stamp, as of a unit that integrates; `sample` of the "
         "instant of its stamp, as Kalibr and spline fits take it"},
        reading, Words{{"mean", "sample"}});
  visit({"gaps", "a list of [from, to]: times without readings, from above 0, increasing", "none"},
        gaps);
  visit({"rate", "samples a second"}, rate_hz, kSensorRate);
}

void fields(Odometry& odometry, auto&& visit) {
  auto& [enabled, rate_hz, noise_mps, yaw_noise_radps, scale_error] = odometry;
  visit({"rate", "samples a second"}, rate_hz, kSensorRate);
  visit({"noise", "white, in each sample of x and y"}, noise_mps, kSpeed);
  visit({"yaw_noise", "likewise of the yaw rate; by it the estimator recognises wheels that slip"},
        yaw_noise_radps, In{kYawNoise, "rad/s"});
  visit({"scale_error", "standard deviation of a factor drawn once a run"}, scale_error, kRatio);
}

void fields(Events& events, auto&& visit) {
  auto& [source, positive, negative, spread, refractory_s, leak_hz, shot_hz, dark_lx] = events;
  visit({"positive", "mean contrast, of the natural logarithm of light, that gives an ON event"},
        positive, kContrast);
  visit({"negative", "likewise of an OFF event"}, negative, kContrast);
  visit({"spread", "standard deviation of both contrasts between pixels"}, spread, kRatio);
  visit({"refractory", "after an event the pixel gives none for this long"}, refractory_s,
        In{kShutter, "ms"});
  visit({"leak", "ON events a second of a pixel in constant light"}, leak_hz, kNoiseRate);
  visit({"shot", "events a second by noise of a pixel in the dark; a quarter of it in daylight"},
        shot_hz, kNoiseRate);
  visit({"dark", "light on a white surface that gives as much current as a pixel has in the dark"},
        dark_lx, kDarkLight);
}

// --- light, weather and the ground

void fields(Image::Headlights& headlights, auto&& visit) {
  auto& [intensity_cd, beam_rad] = headlights;
  visit({"intensity", "on the optical axis", kRequired}, intensity_cd, kIntensity);
  visit({"beam", "standard deviation of the beam round the axis"}, beam_rad, kBeam);
}

void fields(Image::Rain& rain, auto&& visit) {
  auto& [rate_mmph, lens_drops, drop_life_s] = rain;
  visit({"rate", "mm/h that fall, as streaks"}, rate_mmph, kRainRate);
  visit({"lens_drops", "drops on the window before the lens at any time"}, lens_drops,
        Whole{0, 500});
  visit({"drop_life", "mean time until a drop is replaced"}, drop_life_s, kDropLife);
}

void fields(Image::AutoExposure& control, auto&& visit) {
  auto& [target, time_constant_s, exposure_s, gain] = control;
  visit({"target", "mean of the picture in linear light, in which 1 is a full pixel"}, target,
        kShare);
  visit({"time_constant", "in which a deviation from the target falls to 1/e; 0: in a frame"},
        time_constant_s, kTime);
  visit(
      {"exposure", "`[least, most]` of `image.exposure`; the longest is used before the gain rises",
       "the gain alone changes"},
      exposure_s, In{kExposure, "ms"});
  visit({"gain", "`[least, most]` of `image.gain`"}, gain, kGain);
}

void fields(Image::Noise& noise, auto&& visit) {
  auto& [full_well_e, read_e] = noise;
  visit({"full_well", "electrons of a full pixel; shot noise follows from them"}, full_well_e,
        kFullWell);
  visit({"read", "electrons that reading adds (standard deviation)"}, read_e, kElectrons);
}

void fields(Image& image, auto&& visit) {
  auto& [light_lx, shadows, headlights, visibility_m, rain, samples, point_spread_px, blur_px,
         vignetting, exposure_s, gain, auto_exposure, noise, jpeg_quality] = image;
  visit({"light", "on the scene: 10 klx is an overcast day, 100 lx dusk, 0.5 lx night"}, light_lx,
        kIlluminance);
  visit({"shadows",
         "of those lights of the scene that have `castshadow`; corners near a shadow's edge have "
         "no truth"},
        shadows);
  visit({"headlights", "`{intensity: 3000 cd, beam: 20 deg}`: lamps at the camera", "none"},
        headlights);
  visit({"visibility", "distance at which contrast falls to 2 %", "none: clear air"}, visibility_m,
        kDistance);
  visit({"rain", "`{rate: 15, lens_drops: 25, drop_life: 4 s}`", "none"}, rain);
  visit({"samples",
         "points of each pixel whose light is averaged, 1, 4, 5 or 9: outlines are in place to "
         "1, 1/2, 1/5 or 1/3 px"},
        samples, Whole{1, 9});
  visit({"point_spread",
         "standard deviation of a sharp lens's point spread, in pixels; 0.6 and a pixel's area "
         "leave half of the contrast at 0.28 cycles a pixel"},
        point_spread_px, kBlur);
  visit(
      {"blur", "of a lens that is not sharp: standard deviation in pixels, beside `point_spread`"},
      blur_px, kBlur);
  visit({"vignetting",
         "share of the light that the farthest corner of the picture loses; it grows with the "
         "squared distance from the principal point"},
        vignetting, kRatio);
  visit({"exposure",
         "at 1 ms a white surface in daylight fills a pixel; it makes noise and the length of "
         "streaks; `camera.exposure` smears what moves"},
        exposure_s, In{kExposure, "ms"});
  visit({"gain", "after the sensor, of signal and noise"}, gain, kGain);
  visit({"auto_exposure",
         "`{target: 0.2, time_constant: 0.2 s, gain: [1, 16]}`: each picture sets exposure and "
         "gain of the next; `exposure` and `gain` hold for the first",
         "exposure and gain stay"},
        auto_exposure);
  visit({"noise", "`{full_well: 10000, read: 5}`, or `none`"}, noise, OrWord<Plain>{{}, "none"});
  visit({"jpeg", "quality by which the picture is compressed before anything reads it",
         "none: not compressed"},
        jpeg_quality, Whole{1, 100});
}

void fields(RoughGround& ground, auto&& visit) {
  auto& [roughness_m, wavelength_m, centre_m, size_m] = ground;
  visit({"roughness",
         "standard deviation of the height; the ground rises to four of them above the floor"},
        roughness_m, kRoughness);
  visit({"wavelength", "of the shortest waves; the longest are three times as long"}, wavelength_m,
        kSize);
  visit({"centre", "[x, y]", "where the ego starts"}, centre_m, kPosition);
  visit({"size", "[along x, along y]; level at the edges"}, size_m, kSize);
}

// --- actors

void fields(Still& still, auto&& visit) {
  auto& [position_m, heading_rad] = still;
  visit({"position", "[x, y]", "the body's; required of a shape"}, position_m, kPosition);
  visit({"heading", "the direction that the actor faces", "the body's; 0 deg of a shape"},
        heading_rad, kAngle);
}

void fields(Line& line, auto&& visit) {
  auto& [from_m, heading_rad, speed_mps, acceleration_mps2] = line;
  visit({"from", "[x, y]", "the body's place; required of a shape"}, from_m, kPosition);
  visit({"heading", "the direction that the actor moves in", "the body's; required of a shape"},
        heading_rad, kAngle);
  visit({"speed", "at the start", kRequired}, speed_mps, kSpeed);
  visit({"acceleration", "a speed that falls to 0 stays 0"}, acceleration_mps2, kAcceleration);
}

void fields(Circular& circle, auto&& visit) {
  auto& [centre_m, radius_m, start_angle_rad, speed_mps] = circle;
  visit({"centre", "[x, y]", kRequired}, centre_m, kPosition);
  visit({"radius", "of the circle", kRequired}, radius_m, kDistance);
  visit({"start_angle", "of the first point, seen from the centre"}, start_angle_rad,
        In{kAngle, "rad"});
  visit({"speed", "counter-clockwise if it is positive", kRequired}, speed_mps, kSignedSpeed);
}

template <class T>
std::optional<T> alternative(const Trajectory& trajectory) {
  const T* held = std::get_if<T>(&trajectory);
  return held ? std::optional(*held) : std::nullopt;
}

void fields(Trajectory& trajectory, auto&& visit) {
  auto still = alternative<Still>(trajectory);
  auto line = alternative<Line>(trajectory);
  auto waypoints = alternative<Waypoints>(trajectory);
  auto circle = alternative<Circular>(trajectory);
  visit({"still", "the actor does not move", kOneOfThese}, still);
  visit({"line", "it moves straight", kOneOfThese}, line);
  visit({"waypoints",
         "`[[time, x, y], ...]`, two or more: straight and uniform in between; times count from "
         "the start trigger, and increase",
         kOneOfThese},
        waypoints);
  visit({"circle", "it moves round a centre", kOneOfThese}, circle);
  visit.exactly_one_of({"still", "line", "waypoints", "circle"});
  // `still` is the default, which any other given key overrides.
  if (still) trajectory = *still;
  if (line) trajectory = *line;
  if (waypoints) trajectory = *waypoints;
  if (circle) trajectory = *circle;
}

void fields(StartTrigger& start, auto&& visit) {
  auto& [at_s, ego_within_m] = start;
  visit({"time", "the actor starts not before this time"}, at_s, kTime);
  visit({"ego_within", "nor before the ego is as near as this, from origin to origin in the plane",
         "at any distance"},
        ego_within_m, kDistance);
}

void fields(Actor& actor, auto&& visit) {
  auto& [name, source, body, shape, shape_file, size_m, texture, pose, kind, trajectory, joints,
         start] = actor;
  std::optional<Shape> added;
  if (!body) added = shape;
  visit({"shape",
         "adds one to the scene: `box`, `cylinder`, `pedestrian` (rigid), `walker` (a pedestrian "
         "whose limbs move), `car`, or one's own (scenes/README.md): a path relative to this file",
         kOneOfThese},
        added, OwnFileOr{{"box", "cylinder", "pedestrian", "car", "walker"}, shape_file});
  if (added) shape = *added;
  visit({"body", "the name of a body of the scene: moves that one", kOneOfThese}, body);
  visit.exactly_one_of({"shape", "body"});
  visit({"size",
         "of a shape: [length, width, height]; a cylinder stays round, at the geometric mean of "
         "length and width",
         "the shape's own"},
        size_m, kSize);
  visit({"texture",
         "of a shape, for its material `paint`: a style of procedural texture (`rects`, `bricks`, "
         "`windows` and others of `sim/scene/texture.cpp`), or a `.png` file, relative to this one",
         "the shape's own"},
        texture, StyleOrPicture{});
  visit({"pose",
         "of a shape with joints: they stay as in this keyframe of its file, or at `zero`; or it "
         "is `walking` (scenes/README.md)",
         "it has no joints; a walker is `walking`"},
        pose);
  visit({"class",
         "in COCO and MOT: a name of MOTChallenge (`pedestrian`, `car`, `bicycle`, `motorbike`, "
         "...), or any other",
         "the shape's; `object` of one's own shape and of a body"},
        kind);
  std::optional<Trajectory> moved;
  if (joints.empty()) moved = trajectory;
  visit({"trajectory", "how the actor moves", kOneOfThese}, moved);
  if (moved) trajectory = *moved;
  visit({"joint",
         "of a body of the scene, as a door: hinges and slides in it, by name, each with "
         "`[[time, angle or length], ...]` as `waypoints`; its other joints do not move",
         kOneOfThese},
        joints);
  visit.exactly_one_of({"trajectory", "joint"});
  visit.at_most_one_of({"shape", "joint"});
  visit({"start", "when it starts: both conditions hold", "at once"}, start);
}

/// The names of `Recorded::Split`, in its order.
inline constexpr std::array<const char*, 3> kSplits{"train", "validate", "test"};

// --- recorded frames

void fields(RecordingSource::Topics& topics, auto&& visit) {
  auto& [image, camera_info, imu, poses, odometry, world] = topics;
  constexpr const char* kOnly = "the only one of its kind";
  visit({"image", "of `sensor_msgs/Image` or `CompressedImage`",
         "required of a bag; the message lists its topics"},
        image);
  visit({"camera_info", "of `sensor_msgs/CameraInfo`", "that beside the images"}, camera_info);
  visit({"imu", "of `sensor_msgs/Imu`", kOnly}, imu);
  visit({"poses",
         "of `PoseStamped`, `PoseWithCovarianceStamped`, `TransformStamped`, `nav_msgs/Odometry` "
         "or tf, in place of an IMU",
         "none, or the only one if there is no IMU"},
        poses);
  visit({"odometry", "of `nav_msgs/Odometry`: its velocities beside the IMU", "none"}, odometry);
  visit({"world", "frame of poses that come from tf, as `map`", "none"}, world);
}

void fields(RecordingSource& recorded, auto&& visit) {
  auto& [source, path, format, camera, topics, fps, times, time_unit, every, poses, imu, odometry,
         speed_mps, time_offset_s, calibration, imu_calibration, focal_px, centre_px, distortion,
         bayer, bits, camera_height_m, mount_rpy_rad, mask, at_rest_s, labels, labels_video,
         nothing_moves, split] = recorded;
  visit({"path", "a folder, a video or a ROS bag", kRequired}, path, FolderOrFile{});
  visit({"format", "the layout of the files", "recognised from the files"}, format,
        Words{{kRecordingFormats.begin(), kRecordingFormats.end()}});
  visit({"camera", "one of several, as `cam1`, `image_02`, `mono_rear`", "the layout's first"},
        camera);
  visit({"topics", "of a ROS bag"}, topics);
  visit({"fps", "pictures a second, where the layout has no times", "a video's own times"}, fps,
        kSensorRate);
  visit({"times",
         "when the pictures of a video or folder were taken: a time a line, or a table with a "
         "column of times; one row a picture, in their order or with their names",
         "the layout's own"},
        times, File{});
  visit.at_most_one_of({"fps", "times"});
  visit({"time_unit", "of times in tables and in names of pictures",
         "by the header, or by the rates that the recording states"},
        time_unit, Words{{"s", "ms", "us", "ns"}});
  visit({"every", "only every n-th picture is a frame"}, every, Whole{1, 10000});
  visit(
      {"poses",
       "how the camera moved: lines of TUM (`t x y z qx qy qz qw`), of KITTI odometry (12 numbers, "
       "line k of picture k) or others (tools/replay/README.md); x right, y down, z ahead",
       "the layout's own"},
      poses, File{});
  visit({"odometry",
         "beside `imu`: velocities by the wheels, and yaw rates if there are some, CSV as `lcs "
         "generate` writes them",
         "none"},
        odometry, File{});
  visit({"imu",
         "in place of `poses`: a table of readings (tools/replay/README.md); axes are the "
         "vehicle's (x ahead, y left, z up), which starts upright, or any if `calibration` states "
         "the camera's place on the IMU",
         odometry ? kRequired : "the layout's own"},
        imu, File{});
  visit({"speed",
         "without `poses`: ahead, along the optical axis, at all times, and how the camera turns "
         "is not known; with `imu` at the start",
         "none"},
        speed_mps, kSignedSpeed);
  visit({"time_offset", "of pictures to the IMU, as `camera.time_offset`",
         "the calibration's `timeshift_cam_imu`, else 0"},
        time_offset_s, kTimeOffset);
  for (const char* key : {"imu", "odometry", "speed", "time_offset"}) {
    visit.at_most_one_of({"poses", key});
  }
  visit({"calibration",
         "of the camera, in place of the layout's: YAML of Kalibr (camchain), OpenCV, ROS "
         "(`camera_info`), ORB-SLAM3, VINS-Fusion or OpenVINS; with `camera` one of several",
         "the layout's own"},
        calibration, File{});
  visit({"imu_calibration", "noise densities of the IMU, as Kalibr's `imu.yaml` has them",
         "the layout's own, else none; told"},
        imu_calibration, File{});
  visit({"focal", "focal length, or `[fx, fy]`; the layout's calibration is then left aside",
         "the layout's own"},
        focal_px, OneOrTwo{kFocal});
  visit({"centre", "principal point", "the calibration's, with `focal` the middle"}, centre_px,
        kInPicture);
  visit({"distortion", kDistortionKey, "the calibration's, with `focal` none"}, distortion);
  visit({"bayer", "pattern of raw pictures, from the top left pixel on", "they are not raw"}, bayer,
        Words{{"rggb", "bggr", "grbg", "gbrg"}});
  visit({"bits", "that the values of 16-bit pictures use",
         "the least of 8, 10, 12, 14 and 16 that all pictures keep to"},
        bits, Whole{8, 16});
  visit({"camera_height", "of the camera above the ground", "not known"}, camera_height_m,
        kDistance);
  visit({"mount",
         "[roll, pitch, yaw] of the camera in the vehicle, as `camera.rotation`; in place of the "
         "attitude of `poses` it gives the vertical",
         "straight ahead for `imu`, else not known"},
        mount_rpy_rad, kAngle);
  visit({"mask",
         "a picture of the same size, white where the vehicle itself is seen: corners there are "
         "left out",
         "none"},
        mask, File{});
  visit({"at_rest",
         "how long the camera stands at the start: with `imu` this gives biases and the vertical",
         "as long as the readings are still, if that is a second at least and there is no `speed`"},
        at_rest_s, kDuration);
  visit({"labels",
         "boxes of all that moves: MOTChallenge's `gt.txt`, COCO's JSON, or KITTI tracking's",
         "none"},
        labels, File{});
  visit({"labels_video", "of the videos in a file of labels, by its name", "the only one"},
        labels_video);
  visit({"nothing_moves", "in place of `labels`: every rebel is false"}, nothing_moves);
  if (nothing_moves) visit.at_most_one_of({"labels", "nothing_moves"});
  visit({"split", "the use of its figures; a group of that name has the scenario, too", "none"},
        split, Words{{kSplits.begin(), kSplits.end()}});
}

// --- the whole

void fields(Origin& origin, auto&& visit) {
  auto& [source, family, seed, again, features] = origin;
  visit({"family", "of worlds, as `room`", kRequired}, family);
  visit({"seed", "that the world was drawn from; `seed` of the scenario may be another", kRequired},
        seed);
  visit({"again", "worlds of this seed that were thrown away before this one"}, again,
        Whole{0, 1'000'000});
  visit({"features", "that occur in it", "none"}, features);
}

void fields(Criterion& criterion, auto&& visit) {
  auto& [metric, min, max, required, source, detector, over] = criterion;
  visit({"metric", "a key of `metrics.json`", kRequired}, metric);
  visit({"min", "least value; `min`, `max` or both are given", "none"}, min, kBound);
  visit({"max", "largest value", "none"}, max, kBound);
  visit({"required", "`lcs run` exits with 1 when the criterion does not hold"}, required);
  visit({"detector", "the detector of the run that is judged, by its name", "the run's own"},
        detector);
  visit({"over",
         "`seed`: each run is judged; `mean`: the mean over a suite's seeds; `interval`: the 95 % "
         "interval of that mean, all of which has to keep the bounds"},
        over, Words{{kOver.begin(), kOver.end()}});
}

struct CornerKeys {
  CornerSource from = CornerSource::pictures;
  std::optional<int> threshold = kFastThreshold;
};

void fields(CornerKeys& corners, auto&& visit) {
  auto& [from, threshold] = corners;
  visit({"from",
         "`pictures`: FAST; `events`: Arc* (`filter/detect/event_corners.h`), on the events since "
         "the frame before"},
        from, Words{{"pictures", "events"}});
  visit({"threshold",
         "of the FAST detector, in grey levels; `auto`: by the noise and the compression of each "
         "picture (`filter/detect/picture_noise.h`), 20 where there is little"},
        threshold, OrWord<Whole>{{1, 254}, "auto"});
  if (from == CornerSource::events) visit.in_place_of("from", {"threshold"});
}

inline const Scenario& default_scenario() {
  static const Scenario scenario;
  return scenario;
}

struct TruthKeys {
  double min_depth_m = default_scenario().truth_min_depth_m;
};

void fields(TruthKeys& truth, auto&& visit) {
  auto& [min_depth_m] = truth;
  visit({"min_depth",
         "nearest depth that a static corner may have, when the truth decides whether a motion is "
         "radial"},
        min_depth_m, kDistance);
}

void fields(Scenario& scenario, auto&& visit) {
  auto& [name, file, purpose, groups, recording, scene, scene_source, pose, origin, seed, frames,
         ego, camera, cameras, filter_camera, rig_place, imu, odometry, ego_motion, events,
         corner_source, fast_threshold, truth_min_depth_m, image, ground, actors, filter_preset,
         filter_preset_source, filter, criteria, world, sweep] = scenario;
  visit({"purpose", "one line for people", "none"}, purpose);
  visit({"groups", "list of the groups that a suite chooses by, as in `[short, night]`"}, groups,
        GroupNames{});
  visit({"scene",
         "a scene of `scenes/` by its name, or a path ending in `.xml`, relative to this file",
         kOneOfThese},
        scene, SceneName{scene_source});
  visit({"pose",
         "of the scene's joints: they stay as in this keyframe of the scene, or at `zero`; bodies "
         "with a free joint alone start there",
         "they are loose"},
        pose);
  visit(
      {"recording", "recorded frames in place of a scene and all that belongs to it", kOneOfThese},
      recording);
  visit.exactly_one_of({"scene", "recording"});
  visit({"origin",
         "`{family: room, seed: 7, again: 0, features: [slope]}`: the world that `lcs world` drew "
         "it as. It stays that world with any seed; each run states it in `truth.jsonl`, and `lcs "
         "tune` takes none of the split test. A scene may state it too, by `<custom><text "
         "name=\"lcs.world\" data=\"room 7\"/></custom>`; then both must agree",
         "as the scene states it"},
        origin);
  visit({"seed",
         "of textures, bumps, rain, IMU noise, odometry and the camera's noise; each draws from a "
         "stream of its own"},
        seed);
  visit({"ego", "the rover", recording ? "none" : kRequired}, ego);
  visit({"camera", "the rover's camera"}, camera);
  visit({"cameras",
         "in place of `camera`: a rig, as `{left: {...}, right: {...}}`, each with the keys of "
         "`camera`; all have one rate and take their pictures at the same times",
         "none"},
        cameras);
  visit.in_place_of("cameras", {"camera"});
  visit({"filter_camera", "the one of `cameras` that detectors get", "the first"}, filter_camera);
  if (!cameras.empty()) camera = cameras.front().camera;
  std::optional<int> count;
  if (frames > 0) count = frames;
  visit({"frames", "of the camera; frame k is at k / rate", kOneOfThese}, count,
        Whole{1, kMostFrames});
  std::optional<int> before;
  visit({"duration", "in place of `frames`: all frames before this time", kOneOfThese}, before,
        FramesBefore{camera.rate_hz});
  if (!recording) visit.exactly_one_of({"frames", "duration"});
  frames = before.value_or(count.value_or(0));
  visit({"imu", "the rover's IMU"}, imu);
  std::optional<Odometry> measured;
  if (odometry.enabled) measured = odometry;
  visit({"odometry", "of the wheels", "none"}, measured);
  if (measured) {
    odometry = *measured;
    odometry.enabled = true;
  }
  visit({"events", "of event pixels, one for each pixel of the camera; `{}` has the defaults",
         "none"},
        events);
  TruthKeys truth{truth_min_depth_m};
  visit({"truth", "how the truth is made"}, truth);
  truth_min_depth_m = truth.min_depth_m;
  visit({"image", "what the camera makes of the scene", "a real sensor's noise"}, image);
  visit({"ground", "bumps on the floor", "level"}, ground);
  visit({"actors", "who else moves, by name", "none"}, actors);
  visit.in_place_of(
      "recording", {"scene", "pose", "origin", "seed", "ego", "camera", "cameras", "filter_camera",
                    "duration", "imu", "odometry", "events", "truth", "image", "ground", "actors"});
  visit({"ego_motion",
         "what the filter is told of the rover's own motion: `imu` integrates the simulated IMU "
         "(with odometry, if there is some); `truth` is for experiments"},
        ego_motion, Words{{"imu", "truth"}});
  CornerKeys corners{corner_source, fast_threshold};
  visit({"corners", "how corners are found"}, corners);
  fast_threshold = corners.threshold;
  corner_source = corners.from;
  visit({"filter", "parameters of the filter", "its own"}, filter,
        FilterParameters{filter_preset, filter_preset_source});
  visit({"criteria", "bounds on the metrics", "none"}, criteria);
  visit({"sweep", "keys and the values that a suite runs them with: to 1000 points", "none"},
        sweep);
}

/// A type that corresponds to a map in a scenario file.
template <class T>
concept HasFields = requires(T& object) {
  fields(object, 0);
};

}  // namespace lcs::scenario
