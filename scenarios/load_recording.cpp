#include "scenarios/load_recording.h"

#include <system_error>

#include "scenarios/inputs_read.h"
#include "scenarios/quantities.h"
#include "scenarios/scenes.h"

namespace lcs::scenario {
namespace {

namespace fs = std::filesystem;

constexpr int kMostApart = 10000;
constexpr std::size_t kRadialTangential = 5, kEquidistant = 4;

std::optional<fs::path> file_of(Reader& reader, const char* key, const fs::path& folder) {
  const Value* value = reader.find(key);
  if (!value) return std::nullopt;
  as_text(*value, reader.path_of(key));
  const fs::path file = file_beside(*value, folder, reader.path_of(key) + ": there is no file ");
  note_input(file);
  return file;
}

/// A folder, but for a video.
fs::path path_of(Reader& reader, const fs::path& folder) {
  const Value* value = reader.require("path");
  if (!value) return {};
  const fs::path path = folder / as_text(*value, reader.path_of("path"));
  std::error_code none;  // of a name that nothing can have
  if (fs::is_directory(path, none) || fs::is_regular_file(path, none)) {
    note_input(path);
    return path;
  }
  throw Error(value->where, reader.path_of("path") + ": there is no folder or video " +
                                path.string() + "; " + path_remedy(folder));
}

std::vector<double> coefficients_of(const Value& value, const std::string& path,
                                    std::size_t count) {
  std::vector<double> coefficients;
  for (const Value& item : as_list(value, path, count)) {
    const std::string index = std::to_string(coefficients.size());
    coefficients.push_back(as_quantity(item, path + "." + index, kCoefficient));
  }
  return coefficients;
}

Recorded::Distortion read_distortion(const Value& value, const std::string& path) {
  if (value.kind != Value::Kind::map) {
    return {.equidistant = false, .coefficients = coefficients_of(value, path, kRadialTangential)};
  }
  Reader reader(value, path);
  Recorded::Distortion distortion{.equidistant = true, .coefficients = {}};
  if (const Value* list = reader.require("equidistant")) {
    distortion.coefficients = coefficients_of(*list, reader.path_of("equidistant"), kEquidistant);
  }
  reader.finish();
  return distortion;
}

void read_motion(Reader& reader, const fs::path& folder, Recorded& recorded) {
  recorded.poses = file_of(reader, "poses", folder);
  recorded.imu = file_of(reader, "imu", folder);
  recorded.odometry = file_of(reader, "odometry", folder);
  reader.at_most_one_of({"poses", "imu"});
  reader.at_most_one_of({"poses", "odometry"});
  reader.at_most_one_of({"poses", "speed"});
  if (recorded.odometry && !recorded.imu) reader.require("imu");
  reader.read("speed", kSignedSpeed, recorded.speed_mps);
  reader.read("at_rest", kDuration, recorded.at_rest_s);
}

void read_camera(Reader& reader, const fs::path& folder, Recorded& recorded) {
  reader.read("focal", kFocal, recorded.focal_px);
  reader.read("centre", kInPicture, recorded.centre_px);
  if (const Value* distortion = reader.find("distortion")) {
    recorded.distortion = read_distortion(*distortion, reader.path_of("distortion"));
  }
  reader.read("camera_height", kDistance, recorded.camera_height_m);
  reader.read("mount", kAngle, recorded.mount_rpy_rad);
  recorded.mask = file_of(reader, "mask", folder);
}

}  // namespace

Recorded read_recording(Reader reader, const fs::path& folder) {
  Recorded recorded;
  recorded.source = reader.where();
  recorded.path = path_of(reader, folder);
  const std::vector<std::string> formats(kRecordingFormats.begin(), kRecordingFormats.end());
  if (const auto format = reader.choice("format", formats)) recorded.format = formats[*format];
  reader.read("camera", recorded.camera);
  reader.read("fps", kSensorRate, recorded.fps);
  reader.read("every", 1, kMostApart, recorded.every);
  read_motion(reader, folder, recorded);
  read_camera(reader, folder, recorded);
  recorded.labels = file_of(reader, "labels", folder);
  reader.read("nothing_moves", recorded.nothing_moves);
  if (recorded.nothing_moves) reader.at_most_one_of({"labels", "nothing_moves"});
  if (const auto split = reader.choice("split", {kSplits.begin(), kSplits.end()})) {
    recorded.split = static_cast<Recorded::Split>(*split);
  }
  reader.finish();
  return recorded;
}

}  // namespace lcs::scenario
