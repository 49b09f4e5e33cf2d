// `lcs score` from its command line, on the output of `lcs run`.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/figures_file.h"

namespace lcs::test {
namespace {

namespace fs = std::filesystem;

class Score : public testing::Test {
 protected:
  CommandResult lcs(const std::vector<std::string>& arguments) {
    return run_lcs(arguments, {.folder = folder_.path()});
  }
  /// A short run, in the folder `run`.
  void make_run(const std::string& detector, const char* frames = "frames=12") {
    const CommandResult result =
        lcs({"run", fs::path(LCS_SCENARIOS_DIR) / "crossing.yaml", "--set", frames, "--no-video",
             "--quiet", "--out", "run", "--detector", detector});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  nlohmann::json json(const char* file) {
    return nlohmann::json::parse(read(folder_.path() / file));
  }

  const TemporaryFolder folder_;
};

class ScoreOfDetector : public Score, public testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Names, ScoreOfDetector, testing::Values("lcs", "klt", "dis"),
                         [](const auto& test) { return test.param; });

TEST_P(ScoreOfDetector, GivesTheRunsOwnFiguresToTheLastBitTimesIncluded) {
  make_run(GetParam());
  const CommandResult result = lcs({"score", "run", "--out", "again.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(read(folder_.path() / "again.json"), read(folder_.path() / "run/metrics.json"));
  const nlohmann::json figures = json("again.json");
  EXPECT_GT(figures["time.filter_ms_median"].get<double>(), 0);
  const bool layered = GetParam() == std::string("lcs");
  for (const char* of_layers :
       {"dimension.mean", "edges.rematched", "time.line_ms_median", "time.square_over_fast"}) {
    EXPECT_EQ(figures[of_layers].is_null(), !layered) << of_layers;
  }
  EXPECT_NE(result.out.find("crossing by " + std::string(GetParam())), std::string::npos)
      << result.out;
  EXPECT_EQ(result.err, "");
}

TEST_F(Score, PrintsItsFiguresAsCsvWithAllDigits) {
  make_run("lcs");
  const CommandResult result = lcs({"score", "run", "--format", "csv"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::istringstream lines(result.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "figure,unit,lcs");
  const nlohmann::json figures = json("run/metrics.json");
  int compared = 0;
  for (; std::getline(lines, line); ++compared) {
    const std::string key = line.substr(0, line.find(','));
    EXPECT_EQ(std::stod(line.substr(line.rfind(',') + 1)), figures.at(key).get<double>()) << line;
  }
  EXPECT_GT(compared, 50);
}

TEST_P(ScoreOfDetector, ExportedAndScoredAgainItHasTheSameFiguresOfRebelsAndSquares) {
  make_run(GetParam());
  ASSERT_EQ(lcs({"score", "run", "--write-detections", "said.csv", "--quiet"}).exit_code, 0);
  const CommandResult result = lcs(
      {"score", "--sequence", "run", "--detections", "said.csv", "--out", "said.json", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out + result.err, "");
  const nlohmann::json own = json("run/metrics.json"), said = json("said.json");
  EXPECT_GT(own["rebel.recall"].get<double>(), 0);
  int compared = 0;
  for (const auto& [name, figure] : own.items()) {
    if (name == "rebel.f1_lost_first_seen" || name == "rebel.f1_lost_tracked") {
      EXPECT_TRUE(said[name].is_null()) << name << ": by reasons, which detections have none of";
    } else if (name.ends_with(".average_precision")) {
      EXPECT_TRUE(said[name].is_null()) << name << ": by log odds, which detections have none of";
    } else if (name.starts_with("rebel.") || name.starts_with("square.") ||
               name.starts_with("truth.")) {
      EXPECT_EQ(said[name], figure) << name;
      ++compared;
    } else if (name.starts_with("time.")) {
      EXPECT_TRUE(said[name].is_null()) << name;
    }
  }
  EXPECT_GT(compared, 25);
}

TEST_F(Score, LeavesTheRunAsItWas) {
  make_run("lcs", "frames=4");
  const std::string before = read(folder_.path() / "run/metrics.json");
  std::ofstream(folder_.path() / "none.csv");
  ASSERT_EQ(lcs({"score", "run", "--detections", "none.csv"}).exit_code, 0);
  EXPECT_EQ(read(folder_.path() / "run/metrics.json"), before);
}

TEST_F(Score, ReportsVerdictsOnNoCorner) {
  make_run("lcs", "frames=4");
  std::ofstream(folder_.path() / "far.csv") << "3,rebel,0,0\n3,rebel,0\n3,rebel,639,0\n";
  const CommandResult result = lcs({"score", "run", "--detections", "far.csv", "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "2 of 3 verdicts are on no corner: there is none within 2 px\n");
}

TEST_F(Score, WithoutFramesCsvHasNoTimes) {
  make_run("lcs", "frames=4");
  fs::remove(folder_.path() / "run" / scoring::kFramesFile);
  ASSERT_EQ(lcs({"score", "run", "--out", "again.json"}).exit_code, 0);
  EXPECT_TRUE(json("again.json")["time.filter_ms_median"].is_null());
  EXPECT_FALSE(json("again.json")["dimension.mean"].is_null());
}

TEST_F(Score, ItsHelpAsksForTheFolderOnce) {
  const std::string help = run_lcs({"score", "--help"}, {.folder = folder_.path()}).out;
  EXPECT_NE(help.find("DIR REQUIRED"), std::string::npos) << help;
  EXPECT_EQ(help.find("--sequence"), std::string::npos) << help;
}

TEST_F(Score, MistakesAreToldInOneLineAndNothingIsWritten) {
  make_run("lcs", "frames=4");
  std::ofstream(folder_.path() / "bad.csv") << "3,rebel,0\n4,rebel,0\n";
  fs::create_directory(folder_.path() / "empty");
  const struct {
    std::vector<std::string> arguments;
    std::string message;
  } mistakes[] = {
      {{"score"}, "--sequence is required"},
      {{"score", "none"}, "none is no folder; name one that lcs run has left"},
      {{"score", "."},
       ". is a folder of runs, as ./run; name one of these, or the folder of a suite"},
      {{"score", "empty"}, "empty/layers.jsonl: there is no such file; "},
      {{"score", "run", "--detections", "bad.csv"},
       "bad.csv:2: there is no frame 4: the sequence has 0 to 3"},
      {{"score", "run", "--detections", "none.csv"}, "none.csv: there is no such file; "},
      {{"score", "run", "--detections", "/dev/zero"}, "/dev/zero: this is a device; "},
      {{"score", "run", "--detections", ""}, "--detections: is given without a value; "},
      {{"score", "run", "--out", "/proc/lcs/x.json"}, "cannot create /proc/lcs"},
  };
  for (const auto& [arguments, message] : mistakes) {
    std::vector<std::string> all = arguments;
    if (all.size() > 1 && all[all.size() - 2] != "--out") {
      all.insert(all.end(), {"--out", "new.json"});
    }
    const CommandResult result = lcs(all);
    EXPECT_EQ(result.exit_code, 2) << message;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "new.json"));
  }
}

TEST_F(Score, FilesOfOthersAreNotReplaced) {
  make_run("lcs", "frames=4");
  const fs::path thesis = folder_.path() / "thesis.tex", mine = folder_.path() / "mine.csv";
  std::ofstream(thesis) << "precious";
  const fs::path figures = folder_.path() / "mine.json";
  std::ofstream(mine) << "frame,type\n1,rebel,0\n";
  std::ofstream(figures) << R"({"rebel.f1": 0.5})";
  for (const auto& [arguments, said] :
       {std::pair{std::vector<std::string>{"--out", "thesis.tex"}, "would be lost"},
        {{"--write-detections", "thesis.tex"}, "would be lost"},
        {{"--write-detections", "mine.csv"}, "would be lost"},
        {{"--out", "mine.json"}, "would be lost"},
        {{"--out", "mine.json", "--write-detections", "new.csv"}, "would be lost"},
        {{"--detections", "mine.csv", "--write-detections", "mine.csv"}, "which is read"},
        {{"--detections", "mine.csv", "--write-detections", "mine.csv", "--force"},
         "which is read"}}) {
    std::vector<std::string> all{"score", "run"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const CommandResult result = lcs(all);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(said), std::string::npos) << result.err;
  }
  EXPECT_EQ(read(thesis), "precious");
  EXPECT_EQ(read(mine), "frame,type\n1,rebel,0\n");
  EXPECT_EQ(read(figures), R"({"rebel.f1": 0.5})");
  EXPECT_FALSE(fs::exists(folder_.path() / "new.csv"));
  EXPECT_EQ(lcs({"score", "run", "--out", "mine.json", "--force"}).exit_code, 0);
  std::ofstream(folder_.path() / "empty.json");
  EXPECT_EQ(lcs({"score", "run", "--out", "empty.json"}).exit_code, 0);
  EXPECT_EQ(lcs({"score", "run", "--out", "empty.json"}).exit_code, 0) << "its own";
}

TEST_F(Score, QuotedDataIsOneCleanLine) {
  make_run("lcs", "frames=4");
  std::ofstream(folder_.path() / "bad.csv")
      << "3,rebel," << std::string(10'000'000, 'x') << "\x1b[31m" << '\0' << "\xff,0\n";
  const CommandResult result = lcs({"score", "run", "--detections", "bad.csv"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_LT(result.err.size(), 1010u);
  EXPECT_TRUE(result.err.starts_with("lcs: bad.csv:1: x is 'xxx")) << result.err;
  EXPECT_TRUE(result.err.ends_with("xxx\\x1b[31m\\x00\\xff'; give a number\n")) << result.err;
}

TEST_F(Score, APipeOrADeviceIsRefusedAndNotWaitedFor) {
  make_run("lcs", "frames=4");
  ASSERT_EQ(::mkfifo((folder_.path() / "pipe").c_str(), 0600), 0);
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& message) {
    const CommandResult result = lcs(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  };
  refused({"score", "run", "--detections", "pipe"}, "pipe: this is a pipe");
  refused({"run", "pipe"}, "pipe: this is a pipe");
  refused({"compare", "pipe", "pipe"}, "pipe: this is a pipe");
  for (const char* file : {"warnings.json", "layers.jsonl"}) {
    fs::rename(folder_.path() / "run" / file, folder_.path() / "was");
    fs::rename(folder_.path() / "pipe", folder_.path() / "run" / file);
    refused({"score", "run"}, fmt::format("run/{}: this is a pipe", file));
    fs::rename(folder_.path() / "run" / file, folder_.path() / "pipe");
    fs::rename(folder_.path() / "was", folder_.path() / "run" / file);
  }
}

TEST_F(Score, WarningsThatAreCutOrEditedAreRefusedWithTheirPlace) {
  make_run("lcs", "frames=4");
  const fs::path file = folder_.path() / "run/warnings.json";
  const std::string whole = read(file);
  const std::size_t count = whole.find("\"count\": 0");
  ASSERT_NE(count, std::string::npos);
  const auto with = [&](const std::string& text) {
    return whole.substr(0, count) + text + whole.substr(count + std::string("\"count\": 0").size());
  };
  const std::string lists = std::string(100'000, '[') + std::string(100'000, ']');
  for (const auto& [text, told] : std::vector<std::pair<std::string, std::string>>{
           {whole.substr(0, count), "run/warnings.json:3: not JSON at byte "},
           {"", "run/warnings.json:1: not JSON at byte 1; "},
           {"[]", "run/warnings.json: the file is not an object; "},
           {with("\"count\": -5"), ".count is not a whole number from 0; "},
           {with("\"count\": 1.5"), ".count is not a whole number from 0; "},
           {with("\"count\": 99999999999999999999"), ".count is not a whole number from 0; "},
           {with("\"count\": 5"), ".first is not what is told of the first time; "},
           {with("\"counts\": 0"), ".count is missing; "},
           {with("\"count\": " + lists), "run/warnings.json:3: lists and objects are nested"},
           {"{\"few_corners\": 3}", "run/warnings.json: few_corners is not an object; "},
           {"{\"few_corners\": {\"count\": 0, \"first\": 3}}",
            "few_corners.first is not a text; "}}) {
    write(file, text);
    const CommandResult result = lcs({"score", "run"});
    EXPECT_EQ(result.exit_code, 2) << told;
    EXPECT_NE(result.err.find(told), std::string::npos) << told << " in " << result.err;
    EXPECT_EQ(result.err.find("exception"), std::string::npos) << result.err;
    EXPECT_TRUE(result.err.ends_with("; name the folder of a whole run, or run it again\n"))
        << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
}

TEST(Option, OfAnyCommandIsRefusedWithoutAValue) {
  const TemporaryFolder folder;
  const std::vector<std::string> commands[] = {
      {"run", ""},
      {"run", "x.yaml", "--set", ""},
      {"run", "x.yaml", "--recorded", ""},
      {"score", "x", "--detections", ""},
      {"score", "x", "--out", ""},
      {"generate", "x.yaml", "--shard", ""},
      {"generate", "x.yaml", "--formats", ""},
      {"suite", "--filter", ""},
      {"suite", "--recorded", ""},
      {"compare", "a", "b", "--metric", ""},
      {"replay", "x", "--camera", ""},
      {"replay", "x", "--imu", ""},
      {"kinematics", "--config", ""},
  };
  for (const std::vector<std::string>& command : commands) {
    const CommandResult result = run_lcs(command, {.folder = folder.path()});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(" is given without a value; give one, or leave it out"),
              std::string::npos)
        << command[0] << ' ' << command[command.size() - 2] << ' ' << result.err;
  }
  EXPECT_TRUE(entries(folder.path()).empty());
}

TEST_F(Score, AFullDiskIsNoticedAndLeavesTheEarlierFile) {
  make_run("lcs", "frames=4");
  ASSERT_EQ(lcs({"score", "run", "--out", "old.json"}).exit_code, 0);
  const auto before = bytes_in(folder_.path());
  const CommandResult result = run_lcs({"score", "run", "--out", "old.json"},
                                       {.folder = folder_.path(), .largest_file = 1000});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(bytes_in(folder_.path()), before) << "nothing half-written is left";
}

}  // namespace
}  // namespace lcs::test
