// The `lcs` program from its command line to its files, on short versions of the shipped scenarios.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <set>
#include <thread>

#include "sim/pictures/picture_file.h"
#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/output/frame_pictures.h"
#include "tools/output/video.h"
#include "tools/recording/recording_io.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/events.h"
#include "tools/scoring/figures_file.h"
#include "tools/scoring/scoring.h"

namespace lcs::test {
namespace {

namespace fs = std::filesystem;

const fs::path kScenarios = LCS_SCENARIOS_DIR;

std::ptrdiff_t lines(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

class Run : public testing::Test {
 protected:
  /// Runs in a separate empty folder, where default outputs go.
  CommandResult run(std::vector<std::string> arguments,
                    std::optional<std::size_t> largest_file = {}) {
    arguments.insert(arguments.begin(), "run");
    return run_lcs(arguments, {.folder = folder_.path(), .largest_file = largest_file});
  }
  /// Arguments of the fastest possible run.
  static std::vector<std::string> brief(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{kScenarios / "crossing.yaml", "--set", "frames=4",
                                       "--no-video"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  nlohmann::json metrics(const fs::path& result) {
    return nlohmann::json::parse(read(folder_.path() / result / scoring::kMetricsFile));
  }

  const TemporaryFolder folder_;
};

// ---- A successful run

class ShippedScenario : public Run, public testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenarios, ShippedScenario,
                         testing::Values("lab", "crossing", "approaching"),
                         [](const auto& test) { return test.param; });

TEST_P(ShippedScenario, LeavesWholeFilesThatAgreeWithEachOther) {
  const std::string name = GetParam();
  constexpr int kFrames = 8;
  const CommandResult result = run({kScenarios / (name + ".yaml"), "--set", "frames=8", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err + result.out, "") << "--quiet";
  EXPECT_EQ(entries(folder_.path()), std::set<std::string>{"out"});
  const fs::path out = folder_.path() / "out" / name;
  EXPECT_EQ(entries(out), (std::set<std::string>{"camera.json", "metrics.json", "frames.csv",
                                                 "layers.jsonl", "truth.jsonl", "detector.json",
                                                 "run.json", "video.mp4", "warnings.json"}));

  EXPECT_EQ(lines(read(out / scoring::kFramesFile)), 1 + kFrames);
  const recording::Recording recording = recording::read_recording(out);
  ASSERT_EQ(recording.frames.size(), std::size_t{kFrames});
  EXPECT_EQ(recording.scenario, name);
  EXPECT_FALSE(recording.objects.empty());
  for (const recording::FrameRecord& frame : recording.frames) {
    EXPECT_GT(frame.corners_px.size(), 20u) << "frame " << frame.index;
    EXPECT_FALSE(frame.object_truth.empty()) << "frame " << frame.index;
    EXPECT_EQ(frame.signatures.size(), frame.corners_px.size()) << "frame " << frame.index;
  }

  // Scored again from its files, the run has bitwise equal figures, except times.
  const nlohmann::json stored = metrics(fs::path("out") / name);
  for (const auto& [metric, figure] : scoring::score(recording)) {
    ASSERT_TRUE(stored.contains(metric)) << metric;
    if (metric.starts_with("time.process")) {
      EXPECT_TRUE(stored[metric].is_null()) << "the filter is none: " << metric;
    } else if (metric.starts_with("time.") || metric.starts_with("sim.")) {
      EXPECT_TRUE(stored[metric].is_number()) << metric;
    } else if (figure) {
      EXPECT_EQ(stored[metric].get<double>(), *figure) << metric;
    } else {
      EXPECT_TRUE(stored[metric].is_null()) << metric;
    }
  }

  const auto video = output::open_video(out / "video.mp4");
  ASSERT_TRUE(video->isOpened());
  cv::Mat picture;
  int pictures = 0;
  while (video->read(picture)) ++pictures;
  EXPECT_EQ(pictures, kFrames);
}

TEST_F(Run, AReportIsAPageOfTheRunWithItsVideo) {
  const CommandResult result =
      run({kScenarios / "crossing.yaml", "--frames", "3", "--report", "--quiet", "--out", "out"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(metrics("out")["frames"], 3);
  const std::string page = read(folder_.path() / "out" / "report.html");
  const std::string open = R"(<script type="application/json" id="data">)";
  const std::size_t begin = page.find(open) + open.size();
  const auto data =
      nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  EXPECT_EQ(data["scenarios"][0]["name"], "crossing");
  EXPECT_EQ(data["scenarios"][0]["runs"][0]["frames"]["t_s"].size(), 3u);
  EXPECT_TRUE(data["scenarios"][0]["runs"][0]["events"].is_array());
  EXPECT_EQ(data["sets"], nlohmann::json{"frames=3"});
  EXPECT_EQ(data["video"].get<std::string>().size(),
            (fs::file_size(folder_.path() / "out" / output::kVideoFile) + 2) / 3 * 4);
  EXPECT_NE(data["version"].get<std::string>().find(" ("), std::string::npos) << "with the commit";
}

TEST_F(Run, TwoProcessesWriteTheSameLayersAndTruthToTheByte) {
  ASSERT_EQ(run(brief({"--out", "a"})).exit_code, 0);
  ASSERT_EQ(run(brief({"--out", "b"})).exit_code, 0);
  for (const char* file : {recording::kLayersFile, recording::kTruthFile}) {
    const std::string a = read(folder_.path() / "a" / file);
    EXPECT_GT(a.size(), 10'000u);
    EXPECT_TRUE(a == read(folder_.path() / "b" / file)) << file;
  }
}

TEST_F(Run, CollisionIsToldAndARecordingTellsTheSame) {
  // The box starts one second's drive ahead of the rover.
  const std::vector<std::string> into{
      "--set", "ego.speed=2 m/s", "--set",
      "actors.crossing_box.trajectory.line={from: [-3 m, 0 m], heading: 90 deg, speed: 0}"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), into.begin(), into.end());
    return run(brief(more));
  };
  const CommandResult result = with({"--out", "a"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("warning: the rover runs into actor 'crossing_box' at 0."),
            std::string::npos)
      << result.err;
  EXPECT_EQ(metrics("a")["warnings.rover_collisions"].get<int>(), 1);
  EXPECT_EQ(metrics("a")["warnings.rover_tipped"].get<int>(), 0);
  const CommandResult again = with({"--recorded", "a", "--out", "b"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.err.find("warning: the rover runs into actor 'crossing_box'"), std::string::npos);
  EXPECT_EQ(metrics("b")["warnings.rover_collisions"].get<int>(), 1);
  fs::remove(folder_.path() / "a" / "warnings.json");  // like a run of an earlier version
  ASSERT_EQ(with({"--recorded", "a", "--out", "c"}).exit_code, 0);
  EXPECT_TRUE(metrics("c")["warnings.rover_collisions"].is_null());
}

TEST_F(Run, TellsWhichFileIsUsedWhereLcsScenesHasOneOfTheProjectsOwnNames) {
  const fs::path own = folder_.path() / "scenes";
  fs::create_directories(own);
  fs::copy_file(kScenarios.parent_path() / "scenes/lab.xml", own / "lab.xml");
  ASSERT_EQ(setenv("LCS_SCENES", own.c_str(), 1), 0);
  const CommandResult result = run(brief({"--quiet"}));
  unsetenv("LCS_SCENES");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err.find("warning: " + (own / "lab.xml").string() + " is used"), 0u)
      << result.err;
  EXPECT_EQ(lines(result.err), 1) << result.err;
  EXPECT_EQ(run(brief({"--quiet"})).err, "");
}

TEST_F(Run, RefusesAParameterThatOnlyTheFilterOfAnotherPresetHas) {
  const auto with = [&](const std::string& preset) {
    return run(brief({"--set", "filter.circle.mu_0=20", "--set", "filter.preset=" + preset}));
  };
  EXPECT_EQ(with("default").exit_code, 2);
  EXPECT_NE(with("default").err.find("the filter of preset default has no parameter "
                                     "'circle.mu_0', which is of lab, cars; "),
            std::string::npos);
  EXPECT_EQ(with("lab").exit_code, 0);
}

TEST_F(Run, FindsAScenarioOfTheProjectByItsNameUnlessAFileHereIsCalledSo) {
  const CommandResult found = run({"night", "--frames", "2", "--no-video", "--quiet"});
  EXPECT_EQ(found.exit_code, 1) << "two frames do not meet its criteria";
  EXPECT_NE(found.err.find("night is " + (kScenarios / "suite" / "night.yaml").string() + "\n"),
            std::string::npos)
      << found.err;
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "night" / scoring::kMetricsFile));
  for (const char* name : {"night.yaml", "night"}) {
    std::ofstream(folder_.path() / name) << "scene: lab\n";
    const CommandResult unclear = run({"night"});
    EXPECT_EQ(unclear.exit_code, 2);
    EXPECT_NE(unclear.err.find("give ./" + std::string(name) + " or "), std::string::npos)
        << unclear.err;
    fs::remove(folder_.path() / name);
  }
}

TEST_F(Run, AnotherSeedIsAnotherRun) {
  ASSERT_EQ(run(brief({"--out", "a", "--seed", "1"})).exit_code, 0);
  ASSERT_EQ(run(brief({"--out", "b", "--seed", "2"})).exit_code, 0);
  EXPECT_FALSE(read(folder_.path() / "a" / recording::kLayersFile) ==
               read(folder_.path() / "b" / recording::kLayersFile));
  EXPECT_EQ(recording::read_recording(folder_.path() / "b").seed, 2u);
}

TEST_F(Run, EgoMotionIsExactOnlyWhereTheScenarioSaysSo) {
  ASSERT_EQ(run(brief({"--out", "imu"})).exit_code, 0);
  ASSERT_EQ(run(brief({"--out", "truth", "--set", "ego_motion=truth"})).exit_code, 0);
  EXPECT_GT(metrics("imu")["ego.velocity_error_mps_median"].get<double>(), 0);
  EXPECT_EQ(metrics("truth")["ego.velocity_error_mps_median"].get<double>(), 0);
  EXPECT_EQ(metrics("truth")["ego.rotation_error_mrad_median"].get<double>(), 0);
}

TEST_F(Run, AFilterSettingReachesTheFilter) {
  ASSERT_EQ(run(brief({"--out", "a"})).exit_code, 0);
  ASSERT_EQ(run(brief({"--out", "b", "--set", "filter.hypotheses.noise=2"})).exit_code, 0);
  EXPECT_FALSE(read(folder_.path() / "a" / recording::kLayersFile) ==
               read(folder_.path() / "b" / recording::kLayersFile));
}

TEST_F(Run, EventsAreWrittenWithPicturesAndChangeNothingElse) {
  // Frames in which the movers appear: the first counted ones are missed.
  const std::vector<std::string> some{kScenarios / "approaching.yaml", "--set", "frames=16",
                                      "--no-video"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), some.begin(), some.end());
    return run(more);
  };
  ASSERT_EQ(with({"--out", "plain"}).exit_code, 0);
  ASSERT_EQ(with({"--out", "told", "--events"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_.path() / "plain" / scoring::kEventsFile));
  EXPECT_EQ(read(folder_.path() / "plain" / recording::kLayersFile),
            read(folder_.path() / "told" / recording::kLayersFile));

  const std::vector<scoring::ScoredEvent> events =
      scoring::read_events(folder_.path() / "told" / scoring::kEventsFile);
  ASSERT_FALSE(events.empty());
  double missed = 0;
  for (const scoring::ScoredEvent& event : events) {
    int explained = 0;
    for (const auto& [reason, corners] : event.reasons) explained += corners;
    for (const auto& [step, corners] : event.steps) explained += corners;
    EXPECT_EQ(explained, event.corners);
    EXPECT_EQ(event.frames > 0, scoring::family_of(event.kind) == scoring::EventFamily::squares);
    // before, in and after the event; at an end of the run one of them does not exist
    const bool is_at_an_end = event.first_frame == 0 || event.last_frame == 15;
    EXPECT_GE(event.views.size(), is_at_an_end ? 2u : 3u);
    for (const scoring::EventView& view : event.views) {
      EXPECT_EQ(view.jpeg_base64.rfind("/9j/", 0), 0u);  // start of every JPEG
    }
    missed += event.counted_corners > 0 ? event.corners : 0;
  }
  const nlohmann::json told = metrics("told");
  const double all_missed =
      told["truth.rebel_corners"].get<double>() * (1 - told["rebel.recall"].get<double>());
  EXPECT_GT(missed, 0);
  EXPECT_LE(missed, all_missed + 0.5);
}

TEST_F(Run, PrintsProgressOnStderrAndTheTableOnStdout) {
  const CommandResult result = run(brief());
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("4/4 frames"), std::string::npos) << result.err;
  for (const char* part : {"crossing: 4 frames, seed 1", "rebels", "squares", "out/crossing"}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " in\n" << result.out;
  }
}

TEST_F(Run, TellsOnStderrWhatWasWrongWithTheData) {
  const CommandResult good = run(brief({"--quiet"}));
  EXPECT_EQ(good.err, "");
  const CommandResult gap = run(brief({"--quiet", "--set", "imu.gaps=[[0.1 s, 0.2 s]]"}));
  EXPECT_EQ(gap.exit_code, 0);
  EXPECT_EQ(gap.err,
            "1 gaps are in the readings of the IMU, in which the last one is held (imu_gap)\n");
}

TEST_F(Run, ReplacesAnEarlierResult) {
  ASSERT_EQ(run(brief()).exit_code, 0);
  ASSERT_EQ(run(brief({"--set", "frames=5"})).exit_code, 0);
  EXPECT_EQ(metrics("out/crossing")["frames"].get<double>(), 5);
  EXPECT_EQ(entries(folder_.path() / "out"), std::set<std::string>{"crossing"});
}

TEST_F(Run, TwoIntoOneFolderAtATimeLeaveOneOfThemWhole) {
  std::vector<std::string> arguments = brief({"--quiet"});
  arguments.insert(arguments.begin(), "run");
  Command one(arguments, {.folder = folder_.path()});
  Command other(arguments, {.folder = folder_.path()});
  EXPECT_EQ(one.wait().exit_code, 0);
  EXPECT_EQ(other.wait().exit_code, 0);
  EXPECT_EQ(recording::read_recording(folder_.path() / "out" / "crossing").frames.size(), 4u);
  EXPECT_EQ(entries(folder_.path() / "out"), std::set<std::string>{"crossing"});
}

// ---- On the frames of an earlier run

class Again : public Run {
 protected:
  /// Frames in which the movers appear, so that there are events.
  CommandResult approaching(std::vector<std::string> more) {
    more.insert(more.begin(), {kScenarios / "approaching.yaml", "--set", "frames=16", "--quiet"});
    return run(more);
  }
  std::string file(const fs::path& result, const char* name) {
    return read(folder_.path() / result / name);
  }
  /// Compares everything except times.
  void expect_same(const fs::path& one, const fs::path& other) {
    for (const char* name : {recording::kLayersFile, recording::kTruthFile, scoring::kEventsFile}) {
      EXPECT_TRUE(file(one, name) == file(other, name)) << name;
    }
    const nlohmann::json figures = metrics(one), others = metrics(other);
    EXPECT_EQ(figures.size(), others.size());
    for (const auto& [metric, figure] : figures.items()) {
      if (metric.starts_with("time.") || metric.starts_with("sim.")) continue;
      EXPECT_EQ(figure, others[metric]) << metric;
    }
  }
};

TEST_F(Again, TheFilterSaysWhatItWouldSayInARunOfItsOwn) {
  const char* const kSetting = "filter.hypotheses.neighbours=4";
  // With another setting other gaps are asked for, which the first run did not look at.
  const char* const kWithoutGaps = "filter.comers.hanging=1";
  ASSERT_EQ(approaching({"--events", "--no-video", "--out", "first"}).exit_code, 0);
  ASSERT_EQ(approaching({"--events", "--no-video", "--set", kSetting, "--set", kWithoutGaps,
                         "--out", "live"})
                .exit_code,
            0);
  const CommandResult again = approaching({"--events", "--no-video", "--set", kSetting, "--set",
                                           kWithoutGaps, "--recorded", "first", "--out", "again"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.err, "");
  EXPECT_FALSE(file("first", recording::kLayersFile) == file("live", recording::kLayersFile))
      << "the setting does not show";
  expect_same("live", "again");
  for (const char* copied :
       {recording::kTruthFile, output::kPicturesFile}) {  // a user may change one of them
    EXPECT_FALSE(
        fs::equivalent(folder_.path() / "first" / copied, folder_.path() / "again" / copied));
  }
  // Skipped stages took no time.
  const nlohmann::json times = metrics("again");
  EXPECT_TRUE(times["time.filter_ms_median"].is_number());
  for (const char* stage :
       {"time.detect_ms_median", "time.describe_ms_median", "time.simulate_ms_median",
        "time.truth_ms_median", "time.filter_over_fast"}) {
    EXPECT_TRUE(times[stage].is_null()) << stage;
  }
  ASSERT_EQ(
      approaching({"--events", "--no-video", "--recorded", "first", "--out", "same"}).exit_code, 0);
  expect_same("first", "same");
  // A run from recorded frames is a recording, too.
  ASSERT_EQ(
      approaching({"--events", "--no-video", "--recorded", "same", "--out", "more"}).exit_code, 0);
  expect_same("first", "more");
}

TEST_F(Again, AVideoIsOfThePicturesThatWereKept) {
  ASSERT_EQ(approaching({"--events", "--no-video", "--out", "first"}).exit_code, 0);
  ASSERT_EQ(approaching({"--recorded", "first", "--out", "again"}).exit_code, 0);
  const auto video = output::open_video(folder_.path() / "again" / output::kVideoFile);
  cv::Mat picture;
  int pictures = 0;
  for (; video->read(picture); ++pictures) {
    EXPECT_GT(cv::mean(picture)[0], 20) << "frame " << pictures << " is black";
  }
  EXPECT_EQ(pictures, 16);
}

TEST_F(Again, WithoutPicturesThereAreEventsButNoVideo) {
  ASSERT_EQ(approaching({"--no-video", "--out", "first"}).exit_code, 0);
  const CommandResult video = approaching({"--recorded", "first", "--out", "again"});
  EXPECT_EQ(video.exit_code, 2);
  EXPECT_NE(video.err.find("first has no pictures to make a video of; give --no-video"),
            std::string::npos)
      << video.err;
  ASSERT_EQ(
      approaching({"--no-video", "--events", "--recorded", "first", "--out", "again"}).exit_code,
      0);
  const std::vector<scoring::ScoredEvent> events =
      scoring::read_events(folder_.path() / "again" / scoring::kEventsFile);
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.front().views.at(0).jpeg_base64, "");
  EXPECT_FALSE(fs::exists(folder_.path() / "again" / output::kPicturesFile));
}

TEST_F(Again, FramesWithoutSignaturesAreToldAndTheFilterGoesByPlaces) {
  ASSERT_EQ(run(brief({"--quiet", "--detector", "klt", "--out", "first"})).exit_code, 0);
  const CommandResult again = run(brief({"--quiet", "--recorded", "first", "--out", "again"}));
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.err,
            "warning: first has no signatures of its corners, so that the filter goes by their "
            "places alone; leave out --recorded to have them made\n"
            "warning: first does not say what the filter saw below circles, so that bodies that "
            "approach at constant speed are not found; leave out --recorded to have it looked "
            "at\n");
  for (const recording::FrameRecord& frame :
       recording::read_recording(folder_.path() / "again").frames) {
    EXPECT_TRUE(frame.signatures.empty());
    EXPECT_EQ(frame.verdicts.size(), frame.corners_px.size());
  }
}

TEST_F(Again, ARecordingOfAnythingElseIsRefusedWithTheFirstDifference) {
  ASSERT_EQ(run(brief({"--quiet", "--out", "first"})).exit_code, 0);
  const auto refusal = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--quiet", "--recorded", "first"});
    const CommandResult result = run(brief(more));
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_EQ(entries(folder_.path()), std::set<std::string>{"first"});
    return result.err;
  };
  const auto says = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  };
  says(refusal({"--seed", "2"}), "it is of seed 1, not 2; run crossing without --recorded");
  says(refusal({"--set", "ego.speed=0.7 m/s"}),
       "it has ego.speed: 0.5 m/s, and now there is ego.speed: 0.7 m/s");
  says(refusal({"--set", "corners.threshold=30"}),
       "it has no corners.threshold, and now there is corners.threshold: 30");
  says(refusal({"--detector", "klt"}), "klt looks at the pictures");

