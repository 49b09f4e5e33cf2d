#include "tools/scoring/figures_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/scoring/whole_recordings.h"
#include "tests/tools/recordings.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/output/table.h"
#include "tools/recording/warnings.h"

namespace lcs::scoring {
namespace {

using sim::Label;

recording::Recording five_frames(bool with_times) {
  std::vector<recording::FrameRecord> frames;
  for (int k = 0; k < 5; ++k) {
    test::FrameMaker frame(k);
    frame.corners(2, Verdict::rebel, Label::fixed).corners(3, Verdict::ignored, Label::fixed);
    if (k == 4) frame.corners(6, Verdict::rebel, Label::rebel, 1);
    frame.square(1, {0, 0, 30, 30}).rebel_circle({100, 100}, 5);
    Layers& layers = frame.record().layers;
    layers.normal_edges.resize(7);
    layers.rebel_edges.resize(4);
    layers.normal_circles.resize(3);
    frame.record().paper.ignored.resize(2);
    frame.record().paper.collectors.resize(5);
    frame.record().paper.chains.resize(9);
    if (with_times)
      frame.record().times = recording::FrameTimes{.detect_ms = 0.25, .filter_ms = 1.5};
    frames.push_back(frame);
  }
  return test::recording_of(frames);
}

/// Rows by column name; every row must have as many fields as the header.
std::vector<std::map<std::string, std::string>> read_csv(const std::filesystem::path& path) {
  const auto split = [](const std::string& line) {
    std::vector<std::string> fields(1);
    for (const char c : line) {
      if (c == ',') {
        fields.emplace_back();
      } else {
        fields.back() += c;
      }
    }
    return fields;
  };
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> header = split(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = split(line);
    EXPECT_EQ(fields.size(), header.size()) << line;
    for (std::size_t i = 0; i < std::min(fields.size(), header.size()); ++i) {
      if (i == 0) rows.emplace_back();
      rows.back()[header[i]] = fields[i];
    }
  }
  return rows;
}

TEST(FramesCsv, HasARowAFrameWithTheSizesOfAllLayers) {
  const test::TemporaryFolder folder;
  write_frames(folder.path() / kFramesFile, five_frames(true));
  const auto rows = read_csv(folder.path() / kFramesFile);
  ASSERT_EQ(rows.size(), 5u);
  const std::map<std::string, std::string> expected{
      {"frame", "3"},           {"t_s", "0.3"},         {"corners", "5"},
      {"ignored_corners", "3"}, {"psi", "2"},           {"lambda", "5"},
      {"alpha", "9"},           {"normal_edges", "7"},  {"rebel_edges", "4"},
      {"normal_circles", "3"},  {"rebel_circles", "1"}, {"squares", "1"},
      {"dimension", "16"},      {"false_rebels", "2"},  {"true_rebels", "0"},
      {"detect_ms", "0.25"},    {"filter_ms", "1.5"}};
  for (const auto& [column, field] : expected) {
    ASSERT_TRUE(rows[3].contains(column)) << column;
    EXPECT_NEAR(std::stod(rows[3].at(column)), std::stod(field), 1e-9) << column;
  }
}

TEST(FramesCsv, LeavesUndefinedFieldsEmpty) {
  const test::TemporaryFolder folder;
  write_frames(folder.path() / kFramesFile, five_frames(false));
  const auto rows = read_csv(folder.path() / kFramesFile);
  EXPECT_EQ(rows[0].at("precision"), "") << "a frame of the warm-up";
  EXPECT_EQ(rows[4].at("precision"), "0.75");
  EXPECT_EQ(rows[4].at("recall"), "") << "the object is excused for its first frames";
  EXPECT_EQ(rows[4].at("filter_ms"), "") << "there were no times";
}

TEST(FramesCsv, OfNoFramesIsItsHeader) {
  const test::TemporaryFolder folder;
  write_frames(folder.path() / kFramesFile, test::recording_of({}));
  EXPECT_TRUE(read_csv(folder.path() / kFramesFile).empty());
  EXPECT_GT(std::filesystem::file_size(folder.path() / kFramesFile), 0u);
}

TEST(FramesCsv, GivesARecordingItsTimesAgainToTheLastBit) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / kFramesFile;
  recording::Recording written = five_frames(true);
  written.frames[1].times = recording::FrameTimes{.simulate_ms = 1.0 / 3,
                                                  .detect_ms = 0.1 + 0.2,
                                                  .describe_ms = 0.7,
                                                  .line_ms = 1e-7,
                                                  .circle_ms = 2.0 / 7,
                                                  .square_ms = 12345.678901234567,
                                                  .filter_ms = 1e22,
                                                  .truth_ms = 5e-324};
  written.frames[2].times.reset();
  write_frames(path, written);
  recording::Recording read = five_frames(false);
  read_times(path, read);
  EXPECT_FALSE(read.frames[2].times);
  const recording::FrameTimes &a = written.frames[1].times.value(),
                              &b = read.frames[1].times.value();
  for (const auto member : {&recording::FrameTimes::simulate_ms, &recording::FrameTimes::detect_ms,
                            &recording::FrameTimes::describe_ms, &recording::FrameTimes::line_ms,
                            &recording::FrameTimes::circle_ms, &recording::FrameTimes::square_ms,
                            &recording::FrameTimes::filter_ms, &recording::FrameTimes::truth_ms}) {
    EXPECT_EQ(a.*member, b.*member);
  }
  EXPECT_EQ(score(written), score(read));
}

TEST(FramesCsv, FromBeforeThereWereSignaturesHasTheOtherTimes) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / kFramesFile;
  std::ofstream(path) << "frame,simulate_ms,detect_ms,line_ms,circle_ms,square_ms,filter_ms,"
                         "truth_ms\n0,1,2,3,4,5,6,7\n1,,,,,,,\n2,,,,,,,\n3,,,,,,,\n4,,,,,,,\n";
  recording::Recording read = five_frames(false);
  read_times(path, read);
  const recording::FrameTimes& times = read.frames[0].times.value();
  EXPECT_EQ(times.detect_ms, 2);
  EXPECT_EQ(times.describe_ms, 0);
  EXPECT_EQ(times.truth_ms, 7);
  EXPECT_FALSE(value(score(read), "time.describe_ms_median"));
}

