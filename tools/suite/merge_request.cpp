#include "tools/suite/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <optional>
#include <utility>

#include "tools/files/output_file.h"
#include "tools/scoring/events.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

using scoring::in_markdown;

/// Scenarios that are listed; the others are counted.
constexpr std::size_t kMostRemarks = 10;

std::string bytes_of(const std::string& base64) {
  std::string bytes(base64.size() / 4 * 3, '\0');
  const int size = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()),
                                   reinterpret_cast<const unsigned char*>(base64.data()),
                                   static_cast<int>(base64.size()));
  const auto padding = std::ranges::count(base64, '=');
  bytes.resize(static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, size - padding)));
  return bytes;
}

// ---- The event that grew most

struct Grown {
  std::string run;  ///< such as "rain seed 2"
  scoring::ScoredEvent after;
  /// Of the same family and object, in some of the same frames.
  std::optional<scoring::ScoredEvent> before;
};

/// Corners, circles or frames, which are compared only within a family.
int cost_of(const scoring::ScoredEvent& event) {
  const int costs[] = {event.corners, event.circles, event.frames};
  return costs[static_cast<std::size_t>(family_of(event.kind))];
}

std::vector<scoring::ScoredEvent> events_in(const SuiteInFolder& suite, const RunResult& run) {
  const fs::path file = suite.events_of(run);
  return file.empty() ? std::vector<scoring::ScoredEvent>() : scoring::read_events(file);
}

const scoring::ScoredEvent* former(const scoring::ScoredEvent& event,
                                   const std::vector<scoring::ScoredEvent>& before) {
  const scoring::ScoredEvent* worst = nullptr;
  for (const scoring::ScoredEvent& other : before) {
    if (family_of(other.kind) != family_of(event.kind) || other.object != event.object ||
        other.first_frame > event.last_frame || other.last_frame < event.first_frame) {
      continue;
    }
    if (worst == nullptr || cost_of(other) > cost_of(*worst)) worst = &other;
  }
  return worst;
}

/// Absent if no event has grown. A rebel event is preferred to one of circles or squares.
std::optional<Grown> most_grown(const SuiteInFolder& before, const SuiteInFolder& after) {
  std::optional<Grown> most;
  std::pair<bool, int> most_growth{false, 0};
  for (const ScenarioResult& scenario : after.suite.scenarios) {
    const ScenarioResult* earlier = find(before.suite, scenario.name);
    for (const RunResult& run : scenario.runs) {
      const RunResult* same = earlier ? find(*earlier, run.seed) : nullptr;
      if (same == nullptr || same->metrics.empty()) continue;
      const std::vector<scoring::ScoredEvent> then = events_in(before, *same);
      for (scoring::ScoredEvent& event : events_in(after, run)) {
        const scoring::ScoredEvent* was = former(event, then);
        const std::pair growth{family_of(event.kind) == scoring::EventFamily::rebels,
                               cost_of(event) - (was ? cost_of(*was) : 0)};
        if (growth.second <= 0 || growth <= most_growth) continue;
        most_growth = growth;
        most = Grown{fmt::format("{} seed {}", scenario.name, run.seed), std::move(event),
                     was ? std::optional(*was) : std::nullopt};
      }
    }
  }
  return most;
}

/// The view with a picture that is nearest to a frame; null without one.
const scoring::EventView* view_near(const scoring::ScoredEvent& event, int frame) {
  const auto nearest = std::ranges::min_element(event.views, {}, [&](const auto& view) {
    return std::pair(view.jpeg_base64.empty(), std::abs(view.frame - frame));
  });
  const bool is_there = nearest != event.views.end() && !nearest->jpeg_base64.empty();
  return is_there ? &*nearest : nullptr;
}

/// One side's picture, as a cell of the table.
std::string picture(const fs::path& folder, const std::string& name,
                    const scoring::ScoredEvent* event, int frame, const std::string& pictures_at) {
  if (event == nullptr) return "no such event in these frames";
  const scoring::EventView* view = view_near(*event, frame);
  if (view == nullptr) return "the suite keeps no pictures";
  files::write_file(folder / name, bytes_of(view->jpeg_base64));
  return picture_link(view->frame, name, pictures_at);
}

std::string event_text(const fs::path& folder, const Grown& grown, const std::string& pictures_at) {
  constexpr const char* kUnits[] = {"corners", "circles", "frames"};
  const scoring::ScoredEvent& event = grown.after;
  const int middle = (event.first_frame + event.last_frame) / 2;
  const scoring::EventView* shown = view_near(event, middle);
  const int frame = shown ? shown->frame : middle;
  const int was = grown.before ? cost_of(*grown.before) : 0;
  const std::string object =
      event.object_name.empty() ? "" : fmt::format(" `{}`", in_markdown(event.object_name));
  std::string text = fmt::format(
      "\n**The event that grew most**: {}, frames {} to {}: {}{}, {} {} (before: {}).\n\n",
      in_markdown(grown.run), event.first_frame, event.last_frame, text_of(event.kind).meaning,
      object, cost_of(event), kUnits[static_cast<std::size_t>(family_of(event.kind))], was);
  text += "| before | after |\n|---|---|\n";
  text += fmt::format(
      "| {} | {} |\n",
      picture(folder, kBeforePicture, grown.before ? &*grown.before : nullptr, frame, pictures_at),
      picture(folder, kAfterPicture, &event, frame, pictures_at));
  return text;
}

// ---- Figures

std::string remarks_text(const SuiteVerdict& verdict) {
  if (verdict.remarks.empty()) return "";
  std::string text = "\n<details><summary>Scenarios, worst first</summary>\n\n";
  for (std::size_t i = 0; i < std::min(kMostRemarks, verdict.remarks.size()); ++i) {
    const Remark& remark = verdict.remarks[i];
    text += fmt::format("* `{}` {}: {}\n", in_markdown(remark.scenario), text_of(remark.standings),
                        in_markdown(fmt::format("{}", fmt::join(remark.reasons, "; "))));
  }
  if (verdict.remarks.size() > kMostRemarks) {
    text += fmt::format("* and {} more\n", verdict.remarks.size() - kMostRemarks);
  }
  return text + "\n</details>\n";
}

}  // namespace

std::string picture_link(int frame, const std::string& name, const std::string& pictures_at) {
  return fmt::format("![frame {}]({}{}{})", frame, pictures_at,
                     pictures_at.empty() || pictures_at.ends_with('/') ? "" : "/", name);
}

void write_merge_request(const fs::path& folder, const SuiteInFolder& before,
                         const SuiteInFolder& after, const Comparison& comparison,
                         const SuiteVerdict& verdict, const std::string& pictures_at) {
  constexpr std::array<const char*, 3> kLights{"🔴", "🟡", "🟢"};
  std::string headline = word_of(verdict.finding.value());
  headline.front() = static_cast<char>(std::toupper(headline.front()));
  std::string text =
      fmt::format("### {} {}\n\n{}\n", kLights.at(static_cast<std::size_t>(verdict.light)),
                  headline, in_markdown(verdict.line));
  text += fmt::format("\nMeans, with the {:.3g} % interval of each change:\n\n{}",
                      100 * (1 - comparison.level),
                      means_text(comparison, false, scoring::Format::markdown));
  if (const auto grown = most_grown(before, after)) text += event_text(folder, *grown, pictures_at);
  text += remarks_text(verdict);
  files::write_file(folder / kSummaryFile, text);
}

}  // namespace lcs::suite