  // Detector settings, criteria and descriptions may change.
  for (const char* setting : {"filter.circle.gap=0.3", "criteria=[{metric: frames, min: 4}]",
                              "purpose=another", "groups=[long]"}) {
    EXPECT_EQ(run(brief({"--recorded", "first", "--out", "again", "--set", setting})).exit_code, 0)
        << setting;
  }
}

TEST_F(Again, ABrokenRecordingIsToldWithItsFile) {
  ASSERT_EQ(run(brief({"--quiet", "--events", "--out", "first"})).exit_code, 0);
  const fs::path first = folder_.path() / "first";
  const auto refused = [&](const char* part) {
    const CommandResult result = run(brief({"--quiet", "--recorded", "first"}));
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << part << " in\n" << result.err;
    EXPECT_EQ(entries(folder_.path()), std::set<std::string>{"first"});
  };
  const auto rewrite = [&](const char* name, const std::string& text) {
    std::ofstream(first / name, std::ios::binary) << text;
  };
  const std::string pictures = file("first", output::kPicturesFile),
                    truth = file("first", recording::kTruthFile);

  rewrite(output::kPicturesFile, pictures.substr(0, pictures.size() / 2));
  refused("pictures.mjpeg: not a JPEG picture at byte ");
  rewrite(output::kPicturesFile, pictures + pictures);
  refused("pictures.mjpeg has 8 pictures of 4 frames");
  rewrite(output::kPicturesFile, "");
  refused("pictures.mjpeg has 0 pictures of 4 frames");
  rewrite(output::kPicturesFile,
          sim::encode_jpeg(cv::Mat3b(120, 160, cv::Vec3b(9, 9, 9)), 90) + pictures);
  refused("picture 0 has 160 x 120 pixels, and one of a camera of 640 x 480 has 640 x 480; run");
  const std::size_t frame = pictures.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  rewrite(output::kPicturesFile, std::string(pictures).replace(frame + 5, 4, "\x7d\0\x7d\0", 4));
  refused(
      "picture 0 has 32000 x 32000 pixels, and one of a camera of 640 x 480 has 640 x 480; run");
  fs::remove(first / output::kPicturesFile);

  // As written by a version without this entry.
  const std::size_t world = truth.find(",\"world\":{"), end = truth.find('}', world);
  ASSERT_NE(world, std::string::npos);
  rewrite(recording::kTruthFile, truth.substr(0, world) + truth.substr(end + 1));
  refused("it does not say what world it is of");
  rewrite(recording::kTruthFile, truth.substr(0, truth.size() / 2));
  refused("truth.jsonl:");
}

