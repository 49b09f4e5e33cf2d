#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

#include "tools/files/json_node.h"
#include "tools/recording/coco_mask.h"
#include "tools/recording/recording_fields.h"
#include "tools/recording/recording_io.h"

namespace lcs::bench {
namespace {

// Written by hand: a frame has thousands of numbers, and building a JSON tree of them costs more
// than the filter.

template <class Number>
void append_digits(std::string& out, Number number) {
  std::array<char, 32> digits;  // the shortest form of a double has at most 24 characters
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  out.append(digits.data(), end);
}

void append(std::string& out, bool flag) {
  out += flag ? "true" : "false";
}
void append(std::string& out, int number) {
  append_digits(out, number);
}
void append(std::string& out, std::int64_t number) {
  append_digits(out, number);
}
void append(std::string& out, std::uint64_t number) {
  append_digits(out, number);
}
void append(std::string& out, double number) {
  if (number == 0) {
    out += std::signbit(number) ? "-0.0" : "0";  // "-0" would read back as the integer 0
  } else if (std::isfinite(number)) {
    append_digits(out, number);
  } else {
    throw std::invalid_argument("is not a finite number");
  }
}
void append(std::string& out, OrInfinite value) {
  if (value.number == std::numeric_limits<double>::infinity()) {
    out += "null";
  } else {
    append(out, value.number);
  }
}
void append(std::string& out, OrNan value) {
  if (std::isnan(value.number)) {
    out += "null";
  } else {
    append(out, value.number);
  }
}
void append(std::string& out, const std::string& text) {
  out += json_text(nlohmann::json(text));
}
template <class Enum>
requires std::is_enum_v<Enum>
void append(std::string& out, Enum value) {
  out += '"';
  out += names_of(value)[static_cast<std::size_t>(value)];
  out += '"';
}

void append(std::string& out, std::span<const Vec2> points) {
  out += '[';
  for (const Vec2& point : points) {
    out += out.back() == '[' ? "[" : ",[";
    append(out, point.x());
    out += ',';
    append(out, point.y());
    out += ']';
  }
  out += ']';
}

void append(std::string& out, const std::vector<Vec2>& points) {
  append(out, std::span<const Vec2>(points));
}
void append(std::string& out, Form<Outline> outline) {
  append(out, std::as_const(outline.value).vertices());
}

void append(std::string& out, Form<sim::Runs> runs) {
  append(out, packed_runs(runs.value));
}

void append_key(std::string& out, std::string_view key) {
  if (out.back() != '{') out += ',';
  out += '"';
  out += key;
  out += "\":";
}

/// Appends a value; adds the field's name to the error if that fails.
template <class Value>
void append_named(std::string& out, std::string_view list, std::string_view name,
                  const Value& value) {
  try {
    append(out, value);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string(list) + "." + std::string(name) + " " + error.what());
  }
}

/// Appends "list":{"id":[..],"x":[..]}, one array for each field.
template <class Item>
void append_columns(std::string& out, std::string_view list, const std::vector<Item>& items) {
  std::vector<std::string> columns;
  Item item;
  fields(item, [&](const char* name, const auto&) {
    columns.push_back('"' + std::string(name) + "\":[");
  });
  for (const Item& stored : items) {
    item = stored;
    std::size_t column = 0;
    fields(item, [&](const char* name, const auto& value) {
      std::string& text = columns[column++];
      if (text.back() != '[') text += ',';
      append_named(text, list, name, value);
    });
  }
  append_key(out, list);
  out += '{';
  for (const std::string& column : columns) {
    if (out.back() != '{') out += ',';
    out += column;
    out += ']';
  }
  out += '}';
}

void append_array(std::string& out, std::string_view list, std::string_view name,
                  std::span<const double> values) {
  append_key(out, name);
  out += '[';
  for (const double value : values) {
    if (out.back() != '[') out += ',';
    append_named(out, list, name, value);
  }
  out += ']';
}

/// Writes matrices row by row.
void append_motion(std::string& out, std::string_view name, const EgoMotion& motion) {
  const Eigen::Matrix3d by_rows = motion.R_cur_prev.transpose();
  append_key(out, name);
  out += '{';
  append_key(out, "dt_s");
  append_named(out, name, "dt_s", motion.dt_s);
  append_array(out, name, "R_cur_prev", {by_rows.data(), 9});
  append_array(out, name, "v_C_mps", {motion.v_C_mps.data(), 3});
  append_array(out, name, "w_C_radps", {motion.w_C_radps.data(), 3});
  const auto append_known = [&](const char* key, double value) {
    if (value <= 0) return;
    append_key(out, key);
    append_named(out, name, key, value);
  };
  append_known("unseen_turn_rad", motion.unseen_turn_rad);
  append_known("velocity_sigma_mps", motion.velocity_sigma_mps);
  if (motion.ground) {
    append_array(out, name, "up_C", {motion.ground->up_C.data(), 3});
    append_key(out, "height_m");
    append_named(out, name, "height_m", motion.ground->height_m);
  }
  out += '}';
}

std::vector<Place> places_of(const FrameRecord& frame) {
  std::vector<Place> places;
  for (const Eigen::Vector2f& corner : frame.corners_px) places.push_back({corner.x(), corner.y()});
  return places;
}

std::vector<CornerRow> corner_rows(const FrameRecord& frame) {
  std::vector<CornerRow> rows;
  rows.reserve(frame.corners_px.size());
  for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
    rows.push_back({frame.corners_px[i].x(), frame.corners_px[i].y(), frame.verdicts.at(i),
                    frame.reasons.empty() ? Reason::unknown : frame.reasons.at(i)});
  }
  return rows;
}

