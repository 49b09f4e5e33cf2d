
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/report/page_writer.h"
#include "tools/report/report_page.h"
#include "tools/scoring/metrics.h"
#include "tools/scoring/statistics.h"
#include "tools/suite/interval.h"
#include "tools/suite/judgement.h"
#include "tools/suite/summary.h"

namespace lcs::report {

extern const std::string_view kWorldsCss;  // worlds.css

namespace {

using suite::ScenarioResult;
using suite::SuiteResult;

constexpr std::string_view kCorners = "dimension.corners_mean", kFrames = "frames";

/// All worlds of a family, or a single one.
using Worlds = std::vector<const ScenarioResult*>;

std::vector<double> figures_of(const SuiteResult& by, const Worlds& worlds,
                               std::string_view figure) {
  std::vector<double> figures;
  for (const ScenarioResult* world : worlds) {
    if (const auto value = suite::mean_over_seeds(by, world->name, figure)) {
      figures.push_back(*value);
    }
  }
  return figures;
}

Html cell(const SuiteResult& by, const Worlds& worlds, const scoring::Metric& metric) {
  const std::vector<double> figures = figures_of(by, worlds, metric.key);
  const int decimals = metric.scale.decimals;
  if (figures.empty()) return {"<td class=\"nothing\">–</td>"};
  const suite::Interval mean = suite::interval_of(figures);
  std::string text = fmt::format("<td>{:.{}f}", mean.mean, decimals);
  if (mean.half)
    text += fmt::format("<span class=\"spread\">±{:.{}f}</span>", *mean.half, decimals);
  return {text + "</td>"};
}

class WorldsPage : public TextPage {
 public:
  WorldsPage(const fs::path& folder, const std::string& about, const SuiteResult& suite,
             std::span<const SuiteResult> others)
      : TextPage("lcs: worlds", kWorldsCss), folder_(folder), suite_(suite), detectors_{&suite} {
    for (const SuiteResult& other : others) detectors_.push_back(&other);
    for (const ScenarioResult& scenario : suite.scenarios) {
      const std::string family = family_of(scenario);
      const auto found = std::find_if(families_.begin(), families_.end(),
                                      [&](const auto& each) { return each.first == family; });
      (found == families_.end() ? families_.emplace_back(family, Worlds{}) : *found)
          .second.push_back(&scenario);
      all_.push_back(&scenario);
    }
    head(about);
    for (const auto& [family, worlds] : families_) {
      add("<section id=\"{0}\">\n<h2>{0}</h2>\n<p class=\"facts\"><span>{1} {2}</span>", family,
          worlds.size(), worlds.size() == 1 ? "world" : "worlds");
      say(worlds, kCorners, "corners a frame");
      add("</p>\n");
      table(worlds);
      for (const ScenarioResult* world : worlds) article(*world);
      add("</section>\n");
    }
  }

 private:
  static std::string family_of(const ScenarioResult& scenario) {
    return scenario.drawn && !scenario.drawn->family.empty() ? scenario.drawn->family : "others";
  }

  void head(const std::string& about) {
    add("<header>\n<h1>Worlds</h1>\n<p>{}</p>\n<div class=\"facts\"><span><b>{}</b> "
        "worlds</span><span><b>{}</b> drawn again</span><span>{}</span>",
        about, all_.size(), suite::drawn_again(suite_), suite_.version);
    for (const std::string& set : suite_.sets) add("<span><code>{}</code></span>", set);
    add("<span><a href=\"{0}\">{0}</a></span></div>\n", kReportFile);
    add("<p class=\"small\">Pictures: first, middle and last frame, with the truth's boxes: <b "
        "class=\"moves\">moves</b>, <b class=\"stands\">stands</b>. Plan from above, as drawn: <b "
        "class=\"rover\">the rover's way</b> and what it sees at first and at last, <b "
        "class=\"moves\">the movers'</b>. ±: 95 % interval of the mean over worlds.</p>\n");
    add("<h2>{} by family</h2>\n<div class=\"scroll\"><table>\n<thead><tr><th>family</th>",
        scoring::metric(scoring::kF1).label);
    for (const SuiteResult* by : detectors_) add("<th>{}</th>", by->detector);
    add("</tr></thead>\n<tbody>\n");
    for (const auto& [family, worlds] : families_) {
      add("<tr><td><a href=\"#{0}\">{0}</a></td>", family);
      f1_cells(worlds);
    }
    add("<tr><td><b>all</b></td>");
    f1_cells(all_);
    add("</tbody></table></div>\n</header>\n");
  }

