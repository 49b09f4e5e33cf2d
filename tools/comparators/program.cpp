#include "tools/comparators/program.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "scenarios/input/message.h"
#include "tools/files/json_node.h"
#include "tools/recording/recording_io.h"

namespace lcs::comparators {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kIndex = "index", kCircle = "circle", kMask = "mask";

Json parsed(const std::string& line) {
  const std::string shown = input::one_line(std::string_view(line).substr(0, 200));
  constexpr const char* kRemedy = "write one object of JSON in a line, and nothing else";
  try {
    Json json = files::parse_json<Json>(line);
    if (json.is_object()) return json;
  } catch (const files::JsonError& error) {
    throw DetectorError(fmt::format("its answer '{}': {}; {}", shown, error.what(), kRemedy));
  }
  throw DetectorError(fmt::format("its answer is no object: '{}'; {}", shown, kRemedy));
}

/// Adds the detector's name and the place to the errors of `work`.
template <class Work>
decltype(auto) at(const std::string& name, const std::string& place, Work&& work) {
  const auto told = [&](const std::exception& error) {
    return DetectorError(fmt::format("detector {}, {}: {}", name, place, error.what()));
  };
  try {
    return work();
  } catch (const DetectorError& error) {
    throw told(error);
  } catch (const std::invalid_argument& error) {  // from FrameDetections
    throw told(error);
  }
}

/// Appends the values of a row as JSON text, which for numbers equals the text in CSV. A mask in
/// COCO format (an object) gives its size and its counts; counts given as a string are unquoted.
void add_values(const Json& json, bool is_mask, std::vector<std::string>& texts, int depth = 0) {
  constexpr int kOfCounts = 2;  // nesting depth of counts in an object in a row
  if (json.is_array() && depth <= (is_mask ? kOfCounts : 0)) {
    for (const Json& value : json) add_values(value, is_mask, texts, depth + 1);
  } else if (is_mask && json.is_object() && depth < kOfCounts) {
    for (const char* key : {"size", "counts"}) {
      if (json.contains(key)) add_values(json[key], is_mask, texts, depth + 1);
    }
  } else {
    texts.push_back(is_mask && json.is_string() ? json.get<std::string>() : files::json_text(json));
  }
}

/// Adds all rows of one type: each a list of values, or a single value.
void add_rows(const std::string& type, const Json& rows, recording::FrameDetections& detections) {
  if (!rows.is_array()) {
    throw DetectorError(fmt::format("its \"{}\" is no list; give one of rows", type));
  }
  if (rows.empty() && type == kCircle) detections.add(type, {});
  for (const Json& row : rows) {
    std::vector<std::string> texts;
    add_values(row, type == kMask, texts);
    const std::vector<std::string_view> values(texts.begin(), texts.end());
    detections.add(type, values);
  }
}

}  // namespace

ProgramDetector::ProgramDetector(std::string name, const Program& program,
                                 const DetectorContext& context)
    : name_(std::move(name)),
      camera_(context.camera),
      process_(program.command, program.timeout_s, context.on_wait) {
  at(name_, "its greeting", [&] { greet(context); });
}

void ProgramDetector::greet(const DetectorContext& context) {
  const scenario::Scenario& scenario = context.scenario;
  const std::size_t bytes =
      static_cast<std::size_t>(camera_.width_px) * static_cast<std::size_t>(camera_.height_px) * 3;
  const std::string header = fmt::format(
      R"({{"protocol":{},"scenario":{},"seed":{},"frames":{},"rate_hz":{},"camera":{},)"
      R"("picture":{{"pixels":"bgr8","bytes":{},"compressed":{}}}}})",
      kProtocol, files::json_text<Json>(scenario.name), scenario.seed,
      context.frames > 0 ? std::to_string(context.frames) : "null", scenario.camera.rate_hz,
      recording::camera_json(camera_), bytes, !context.recorded.empty());
  const Json greeting = parsed(process_.request(header + '\n'));
  const auto protocol = greeting.find("protocol");
  if (protocol == greeting.end() || *protocol != kProtocol) {
    throw DetectorError(fmt::format(
        "it does not say {{\"protocol\": {0}}}, but '{1}'; speak protocol {0} (PROTOCOL.md)",
        kProtocol, input::one_line(files::json_text(greeting).substr(0, 200))));
  }
  if (const auto circles = greeting.find("circles"); circles != greeting.end()) {
    if (!circles->is_boolean()) {
      throw DetectorError("its \"circles\" is not true or false; say which");
    }
    gives_circles_ = circles->get<bool>();
  }
  if (const auto most = greeting.find(kAnswerBytes); most != greeting.end()) {
    if (!most->is_number_unsigned() || *most > kMostAskedAnswer) {
      throw DetectorError(fmt::format("its \"{}\" is {}; give a whole number up to {}",
                                      kAnswerBytes, files::json_text(*most), kMostAskedAnswer));
    }
    process_.allow_answer(most->get<std::size_t>());
  }
}

void ProgramDetector::read_answer(const std::string& line, recording::FrameRecord& frame) {
  const Json answer = parsed(line);
  const auto index = answer.find(kIndex);
  if (index == answer.end()) {
    throw DetectorError("its answer has no \"index\"; give the index of the answered frame");
  }
  if (*index != frame.index) {
    throw DetectorError(
        fmt::format("its answer has the index {}; give one answer to each frame, in their order",
                    files::json_text(*index)));
  }
  recording::FrameDetections detections(frame, camera_);
  for (const auto& [type, rows] : answer.items()) {
    if (type != kIndex) add_rows(type, rows, detections);
  }
  if (detections.gives_circles() && !gives_circles_) {
    throw DetectorError("it gives circles, and has not said \"circles\": true in its greeting");
  }
  counts_ += detections.finish();
}

const FrameResult& ProgramDetector::step(const bench::DetectorInput& input) {
  if (input.image.empty()) {
    throw DetectorError(
        fmt::format("detector {}: there is no picture of frame {}", name_, input.index));
  }
  recording::FrameRecord frame;
  frame.index = input.index;
  frame.t_ns = input.t_ns;
  frame.corners_px.assign(input.corners_px.begin(), input.corners_px.end());
  const std::optional<EgoMotion> motion = intake_.take(input.motion, diagnostics_);
  const std::string line = recording::given_line(frame, motion ? &*motion : nullptr) + '\n';
  const cv::Mat3b picture = input.image.isContinuous() ? input.image : input.image.clone();
  at(name_, fmt::format("frame {}", frame.index), [&] {
    read_answer(process_.request(line, {picture.data, picture.total() * picture.elemSize()}),
                frame);
  });
  result_.verdicts = std::move(frame.verdicts);
  result_.layers = std::move(frame.layers);
  masks_ = std::move(frame.masks);
  return result_;
}

void ProgramDetector::finish() {
  at(name_, "after the last frame", [&] { process_.finish(); });
}

std::vector<std::string> ProgramDetector::remarks() const {
  std::vector<std::string> lines = recording::lines_of(counts_);
  for (const std::string& line : process_.said()) {
    lines.push_back(fmt::format("{}: {}", name_, line));
  }
  return lines;
}

}  // namespace lcs::comparators
