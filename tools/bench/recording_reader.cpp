#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "tools/bench/recording_fields.h"
#include "tools/bench/recording_io.h"

namespace lcs::bench {
namespace {

using Json = nlohmann::json;

void read(const Json& json, bool& flag) {
  flag = json.get<bool>();
}
void read(const Json& json, std::string& text) {
  text = json.get<std::string>();
}
void read(const Json& json, double& number) {
  number = json.get<double>();
}
void read(const Json& json, OrInfinite value) {
  value.number = json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
}
void read(const Json& json, OrNan value) {
  value.number = json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}
template <class Integer>
requires std::is_integral_v<Integer>
void read(const Json& json, Integer& number) {
  if (!json.is_number_integer()) throw std::runtime_error("not an integer: " + json.dump());
  number = json.get<Integer>();
}
template <class Enum>
requires std::is_enum_v<Enum>
void read(const Json& json, Enum& value) {
  const auto& names = names_of(value);
  const auto& text = json.get_ref<const std::string&>();
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end() || text.empty())
    throw std::runtime_error("unknown word \"" + text + '"');
  value = static_cast<Enum>(found - names.begin());
}

void read_array(const Json& list, std::span<double> values) {
  if (list.size() != values.size()) throw std::runtime_error("a vector has the wrong length");
  for (std::size_t i = 0; i < values.size(); ++i) read(list.at(i), values[i]);
}

void read(const Json& list, std::vector<Vec2>& points) {
  points.resize(list.size());
  for (std::size_t i = 0; i < points.size(); ++i) read_array(list[i], {points[i].data(), 2});
}

template <class Item>
std::vector<Item> read_columns(const Json& list) {
  std::vector<const Json*> columns;
  Item item;
  fields(item, [&](const char* name, const auto&) { columns.push_back(&list.at(name)); });
  const std::size_t size = columns.front()->size();
  for (const Json* column : columns) {
    if (column->size() != size) throw std::runtime_error("columns differ in length");
  }
  std::vector<Item> items;
  items.reserve(size);
  for (std::size_t row = 0; row < size; ++row) {
    std::size_t column = 0;
    fields(item, [&](const char*, auto&& value) { read(columns[column++]->at(row), value); });
    items.push_back(item);
  }
  return items;
}

EgoMotion read_motion(const Json& json) {
  EgoMotion motion;
  Eigen::Matrix3d by_rows;
  read(json.at("dt_s"), motion.dt_s);
  read_array(json.at("R_cur_prev"), {by_rows.data(), 9});
  motion.R_cur_prev = by_rows.transpose();
  read_array(json.at("v_C_mps"), {motion.v_C_mps.data(), 3});
  read_array(json.at("w_C_radps"), {motion.w_C_radps.data(), 3});
  if (json.contains("unseen_turn_rad")) read(json.at("unseen_turn_rad"), motion.unseen_turn_rad);
  if (json.contains("height_m")) {
    Ground& ground = motion.ground.emplace();
    read_array(json.at("up_C"), {ground.up_C.data(), 3});
    read(json.at("height_m"), ground.height_m);
  }
  return motion;
}

std::vector<Chain> chains_of(const std::vector<ChainRow>& rows) {
  std::vector<Chain> chains;
  for (const ChainRow& row : rows) {
    Chain& chain = chains.emplace_back();
    if (row.sightings.size() > chain.sightings.size()) {
      throw std::runtime_error("a chain has too many sightings");
    }
    std::copy(row.sightings.begin(), row.sightings.end(), chain.sightings.begin());
    chain.off_field_px = row.off_field_px;
    chain.count = static_cast<int>(row.sightings.size());
  }
  return chains;
}

void read_layers(const Json& json, FrameRecord& frame) {
  read(json.at("index"), frame.index);
  read(json.at("t_ns"), frame.t_ns);
  frame.motion = read_motion(json.at("motion"));
  for (const CornerRow& corner : read_columns<CornerRow>(json.at("corners"))) {
    frame.corners_px.push_back(Vec2(corner.x, corner.y).cast<float>());
    frame.verdicts.push_back(corner.verdict);
    frame.reasons.push_back(corner.reason);
  }
  Layers& layers = frame.layers;
  layers.normal_edges = read_columns<Edge>(json.at("normal_edges"));
  layers.rebel_edges = read_columns<Edge>(json.at("rebel_edges"));
  layers.normal_circles = read_columns<Circle>(json.at("normal_circles"));
  layers.rebel_circles = read_columns<Circle>(json.at("rebel_circles"));
  layers.squares = read_columns<Square>(json.at("squares"));
  layers.ignored = read_columns<IgnoreRegion>(json.at("ignored"));
  layers.collectors = read_columns<Collector>(json.at("collectors"));
  layers.chains = chains_of(read_columns<ChainRow>(json.at("chains")));
  for (Edge& edge : layers.rebel_edges) edge.rebel = true;
  for (Circle& circle : layers.rebel_circles) circle.rebel = true;
}

void read_truth(const Json& json, FrameRecord& frame) {
  int index = 0;
  read(json.at("index"), index);
  if (index != frame.index) throw std::runtime_error("is not the frame that the layers are of");
  frame.true_motion = read_motion(json.at("motion"));
  frame.corner_truth = read_columns<sim::CornerTruth>(json.at("corners"));
  frame.object_truth = read_columns<sim::ObjectTruth>(json.at("objects"));
}

/// Hands on one parsed line after the other, and says where it was when something is wrong.
class LineReader {
 public:
  explicit LineReader(const std::filesystem::path& path) : path_(path), stream_(path) {
    if (!stream_) throw std::runtime_error("cannot read " + path.string());
  }
  template <class Use>
  bool next(Use&& use) {
    std::string text;
    if (!std::getline(stream_, text)) return false;
    ++line_;
    try {
      use(Json::parse(text));
    } catch (const std::exception& error) {
      throw std::runtime_error(path_.string() + ":" + std::to_string(line_) + ": " + error.what());
    }
    return true;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(path_.string() + ":" + std::to_string(line_) + ": " + what);
  }

 private:
  std::filesystem::path path_;
  std::ifstream stream_;
  int line_ = 0;
};

}  // namespace

Recording read_recording(const std::filesystem::path& folder) {
  Recording recording;
  LineReader layers(folder / kLayersFile);
  LineReader truth(folder / kTruthFile);
  const bool has_header = truth.next([&](const Json& json) {
    read(json.at("scenario"), recording.scenario);
    read(json.at("seed"), recording.seed);
    read(json.at("detector"), recording.detector.name);
    read(json.at("layered"), recording.detector.layered);
    if (json.contains("world")) recording.world = json.at("world").get<decltype(recording.world)>();
    recording.objects = read_columns<sim::Object>(json.at("objects"));
  });
  if (!has_header) truth.fail("is empty");

  while (true) {
    FrameRecord frame;
    if (!layers.next([&](const Json& json) { read_layers(json, frame); })) break;
    if (!truth.next([&](const Json& json) { read_truth(json, frame); })) {
      truth.fail("ends before the layers do");
    }
    recording.frames.push_back(std::move(frame));
  }
  if (truth.next([](const Json&) {})) layers.fail("ends before the truth does");
  return recording;
}

}  // namespace lcs::bench
