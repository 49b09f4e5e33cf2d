#include "tools/recording/warnings.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/files/json_node.h"
#include "tools/files/output_file.h"
#include "tools/recording/motion_warnings.h"

namespace lcs::bench {
namespace {

constexpr const char* kFewCornersWord = "few_corners";

Warned few_corners(const Recording& recording) {
  const auto has_few = [](const FrameRecord& frame) {
    return frame.corners_px.size() < kFewCorners;
  };
  const auto& frames = recording.frames;
  const std::int64_t few = std::count_if(frames.begin(), frames.end(), has_few);
  Warned warned{kFewCornersWord, 0, ""};
  if (frames.empty()) warned.count.reset();
  if (2 * few <= std::ssize(frames)) return warned;
  const auto first = std::find_if(frames.begin(), frames.end(), has_few);
  warned.count = few;
  warned.text = fmt::format(
      "fewer than {} corners are in {} of {} frames, first at {:.2f} s: see what the camera sees "
      "(video.mp4), or lower corners.threshold",
      kFewCorners, few, frames.size(),
      1e-9 * static_cast<double>(first->t_ns - frames.front().t_ns));
  return warned;
}

}  // namespace

std::vector<Warned> warnings_of(const Recording& recording) {
  std::vector<Warned> all;
  for (std::size_t i = 0; i < sim::kWarnings.size(); ++i) {
    Warned& warned = all.emplace_back(Warned{sim::kWarnings[i].word, std::nullopt, ""});
    if (!recording.warnings) continue;
    const sim::Warnings::Met& met = recording.warnings->of(static_cast<sim::Warning>(i));
    warned.count = met.count;
    warned.text = met.first;
  }
  all.push_back(few_corners(recording));
  const bool is_recorded = recording.truth != Truth::all && !recording.frames.empty();
  for (const MotionWarning& warning : motion_warnings(is_recorded ? recording : Recording{})) {
    all.push_back({warning.word, warning.count, warning.text});
    if (!is_recorded) all.back().count.reset();
  }
  return all;
}

std::vector<std::string> lines_of(const std::vector<Warned>& warnings) {
  std::vector<std::string> lines;
  for (const Warned& warned : warnings) {
    if (warned.count.value_or(0) == 0) continue;
    lines.push_back(fmt::format("{} (warnings.{}: {})", warned.text, warned.word, *warned.count));
  }
  return lines;
}

void write_warnings(const std::filesystem::path& path, const std::vector<Warned>& warnings) {
  nlohmann::ordered_json json;
  for (const Warned& warned : warnings) {
    if (warned.count) json[warned.word] = {{"count", *warned.count}, {"first", warned.text}};
  }
  // A body's name may hold any bytes; JSON holds UTF-8 only.
  write_file(path, json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
}

std::vector<Warned> read_warnings(const std::filesystem::path& path) {
  constexpr input::FileKind kWarningsDocument{input::kMebibyte,
                                              "name the folder of a whole run, or run it again"};
  return read_json(path, kWarningsDocument, [](const JsonNode& node) {
    std::vector<Warned> all;
    node.each_entry([&](const std::string& word, const JsonNode& warned) {
      const auto count = warned["count"].natural<std::int64_t>();
      const std::string first = warned["first"].text();
      warned["first"].require(count == 0 || !first.empty(), "what is told of the first time");
      all.push_back({word, count, first});
    });
    return all;
  });
}

std::optional<sim::Warnings> world_warnings(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kWarningsFile;
  if (!std::filesystem::exists(path)) return std::nullopt;
  sim::Warnings warnings;
  for (const Warned& warned : read_warnings(path)) {
    for (std::size_t i = 0; i < sim::kWarnings.size(); ++i) {
      if (warned.word == sim::kWarnings[i].word) {
        warnings.of(static_cast<sim::Warning>(i)) = {*warned.count, warned.text, {}};
      }
    }
  }
  return warnings;
}

}  // namespace lcs::bench
