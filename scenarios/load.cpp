#include "scenarios/load.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <system_error>

#include "scenarios/fields.h"
#include "scenarios/input/inputs_read.h"
#include "scenarios/input/reader.h"
#include "scenarios/scenes.h"

namespace lcs::scenario {
namespace {

/// A value to read, its path in messages, and the folder of the scenario.
struct Item {
  const input::Value& value;
  std::string path;
  const fs::path& folder;

  Item at(std::size_t index, const input::Value& item) const {
    return {item, path + "." + std::to_string(index), folder};
  }
  /// \param what follows the path.
  [[noreturn]] void refuse(const std::string& what) const {
    throw input::Error(value.where, path + what);
  }
};

// --- checks of a whole map, after its keys

void complete(input::Reader&, auto&) {}

void complete(input::Reader& reader, Ego& ego) {
  if (!ego.path.empty()) {
    ego.start_m = ego.path.front().position_m.head<2>();
    ego.heading_rad = ego.path.front().rpy_rad.z();
  }
  if (ego.waypoints.empty()) return;
  ego.start_m = ego.waypoints.front().position_m;
  const auto elsewhere = std::ranges::find_if(
      ego.waypoints, [&](const Waypoint& point) { return point.position_m != ego.start_m; });
  if (elsewhere == ego.waypoints.end()) {
    reader.refuse("waypoints",
                  " lead nowhere: all are one place; make one of them another, or give start and "
                  "heading for a rover that stands");
  }
  const Eigen::Vector2d way = elsewhere->position_m - ego.start_m;
  ego.heading_rad = std::atan2(way.y(), way.x());
}

void complete(input::Reader&, Imu& imu) {
  if (imu.noise != imu_preset(imu.preset)) imu.preset = "custom";
}

constexpr double kRounding = 1e-5;  // calibrations are printed with some digits

bool is_rotation(const Eigen::Matrix3d& R) {
  return (R * R.transpose()).isIdentity(kRounding) && R.determinant() > 0;
}

void require_lower_triangular(input::Reader& reader, const Eigen::Matrix3d& M) {
  if (M.isLowerTriangular() && (M.diagonal().array() > 0).all()) return;
  reader.refuse("M",
                " is not lower triangular with a diagonal above 0, as Kalibr's is; give "
                "[[x, 0, 0], [yx, y, 0], [zx, zy, z]], with 1 for an exact scale");
}

void complete(input::Reader& reader, Gyroscopes& gyroscopes) {
  require_lower_triangular(reader, gyroscopes.M);
  if (is_rotation(gyroscopes.C_gyro_i)) return;
  reader.refuse("C_gyro_i", " is no rotation; give three rows of one, as Kalibr writes them");
}

void complete(input::Reader& reader, Accelerometers& accelerometers) {
  require_lower_triangular(reader, accelerometers.M);
}

void complete(input::Reader& reader, Criterion& criterion) {
  if (!criterion.min && !criterion.max) {
    throw input::Error(criterion.source, reader.path() + " has no bound; give min, max or both");
  }
  if (criterion.min && criterion.max && *criterion.min > *criterion.max) {
    throw input::Error(criterion.source,
                       reader.path() + " has its min above its max; exchange them");
  }
}

/// Rejects a missing start: only a body of the scene has a default position.
void require_place(const Actor& actor, const std::string& path) {
  const auto* still = std::get_if<Still>(&actor.trajectory);
  const auto* line = std::get_if<Line>(&actor.trajectory);
  std::string missing;
  if (still && !still->position_m) missing = "still.position";
  if (line && !line->heading_rad) missing = "line.heading";
  if (line && !line->from_m) missing = "line.from";
  if (missing.empty()) return;
  throw input::Error(actor.source,
                     "{} has a shape of its own and so needs trajectory.{}; add it (only a body of "
                     "the scene has a place there)",
                     path, missing);
}

void complete(input::Reader& reader, Actor& actor) {
  if (!actor.body) return require_place(actor, reader.path());
  for (const char* key : {"size", "texture"}) {
    if (!reader.find(key)) continue;
    reader.refuse(key,
                  " is given for a body of the scene, which has its own; remove it, or give "
                  "'shape' in place of 'body'");
  }
}

// --- values by their type and form

void read_value(const Item& item, const input::Quantity& quantity, double& out) {
  out = input::as_quantity(item.value, item.path, quantity);
}

template <std::integral T>
void read_value(const Item& item, const Whole& form, T& out) {
  out = static_cast<T>(input::as_integer(item.value, item.path, form.low, form.high));
}

void read_value(const Item& item, Plain, std::uint64_t& seed) {
  seed = input::as_seed(item.value, item.path);
}

void read_value(const Item& item, Plain, bool& out) {
  out = input::as_choice(item.value, item.path, {"false", "true"}) == 1;
}

void read_value(const Item& item, Plain, std::string& out) {
  out = input::as_text(item.value, item.path);
}

void read_value(const Item& item, const Words& form, std::string& out) {
  out = form.words[input::as_choice(item.value, item.path, form.words)];
}

template <Enumeration Enum>
void read_value(const Item& item, const Words& form, Enum& out) {
  out = static_cast<Enum>(input::as_choice(item.value, item.path, form.words));
}

template <Enumeration Enum>
void read_value(const Item& item, const OwnFileOr& form, Enum& out) {
  const input::Value& value = item.value;
  if (value.kind == input::Value::Kind::scalar && value.text.ends_with(".xml")) {
    out = Enum::own;
    form.file = file_beside(value, item.folder, item.path + ": there is no file ");
  } else {
    out = static_cast<Enum>(
        input::as_choice(value, item.path, form.words,
                         "the path of an .xml file (with size and ground; it may attach a .urdf)"));
  }
}

template <class Number, int N, class Form>
void read_value(const Item& item, const Form& form, Eigen::Matrix<Number, N, 1>& out) {
  const std::vector<input::Value>& list = input::as_list(item.value, item.path, N);
  for (std::size_t i = 0; i < list.size(); ++i) {
    read_value(item.at(i, list[i]), form, out[static_cast<Eigen::Index>(i)]);
  }
}

void read_value(const Item& item, const input::Quantity& quantity, Eigen::Matrix3d& out) {
  const std::vector<input::Value>& rows = input::as_list(item.value, item.path, 3);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Eigen::Vector3d row;
    read_value(item.at(i, rows[i]), quantity, row);
    out.row(static_cast<Eigen::Index>(i)) = row;
  }
}

void read_value(const Item& item, const OneOrTwo& form, Eigen::Vector2d& out) {
  if (item.value.kind == input::Value::Kind::list) {
    read_value(item, form.quantity, out);
  } else {
    out.setConstant(input::as_quantity(item.value, item.path, form.quantity));
  }
}

template <class T, class Form>
void read_value(const Item& item, const Form& form, std::optional<T>& out) {
  T value{};
  read_value(item, form, value);
  out = std::move(value);
}

template <class T, class Form>
void read_value(const Item& item, const OrWord<Form>& form, std::optional<T>& out) {
  if (item.value.kind == input::Value::Kind::scalar && item.value.text == form.word) {
    out.reset();
  } else if constexpr (std::is_same_v<Form, Whole>) {
    out = static_cast<T>(input::as_integer(item.value, item.path, form.form.low, form.form.high,
                                           " or " + std::string(form.word)));
  } else {
    read_value(item, form.form, out);
  }
}

template <class T, class Form>
void read_value(const Item& item, const Form& form, std::vector<T>& out) {
  for (const input::Value& value : input::as_list(item.value, item.path)) {
    const Item next = item.at(out.size(), value);
    read_value(next, form, out.emplace_back());
  }
}

void read_value(const Item& item, const SceneName& form, fs::path& out) {
  out = find_scene(item.value, item.folder);
  form.source = item.value.where;
}

void read_value(const Item& item, File, fs::path& out) {
  input::as_text(item.value, item.path);
  out = file_beside(item.value, item.folder, item.path + ": there is no file ");
  input::note_input(out);
}

void read_value(const Item& item, FolderOrFile, fs::path& out) {
  out = item.folder / input::as_text(item.value, item.path);
  std::error_code none;  // for a name that no file can have
  if (!fs::is_directory(out, none) && !fs::is_regular_file(out, none)) {
    item.refuse(": there is no folder or video " + out.string() + "; " + path_remedy(item.folder));
  }
  input::note_input(out);
}

void read_value(const Item& item, StyleOrPicture, std::string& out) {
  out = input::as_text(item.value, item.path);
  if (!out.ends_with(".png")) return;
  out = file_beside(item.value, item.folder, item.path + ": there is no picture ").string();
}

/// Number of frames at 0, 1/rate, 2/rate, ... before the end.
void read_value(const Item& item, const FramesBefore& form, int& frames) {
  constexpr double rounding = 1e-6;  // 0.3 s at 10 Hz is 3 frames, despite binary rounding
  const double duration_s = input::as_quantity(item.value, item.path, kDuration);
  const double count = std::ceil(duration_s * form.rate_hz - rounding);
  if (count > kMostFrames) {
    throw input::Error(item.value.where, "duration '{}' makes more than {} frames; shorten it",
                       item.value.text, kMostFrames);
  }
  frames = std::max(1, static_cast<int>(count));
}

void read_value(const Item& item, Plain, Distortion& out) {
  input::Value list = item.value;
  std::string path = item.path;
  if (list.kind == input::Value::Kind::map) {
    input::Reader reader(item.value, path);
    const input::Value* coefficients = reader.require("equidistant");
    reader.finish();
    list = *coefficients;
    path = reader.path_of("equidistant");
    out.equidistant = true;
  }
  input::as_list(list, path, out.equidistant ? 4 : 5);
  read_value(Item{list, path, item.folder}, kCoefficient, out.coefficients);
}

/// Reads a list of two or more elements: an increasing time, and `length` - 1 other numbers.
/// \param read_number reads the one of these at a place from 0 on.
template <class T>
void read_timed(const Item& item, std::size_t length, std::string_view what_to_give,
                std::vector<T>& out, const auto& read_number) {
  for (const input::Value& value : input::as_list(item.value, item.path)) {
    const Item next = item.at(out.size(), value);
    const std::vector<input::Value>& numbers = input::as_list(value, next.path, length);
    T timed;
    read_value(next.at(0, numbers[0]), kTime, timed.at_s);
    for (std::size_t i = 1; i < length; ++i) {
      read_number(next.at(i, numbers[i]), static_cast<Eigen::Index>(i) - 1, timed);
    }
    if (!out.empty() && timed.at_s <= out.back().at_s) {
      next.refuse(" is at '" + numbers[0].text +
                  "', not after the one before; make the times increase");
    }
    out.push_back(timed);
  }
  if (out.size() < 2) item.refuse(fmt::format(" has fewer than two {}", what_to_give));
}

void read_value(const Item& item, Plain, std::vector<Waypoint>& points) {
  read_timed(item, 3, "waypoints; give two or more [time, x, y]", points,
             [](const Item& number, Eigen::Index i, Waypoint& point) {
               read_value(number, kPosition, point.position_m[i]);
             });
}

void read_value(const Item& item, Plain, std::vector<PathPose>& path) {
  read_timed(item, 7, "poses; give two or more [time, x, y, z, roll, pitch, yaw]", path,
             [](const Item& number, Eigen::Index i, PathPose& pose) {
               i < 3 ? read_value(number, kPosition, pose.position_m[i])
                     : read_value(number, kAngle, pose.rpy_rad[i - 3]);
             });
}

void read_value(const Item& item, Plain, std::vector<JointMotion>& joints) {
  const input::Reader names(item.value, item.path);
  for (const input::Entry& entry : item.value.entries) {
    joints.push_back({entry.key, entry.where, {}});
    read_timed(Item{entry.value, names.path_of(entry.key), item.folder}, 2,
               "waypoints; give two or more [time, angle] of a hinge, or [time, length] of a slide",
               joints.back().points, [](const Item& number, Eigen::Index, JointPoint& point) {
                 const std::string& text = number.value.text;
                 point.is_angle = text.ends_with("deg") || text.ends_with("rad");
                 read_value(number, point.is_angle ? kJointAngle : kPosition, point.value);
               });
  }
  if (joints.empty()) item.refuse(" has no joint; give {NAME: [[0 s, 0 deg], [2 s, 80 deg]]}");
}

/// Gaps begin after 0, because the estimator takes its initial state from the reading at 0.
void read_value(const Item& item, Plain, std::vector<TimeSpan>& gaps) {
  for (const input::Value& value : input::as_list(item.value, item.path)) {
    const Item next = item.at(gaps.size(), value);
    const std::vector<input::Value>& pair = input::as_list(value, next.path, 2);
    const TimeSpan gap{input::as_quantity(pair[0], next.path + ".0", kDuration),
                       input::as_quantity(pair[1], next.path + ".1", kDuration)};
    if (gap.to_s <= gap.from_s || (!gaps.empty() && gap.from_s < gaps.back().to_s)) {
      next.refuse(fmt::format(" is [{}, {}]; make the times increase, from each gap to the next",
                              pair[0].text, pair[1].text));
    }
    gaps.push_back(gap);
  }
}

constexpr std::string_view kNameChars = "abcdefghijklmnopqrstuvwxyz0123456789_-";

/// Calls `read` for each value of a list of one or more distinct ones.
void read_distinct(const Item& list, std::string_view remedy, const auto& read) {
  std::set<std::string> known;
  for (const input::Value& value : input::as_list(list.value, list.path)) {
    read(list.at(known.size(), value));
    const std::string text = input::line_of(value);
    if (known.insert(text).second) continue;
    throw input::Error(value.where, list.path + " has '" + text + "' twice; remove one");
  }
  if (known.empty()) list.refuse(fmt::format(" is an empty list; {}", remedy));
}

void read_value(const Item& item, GroupList, std::vector<int>& groups) {
  groups.clear();
  read_distinct(item, "nothing would be drawn: give one or more, or remove the key",
                [&](const Item& group) {
                  read_value(group, Whole{0, 5}, groups.emplace_back());
                });
}

void read_value(const Item& item, GroupNames, std::vector<std::string>& groups) {
  groups.clear();
  read_distinct(item, "give one or more, or remove the key", [&](const Item& group) {
    groups.push_back(input::as_text(group.value, group.path));
    if (groups.back().find_first_not_of(kNameChars) == std::string::npos) return;
    throw input::Error(group.value.where,
                       "the group '{}' has other characters than a-z, 0-9, '_' and '-'; rename it",
                       groups.back());
  });
}

/// The filter checks names and values.
void read_value(const Item& item, const FilterParameters& form,
                std::vector<FilterSetting>& settings) {
  const input::Reader reader(item.value, item.path);
  for (const input::Entry& entry : item.value.entries) {
    const std::string& text = input::as_text(entry.value, reader.path_of(entry.key));
    if (entry.key == "preset") {
      form.preset = text;
      form.source = entry.value.where;
      continue;
    }
    settings.push_back({entry.key, text, entry.value.where});
  }
}

/// Keys without effect on a run, and the seed, which the suite varies.
constexpr std::array<std::string_view, 5> not_to_be_swept = {"sweep", "groups", "purpose", "origin",
                                                             "seed"};

SweptKey read_key(const input::Entry& entry) {
  const std::string path = "sweep." + entry.key;
  if (std::ranges::count(not_to_be_swept, entry.key) > 0) {
    throw input::Error(
        entry.where, "{} cannot be swept; {}", path,
        entry.key == "seed" ? "the number of seeds is the suite's option" : "remove it");
  }
  SweptKey swept{entry.key, {}, entry.where};
  const fs::path nowhere;
  read_distinct(Item{entry.value, path, nowhere}, "give one or more values", [&](const Item& one) {
    if (one.value.kind == input::Value::Kind::null) one.refuse(" is nothing; give a value");
    swept.values.push_back({input::line_of(one.value), one.value.where});
  });
  return swept;
}

/// Checks the syntax only. Unknown keys and values fail when a point is loaded.
void read_value(const Item& item, Plain, std::vector<SweptKey>& sweep) {
  const input::Reader keys(item.value, item.path);
  for (const input::Entry& entry : item.value.entries) sweep.push_back(read_key(entry));
  if (sweep.empty()) {
    throw input::Error(item.value.where,
                       "sweep is an empty map; give keys, as in {ego.speed: [0.2, 0.4]}");
  }
}

/// Checks that the first exposure and gain are ones that the control may choose.
void complete(input::Reader& reader, Image& image) {
  constexpr std::array kSamples{1, 4, 5, 9};
  if (std::ranges::find(kSamples, image.samples) == kSamples.end()) {
    reader.refuse("samples", fmt::format(" is {}; give 1, 4, 5 or 9", image.samples));
  }
  if (image.shadows && image.headlights) {
    reader.refuse("headlights",
                  " light places that the shadows of other lights leave dark, which the simulator "
                  "does not draw; remove them, or image.shadows");
  }
  if (!image.auto_exposure) return;
  input::Reader inner(*reader.find("auto_exposure"), reader.path_of("auto_exposure"));
  const auto require_within = [&](const char* key, double first, const Eigen::Vector2d& bounds) {
    if (bounds[0] <= first && first <= bounds[1]) return;
    const input::Value* given = inner.find(key);
    throw input::Error((given ? *given : *reader.find(key)).where,
                       "{} is [{}, {}] without the {} of {}, which the first picture has; give "
                       "[least, most] round it",
                       inner.path_of(key), input::number_text(bounds[0]),
                       input::number_text(bounds[1]), input::number_text(first),
                       reader.path_of(key));
  };
  require_within("gain", image.gain, image.auto_exposure->gain);
  if (const auto& bounds_s = image.auto_exposure->exposure_s) {
    require_within("exposure", image.exposure_s, *bounds_s);
  }
}

/// Takes position and rotation from `T_BC`, and checks that a frame is whole before the next one.
void complete(input::Reader& reader, Camera& camera) {
  const double period_s = 1 / camera.rate_hz;
  const auto require_within = [&](const char* key, double time_s, const std::string& what) {
    if (time_s <= period_s) return;
    reader.refuse(key, fmt::format("{} more than the {} s from one frame to the next; make it "
                                   "shorter, or the rate lower",
                                   what, input::number_text(period_s)));
  };
  require_within(camera.rolling_shutter_s > 0 ? "rolling_shutter" : "exposure",
                 camera.rolling_shutter_s + camera.exposure_s,
                 camera.rolling_shutter_s > 0 && camera.exposure_s > 0
                     ? " and exposure together take"
                     : " takes");
  require_within("time_offset", std::abs(camera.time_offset_s), " is");
  if (const input::Value* told = reader.find("told")) {
    input::Reader inner(*told, reader.path_of("told"));
    if (std::abs(camera.told.time_offset_error_s) > period_s) {
      inner.refuse("time_offset_error",
                   fmt::format(" is more than the {} s from one frame to the next; make it smaller",
                               input::number_text(period_s)));
    }
  }
  const input::Value* value = reader.find("T_BC");
  if (!value) return;
  const fs::path nowhere;
  std::vector<Eigen::Vector4d> rows;
  read_value(Item{*value, reader.path_of("T_BC"), nowhere}, kCoefficient, rows);
  rows.resize(std::max<std::size_t>(rows.size(), 4), Eigen::Vector4d::Zero());
  Eigen::Matrix4d T;
  T << rows[0].transpose(), rows[1].transpose(), rows[2].transpose(), rows[3].transpose();
  const Eigen::Matrix3d R_BC = T.topLeftCorner<3, 3>();
  if (rows.size() != 4 || T.row(3) != Eigen::RowVector4d(0, 0, 0, 1) || !is_rotation(R_BC)) {
    reader.refuse("T_BC",
                  " is no rigid transform; give four rows: a rotation beside a translation, and "
                  "0 0 0 1");
  }
  camera.mount_position_m = T.topRightCorner<3, 1>();
  Eigen::Matrix3d R;  // of a camera's forward, left and up
  R << R_BC.col(2), -R_BC.col(0), -R_BC.col(1);
  const double pitch = std::asin(std::clamp(-R(2, 0), -1.0, 1.0));
  const bool is_vertical = std::hypot(R(2, 1), R(2, 2)) < 1e-9;  // roll and yaw are one then
  camera.mount_rpy_rad = {
      is_vertical ? std::atan2(-R(1, 2), R(1, 1)) : std::atan2(R(2, 1), R(2, 2)), pitch,
      is_vertical ? 0 : std::atan2(R(1, 0), R(0, 0))};
}

void require_events(input::Reader& reader, const Scenario& scenario) {
  if (scenario.corner_source == CornerSource::events && !scenario.events && !scenario.recording) {
    throw input::Error(
        reader.find("corners")->where,
        "corners.from is 'events', and the camera has no event pixels; add 'events: {}'");
  }
  if (scenario.events && scenario.image.rain) {
    throw input::Error(scenario.events->source,
                       "events see no rain, and image.rain is given; remove one of the two");
  }
}

void require_one_exposure(input::Reader& reader, const Scenario& scenario) {
  const auto smears = [](const Camera& camera) { return camera.exposure_s > 0; };
  const bool is_smeared =
      smears(scenario.camera) || std::ranges::any_of(scenario.cameras, smears, &RigCamera::camera);
  const auto& control = scenario.image.auto_exposure;
  if (!is_smeared || !control || !control->exposure_s) return;
  throw input::Error(
      reader.find("image")->where,
      "image.auto_exposure.exposure changes the exposure, and camera.exposure smears for a "
      "constant time; remove one of them (without the first the gain alone changes)");
}

/// Chooses the camera of the detectors.
void complete(input::Reader& reader, Scenario& scenario) {
  require_events(reader, scenario);
  require_one_exposure(reader, scenario);
  if (scenario.cameras.empty() && scenario.filter_camera.empty()) return;
  const auto found = std::ranges::find(scenario.cameras, scenario.filter_camera, &RigCamera::name);
  if (found == scenario.cameras.end() && !scenario.filter_camera.empty()) {
    reader.refuse("filter_camera",
                  " is '" + scenario.filter_camera +
                      "', and no camera of cameras has that name; give one that has, or remove it");
  }
  const bool is_first = scenario.filter_camera.empty();
  scenario = seen_by(std::move(scenario),
                     is_first ? 0 : static_cast<std::size_t>(found - scenario.cameras.begin()));
  if (scenario.cameras.size() > 1 && scenario.image.rain) {
    throw input::Error(reader.find("image")->where,
                       "image.rain falls before a single camera, and this is a rig of {}; remove "
                       "the rain, or give one camera",
                       scenario.cameras.size());
  }
}

// --- maps

struct ReadFields {
  input::Reader& reader;
  const fs::path& folder;

