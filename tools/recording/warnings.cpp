#include "tools/recording/warnings.h"

#include <fmt/format.h>

#include "tools/files/json_node.h"
#include "tools/files/output_file.h"

namespace lcs::recording {

void WarningWatch::add(const FrameRecord& frame) {
  if (frames_++ == 0) start_ns_ = frame.t_ns;
  if (frame.corners_px.size() < kFewCorners && few_++ == 0) few_ns_ = frame.t_ns;
  if (is_recorded_) motion_.add(frame);
}

Warned WarningWatch::few_corners() const {
  if (frames_ == 0) return {"few_corners", std::nullopt, ""};
  if (2 * few_ <= frames_) return {"few_corners", 0, ""};
  return {"few_corners", few_,
          fmt::format("fewer than {} corners are in {} of {} frames, first at {:.2f} s: see what "
                      "the camera sees (video.mp4), or lower corners.threshold",
                      kFewCorners, few_, frames_, 1e-9 * static_cast<double>(few_ns_ - start_ns_))};
}

std::vector<Warned> WarningWatch::warned(const std::optional<sim::Warnings>& world) const {
  std::vector<Warned> all;
  for (std::size_t i = 0; i < sim::kWarnings.size(); ++i) {
    all.push_back({sim::kWarnings[i].word, std::nullopt, ""});
    if (!world) continue;
    const sim::Warnings::Met& met = world->of(static_cast<sim::Warning>(i));
    all.back() = {sim::kWarnings[i].word, met.count, met.first};
  }
  all.push_back(few_corners());
  for (const Warned& warning : motion_.warnings()) {
    all.push_back(warning);
    if (!is_recorded_ || frames_ == 0) all.back().count.reset();
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
  files::Json json;
  for (const Warned& warned : warnings) {
    if (warned.count) json[warned.word] = {{"count", *warned.count}, {"first", warned.text}};
  }
  // A body's name may hold any bytes; JSON holds UTF-8 only.
  files::write_file(path, files::json_text(json, 1) + '\n');
}

std::vector<Warned> read_warnings(const std::filesystem::path& path) {
  constexpr input::FileKind kWarningsDocument{input::kMebibyte,
                                              "name the folder of a whole run, or run it again"};
  return files::read_json(path, kWarningsDocument, [](const files::JsonNode& node) {
    std::vector<Warned> all;
    node.each_entry([&](const std::string& word, const files::JsonNode& warned) {
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

}  // namespace lcs::recording