  void f1_cells(const Worlds& worlds) {
    for (const SuiteResult* by : detectors_) {
      add("{}", cell(*by, worlds, scoring::metric(scoring::kF1)));
    }
    add("</tr>\n");
  }

  /// Adds a table with a row per detector.
  void table(const Worlds& worlds) {
    const std::vector<std::string_view> keys = scoring::keys_in(scoring::Table::worlds);
    add("<div class=\"scroll\"><table>\n<thead><tr><th></th>");
    for (const std::string_view key : keys) {
      const scoring::Metric& metric = scoring::metric(key);
      add("<th title=\"{}\">{}</th>", metric.tooltip(), metric.heading());
    }
    add("</tr></thead>\n<tbody>\n");
    for (const SuiteResult* by : detectors_) {
      add("<tr><td>{}</td>", by->detector);
      for (const std::string_view key : keys) {
        add("{}", cell(*by, worlds, scoring::metric(key)));
      }
      add("</tr>\n");
    }
    add("</tbody></table></div>\n");
  }

  /// Adds a figure that does not depend on the detector, rounded.
  void say(const Worlds& worlds, std::string_view figure, const char* what) {
    const auto mean = scoring::mean(figures_of(suite_, worlds, figure));
    if (mean) add("<span>{:.0f} {}</span>", *mean, what);
  }

  void article(const ScenarioResult& world) {
    add("<article id=\"{0}\">\n<h3>{0} <a href=\"#{1}\">#</a>", world.name,
        suite::anchor_of(world.name));
    say({&world}, kFrames, "frames");
    say({&world}, kCorners, "corners a frame");
    if (suite::is_in(world, "static")) {
      add("<span>nothing moves</span>");
    }
    const std::uint64_t again = world.drawn ? world.drawn->again : 0;
    if (again > 0) add("<span>drawn again {} {}</span>", again, again == 1 ? "time" : "times");
    add("</h3>\n");
    if (const fs::path sheet = sheet_path(world); fs::exists(folder_ / sheet)) {
      add("<a href=\"{0}\"><img src=\"{0}\" alt=\"{1}: three pictures and the plan\" "
          "width=\"1920\" height=\"360\" loading=\"lazy\"/></a>\n",
          suite::address_of(sheet.generic_string()), world.name);
    }
    add("<div class=\"beside\">\n");
    table({&world});
    add("<div class=\"words\"><p>");
    if (world.drawn) {
      for (const std::string& feature : world.drawn->features) {
        add("<span class=\"feature\">{}</span>", feature);
      }
    }
    add("</p>\n");
    for (const suite::RunResult& run : world.runs) links(world, run);
    add("</div>\n</div>\n</article>\n");
  }

  void links(const ScenarioResult& world, const suite::RunResult& run) {
    add("<p><code>lcs run {} --seed {}</code>", world.file.generic_string(), run.seed);
    if (!run.error.empty()) add(" <span class=\"error\">{}</span>", run.error);
    add(" <a href=\"{}#{}\">report</a>", kReportFile, suite::anchor_of(world.name, run.seed));
    if (!run.folder.empty()) {
      add(" <a href=\"{}/\">files</a>", suite::address_of(run.folder.generic_string()));
    }
    add("</p>\n");
  }

  const fs::path& folder_;
  const SuiteResult& suite_;
  std::vector<const SuiteResult*> detectors_;
  std::vector<std::pair<std::string, Worlds>> families_;
  Worlds all_;
};

}  // namespace

fs::path sheet_path(const ScenarioResult& scenario) {
  return fs::path(kSheetsFolder) / (scenario.name + ".jpg");
}

void write_worlds_page(const fs::path& suite_folder, const std::string& about,
                       const SuiteResult& suite, std::span<const SuiteResult> others) {
  WorldsPage(suite_folder, about, suite, others).write(suite_folder / kWorldsFile);
}

}  // namespace lcs::report