/// Writes two digits for each byte in memory order, which is the same on any machine.
void append(std::string& out, const std::vector<Signature>& signatures) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  out += '"';
  for (const Signature& signature : signatures) {
    for (const std::uint8_t byte : std::bit_cast<SignatureBytes>(signature)) {
      out += kDigits[byte >> 4];
      out += kDigits[byte & 15];
    }
  }
  out += '"';
}

std::vector<ChainRow> chain_rows(const std::vector<Chain>& chains) {
  std::vector<ChainRow> rows;
  for (const Chain& chain : chains) {
    rows.push_back(
        {{chain.sightings.begin(), chain.sightings.begin() + chain.count}, chain.off_field_px});
  }
  return rows;
}

std::vector<MaskRow> mask_rows(const SquareMasks& masks) {
  std::vector<MaskRow> rows;
  for (const auto& [square, mask] : masks) {
    const cv::Rect& box = mask.box;
    rows.push_back({square, box.x, box.y, box.x + box.width, box.y + box.height, mask.runs});
  }
  return rows;
}

template <class Content>
std::string line(const FrameRecord& frame, Content&& append_content) {
  try {
    std::string out = "{";
    append_key(out, "index");
    append(out, frame.index);
    append_content(out);
    out += '}';
    return out;
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("frame " + std::to_string(frame.index) + ": " + error.what());
  }
}

std::string header_line(const RunInfo& run) {
  std::string out = "{";
  append_key(out, "scenario");
  append(out, run.scenario);
  append_key(out, "seed");
  append(out, run.seed);
  if (!run.world.empty()) {
    append_key(out, "world");
    out += '{';
    for (const auto& [key, text] : run.world) {
      if (out.back() != '{') out += ',';
      append(out, key);
      out += ':';
      append(out, text);
    }
    out += '}';
  }
  if (run.origin) {
    append_key(out, "origin");
    out += '{';
    append_key(out, "family");
    append(out, run.origin->family);
    append_key(out, "seed");
    append(out, run.origin->seed);
    out += '}';
  }
  if (run.truth != Truth::all) {
    append_key(out, "truth");
    append(out, run.truth);
  }
  append_columns(out, "objects", run.objects);
  out += '}';
  return out;
}

}  // namespace

