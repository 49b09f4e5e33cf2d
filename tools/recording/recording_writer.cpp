#include <fmt/ranges.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

#include "tools/files/json_node.h"
#include "tools/recording/recording_fields.h"
#include "tools/recording/recording_io.h"

namespace lcs::recording {
namespace {

// Written by hand: a frame has thousands of numbers, and building a JSON tree of them costs more
// than the filter.

void append(std::string& out, bool flag) {
  out += flag ? "true" : "false";
}
template <class Number>
requires std::is_arithmetic_v<Number>
void append(std::string& out, Number number) {
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(number)) throw std::invalid_argument("is not a finite number");
    // "-0" would read back as the integer 0.
    if (number == 0 && std::signbit(number)) return void(out += "-0.0");
  }
  std::array<char, 32> digits;  // the shortest form of a double has at most 24 characters
  using Written = std::conditional_t<std::is_same_v<Number, float>, double, Number>;
  const auto end = std::to_chars(digits.begin(), digits.end(), Written{number}).ptr;
  out.append(digits.data(), end);
}
template <bool kMayBeInfinite>
void append(std::string& out, OrNull<kMayBeInfinite> value) {
  if (kMayBeInfinite ? value.number == value.kNull : std::isnan(value.number)) {
    out += "null";
  } else {
    append(out, value.number);
  }
}
void append(std::string& out, const std::string& text) {
  out += files::json_text(nlohmann::json(text));
}
template <class Enum>
requires std::is_enum_v<Enum>
void append(std::string& out, Enum value) {
  out += '"';
  out += names_of(value)[static_cast<std::size_t>(value)];
  out += '"';
}

void append_list(std::string& out, const auto& items, const auto& append_item) {
  out += '[';
  for (const auto& item : items) {
    if (out.back() != '[') out += ',';
    append_item(item);
  }
  out += ']';
}
/// A matrix row by row.
template <class Derived>
void append(std::string& out, const Eigen::MatrixBase<Derived>& numbers) {
  append_list(out, numbers.template reshaped<Eigen::RowMajor>(),
              [&](double number) { append(out, number); });
}
void append(std::string& out, const std::vector<float>& numbers) {
  append_list(out, numbers,
              [&](float number) { append(out, std::round(100 * double{number}) / 100); });
}
void append(std::string& out, std::span<const Vec2> points) {
  append_list(out, points, [&](const Vec2& point) { append(out, point); });
}
void append(std::string& out, Form<Outline> outline) {
  append(out, std::as_const(outline.value).vertices());
}
void append(std::string& out, Sightings valid) {
  append(out, std::span<const Vec2>(valid.chain.sightings).first(valid.chain.count));
}

void append(std::string& out, Form<sim::PixelRuns> runs) {
  append(out, packed_runs(runs.value));
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

void append_key(std::string& out, std::string_view key) {
  if (out.back() != '{') out += ',';
  out += '"';
  out += key;
  out += "\":";
}

/// Appends a value; adds the field's name to the error if that fails.
void append_named(std::string& out, std::string_view list, std::string_view name,
                  const auto& value) {
  try {
    append(out, value);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}.{} {}", list, name, error.what()));
  }
}

/// \param owner of the member, for the error.
void append_member(std::string& out, std::string_view owner, std::string_view name,
                   const auto& value) {
  append_key(out, name);
  append_named(out, owner, name, value);
}

/// Appends "list":{"id":[..],"x":[..]}, one array for each field.
template <class Item>
void append_columns(std::string& out, std::string_view list, const std::vector<Item>& items) {
  std::vector<std::string> columns;
  Item item;
  fields(item,
         [&](const char* name, const auto&) { columns.push_back(fmt::format("\"{}\":[", name)); });
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
  out += fmt::format("{{{}]}}", fmt::join(columns, "],"));
}

void append_motion(std::string& out, std::string_view name, const EgoMotion& motion) {
  append_key(out, name);
  out += '{';
  const auto add = [&](const char* key, const auto& value) {
    append_member(out, name, key, value);
  };
  add("dt_s", motion.dt_s);
  add("R_cur_prev", motion.R_cur_prev);
  add("v_C_mps", motion.v_C_mps);
  add("w_C_radps", motion.w_C_radps);
  if (!(motion.unseen_turn_rad <= 0)) add("unseen_turn_rad", motion.unseen_turn_rad);
  if (!(motion.velocity_sigma_mps <= 0)) add("velocity_sigma_mps", motion.velocity_sigma_mps);
  if (motion.ground) {
    add("up_C", motion.ground->up_C);
    add("height_m", motion.ground->height_m);
  }
  out += '}';
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

std::vector<MaskRow> mask_rows(const SquareMasks& masks) {
  std::vector<MaskRow> rows;
  for (const auto& [square, mask] : masks) {
    const cv::Rect& box = mask.box;
    rows.push_back({square, box.x, box.y, box.x + box.width, box.y + box.height, mask.runs});
  }
  return rows;
}

std::string line(const FrameRecord& frame, auto&& append_content) {
  try {
    std::string out = fmt::format("{{\"index\":{}", frame.index);
    append_content(out);
    return out + '}';
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("frame {}: {}", frame.index, error.what()));
  }
}

