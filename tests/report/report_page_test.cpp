#include "tools/report/report_page.h"

#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/scoring/whole_recordings.h"
#include "tests/tools/files.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/files/output_file.h"
#include "tools/output/video.h"
#include "tools/report/page_writer.h"
#include "tools/scoring/events.h"
#include "tools/scoring/figures_file.h"

namespace lcs::report {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using suite::Outcome;
using suite::RunResult;
using suite::ScenarioResult;
using suite::SuiteResult;
using test::TemporaryFolder;

const std::string kNasty = "a<b>&\"'</script><!--\xff";

RunResult run_with(std::uint64_t seed, double f1) {
  RunResult run;
  run.seed = seed;
  run.outcome = f1 >= 0.5 ? Outcome::passed : Outcome::failed;
  run.metrics = {{"rebel.f1", f1}, {"rebel.recall", std::nullopt}};
  scoring::JudgedCriterion& criterion = run.criteria.emplace_back();
  criterion.metric = "rebel.f1";
  criterion.min = 0.5;
  criterion.value = f1;
  criterion.met = f1 >= 0.5;
  run.wall_s = 1.5;
  return run;
}

ScenarioResult scenario_with(const std::string& name, std::vector<RunResult> runs) {
  ScenarioResult scenario;
  scenario.name = name;
  scenario.purpose = "a box crosses";
  scenario.file = "scenarios/" + name + ".yaml";
  scenario.groups = {"short", "daylight"};
  scenario.runs = std::move(runs);
  return scenario;
}

SuiteResult suite_of(std::vector<ScenarioResult> scenarios) {
  return {.detector = "lcs", .sets = {}, .version = "lcs 1", .scenarios = std::move(scenarios)};
}

scoring::ScoredEvent event_with(int corners, std::size_t picture_bytes) {
  scoring::ScoredEvent event;
  event.kind = scoring::EventKind::found_late;
  event.first_frame = 3;
  event.last_frame = 9;
  event.object = 1;
  event.object_name = "box";
  event.corners = corners;
  event.counted_corners = 2 * corners;
  event.reasons = {{Reason::normal_edge, corners}};
  event.views.resize(1);
  event.views[0].jpeg_base64 = std::string(picture_bytes, 'A');
  return event;
}

class Report : public testing::Test {
 protected:
  /// A run's folder with the given events.
  fs::path run_folder(const std::string& name, const std::vector<scoring::ScoredEvent>& events) {
    const fs::path relative = fs::path("runs") / name;
    fs::create_directories(folder_.path() / relative);
    scoring::write_events(folder_.path() / relative / scoring::kEventsFile, events,
                          scoring::sums_of(events));
    return relative;
  }
  /// The baseline's runs are in "before".
  suite::SuiteInFolder in_folder(const SuiteResult& suite) const { return {suite, folder_.path()}; }
  /// Calls `use` with the verdict and the baseline.
  template <class Use>
  auto judged(const SuiteResult& suite, const SuiteResult* baseline, const Use& use) const {
    if (!baseline) return use(suite::verdict_of(in_folder(suite), nullptr, nullptr), nullptr);
    const suite::SuiteInFolder before{*baseline, folder_.path() / "before"};
    const suite::Comparison comparison =
        suite::compare(*baseline, suite, [](std::string_view) { return true; });
    const Against against{before, comparison};
    return use(suite::verdict_of(in_folder(suite), &before, &comparison), &against);
  }
  std::string data_text(const SuiteResult& suite, const SuiteResult* baseline,
                        std::size_t budget) const {
    return judged(suite, baseline, [&](const suite::SuiteVerdict& verdict, const Against* against) {
      return report_data(in_folder(suite), verdict, against, budget);
    });
  }
  json data(const SuiteResult& suite, const SuiteResult* baseline = nullptr,
            std::size_t budget = kPictureBudget) {
    return json::parse(data_text(suite, baseline, budget));
  }
  std::string page(const SuiteResult& suite, const SuiteResult* baseline = nullptr) {
    const fs::path file = folder_.path() / kReportFile;
    judged(suite, baseline, [&](const suite::SuiteVerdict& verdict, const Against* against) {
      write_report(file, in_folder(suite), verdict, against);
    });
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  const TemporaryFolder folder_;
};

/// The page without the content of its script and style elements, which is no markup.
std::string markup(std::string html) {
  for (const std::string name : {"script", "style"}) {
    for (std::size_t open = html.find('<' + name); open != html.npos;
         open = html.find('<' + name, open + 1)) {
      const std::size_t begin = html.find('>', open) + 1;
      html.erase(begin, html.find("</" + name + '>', begin) - begin);
    }
  }
  return html;
}

/// The JSON in the page.
json data_of(const std::string& html) {
  const std::string open = R"(<script type="application/json" id="data">)";
  const std::size_t begin = html.find(open) + open.size();
  return json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

TEST_F(Report, IsWellFormedWhateverNamesHold) {
  ScenarioResult scenario = scenario_with(kNasty, {run_with(1, 0.8)});
  scenario.purpose = kNasty;
  scenario.groups = {kNasty};
  scenario.point = {{kNasty, kNasty}};
  scenario.runs[0].error = kNasty;
  SuiteResult suite = suite_of({scenario});
  suite.detector = kNasty;
  suite.sets = {kNasty};
  const std::string html = page(suite, &suite);
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(markup(html).c_str()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  EXPECT_NE(html.find("<title>lcs suite: a&lt;b&gt;&amp;"), html.npos);
  // Two elements end with </script>: the data and the script. No name adds another one.
  std::size_t ends = 0;
  for (std::size_t at = html.find("</script>"); at != html.npos;
       at = html.find("</script>", at + 1)) {
    ++ends;
  }
  EXPECT_EQ(ends, 2u);
  // The same name, except for the byte that is invalid UTF-8.
  const std::string name = data_of(html).at("scenarios")[0].at("name");
  EXPECT_EQ(name, kNasty.substr(0, kNasty.size() - 1) + "\xef\xbf\xbd");
}

TEST_F(Report, OfWorldsIsWellFormedAndHasEachWithTheFiguresOfAllDetectors) {
  ScenarioResult one = scenario_with("room_1", {run_with(1, 0.8)});
  one.drawn = suite::Drawn{"room", 2, {"slope", kNasty}};
  one.runs[0].folder = "runs/room_1/seed-1";
  ScenarioResult broken = scenario_with(kNasty, {run_with(2, 0.4)});
  broken.drawn = suite::Drawn{kNasty, 0, {}};
  broken.runs[0].metrics.clear();
  broken.runs[0].error = kNasty;
  const SuiteResult suite = suite_of({one, broken});
  SuiteResult other = suite_of({scenario_with("room_1", {run_with(1, 0.6)})});
  other.detector = kNasty;
  fs::create_directory(folder_.path() / kSheetsFolder);
  std::ofstream(folder_.path() / sheet_path(one)) << "a picture";
  write_worlds_page(folder_.path(), kNasty, suite, {{other}});
  std::ifstream stream(folder_.path() / kWorldsFile, std::ios::binary);
  const std::string html{std::istreambuf_iterator<char>(stream), {}};
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(markup(html).c_str()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  for (const char* part :
       {"<td>0.80</td>", "<td>0.60</td>", "drawn again 2 times", "<b>1</b> drawn again",
        "src=\"worlds/room_1.jpg\"", "href=\"runs/room_1/seed-1/\"", "report.html#room_1/seed-1",
        "<span class=\"feature\">slope</span>"}) {
    EXPECT_NE(html.find(part), html.npos) << part;
  }
  EXPECT_EQ(html.find("<script"), html.npos);
  EXPECT_EQ(html.find("<img"), html.rfind("<img"));  // there is only one sheet
}

TEST_F(Report, OfWorldsTakesNoNameForMarkupOrForAScheme) {
  ScenarioResult world = scenario_with("x\" onerror=\"alert(1)", {run_with(1, 0.8)});
  world.drawn = suite::Drawn{"f\" onclick=\"alert(2)", 0, {"<img src=y>"}};
  world.runs[0].folder = "javascript:alert(3)";
  fs::create_directory(folder_.path() / kSheetsFolder);
  std::ofstream(folder_.path() / sheet_path(world)) << "a picture";
  write_worlds_page(folder_.path(), "about", suite_of({world}), {});
  const std::string html = test::read(folder_.path() / kWorldsFile);
  EXPECT_NE(html.find("<img src=\"worlds/x%22%20onerror=%22alert(1).jpg\""), html.npos);
  for (const char* sign : {"\" onerror", "\" onclick", "<img src=y", "=\"javascript:"}) {
    EXPECT_EQ(html.find(sign), html.npos) << sign;
  }
}

TEST(TextPage, EscapesAllThatIsNotHtmlItself) {
  TextPage page("t", "");
  page.add("<i>{}</i>{} {:.1f}", std::string("<b>"), Html{"<hr/>"}, 1.25);
  const TemporaryFolder folder;
  page.write(folder.path() / "page.html");
  const std::string html = test::read(folder.path() / "page.html");
  EXPECT_NE(html.find("<i>&lt;b&gt;</i><hr/> 1.2"), html.npos) << html;
}

TEST_F(Report, AsksTheNetworkForNothing) {
  const std::string html = page(suite_of({scenario_with("one", {run_with(1, 0.8)})}));
  std::string rest = html;
  // A comment and the name of SVG's elements, which are never fetched.
  for (const std::string name : {"https://github.com/leeoniya/uPlot", "http://www.w3.org/2000/svg"})
    rest.erase(rest.find(name), name.size());
  for (const char* sign : {"http:", "https:", "url(", "@import", "<link", " src=\"", "fetch(",
                           "XMLHttpRequest", "import("}) {
    EXPECT_EQ(rest.find(sign), rest.npos) << sign;
  }
  EXPECT_NE(html.find("default-src 'none'"), html.npos);
}

TEST_F(Report, HasEachScenarioWithItsMeanSpreadAndOutcome) {
  const json all = data(suite_of({scenario_with("good", {run_with(1, 0.8), run_with(2, 0.9)}),
                                  scenario_with("bad", {run_with(1, 0.8), run_with(2, 0.2)})}));
  ASSERT_EQ(all.at("scenarios").size(), 2u);
  const json& good = all["scenarios"][0];
  EXPECT_EQ(good.at("name"), "good");
  EXPECT_EQ(good.at("outcome"), "passed");
  EXPECT_NEAR(good.at("figures").at("rebel.f1").at("mean"), 0.85, 1e-12);
  EXPECT_NEAR(good.at("figures").at("rebel.f1").at("spread"), 0.05, 1e-12);
  EXPECT_FALSE(good.at("figures").contains("rebel.recall"));  // undefined
  EXPECT_EQ(all["scenarios"][1].at("outcome"), "failed");
  EXPECT_EQ(all["scenarios"][1]["runs"][1].at("criteria")[0].at("met"), false);
  EXPECT_EQ(all.at("baseline"), nullptr);
}

TEST_F(Report, HasTheF1OfEachScenarioByOtherDetectors) {
  const SuiteResult suite = suite_of({scenario_with("near", {run_with(1, 0.8)})});
  SuiteResult other = suite_of({scenario_with("near", {run_with(1, 0.5), run_with(2, 0.75)})});
  other.detector = "klt";
  const auto verdict = suite::verdict_of(in_folder(suite), nullptr, nullptr);
  const json data = json::parse(report_data(in_folder(suite), verdict, nullptr, kPictureBudget,
                                            std::span<const SuiteResult>(&other, 1)));
  EXPECT_EQ(data.at("beside"), json::parse(R"([{"detector": "klt", "f1": {"near": 0.625}}])"));
}

TEST_F(Report, SetsTheBaselineBesideScenariosOfTheSameName) {
  const SuiteResult now = suite_of(
      {scenario_with("old", {run_with(1, 0.8)}), scenario_with("new", {run_with(1, 0.7)})});
  const SuiteResult before = suite_of({scenario_with("old", {run_with(1, 0.6)})});
  const json all = data(now, &before);
  EXPECT_EQ(all.at("baseline").at("version"), "lcs 1");
  EXPECT_EQ(all["scenarios"][0]["figures"]["rebel.f1"].at("before"), 0.6);
  EXPECT_FALSE(all["scenarios"][1]["figures"]["rebel.f1"].contains("before"));
  const json& group = all.at("groups").at(0);
  EXPECT_EQ(group.at("label"), "short (2)");
  EXPECT_NEAR(group.at("figures").at("rebel.f1").at("mean"), 0.75, 1e-12);
  EXPECT_EQ(group["figures"]["rebel.f1"].at("before"), 0.6);
  EXPECT_NEAR(group["figures"]["rebel.f1"].at("change"), 0.2, 1e-12) << "of the one in common";
}

TEST_F(Report, AChangeIsOfTheSeedsAndScenariosThatBothHave) {
  // Nothing changed per seed, though each suite has a seed and a scenario of its own.
  const SuiteResult now = suite_of({scenario_with("both", {run_with(1, 0.5), run_with(2, 0.9)}),
                                    scenario_with("now", {run_with(1, 0.1)})});
  const SuiteResult before =
      suite_of({scenario_with("then", {run_with(1, 0.7)}),
                scenario_with("both", {run_with(1, 0.5), run_with(3, 0.1)})});
  const json all = data(now, &before);
  const json& both = all["scenarios"][0]["figures"]["rebel.f1"];
  EXPECT_NEAR(both.at("mean"), 0.7, 1e-12);
  EXPECT_EQ(both.at("before"), 0.5);
  EXPECT_EQ(both.at("change"), 0);
  EXPECT_EQ(all.at("groups").at(0)["figures"]["rebel.f1"].at("change"), 0);
  EXPECT_FALSE(all["scenarios"][1]["figures"]["rebel.f1"].contains("change"));

  // Without a common seed there is no comparison.
  const SuiteResult other = suite_of({scenario_with("both", {run_with(7, 0.2)})});
  EXPECT_FALSE(data(now, &other)["scenarios"][0]["figures"]["rebel.f1"].contains("before"));
}

TEST_F(Report, CallsAChangeRealWhereACompareDoes) {
  // A change of 0.1 on average, once within the noise of seeds and once beyond it.
  const SuiteResult before =
      suite_of({scenario_with("noisy", {run_with(1, 0.7), run_with(2, 0.7)}),
                scenario_with("sure", {run_with(1, 0.7), run_with(2, 0.7)})});
  const SuiteResult now = suite_of({scenario_with("noisy", {run_with(1, 0.5), run_with(2, 0.7)}),
                                    scenario_with("sure", {run_with(1, 0.6), run_with(2, 0.6)})});
  const json all = data(now, &before);
  const json& noisy = all["scenarios"][0]["figures"]["rebel.f1"];
  const json& sure = all["scenarios"][1]["figures"]["rebel.f1"];
  EXPECT_NEAR(noisy.at("change"), sure.at("change"), 1e-12);
  EXPECT_EQ(noisy.at("verdict"), "none");
  EXPECT_EQ(sure.at("verdict"), "regressed");
  EXPECT_EQ(all.at("verdict"),
            "no regression found, but a loss of up to 0.735 of rebel.f1 is not excluded (some 25 "
            "times as many seeds would tell 0.02 of rebel.f1 apart), 1 scenario regressed; of 2 "
            "means 0 regressed, 0 improved; of 2 scenarios 1 regressed, 0 improved, 1 as before; 4 "
            "of 4 criteria met, 0 failed");
  EXPECT_EQ(all.at("light"), "yellow");
  ASSERT_EQ(all.at("remarks").size(), 1u);
  EXPECT_EQ(all["remarks"][0].at("scenario"), "sure");
  EXPECT_EQ(all["remarks"][0].at("standings"), (json{"passed", "regressed"}));
  EXPECT_EQ(all["scenarios"][1].at("standings"), (json{"passed", "regressed"}));
  EXPECT_EQ(all["scenarios"][0].at("standings"), json{"passed"});
  EXPECT_EQ(all["remarks"][0].at("reasons")[0], "rebel.f1 0.700 -> 0.600 [-0.100, -0.100]");
}

TEST_F(Report, GivesTheCommandThatRunsItAgain) {
  RunResult run = run_with(7, 0.8);
  run.command = "lcs run 'a b.yaml'";
  EXPECT_EQ(data(suite_of({scenario_with("a b", {run})}))["scenarios"][0]["runs"][0].at("command"),
            run.command);
}

TEST_F(Report, AnErrorHasItsMessageAndNoPlots) {
  RunResult run;
  run.seed = 1;
  run.error = "scene.yaml:3: no such scene";
  const json all = data(suite_of({scenario_with("broken", {run})}));
  const json& told = all["scenarios"][0]["runs"][0];
  EXPECT_EQ(told.at("outcome"), "error");
  EXPECT_EQ(told.at("error"), run.error);
  EXPECT_EQ(told.at("frames"), nullptr);
  EXPECT_EQ(told.at("events"), nullptr);
}

TEST_F(Report, TellsWhatARunWarnsOf) {
  SuiteResult suite = suite_of({scenario_with("near", {run_with(1, 0.8), run_with(2, 0.8)})});
  suite.scenarios[0].runs[1].warnings = {{"rover_tipped", 2, "it tips over: make it slower"}};
  const json runs = data(suite)["scenarios"][0]["runs"];
  EXPECT_EQ(runs[0].at("warnings"), json::array());
  EXPECT_EQ(runs[1].at("warnings"),
            json::array({"it tips over: make it slower (warnings.rover_tipped: 2)"}));
}

TEST_F(Report, ShowsFramesAndEventsOfARunThatHasThem) {
  RunResult run = run_with(1, 0.8);
  run.folder = run_folder("one", {event_with(12, 8)});
  recording::Recording recording;
  for (int k = 0; k < 3; ++k) {
    recording::FrameRecord& frame = recording.frames.emplace_back();
    frame.index = k;
    frame.t_ns = k * std::int64_t{100'000'000};
  }
  scoring::write_frames(folder_.path() / run.folder / scoring::kFramesFile, recording);
  const json all = data(suite_of({scenario_with("one", {run})}));
  const json& told = all["scenarios"][0]["runs"][0];
  EXPECT_EQ(told.at("frames").at("t_s"), (json{0, 0.1, 0.2}));
  EXPECT_EQ(told["frames"].at("precision"), (json{nullptr, nullptr, nullptr}));
  const json& event = told.at("events").at(0);
  EXPECT_EQ(event.at("kind"), "found_late");
  EXPECT_EQ(event.at("object_name"), "box");
  EXPECT_EQ(event.at("corners"), 12);
  EXPECT_EQ(event.at("reasons")[0].at("word"), "normal_edge");
  EXPECT_EQ(event["reasons"][0].at("meaning"), text_of(Reason::normal_edge).meaning);
  EXPECT_EQ(event.at("views")[0].at("jpeg_base64"), "AAAAAAAA");
}

TEST_F(Report, SetsTheBaselinesCurvesBesideAndTellsNewEventsFromThoseThatAreGone) {
  const auto run_in = [&](const fs::path& folder, const std::vector<scoring::ScoredEvent>& events) {
    RunResult run = run_with(1, 0.8);
    run.folder = "runs/one";
    fs::create_directories(folder / run.folder);
    scoring::write_events(folder / run.folder / scoring::kEventsFile, events,
                          scoring::sums_of(events));
    recording::Recording recording;
    recording.frames.resize(2);
    scoring::write_frames(folder / run.folder / scoring::kFramesFile, recording);
    return run;
  };
  const scoring::ScoredEvent kept = event_with(12, 8);
  scoring::ScoredEvent later = kept, other = kept, as_false = kept;
  later.first_frame = later.last_frame = 30;
  other.object_name = "car";
  as_false.counted_corners = 0;
  const SuiteResult before =
      suite_of({scenario_with("one", {run_in(folder_.path() / "before", {kept, other})})});
  const SuiteResult now =
      suite_of({scenario_with("one", {run_in(folder_.path(), {kept, later, as_false})})});
  const json all = data(now, &before);
  const json& run = all["scenarios"][0]["runs"][0];
  EXPECT_EQ(run.at("before").at("frames").at("t_s").size(), 2u);
  EXPECT_EQ(run.at("events")[0].at("is_new"), false);
  EXPECT_EQ(run["events"][1].at("is_new"), true);
  EXPECT_EQ(run["events"][2].at("is_new"), true);
  ASSERT_EQ(run["before"].at("gone").size(), 1u);
  EXPECT_EQ(run["before"]["gone"][0].at("object_name"), "car");
  EXPECT_TRUE(run["before"]["gone"][0].at("views").empty());

  // A faulty baseline is reported, and the suite is still shown.
  std::ofstream(folder_.path() / "before" / "runs" / "one" / scoring::kFramesFile) << "frame\n";
  const json told = data(now, &before)["scenarios"][0]["runs"][0];
  EXPECT_NE(told["before"].at("error").get<std::string>().find("has no column"), std::string::npos);
  EXPECT_EQ(told.at("events").size(), 3u);
}

TEST_F(Report, EventsOfSquaresSayTheirFramesAndHowFarCornersCame) {
  scoring::ScoredEvent event;
  event.kind = scoring::EventKind::square_split;
  event.object_name = "box";
  event.corners = 12;
  event.frames = 7;
  event.of_frames = 9;
  event.steps = {{scoring::SquareStep::no_circle, 12}};
  RunResult run = run_with(1, 0.8);
  run.folder = run_folder("one", {event});
  const json told = data(suite_of({scenario_with("one", {run})}))["scenarios"][0]["runs"][0];
  const json& shown = told.at("events").at(0);
  EXPECT_EQ(shown.at("family"), "squares");
  EXPECT_EQ(shown.at("frames"), 7);
  EXPECT_EQ(shown.at("of_frames"), 9);
  EXPECT_EQ(shown.at("reasons").at(0).at("meaning"),
            scoring::text_of(scoring::SquareStep::no_circle).meaning);
}

TEST_F(Report, OfARunHasItsVideoWithin) {
  RunResult run = run_with(1, 0.8);
  run.folder = ".";
  const SuiteResult suite = suite_of({scenario_with("one", {run})});
  EXPECT_FALSE(json::parse(run_report_data(in_folder(suite), nullptr)).contains("video"));
  std::ofstream(folder_.path() / output::kVideoFile) << "film";
  const json all = json::parse(run_report_data(in_folder(suite), nullptr));
  EXPECT_EQ(all.at("video"), "ZmlsbQ==");
  EXPECT_EQ(all.at("is_run"), true);
  EXPECT_EQ(all.at("verdict"), "1 of 1 criteria met, 0 failed");
  // A video that is too large for a page is named.
  fs::resize_file(folder_.path() / output::kVideoFile, kVideoBudget + 1'000'000);
  const json large = json::parse(run_report_data(in_folder(suite), nullptr));
  EXPECT_FALSE(large.contains("video"));
  EXPECT_EQ(large.at("video_left_out_mb"), 65);
}

TEST_F(Report, ABrokenFileOfARunIsNamed) {
  RunResult run = run_with(1, 0.8);
  run.folder = run_folder("one", {});
  const fs::path frames = folder_.path() / run.folder / scoring::kFramesFile;
  const auto expect_error = [&](const std::string& text, const std::string& part) {
    std::ofstream(frames) << text;
    const std::string what = test::refusal_of<std::runtime_error>(
        [&] { data(suite_of({scenario_with("one", {run})})); });
    EXPECT_NE(what.find(frames.string() + part), std::string::npos) << what;
  };
  expect_error("frame,t_s\n", ":1: has no column");
  expect_error(
      "t_s,precision,recall,normal_edges,rebel_edges,normal_circles,rebel_circles,squares,"
      "dimension,corners\n0,,,0,0,0,0,0,0,0\n1,,,many,0,0,0,0,0,0\n",
      ":3: 'many' is not a number");
}

TEST_F(Report, KeepsThePicturesOfTheCostliestEventsWithinItsBudget) {
  std::vector<RunResult> runs;
  for (std::uint64_t seed : {1, 2}) {
    RunResult run = run_with(seed, 0.8);
    run.folder = run_folder("seed-" + std::to_string(seed),
                            {event_with(40, 100), event_with(20, 100), event_with(10, 100)});
    runs.push_back(run);
  }
  const json all = data(suite_of({scenario_with("one", runs)}), nullptr, 350);
  const auto kept = [&](int run, int event) {
    return all["scenarios"][0]["runs"][run]["events"][event]["views"][0]["jpeg_base64"] != "";
  };
  EXPECT_TRUE(kept(0, 0));
  EXPECT_TRUE(kept(0, 1));
  EXPECT_TRUE(kept(0, 2));
  EXPECT_FALSE(kept(1, 0));
  EXPECT_EQ(all["scenarios"][0]["runs"][1]["events"][0].at("left_out"), true);
  EXPECT_EQ(all["scenarios"][0]["runs"][1]["events"].size(), 3u);  // listed, without pictures
}

TEST_F(Report, ASuiteOfFortyScenariosStaysSmall) {
  std::vector<ScenarioResult> scenarios;
  for (int s = 0; s < 40; ++s) {
    std::vector<RunResult> runs;
    for (std::uint64_t seed : {1, 2, 3}) {
      RunResult run = run_with(seed, 0.8);
      run.folder = run_folder(std::to_string(s) + "-" + std::to_string(seed),
                              std::vector<scoring::ScoredEvent>(5, event_with(40, 60'000)));
      runs.push_back(run);
    }
    scenarios.push_back(scenario_with("scenario" + std::to_string(s), runs));
  }
  const std::string html = page(suite_of(scenarios));
  EXPECT_LT(html.size(), 10'000'000u);
  EXPECT_GT(html.size(), kPictureBudget - 100'000);
}

TEST_F(Report, AThousandScenariosAreLinksApartFromTheWorst) {
  std::vector<ScenarioResult> scenarios;
  for (int s = 0; s < 1000; ++s) {
    std::vector<RunResult> runs;
    for (std::uint64_t seed : {1, 2, 3}) {
      RunResult run = run_with(seed, s == 700 ? 0.1 : 0.8);
      for (const scoring::Metric& metric : scoring::metrics())
        run.metrics.emplace_back(metric.key, 0.123456789012345);
      if (s == 700 || s == 999) {
        run.folder = run_folder(std::to_string(s) + "-" + std::to_string(seed),
                                std::vector<scoring::ScoredEvent>(5, event_with(40, 60'000)));
      }
      runs.push_back(run);
    }
    scenarios.push_back(scenario_with("scenario" + std::to_string(s), runs));
  }
  const SuiteResult suite = suite_of(scenarios);
  EXPECT_LT(page(suite).size(), 15'000'000u);
  const json all = data(suite);
  int whole = 0;
  for (const json& scenario : all.at("scenarios")) whole += scenario.at("is_whole").get<bool>();
  EXPECT_EQ(whole, 60);
  const json &worst = all["scenarios"][700], &other = all["scenarios"][999];
  EXPECT_TRUE(worst.at("is_whole"));
  EXPECT_EQ(worst["runs"][0].at("events").size(), 5u);
  EXPECT_TRUE(other["runs"][0].at("events").is_null());
  EXPECT_NEAR(other["figures"]["rebel.f1"].at("mean"), 0.8, 1e-12);
  EXPECT_EQ(other["runs"][0].at("folder"), "runs/999-1");
}

TEST_F(Report, ReplacesAnOlderPageAndLeavesNothingBeside) {
  page(suite_of({}));
  const std::string html = page(suite_of({scenario_with("later", {})}));
  EXPECT_NE(html.find("later"), html.npos);
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    names.insert(entry.path().filename());
  }
  EXPECT_EQ(names, std::set<std::string>{kReportFile});
}

TEST_F(Report, APlaceThatCannotBeWrittenIsAnError) {
  EXPECT_THROW(
      write_report(folder_.path() / "missing" / kReportFile, in_folder(suite_of({})), {}, nullptr),
      files::OutputError);
}

}  // namespace
}  // namespace lcs::report
