#include "tools/comparators/detectors.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <ranges>
#include <stdexcept>
#include <utility>

#include "tools/comparators/flow_detectors.h"
#include "tools/recording/detections.h"
#include "tools/recording/recording_io.h"

namespace lcs::comparators {
namespace {

/// Detections read from a CSV file (tools/recording/DETECTIONS.md), frame by frame.
class StoredDetections : public bench::Detector {
 public:
  /// \param sequence with the frames that will be processed, in order.
  /// \throws input::Error naming file and line.
  StoredDetections(const std::filesystem::path& csv, recording::Recording sequence)
      : said_(recording::read_detections(csv, std::move(sequence))) {}

  const FrameResult& step(const bench::DetectorInput&) override {
    recording::FrameRecord& frame = said_.recording.frames.at(next_++);
    result_.verdicts = std::move(frame.verdicts);
    result_.layers = std::move(frame.layers);
    masks_ = std::move(frame.masks);
    return result_;
  }
  double recording::FrameTimes::*step_time() const override { return nullptr; }
  bool gives_circles() const override { return said_.recording.detector.circles; }
  const recording::SquareMasks& masks() const override { return masks_; }
  std::vector<std::string> remarks() const override { return recording::lines_of(said_.counts); }

 private:
  recording::Detections said_;
  std::size_t next_ = 0;
  FrameResult result_;
  recording::SquareMasks masks_;
};

using Made = std::unique_ptr<bench::Detector>;

Made make_lcs(const Intrinsics& camera, const scenario::Scenario& scenario) {
  return std::make_unique<bench::LcsDetector>(camera, bench::filter_parameters(scenario));
}

template <class OfCamera>
Made make_of_camera(const Intrinsics& camera, const scenario::Scenario&) {
  return std::make_unique<OfCamera>(camera);
}

constexpr std::array<DetectorKind, 3> kDetectors{{
    {"lcs", "the Line-Circle-Square filter", true, false, make_lcs},
    {"klt", "Lucas-Kanade, and distance to the epipolar segment that the IMU gives", false, true,
     make_of_camera<KltDetector>},
    {"dis", "dense flow, and distance to the epipolar segment", false, true,
     make_of_camera<DisDetector>},
}};

constexpr DetectorKind kProgram{"program", "a program of yours", false, true, nullptr};
constexpr DetectorKind kFile{"file", "what a detector has written", false, false, nullptr};

/// Checks a name: only characters that are valid in a folder's name and a test's name.
std::string own_name(const std::string& name) {
  const bool is_plain =
      !name.empty() && name.front() != '.' && std::ranges::all_of(name, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
      });
  if (!is_plain) {
    throw std::invalid_argument(
        fmt::format("'{}' cannot be a detector's name; give one of letters, digits, '_', '-' and "
                    "'.' by --detector",
                    name));
  }
  for (const DetectorKind& each : kDetectors) {
    if (each.name != name) continue;
    throw std::invalid_argument(fmt::format(
        "{} is a detector of this program; give yours another name by --detector", name));
  }
  return name;
}

/// For "python3 mine.py" it is python3.
std::string program_name(const std::string& command) {
  const std::size_t begin = command.find_first_not_of(" \t\n");
  if (begin == std::string::npos) return "";
  const std::size_t end = command.find_first_of(" \t\n", begin);
  return std::filesystem::path(command.substr(begin, end - begin)).stem().string();
}

}  // namespace

std::span<const DetectorKind> detectors() {
  return kDetectors;
}

const DetectorKind& detector(std::string_view name) {
  const auto found = std::ranges::find(kDetectors, name, &DetectorKind::name);
  if (found != kDetectors.end()) return *found;
  throw std::invalid_argument(
      fmt::format("no detector is called '{}'; there are {}", name,
                  fmt::join(kDetectors | std::views::transform(&DetectorKind::name), ", ")));
}

DetectorSpec spec_of(const std::string& name) {
  const std::size_t colon = name.find(':');
  const DetectorKind& found = detector(name.substr(0, colon));
  if (colon == std::string::npos) return {name, found, ""};
  if (!found.layered) {
    throw std::invalid_argument(fmt::format(
        "detector {}: {} has no presets, which are the filter's; give {} alone, or lcs:{}", name,
        found.name, found.name, name.substr(colon + 1)));
  }
  const std::string preset = name.substr(colon + 1);
  lcs::preset(preset);  // throws if unknown
  return {name, found, preset};
}

DetectorSpec spec_of_program(const std::string& name, const Program& program) {
  return {own_name(name.empty() ? program_name(program.command) : name), kProgram, "", program, {}};
}

DetectorSpec spec_of_file(const std::string& name, const std::filesystem::path& detections_file) {
  return {own_name(name.empty() ? detections_file.stem().string() : name), kFile, "", std::nullopt,
          detections_file};
}

std::unique_ptr<bench::Detector> make(const DetectorSpec& spec, const DetectorContext& context) {
  if (!spec.detections_file.empty()) {
    if (context.recorded.empty()) {
      throw std::invalid_argument(
          "--detections are of the frames of an earlier run; name it by --recorded");
    }
    return std::make_unique<StoredDetections>(spec.detections_file,
                                              recording::read_recording(context.recorded));
  }
  if (!spec.program) return spec.detector.make(context.camera, context.scenario);
  return std::make_unique<ProgramDetector>(spec.name, *spec.program, context);
}

std::vector<std::string> apply_preset(const DetectorSpec& spec, scenario::Scenario& scenario) {
  bench::filter_parameters(scenario);  // throws for invalid settings, even unused ones
  std::vector<std::string> lines;
  if (spec.preset.empty()) return lines;
  const auto leave_out = [&](std::string_view key, const input::Source& where) {
    if (!where.file.starts_with("--set ")) return;
    lines.push_back(
        fmt::format("filter.{} has no effect with {}, which is the preset alone", key, spec.name));
  };
  leave_out("preset", scenario.filter_preset_source);
  for (const scenario::FilterSetting& setting : scenario.filter) {
    leave_out(setting.key, setting.source);
  }
  scenario.filter_preset = spec.preset;
  scenario.filter.clear();
  return lines;
}

void require_corners_suffice(const DetectorSpec& spec) {
  if (!spec.detector.sees_pictures || spec.program) return;
  throw std::invalid_argument(fmt::format(
      "{} looks at the pictures, and a recording has corners; leave out --recorded", spec.name));
}

}  // namespace lcs::comparators
