#include <fmt/format.h>

#include <simdjson.h>
#include <algorithm>
#include <bit>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

#include "scenarios/input/input_file.h"
#include "scenarios/input/inputs_read.h"
#include "scenarios/input/message.h"
#include "tools/files/json_node.h"
#include "tools/recording/recording_fields.h"
#include "tools/recording/recording_io.h"
#include "tools/recording/warnings.h"

namespace lcs::recording {
namespace {

using Json = simdjson::dom::element;
using JsonList = simdjson::dom::array;

/// The longest image side; larger than any image, and small enough for sums not to overflow.
constexpr int kLongest_px = 1 << 20;

/// \throws std::runtime_error; the caller puts the place before its message.
template <class... Arguments>
[[noreturn]] void fail_reading(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  throw std::runtime_error(fmt::format(text, std::forward<Arguments>(arguments)...));
}
void require(bool condition, const char* what) {
  if (!condition) fail_reading("is not {}", what);
}

/// Calls `use`; prefixes its errors with their place, as ".corners.x[3] is not a number".
void within(const std::string& place, const auto& use) {
  try {
    use();
  } catch (const std::runtime_error& error) {
    const std::string_view what = error.what();
    const bool goes_on = what.starts_with('.');
    fail_reading("{}{}{}", place, goes_on ? "" : " ", what);
  }
}

/// A member of an object, if it is there.
std::optional<Json> find(Json json, const char* key) {
  Json found;
  return json[key].get(found) == simdjson::SUCCESS ? std::optional(found) : std::nullopt;
}

Json member(Json json, const char* key) {
  require(json.is_object(), "an object");
  const std::optional<Json> found = find(json, key);
  if (!found) fail_reading("has no {}", key);
  return *found;
}

JsonList list_of(Json json, const char* what = "a list") {
  constexpr std::size_t kUncounted = 0xffffff;  // simdjson counts no further
  JsonList list;
  require(json.get(list) == simdjson::SUCCESS && list.size() < kUncounted, what);
  return list;
}

void read(Json json, bool& flag) {
  require(json.get(flag) == simdjson::SUCCESS, "true or false");
}
void read(Json json, std::string_view& text) {
  require(json.get(text) == simdjson::SUCCESS, "a text");
}
void read(Json json, std::string& text) {
  std::string_view view;
  read(json, view);
  text = view;
}
void read(Json json, double& number) {
  require(json.get(number) == simdjson::SUCCESS, "a number");
}
void read(Json json, float& number) {
  double exact = 0;
  read(json, exact);
  number = static_cast<float>(exact);
}
template <bool kMayBeInfinite>
void read(Json json, OrNull<kMayBeInfinite> value) {
  value.number = value.kNull;
  if (!json.is_null()) read(json, value.number);
}
template <class Integer>
requires std::is_integral_v<Integer>
void read(Json json, Integer& number) {
  std::int64_t whole = 0;
  std::uint64_t natural = 0;
  if (json.get(whole) == simdjson::SUCCESS && std::in_range<Integer>(whole)) {
    number = static_cast<Integer>(whole);
  } else {
    require(json.get(natural) == simdjson::SUCCESS && std::in_range<Integer>(natural),
            "a whole number of its range");
    number = static_cast<Integer>(natural);
  }
}
template <class Enum>
requires std::is_enum_v<Enum>
void read(Json json, Enum& value) {
  const auto& names = names_of(value);
  std::string_view text;
  read(json, text);
  const auto found = std::ranges::find(names, text);
  if (found == names.end() || text.empty()) {
    fail_reading("is the unknown word '{}'", input::printable(text));  // NUL would end it
  }
  value = static_cast<Enum>(found - names.begin());
}

void read(Json json, std::span<double> values) {
  constexpr const char* kWhat = "a list of as many numbers as belong";
  const JsonList list = list_of(json, kWhat);
  require(list.size() == values.size(), kWhat);
  std::size_t i = 0;
  for (const Json item : list) read(item, values[i++]);
}

/// \return how many points there are, of those that there is room for.
int read_points(Json json, std::span<Vec2> points) {
  const JsonList list = list_of(json, "a list of points");
  if (list.size() > points.size()) fail_reading("has over {} points", points.size());
  int count = 0;
  for (const Json item : list) read(item, std::span(points[count++].data(), 2));
  return count;
}
void read(Json json, Form<Outline> outline) {
  outline.value.count = read_points(json, outline.value.places);
}
void read(Json json, Sightings valid) {
  valid.chain.count = read_points(json, valid.chain.sightings);
}

/// Reads COCO's run-length string; `require_filled` checks that the runs fill the box.
void read(Json json, Form<sim::PixelRuns> runs) {
  std::string_view word;
  read(json, word);
  runs.value.clear();
  try {
    for (const std::int64_t run : unpacked_runs(word)) {
      if (!std::in_range<std::uint32_t>(run)) throw std::invalid_argument("");
      runs.value.push_back(static_cast<std::uint32_t>(run));
    }
  } catch (const std::invalid_argument&) {
    fail_reading("is not the word of a mask");
  }
}

/// Whether a file may lack the column of such a field.
template <class Value>
constexpr bool kMayLack = false;
template <class Value>
constexpr bool kMayLack<Form<Value>> = true;

/// Checks that the runs of a mask add up to its box. Older files have no masks of objects.
template <class Item>
void require_filled(const Item& item, std::size_t row) {
  if (item.mask.empty() && std::is_same_v<Item, sim::ObjectTruth>) return;
  const std::int64_t width = std::int64_t{item.right} - item.left,
                     height = std::int64_t{item.bottom} - item.top;
  std::int64_t sum = 0;
  for (const std::uint32_t run : item.mask) sum += run;
  if (width < 1 || height < 1 || width > kLongest_px || height > kLongest_px ||
      sum != width * height) {
    fail_reading(".mask[{}] is not as large as its box", row);
  }
}

/// Reads items that are stored by column.
template <class Item>
void read(Json json, std::vector<Item>& items) {
  std::vector<std::optional<JsonList>> columns;
  Item item;
  fields(item, [&]<class Value>(const char* name, const Value&) {
    std::optional<JsonList>& column = columns.emplace_back();
    if (kMayLack<Value> && !find(json, name)) return;
    const Json list = member(json, name);
    within(fmt::format(".{}", name), [&] { column = list_of(list); });
  });
  const JsonList& first = *columns.front();
  std::vector<JsonList::iterator> cells;  // the next of each column
  for (const std::optional<JsonList>& column : columns) {
    if (column && column->size() != first.size()) {
      fail_reading("has columns that differ in length");
    }
    cells.push_back(column.value_or(first).begin());
  }
  items.reserve(first.size());
  for (std::size_t row = 0; row < first.size(); ++row) {
    std::size_t column = 0;
    fields(item, [&](const char* name, auto&& value) {
      const std::size_t place = column++;
      if (!columns[place]) return;
      try {
        read(*cells[place], value);
      } catch (const std::runtime_error& error) {
        fail_reading(".{}[{}] {}", name, row, error.what());
      }
      ++cells[place];
    });
    if constexpr (requires { item.mask; }) require_filled(item, row);
    items.push_back(item);
  }
}

void read(Json json, EgoMotion& motion);

/// Reads a member of an object.
void read_member(Json json, const char* key, auto&& out) {
  const Json value = member(json, key);
  within(fmt::format(".{}", key), [&] { read(value, out); });
}
void read(Json json, EgoMotion& motion) {
  Eigen::Matrix3d by_rows;
  read_member(json, "dt_s", motion.dt_s);
  read_member(json, "R_cur_prev", std::span(by_rows.data(), 9));
  motion.R_cur_prev = by_rows.transpose();
  read_member(json, "v_C_mps", std::span(motion.v_C_mps.data(), 3));
  read_member(json, "w_C_radps", std::span(motion.w_C_radps.data(), 3));
  const auto read_known = [&](const char* key, double& value) {
    if (find(json, key)) read_member(json, key, value);
  };
  read_known("unseen_turn_rad", motion.unseen_turn_rad);
  read_known("velocity_sigma_mps", motion.velocity_sigma_mps);
  if (find(json, "height_m")) {
    Ground& ground = motion.ground.emplace();
    read_member(json, "up_C", std::span(ground.up_C.data(), 3));
    read_member(json, "height_m", ground.height_m);
  }
}

std::vector<Signature> signatures_of(Json json, std::size_t corners) {
  std::string_view digits;
  read(json, digits);
  require(digits.size() == corners * 2 * sizeof(Signature),
          "64 hexadecimal digits for each corner");
  std::vector<Signature> signatures(corners);
  const char* next = digits.data();
  for (Signature& signature : signatures) {
    SignatureBytes bytes;
    for (std::uint8_t& byte : bytes) {
      require(std::from_chars(next, next + 2, byte, 16).ptr == next + 2,
              "64 hexadecimal digits for each corner");
      next += 2;
    }
    signature = std::bit_cast<Signature>(bytes);
  }
  return signatures;
}

void read_layers(Json json, FrameRecord& frame) {
  read_member(json, "index", frame.index);
  read_member(json, "t_ns", frame.t_ns);
  read_member(json, "told_motion", frame.motion);
  std::vector<CornerRow> corners;
  read_member(json, "corners", corners);
  for (const CornerRow& corner : corners) {
    frame.corners_px.push_back(Vec2(corner.x, corner.y).cast<float>());
    frame.verdicts.push_back(corner.verdict);
    frame.reasons.push_back(corner.reason);
  }
  if (const std::optional<Json> odds = find(json, "log_odds")) {
    within(".log_odds", [&] {
      const JsonList list = list_of(*odds, "a list of numbers");
      require(list.size() == frame.corners_px.size(), "a number for each corner");
      for (const Json item : list) read(item, frame.log_odds.emplace_back());
    });
  }
  if (const std::optional<Json> signatures = find(json, "signatures")) {
    within(".signatures",
           [&] { frame.signatures = signatures_of(*signatures, frame.corners_px.size()); });
  }
  Layers& layers = frame.layers;
  read_member(json, "normal_edges", layers.normal_edges);
  read_member(json, "rebel_edges", layers.rebel_edges);
  read_member(json, "normal_circles", layers.normal_circles);
  read_member(json, "rebel_circles", layers.rebel_circles);
  read_member(json, "squares", layers.squares);
  if (find(json, "gaps")) read_member(json, "gaps", frame.gaps.emplace());
  read_member(json, "ignored", frame.paper.ignored);
  read_member(json, "collectors", frame.paper.collectors);
  read_member(json, "chains", frame.paper.chains);
  if (find(json, "masks")) {
    std::vector<MaskRow> rows;
    read_member(json, "masks", rows);
    for (MaskRow& row : rows) {
      frame.masks[row.square] = {
          cv::Rect(cv::Point(row.left, row.top), cv::Point(row.right, row.bottom)),
          std::move(row.mask)};
    }
  }
  for (Edge& edge : layers.rebel_edges) edge.rebel = true;
  for (Circle& circle : layers.rebel_circles) circle.rebel = true;
}

void read_truth(Json json, FrameRecord& frame) {
  int index = 0;
  read_member(json, "index", index);
  if (index != frame.index) fail_reading("index differs from the layers' index");
  read_member(json, "true_motion", frame.true_motion);
  read_member(json, "corners", frame.corner_truth);
  read_member(json, "objects", frame.object_truth);
  if (find(json, "labels")) read_member(json, "labels", frame.labels.emplace());
}

void read_detector(Json json, DetectorInfo& detector) {
  read_member(json, "detector", detector.name);
  read_member(json, "layered", detector.layered);
  read_member(json, "circles", detector.circles);
}

void read_header(Json json, RunInfo& recording) {
  read_member(json, "scenario", recording.scenario);
  read_member(json, "seed", recording.seed);
  if (find(json, "detector")) read_detector(json, recording.detector);  // before detector.json
  if (const std::optional<Json> world = find(json, "world")) {
    within(".world", [&] {
      simdjson::dom::object texts;
      require(world->get(texts) == simdjson::SUCCESS, "an object");
      for (const auto& [key, text] : texts) read(text, recording.world[std::string(key)]);
    });
  }
  if (const std::optional<Json> told = find(json, "origin")) {
    scenario::Origin& origin = recording.origin.emplace();
    within(".origin", [&] {
      read_member(*told, "family", origin.family);
      read_member(*told, "seed", origin.seed);
    });
  }
  if (find(json, "truth")) read_member(json, "truth", recording.truth);
  read_member(json, "objects", recording.objects);
}

// About 100 kB a frame, for hundreds of thousands of frames.
constexpr input::FileKind kRecordingFile{64 * input::kGibibyte,
                                         "name the folder of a whole run, or run it again"};

}  // namespace

/// Passes one parsed line after the other to its user, and adds file and line to errors.
class LineReader {
 public:
  explicit LineReader(const std::filesystem::path& path) : file_(path, kRecordingFile) {
    if (parser_.allocate(0, files::kDeepestJson + 1) != simdjson::SUCCESS) throw std::bad_alloc();
  }
  bool next(auto&& use) {
    if (!file_.next_line(text_)) return false;
    const Json json = parsed();
    try {
      use(json);
    } catch (const std::runtime_error& error) {
      fail(error.what());
    }
    return true;
  }
  void require_next(auto&& use, std::string_view otherwise) {
    if (!next(use)) fail(otherwise);
  }
  bool skip() { return file_.next_line(text_); }
  [[noreturn]] void fail(std::string_view what) const {
    if (what.starts_with('.')) what.remove_prefix(1);
    throw input::Error(file_.here(), "{}; {}", what, kRecordingFile.remedy);
  }