std::string layers_line(const FrameRecord& frame) {
  return line(frame, [&](std::string& out) {
    const Layers& layers = frame.layers;
    append_key(out, "t_ns");
    append(out, frame.t_ns);
    append_motion(out, "told_motion", frame.motion);
    append_columns(out, "corners", corner_rows(frame));
    if (!frame.signatures.empty()) {
      append_key(out, "signatures");
      append(out, frame.signatures);
    }
    append_columns(out, "normal_edges", layers.normal_edges);
    append_columns(out, "rebel_edges", layers.rebel_edges);
    append_columns(out, "normal_circles", layers.normal_circles);
    append_columns(out, "rebel_circles", layers.rebel_circles);
    append_columns(out, "squares", layers.squares);
    if (frame.gaps) append_columns(out, "gaps", *frame.gaps);
    append_columns(out, "ignored", layers.ignored);
    append_columns(out, "collectors", layers.collectors);
    append_columns(out, "chains", chain_rows(layers.chains));
    if (!frame.masks.empty()) append_columns(out, "masks", mask_rows(frame.masks));
  });
}

std::string truth_line(const FrameRecord& frame) {
  return line(frame, [&](std::string& out) {
    append_motion(out, "true_motion", frame.true_motion);
    append_columns(out, "corners", frame.corner_truth);
    append_columns(out, "objects", frame.object_truth);
    if (frame.labels) append_columns(out, "labels", *frame.labels);
  });
}

std::string given_line(const FrameRecord& frame, const EgoMotion* motion) {
  return line(frame, [&](std::string& out) {
    append_key(out, "t_ns");
    append(out, frame.t_ns);
    if (motion != nullptr) {
      append_motion(out, "told_motion", *motion);
    } else {
      out += ",\"told_motion\":null";
    }
    append_columns(out, "corners", places_of(frame));
  });
}

std::string objects_line(const std::vector<sim::Object>& objects) {
  std::string out = "{";
  append_columns(out, "objects", objects);
  return out + '}';
}

std::string seen_line(const FrameRecord& frame) {
  return line(frame, [&](std::string& out) {
    append_key(out, "t_ns");
    append(out, frame.t_ns);
    append_columns(out, "corners", places_of(frame));
    append_columns(out, "truth", frame.corner_truth);
    append_columns(out, "objects", frame.object_truth);
  });
}

std::string camera_json(const Intrinsics& camera) {
  std::string out = R"({"model":"pinhole")";
  append_key(out, "focal_px");
  append_named(out, "camera", "focal_px", camera.focal_px);
  append_array(out, "camera", "centre_px", {camera.centre_px.data(), 2});
  append_key(out, "width_px");
  append(out, camera.width_px);
  append_key(out, "height_px");
  append(out, camera.height_px);
  out += '}';
  return out;
}

/// {"detector": name, "layered": whether it has the filter's layers, "circles": whether it has
/// circles}
static std::string detector_json(const DetectorInfo& detector) {
  std::string out = "{";
  append_key(out, "detector");
  append(out, detector.name);
  append_key(out, "layered");
  append(out, detector.layered);
  append_key(out, "circles");
  append(out, detector.circles);
  return out + '}';
}

RecordingWriter::RecordingWriter(const std::filesystem::path& folder, const RunInfo& run,
                                 bool compressed, bool with_truth)
    : layers_(folder / kLayersFile, compressed) {
  if (with_truth) {
    truth_.emplace(folder / kTruthFile, compressed);
    truth_->write(header_line(run) + '\n');
  }
  write_file(folder / kDetectorFile, detector_json(run.detector) + '\n');
  if (run.camera) write_file(folder / kCameraFile, camera_json(*run.camera) + '\n');
}

void RecordingWriter::write(const FrameRecord& frame) {
  layers_.write(layers_line(frame) + '\n');
  if (truth_) truth_->write(truth_line(frame) + '\n');
}

void RecordingWriter::close() {
  layers_.close();
  if (truth_) truth_->close();
}

}  // namespace lcs::bench