TEST(FramesCsv, LeavesOutWhatADetectorWithoutLayersDoesNotHave) {
  const test::TemporaryFolder folder;
  recording::Recording recording = five_frames(true);
  recording.detector = {.name = "klt", .layered = false};
  write_frames(folder.path() / kFramesFile, recording);
  const auto rows = read_csv(folder.path() / kFramesFile);
  for (const char* empty : {"dimension", "line_ms", "circle_ms", "square_ms"}) {
    EXPECT_EQ(rows[3].at(empty), "") << empty;
  }
  EXPECT_EQ(rows[3].at("filter_ms"), "1.5");
}

TEST(FramesCsv, MismatchWithTheRecordingIsRefusedAtItsLine) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / kFramesFile;
  recording::Recording recording = five_frames(true);
  const std::string header =
      "frame,simulate_ms,detect_ms,line_ms,circle_ms,square_ms,filter_ms,truth_ms\n";
  const std::pair<std::string, const char*> wrong[] = {
      {"", ":1: has no column frame"},
      {"frame,simulate_ms\n0,1\n", ":2: has no column detect_ms"},
      {header + "0,1,1,1,1,1,1\n", ":2: has 7 fields, the header 8"},
      {header + "1,1,1,1,1,1,1,1\n", ":2: is of frame '1', and should be of 0"},
      {header + "0,1,1,1,fast,1,1,1\n", ":2: circle_ms is 'fast', not a number"},
      {header + "0,,,,,,,\n1,1,1,1,1,1,1,1\n", ":4: the row of frame 2 is missing"},
      {header + "0,,,,,,,\n1,,,,,,,\n2,,,,,,,\n3,,,,,,,\n4,,,,,,,\n5,,,,,,,\n",
       ":7: there are more rows than the recording has frames"},
  };
  for (const auto& [text, message] : wrong) {
    std::ofstream(path) << text;
    EXPECT_EQ(
        test::refusal_of<std::runtime_error>([&] { read_times(path, recording); }),
        path.string() + message + "; run the scenario again, or remove the file to have no times");
  }
  EXPECT_THROW(read_times(folder.path() / "none.csv", recording), std::runtime_error);
}