 private:
  /// simdjson names no place of a fault, and reads no integer of more than 64 bits.
  Json parsed() {
    Json json;
    if (parse().get(json) == simdjson::SUCCESS) return json;
    text_ = files::parse_json<nlohmann::json>(text_, file_.here(), kRecordingFile.remedy).dump();
    if (const auto error = parse().get(json)) fail(simdjson::error_message(error));
    return json;
  }
  simdjson::simdjson_result<Json> parse() {
    text_.reserve(text_.size() + simdjson::SIMDJSON_PADDING);  // or it is copied
    return parser_.parse(text_);
  }

  input::InputFile file_;
  std::string text_;
  simdjson::dom::parser parser_;
};

namespace {

constexpr std::string_view kEmpty = "is empty";

void read_detector_of(const std::filesystem::path& folder, RunInfo& recording) {
  if (!std::filesystem::exists(folder / kDetectorFile)) return;
  LineReader file(folder / kDetectorFile);
  file.require_next([&](Json json) { read_detector(json, recording.detector); }, kEmpty);
}

}  // namespace

/// A letter above '0' holds five bits, lowest first; 32 marks a continuation, 16 in the last letter
/// a negative number. From the fourth on, a number is the difference to the last but one.
std::vector<std::int64_t> unpacked_runs(std::string_view word) {
  constexpr int kMostShift = 35;  // of an image's runs
  std::vector<std::int64_t> runs;
  std::int64_t number = 0;
  int shift = 0;
  for (const char letter : word) {
    const int bits = letter - '0';
    if (bits < 0 || bits > 63 || shift >= kMostShift) {
      throw std::invalid_argument(input::printable(fmt::format(
          "the mask's counts have '{}' where none can be; give COCO's word or its numbers",
          letter)));
    }
    number |= std::int64_t{bits & 31} << shift;
    shift += 5;
    if ((bits & 32) != 0) continue;
    if ((bits & 16) != 0) number -= std::int64_t{1} << shift;
    if (runs.size() > 2) number += runs[runs.size() - 2];
    runs.push_back(number);
    number = shift = 0;
  }
  if (shift > 0) {
    throw std::invalid_argument("the mask's counts end within a number; give all of them");
  }
  return runs;
}

std::filesystem::path stored(const std::filesystem::path& folder, const char* name) {
  const std::filesystem::path plain = folder / name;
  std::filesystem::path compressed = plain;
  compressed += ".gz";
  return !std::filesystem::exists(plain) && std::filesystem::exists(compressed) ? compressed
                                                                                : plain;
}

RecordingReader::~RecordingReader() = default;

RecordingReader::RecordingReader(const std::filesystem::path& folder)
    : layers_(std::make_unique<LineReader>(stored(folder, kLayersFile))),
      truth_(std::make_unique<LineReader>(stored(folder, kTruthFile))) {
  input::note_input(folder);
  truth_->require_next([&](Json json) { read_header(json, run_); }, kEmpty);
  read_detector_of(folder, run_);
  run_.warnings = world_warnings(folder);
  if (!std::filesystem::exists(folder / kCameraFile)) return;
  LineReader file(folder / kCameraFile);
  const auto read_camera = [&](Json json) {
    Intrinsics& camera = run_.camera.emplace();
    read_member(json, "focal_px", camera.focal_px);
    read_member(json, "centre_px", std::span(camera.centre_px.data(), 2));
    const auto read_side = [&](const char* key, int& side) {
      read_member(json, key, side);
      if (side < 1 || side > kLongest_px) fail_reading("{} is not the side of a picture", key);
    };
    read_side("width_px", camera.width_px);
    read_side("height_px", camera.height_px);
  };
  file.require_next(read_camera, kEmpty);
}

bool RecordingReader::next(FrameRecord& frame) {
  frame = {};
  if (!layers_->next([&](Json json) { read_layers(json, frame); })) {
    if (truth_->next([](Json) {})) layers_->fail("ends before the truth does");
    return false;
  }
  truth_->require_next([&](Json json) { read_truth(json, frame); }, "ends before the layers do");
  return true;
}

bool RecordingReader::skip() {
  const bool is_there = layers_->skip();
  if (truth_->skip() != is_there) {
    (is_there ? truth_ : layers_)->fail("ends before the other file does");
  }
  return is_there;
}

int RecordingReader::count_left() {
  int frames = 0;
  while (truth_->skip()) ++frames;
  return frames;
}

Recording read_recording(const std::filesystem::path& folder) {
  RecordingReader reader(folder);
  Recording recording{reader.run(), {}};
  for (FrameRecord frame; reader.next(frame);) recording.frames.push_back(std::move(frame));
  return recording;
}

RunInfo read_run_info(const std::filesystem::path& folder) {
  RunInfo run;
  LineReader truth(stored(folder, kTruthFile));
  truth.require_next([&](Json json) { read_header(json, run); }, kEmpty);
  read_detector_of(folder, run);
  return run;
}

SeenReader::~SeenReader() = default;
SeenReader::SeenReader(SeenReader&&) noexcept = default;

SeenReader::SeenReader(const std::filesystem::path& file)
    : lines_(std::make_unique<LineReader>(file)) {
  lines_->require_next([&](Json json) { read_member(json, "objects", objects_); }, kEmpty);
}

const FrameRecord* SeenReader::at(std::int64_t t_ns) {
  while (!frame_ || frame_->t_ns < t_ns) {
    FrameRecord frame;
    const bool is_there = lines_->next([&](Json json) {
      read_member(json, "index", frame.index);
      read_member(json, "t_ns", frame.t_ns);
      read_member(json, "corners", frame.corners_px);
      read_member(json, "truth", frame.corner_truth);
      read_member(json, "objects", frame.object_truth);
      if (frame.corner_truth.size() != frame.corners_px.size()) {
        fail_reading("truth is of another number of corners");
      }
      if (frame_ && frame.t_ns <= frame_->t_ns)
        fail_reading("t_ns is not later than in the line before");
    });
    if (!is_there) return nullptr;
    frame_ = std::move(frame);
  }
  return frame_->t_ns == t_ns ? &*frame_ : nullptr;
}

std::vector<std::vector<sim::ObjectTruth>> read_object_truth(const std::filesystem::path& folder,
                                                             std::span<const int> frames) {
  LineReader truth(stored(folder, kTruthFile));
  std::vector<std::vector<sim::ObjectTruth>> objects;
  int next = -1;  // the header line
  for (const int frame : frames) {
    if (frame < next) {
      objects.push_back(objects.back());
      continue;
    }
    while (next < frame && truth.skip()) ++next;
    truth.require_next([&](Json json) { read_member(json, "objects", objects.emplace_back()); },
                       fmt::format("ends before frame {}", frame));
    ++next;
  }
  return objects;
}

}  // namespace lcs::recording