  template <class T, class Form = Plain>
  void operator()(const Key& key, T& member, const Form& form = {}) const {
    const input::Value* value =
        key.without == kRequired ? reader.require(key.name) : reader.find(key.name);
    if (value) read_value(Item{*value, reader.path_of(key.name), folder}, form, member);
  }
  void at_most_one_of(std::initializer_list<std::string_view> keys) const {
    reader.at_most_one_of(keys);
  }
  void exactly_one_of(std::initializer_list<std::string_view> keys) const {
    reader.exactly_one_of(keys);
  }
  void in_place_of(std::string_view key, std::initializer_list<std::string_view> others) const {
    for (const std::string_view other : others) reader.at_most_one_of({key, other});
  }
};

/// Keys of other simulators, of calibrations and of other maps of a scenario, and the remedy where
/// the map has no such key.
const std::vector<std::pair<std::vector<std::string_view>, std::string_view>> kForeignKeys{
    {{"fx", "fy"}, "give camera.focal: [fx, fy]"},
    {{"cx", "cy"}, "give camera.centre: [cx, cy]"},
    {{"intrinsics"}, "give camera.focal: [fx, fy] and camera.centre: [cx, cy]"},
    {{"distortion_coeffs", "distortion_coefficients"}, "give camera.distortion"},
    {{"distortion_model"}, "give camera.distortion, with {equidistant: ...} for a fisheye"},
    {{"T_BS", "T_imu_cam"}, "give camera.T_BC"},
    {{"T_cam_imu"}, "give its inverse as camera.T_BC"},
    {{"rolling_shutter", "rolling_shutter_time", "rolling_shutter_tr", "readout_time"},
     "give camera.rolling_shutter"},
    {{"rolling_shutter_line_time", "line_delay"},
     "give camera.rolling_shutter: this times the rows"},
    {{"motion_blur", "shutter_speed"}, "give camera.exposure"},
    {{"exposure_time", "exposure"}, "give camera.exposure for blur, image.exposure for brightness"},
    {{"timeshift_cam_imu", "calib_camimu_dt"}, "give camera.time_offset, with the same sign"},
    {{"time_offset"}, "give camera.time_offset"},
    {{"vignetting"}, "give image.vignetting"},
    {{"accelerometer_noise_density", "accel_noise_density"},
     "give imu.accelerometer_noise_density"},
    {{"gyroscope_noise_density", "gyro_noise_density"}, "give imu.gyroscope_noise_density"},
    {{"accelerometer_random_walk"}, "give imu.accelerometer_random_walk"},
    {{"gyroscope_random_walk"}, "give imu.gyroscope_random_walk"},
    {{"acc_n"}, "give imu.accelerometer_noise_density, per sqrt(Hz)"},
    {{"gyr_n"}, "give imu.gyroscope_noise_density, per sqrt(Hz)"},
    {{"acc_w"}, "give imu.accelerometer_random_walk, per sqrt(Hz)"},
    {{"gyr_w"}, "give imu.gyroscope_random_walk, per sqrt(Hz)"},
    {{"update_rate"}, "give imu.rate"},
    {{"rate_hz"}, "give the rate of the sensor as its rate"},
    {{"T_i_b"}, "give imu.position and imu.rotation"},
    {{"stereo"}, "give the rig as cameras: {left: {...}, right: {...}}"},
    {{"auto_exposure", "exposure_mode"}, "give image.auto_exposure"},
    {{"exposure_compensation"}, "give image.auto_exposure.target"},
    {{"exposure_speed_up", "exposure_speed_down"}, "give image.auto_exposure.time_constant"},
    {{"bloom_intensity", "chromatic_aberration_intensity", "lens_flare_intensity"}, ""},
    {{"iso"}, "give image.gain"},
    {{"castshadow"}, "give image.shadows, and castshadow to lights in the scene's file"},
    {{"shadows"}, "give image.shadows"},
    {{"pedestrian"}, "give a shape: pedestrian (rigid) or walker (limbs that move)"},
    {{"walker"}, "give a shape: walker"},
    {{"gait", "animation"}, "give shape: walker, or pose: walking to one's own shape"},
    {{"skin"}, "give shape: walker; an actor has rigid parts alone"}};

void refuse_foreign_keys(const Item& item, const input::Reader& reader) {
  for (const input::Entry& entry : item.value.entries) {
    if (reader.knows(entry.key)) continue;
    const auto found = std::ranges::find_if(kForeignKeys, [&](const auto& foreign) {
      return std::ranges::count(foreign.first, entry.key) > 0;
    });
    if (found == kForeignKeys.end()) continue;
    throw input::Error(entry.where, "unknown key '{}'; {}", entry.key,
                       found->second.empty()
                           ? "the simulator has none of it (scenarios/README.md, 'What the "
                             "simulator has, and has not'); remove it"
                           : found->second);
  }
}

void read_value(const Item& item, Plain, HasFields auto& out) {
  input::Reader reader(item.value, item.path);
  if constexpr (requires { out.source; }) out.source = reader.where();
  fields(out, ReadFields{reader, item.folder});
  refuse_foreign_keys(item, reader);
  reader.finish();
  complete(reader, out);
}

/// The ego's own keys are the first phase, already in `phases`.
void read_value(const Item& item, Plain, std::vector<EgoPhase>& phases) {
  for (const input::Value& value : input::as_list(item.value, item.path)) {
    const EgoPhase before = phases.back();
    const Item next = item.at(phases.size() - 1, value);
    input::Reader reader(value, next.path);
    EgoPhase& phase = phases.emplace_back(before);
    const input::Value* const at = reader.find("at");
    if (at) phase.at_s = input::as_quantity(*at, reader.path_of("at"), kTime);
    const double after_s = phase.at_s - before.at_s;
    phase.speed_mps = std::max(0.0, before.speed_mps + before.acceleration_mps2 * after_s);
    read_value(next, Plain{}, phase);
    if (phase.at_s > before.at_s) continue;
    reader.refuse(
        "at", fmt::format(" is '{}', not after the phase before ({} s); make the times increase",
                          at->text, input::number_text(before.at_s)));
  }
}

/// Names are also parts of `--set` paths.
/// \param owner as "the actor's".
void check_name(const input::Entry& entry, const std::string& owner) {
  const std::string chars = std::string(kNameChars) + "ABCDEFGHIJKLMNOPQRSTUVWXYZ";
  if (entry.key.find_first_not_of(chars) == entry.key.npos) return;
  throw input::Error(
      entry.where, "{} name '{}' has other characters than letters, digits, '_' and '-'; rename it",
      owner, entry.key);
}

void read_value(const Item& item, Plain, std::vector<Actor>& actors) {
  const input::Reader names(item.value, item.path);
  for (const input::Entry& entry : item.value.entries) {
    // it is also the name of a body in the world
    if (entry.key == "ego") {
      throw input::Error(entry.where,
                         "an actor is called 'ego', which is the rover's name; rename it");
    }
    check_name(entry, "the actor's");
    Actor& actor = actors.emplace_back();
    actor.name = entry.key;
    read_value(Item{entry.value, names.path_of(entry.key), item.folder}, Plain{}, actor);
  }
}

void read_value(const Item& item, Plain, std::vector<RigCamera>& cameras) {
  const input::Reader names(item.value, item.path);
  for (const input::Entry& entry : item.value.entries) {
    check_name(entry, "the camera's");
    RigCamera& one = cameras.emplace_back();
    one.name = entry.key;
    one.source = entry.where;
    read_value(Item{entry.value, names.path_of(entry.key), item.folder}, Plain{}, one.camera);
    const auto require_same = [&](double Camera::*member, const char* quantity) {
      if (one.camera.*member == cameras.front().camera.*member) return;
      throw input::Error(one.source,
                         "{} has another {} than the camera before it; give all of a rig one {}",
                         names.path_of(entry.key), quantity, quantity);
    };
    require_same(&Camera::rate_hz, "rate");
    require_same(&Camera::time_offset_s, "time_offset");
  }
  if (cameras.empty() || cameras.size() > kMostCameras) {
    item.refuse(fmt::format(" has {} cameras; give 1 to {}, as {{left: {{...}}, right: {{...}}}}",
                            cameras.size(), kMostCameras));
  }
}

/// The keys that determine sensor data and truth, except for the seed.
std::map<std::string, std::string> world_of(const input::Value& root) {
  constexpr std::array<std::string_view, 7> kNotOfTheWorld{"purpose", "groups",   "origin", "seed",
                                                           "filter",  "criteria", "sweep"};
  input::Value world(input::Value::Kind::map, root.where);
  std::ranges::copy_if(
      root.entries, std::back_inserter(world.entries),
      [&](const auto& key) { return std::ranges::count(kNotOfTheWorld, key) == 0; },
      &input::Entry::key);
  return input::flattened(world);
}

}  // namespace

Scenario load(const std::filesystem::path& file, const LoadOptions& options) {
  return load(input::parse_file(file), file, options);
}

Scenario load(input::Value root, const std::filesystem::path& file, const LoadOptions& options) {
  for (const std::string& assignment : options.sets) input::apply_set(root, assignment);
  Scenario scenario;
  scenario.name = file.stem().string();
  scenario.file = file;
  if (input::Reader(root, "").find("recording")) {
    scenario.fast_threshold.reset();  // each camera has its own noise level
  } else {
    scenario.imu.noise = imu_preset(scenario.imu.preset).value();
  }
  read_value(Item{root, "", file.parent_path()}, Plain{}, scenario);
  if (scenario.recording && scenario.recording->split) {
    const std::string split = kSplits.at(static_cast<std::size_t>(*scenario.recording->split));
    if (std::ranges::count(scenario.groups, split) == 0) scenario.groups.push_back(split);
  }
  scenario.world = world_of(root);
  if (options.seed && !scenario.recording) scenario.seed = *options.seed;
  return scenario;
}

}  // namespace lcs::scenario