/// \param head the members before the objects.
std::string line(const files::Json& head, const std::vector<sim::Object>& objects) {
  std::string out = files::json_text(head);
  out.pop_back();
  append_columns(out, "objects", objects);
  return out + '}';
}

std::string header_line(const RunInfo& run) {
  files::Json head = {{"scenario", run.scenario}, {"seed", run.seed}};
  if (!run.world.empty()) head["world"] = run.world;
  if (run.origin) head["origin"] = {{"family", run.origin->family}, {"seed", run.origin->seed}};
  if (run.truth != Truth::all) head["truth"] = kTruths.at(static_cast<std::size_t>(run.truth));
  return line(head, run.objects);
}

}  // namespace

std::string packed_runs(const sim::PixelRuns& runs) {
  std::string word;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::int64_t number = runs[i];
    if (i > 2) number -= runs[i - 2];
    for (bool more = true; more;) {
      int bits = static_cast<int>(number & 31);
      number >>= 5;
      more = number != ((bits & 16) != 0 ? -1 : 0);
      if (more) bits |= 32;
      word += static_cast<char>('0' + bits);
    }
  }
  return word;
}

std::string layers_line(const FrameRecord& frame) {
  return line(frame, [&](std::string& out) {
    const Layers& layers = frame.layers;
    append_member(out, "frame", "t_ns", frame.t_ns);
    append_motion(out, "told_motion", frame.motion);
    append_columns(out, "corners", corner_rows(frame));
    if (!frame.log_odds.empty()) append_member(out, "frame", "log_odds", frame.log_odds);
    if (!frame.signatures.empty()) append_member(out, "frame", "signatures", frame.signatures);
    append_columns(out, "normal_edges", layers.normal_edges);
    append_columns(out, "rebel_edges", layers.rebel_edges);
    append_columns(out, "normal_circles", layers.normal_circles);
    append_columns(out, "rebel_circles", layers.rebel_circles);
    append_columns(out, "squares", layers.squares);
    if (frame.gaps) append_columns(out, "gaps", *frame.gaps);
    append_columns(out, "ignored", frame.paper.ignored);
    append_columns(out, "collectors", frame.paper.collectors);
    append_columns(out, "chains", frame.paper.chains);
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
    append_member(out, "frame", "t_ns", frame.t_ns);
    if (motion != nullptr) {
      append_motion(out, "told_motion", *motion);
    } else {
      out += ",\"told_motion\":null";
    }
    append_columns(out, "corners", frame.corners_px);
  });
}

std::string objects_line(const std::vector<sim::Object>& objects) {
  return line(files::Json::object(), objects);
}

std::string seen_line(const FrameRecord& frame) {
  return line(frame, [&](std::string& out) {
    append_member(out, "frame", "t_ns", frame.t_ns);
    append_columns(out, "corners", frame.corners_px);
    append_columns(out, "truth", frame.corner_truth);
    append_columns(out, "objects", frame.object_truth);
  });
}

std::string camera_json(const Intrinsics& camera) {
  std::string out = R"({"model":"pinhole")";
  append_member(out, "camera", "focal_px", camera.focal_px);
  append_member(out, "camera", "centre_px", camera.centre_px);
  append_member(out, "camera", "width_px", camera.width_px);
  append_member(out, "camera", "height_px", camera.height_px);
  return out + '}';
}

RecordingWriter::RecordingWriter(const std::filesystem::path& folder, const RunInfo& run,
                                 bool compressed, bool with_truth)
    : layers_(folder / kLayersFile, compressed) {
  if (with_truth) {
    truth_.emplace(folder / kTruthFile, compressed);
    truth_->write(header_line(run) + '\n');
  }
  const auto& [name, layered, circles] = run.detector;
  // Whether it has the filter's layers, and whether it has circles.
  const files::Json detector = {{"detector", name}, {"layered", layered}, {"circles", circles}};
  files::write_file(folder / kDetectorFile, files::json_text(detector) + '\n');
  if (run.camera) files::write_file(folder / kCameraFile, camera_json(*run.camera) + '\n');
}

void RecordingWriter::write(const FrameRecord& frame) {
  layers_.write(layers_line(frame) + '\n');
  if (truth_) truth_->write(truth_line(frame) + '\n');
}

void RecordingWriter::close() {
  layers_.close();
  if (truth_) truth_->close();
}

}  // namespace lcs::recording