// ---- Criteria

TEST_F(Run, ARequiredCriterionThatFailsExitsWithOneAndKeepsTheResult) {
  const CommandResult result =
      run(brief({"--quiet", "--set", "criteria=[{metric: frames, min: 5}]"}));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(lines(result.err), 1);
  EXPECT_NE(result.err.find("frames is 4, must be at least 5"), std::string::npos) << result.err;
  EXPECT_EQ(metrics("out/crossing")["frames"].get<double>(), 4);
}

TEST_F(Run, ACriterionThatIsMetOrNotRequiredExitsWithZero) {
  EXPECT_EQ(run(brief({"--set", "criteria=[{metric: frames, min: 4}]"})).exit_code, 0);
  const CommandResult result =
      run(brief({"--quiet", "--set", "criteria=[{metric: frames, min: 5, required: false}]"}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("frames is 4"), std::string::npos) << result.err;
}

TEST_F(Run, ACriterionAsksTheDetectorThatItNamesAndNobodyWhereThatIsNotThere) {
  const std::string criteria = "criteria=[{metric: frames, min: 5, detector: klt}]";
  const CommandResult alone = run(brief({"--quiet", "--set", criteria}));
  EXPECT_EQ(alone.exit_code, 0);
  EXPECT_EQ(lines(alone.err), 1);
  EXPECT_NE(alone.err.find("not asked: criteria of klt (--set criteria"), std::string::npos)
      << alone.err;
  const CommandResult beside = run(brief({"--quiet", "--set", criteria, "--beside", "klt=klt"}));
  EXPECT_EQ(beside.exit_code, 1);
  EXPECT_EQ(lines(beside.err), 1);
  EXPECT_NE(beside.err.find("frames of klt is 4, must be at least 5"), std::string::npos)
      << beside.err;
  EXPECT_EQ(run(brief({"--set", criteria, "--detector", "klt"})).exit_code, 1) << "the run's own";
}

// ---- Errors

struct Mistake {
  const char* name;
  std::vector<std::string> arguments;
  const char* said;  ///< part of the message
};

class RunMistake : public Run, public testing::WithParamInterface<Mistake> {};

TEST_P(RunMistake, IsToldInOneLineWithExitCodeTwoBeforeAnyOutputIsBegun) {
  const CommandResult result = run(GetParam().arguments);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(lines(result.err), 1) << result.err;
  EXPECT_NE(result.err.find(GetParam().said), std::string::npos) << result.err;
  EXPECT_TRUE(entries(folder_.path()).empty()) << "something was written";
}

const std::string kCrossing = kScenarios / "crossing.yaml";
INSTANTIATE_TEST_SUITE_P(
    All, RunMistake,
    testing::Values(
        Mistake{"no_scenario", {}, "SCENARIO"},
        Mistake{"missing_scenario", {"no_such.yaml"}, "no_such.yaml"},
        Mistake{"unknown_option", {kCrossing, "--fast"}, "--fast"},
        Mistake{"seed_that_is_no_number", {kCrossing, "--seed", "many"}, "many"},
        Mistake{"unknown_key", {kCrossing, "--set", "ego.sped=1 m/s"}, "speed"},
        Mistake{"wrong_unit", {kCrossing, "--set", "ego.speed=1 kg"}, "kg"},
        Mistake{"rate_of_zero", {kCrossing, "--set", "camera.rate=0 Hz"}, "rate"},
        Mistake{"not_a_number", {kCrossing, "--set", "ego.speed=.nan m/s"}, "ego.speed"},
        Mistake{"missing_scene", {kCrossing, "--set", "scene=moon"}, "moon"},
        Mistake{"missing_body",
                {kCrossing, "--set", "actors={walker: {body: ghost, trajectory: {still: {}}}}"},
                "moves body 'ghost'"},
        Mistake{"unknown_preset", {kCrossing, "--set", "filter.preset=best"}, "best"},
        Mistake{"unknown_parameter", {kCrossing, "--set", "filter.circle.mu_9=1"}, "circle.mu"},
        Mistake{"parameter_out_of_range", {kCrossing, "--set", "filter.circle.gap=-1"}, "gap"},
        Mistake{"unknown_metric",
                {kCrossing, "--set", "criteria=[{metric: rebel.f2, min: 1}]"},
                "rebel.f1"},
        Mistake{"preset_that_the_detector_lacks",
                {kCrossing, "--detector", "lcs:best"},
                "no preset 'best'; there are default"},
        Mistake{"nowhere_beside", {kCrossing, "--beside", "klt"}, "as klt=out/klt"},
        Mistake{"two_in_one_folder",
                {kCrossing, "--out", "a", "--beside", "klt=./a"},
                "results would go into each other"},
        Mistake{"recording_that_is_not_there",
                {kCrossing, "--recorded", "nowhere"},
                "there is no run in nowhere"},
        Mistake{"unwritable_folder", {kCrossing, "--out", "/proc/lcs"}, "/proc/lcs"}),
    [](const auto& test) { return test.param.name; });

TEST_F(Run, DetectorBesideOthersSaysWhatItSaysAlone) {
  const std::vector<std::string> all{"--set",    "frames=8",         "--beside", "klt=klt",
                                     "--beside", "lcs:lab=lab/here", "--out",    "own"};
  const CommandResult together = run(brief(all));
  ASSERT_EQ(together.exit_code, 0) << together.err;
  EXPECT_EQ(entries(folder_.path()), (std::set<std::string>{"own", "klt", "lab"}));
  for (const auto& [name, folder] :
       {std::pair{"lcs", "own"}, {"klt", "klt"}, {"lcs:lab", "lab/here"}}) {
    ASSERT_EQ(run(brief({"--set", "frames=8", "--detector", name, "--out", "alone"})).exit_code, 0);
    for (const char* file :
         {recording::kLayersFile, recording::kTruthFile, recording::kWarningsFile}) {
      EXPECT_TRUE(read(folder_.path() / folder / file) == read(folder_.path() / "alone" / file))
          << name << " " << file;
    }
  }
}

TEST_F(Run, TwoThreadsWriteTheFilesOfOne) {
  const auto compare = [&](std::vector<std::string> options) {
    for (const char* threads : {"1", "2"}) {
      std::vector<std::string> words{kCrossing, "--set", "frames=8", "--quiet", "--events"};
      words.insert(words.end(), options.begin(), options.end());
      words.insert(words.end(), {"--threads", threads, "--out", std::string("by") + threads});
      const CommandResult result = run(words);
      ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    for (const char* file :
         {recording::kLayersFile, recording::kTruthFile, recording::kWarningsFile,
          scoring::kEventsFile, output::kPicturesFile, output::kVideoFile}) {
      const std::string one = read(folder_.path() / "by1" / file);
      EXPECT_FALSE(one.empty()) << file;
      EXPECT_TRUE(one == read(folder_.path() / "by2" / file)) << file;
    }
  };
  compare({"--beside", "klt=klt"});
  fs::rename(folder_.path() / "by1", folder_.path() / "earlier");
  compare({"--recorded", "earlier"});
}

TEST_F(Run, AFolderThatHoldsSomethingElseIsRefusedAndUntouched) {
  fs::create_directory(folder_.path() / "papers");
  std::ofstream(folder_.path() / "papers" / "thesis.tex") << "precious";
  const CommandResult result = run(brief({"--out", "papers"}));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(lines(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("thesis.tex"), std::string::npos) << result.err;
  EXPECT_EQ(entries(folder_.path()), std::set<std::string>{"papers"});
  EXPECT_EQ(read(folder_.path() / "papers" / "thesis.tex"), "precious");
}

TEST_F(Run, ADiskThatFillsUpIsToldInOneLineAndLeavesNothingBehind) {
  const CommandResult result = run(brief({"--quiet"}), 20'000);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(lines(result.err), 1) << result.err;
  EXPECT_NE(result.err.find(".jsonl: File too large; "), std::string::npos) << result.err;
  EXPECT_TRUE(entries(folder_.path()).empty());
}

TEST_F(Run, AVideoThatTheDiskCannotHoldIsToldLikewise) {
  // All other files of so short a run are within the limit, so the message names this one.
  const CommandResult result =
      run({kCrossing, "--set", "frames=2", "--set", "corners.threshold=100", "--quiet"}, 20'000);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(lines(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("video.mp4"), std::string::npos) << result.err;
  EXPECT_TRUE(entries(folder_.path()).empty());
}

// ---- Interruption

class RunInterrupted : public Run, public testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Signals, RunInterrupted,
                         testing::Values(SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGXFSZ, SIGPIPE),
                         [](const auto& test) {
                           return std::string("SIG") + sigabbrev_np(test.param);
                         });

TEST_P(RunInterrupted, LeavesTheEarlierResultAsItWasAndExitsWith130) {
  ASSERT_EQ(run(brief()).exit_code, 0);
  const std::string before = read(folder_.path() / "out" / "crossing" / recording::kLayersFile);

  for (const char* threads : {"1", "2"}) {
    Command command({"run", kCrossing, "--set", "frames=1000", "--threads", threads},
                    {.folder = folder_.path()});
    // The run is under way once a staging folder exists beside the result.
    while (command.is_running() && entries(folder_.path() / "out").size() < 2) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ASSERT_TRUE(command.is_running());
    command.send(GetParam());
    const CommandResult result = command.wait();

    const bool is_about_a_write = GetParam() == SIGXFSZ || GetParam() == SIGPIPE;
    EXPECT_EQ(result.exit_code, is_about_a_write ? 2 : 130);
    EXPECT_NE(result.err.find(is_about_a_write ? "cannot write" : "interrupted"), std::string::npos)
        << result.err;
    EXPECT_EQ(entries(folder_.path() / "out"), std::set<std::string>{"crossing"});
    EXPECT_EQ(read(folder_.path() / "out" / "crossing" / recording::kLayersFile), before);
  }
}

// ---- The program itself

CommandResult lcs_with(const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  return run_lcs(arguments, {.folder = folder.path()});
}

TEST(Program, NamesTheVersionsOfWhatItRunsOn) {
  const CommandResult result = lcs_with({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* part : {"lcs ", "MuJoCo ", "Mesa ", "OpenCV "}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " in\n" << result.out;
  }
}

TEST(Program, PrintsTheKeysOfAScenario) {
  const CommandResult result = lcs_with({"run", "--keys"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* part : {"\ncamera.fovy: ", "\nego.phases.N.at: ", "\nactors.NAME.shape: "}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " in\n" << result.out;
  }
}

TEST(Program, HelpTeachesExamplesFilesAndExitCodes) {
  const CommandResult top = lcs_with({"--help"});
  EXPECT_EQ(top.exit_code, 0);
  EXPECT_NE(top.out.find("lcs run scenarios/crossing.yaml"), std::string::npos) << top.out;
  const CommandResult run = lcs_with({"run", "--help"});
  EXPECT_EQ(run.exit_code, 0);
  for (const char* part : {"Examples", "metrics.json", "Exit codes", "130", "--seed", "--set"}) {
    EXPECT_NE(run.out.find(part), std::string::npos) << part << " in\n" << run.out;
  }
}

TEST(Program, SaysWhatIsMeantByMistakesOnTheCommandLine) {
  const std::string crossing = kScenarios / "crossing.yaml";
  const std::pair<std::vector<std::string>, const char*> mistakes[] = {
      {{}, "see lcs --help"},
      {{"runn", "x"}, "there is no command 'runn'; did you mean 'run'?"},
      {{"x"}, "there is no command 'x'; the commands are run, "},
      {{"run", "no_such_scenario"}, "no_such_scenario: there is no such file"},
      {{"run", crossing, "--set", "filter.coupling=3"}, "the nearest is 'hypotheses.coupling'"},
      {{"run", crossing, "--set", "criteria=[{metric: rebel.f1_score, min: 0}]"},
       "did you mean 'rebel.f1'?"},
      {{"suite", "--group", "nigth"}, "no scenario is of the group 'nigth'; did you mean 'night'?"},
      {{"suite", "--worlds", "train", "--shard", "1/4", "a.yaml"}, "leave one of them out"},
      {{"suite", "--times", "x.json"}, "give both, or leave the first out"},
  };
  for (const auto& [arguments, message] : mistakes) {
    const CommandResult result = lcs_with(arguments);
    EXPECT_EQ(result.exit_code, 2) << message;
    EXPECT_EQ(lines(result.err), 1) << result.err;
    EXPECT_NE(result.err.find(message), std::string::npos) << message << " in\n" << result.err;
  }
}

}  // namespace
}  // namespace lcs::test