TEST(Warnings, AreOfFewCornersWhereMoreThanHalfOfTheFramesHaveThem) {
  const auto few = [](int frames_with_nine, int frames_with_ten) {
    std::vector<recording::FrameRecord> frames;
    for (int k = 0; k < frames_with_ten + frames_with_nine; ++k) {
      frames.push_back(test::FrameMaker(k).corners(k < frames_with_ten ? 10 : 9, Verdict::normal,
                                                   sim::Label::fixed));
    }
    for (const recording::Warned& warned : warnings_of(test::recording_of(std::move(frames)))) {
      if (warned.word == "few_corners") return warned;
    }
    return recording::Warned{};
  };
  EXPECT_EQ(few(0, 2).word, "few_corners");
  EXPECT_EQ(few(0, 2).count, 0);
  EXPECT_EQ(few(2, 2).count, 0);
  EXPECT_EQ(few(3, 2).count, 3);
  EXPECT_NE(few(3, 2).text.find("fewer than 10 corners are in 3 of 5 frames, first at 0.20 s"),
            std::string::npos)
      << few(3, 2).text;
  EXPECT_FALSE(few(0, 0).count) << "of no frame nothing is known";
}

TEST(MetricsJson, IsFlatWithEveryMetricInOrderAndNullForWhatIsUndefined) {
  const test::TemporaryFolder folder;
  const Metrics metrics = score(five_frames(true));
  write_metrics(folder.path() / kMetricsFile, metrics);
  std::ifstream file(folder.path() / kMetricsFile);
  const auto json = nlohmann::ordered_json::parse(file);
  ASSERT_EQ(json.size(), metrics.size());
  auto entry = json.begin();
  int undefined = 0;
  for (const auto& [name, figure] : metrics) {
    EXPECT_EQ(entry.key(), name);
    if (figure) {
      EXPECT_EQ(entry.value().get<double>(), *figure) << "to the last bit";
    } else {
      EXPECT_TRUE(entry.value().is_null()) << name;
      ++undefined;
    }
    ++entry;
  }
  EXPECT_GT(undefined, 0);
}

TEST(MetricsJson, ComesBackToTheLastBit) {
  const test::TemporaryFolder folder;
  const Metrics metrics = score(five_frames(true));
  write_metrics(folder.path() / kMetricsFile, metrics);
  EXPECT_EQ(read_metrics(folder.path() / kMetricsFile), metrics);
}

TEST(MetricsJson, MissingOrDamagedFileIsNamed) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / kMetricsFile;
  const auto refusal = [&] {
    return test::refusal_of<std::runtime_error>([&] { read_metrics(path); });
  };
  EXPECT_NE(refusal().find(path.string()), std::string::npos) << "missing";
  for (const char* text : {"", "{\"rebel.f1\": 0.5", "{\"rebel.f1\": \"much\"}"}) {
    std::ofstream(path) << text;
    EXPECT_NE(refusal().find(path.string()), std::string::npos) << text;
  }
}

TEST(Table, IsAFewLinesThatFitATerminalAndShowsADashForWhatIsUndefined) {
  for (const recording::Recording& recording : {recording::Recording{}, five_frames(true)}) {
    std::istringstream text(output::table(score(recording)));
    int lines = 0;
    for (std::string line; std::getline(text, line); ++lines) EXPECT_LE(line.size(), 120u) << line;
    EXPECT_EQ(lines, 7);  // rebels, a remark on them, objects, squares, movers, size, time
  }
  const std::string empty = output::table(score(recording::Recording{}));
  EXPECT_NE(empty.find("nothing to find"), std::string::npos) << empty;
  EXPECT_NE(empty.find("latency -"), std::string::npos) << empty;
  const std::string some = output::table(score(five_frames(true)));
  EXPECT_NE(some.find("false corners 2.0 per frame"), std::string::npos) << some;
}

TEST(Reports, AFileThatCannotBeWrittenIsNamedWithTheReason) {
  const std::filesystem::path nowhere = "/no/such/folder/metrics.json";
  const std::string what = test::refusal_of<files::OutputError>(
      [&] { write_metrics(nowhere, score(recording::Recording{})); });
  EXPECT_NE(what.find(nowhere.string()), std::string::npos) << what;
  EXPECT_NE(what.find("No such file"), std::string::npos) << what;
}

TEST(Reports, AFullDiskIsNoticed) {
  // The kernel's always-full device.
  EXPECT_THROW(write_metrics("/dev/full", score(recording::Recording{})), files::OutputError);
  EXPECT_THROW(write_frames("/dev/full", five_frames(true)), files::OutputError);
}

}  // namespace
}  // namespace lcs::scoring
