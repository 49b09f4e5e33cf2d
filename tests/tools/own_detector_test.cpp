// Any program as a detector, from the command line to the figures: small images, real processes.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/processes.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/box.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/figures_file.h"
#include "tools/suite/suite_result.h"

namespace lcs {
namespace {

namespace fs = std::filesystem;
using test::Command;
using test::CommandResult;
using test::entries;
using test::read;
using Json = nlohmann::json;
using namespace std::chrono_literals;

/// A Python with OpenCV; "" if there is none.
std::string python() {
  static const std::string found = [] {
    for (const std::string name : {"python3", "/usr/bin/python3"}) {
      if (std::system((name + " -c 'import cv2, numpy' 2>/dev/null").c_str()) == 0) return name;
    }
    return std::string();
  }();
  return found;
}

/// Follows the protocol with empty answers; its argument selects a deviation from the
/// protocol.
constexpr const char* kProgram = R"(
import json, os, signal, sys, time
mode = sys.argv[1]
header = json.loads(sys.stdin.buffer.readline())
if mode == "silent": time.sleep(1000)
if mode == "writes": open(sys.argv[2], "w").write(json.dumps(header) + "\n")
lists = "[" * 100000 + "]" * 100000
if mode == "nested greeting": print('{"protocol": ' + lists + '}', flush=True)
greeting = {"protocol": 2 if mode == "newer" else 1}
if mode == "asks for all": greeting["answer_bytes"] = 1 << 40
if mode == "asks for more": greeting["answer_bytes"] = 3000000
print(json.dumps(greeting), flush=True)
for line in sys.stdin.buffer:
    frame = json.loads(line)
    k = frame["index"]
    if mode == "early" and k == 3: print('{"index": 3}', flush=True); time.sleep(1000)
    picture = sys.stdin.buffer.read(header["picture"]["bytes"])
    answer = {"index": k}
    if mode == "writes":
        frame["picture"] = len(picture), sum(picture)
        open(sys.argv[2], "a").write(json.dumps(frame) + "\n")
    if mode == "masks":
        answer["mask"] = [[1, {"size": [240, 320], "counts": "mV11b7a0\\YY2"}],
                          [2, {"size": [240, 320], "counts": [0, 240, 76560]}]]
    if mode == "dies for far" and header["scenario"] == "far": os.kill(os.getpid(), signal.SIGSEGV)
    if k == 3:
        if mode == "hangs": print("still thinking", file=sys.stderr, flush=True); time.sleep(1000)
        if mode == "garbage": print("\x1b[31mrebels: 7", flush=True)
        if mode == "list": print("[]", flush=True)
        if mode == "no index": print("{}", flush=True)
        if mode == "corner": answer["rebel"] = [99999]
        if mode == "word": answer["rebels"] = [1]
        if mode == "nan": answer["box"] = [[1, float("nan"), 2, 3, 4]]
        if mode == "circle": answer["circle"] = []
        if mode == "mask": answer["mask"] = [[1, {"size": [240, 320], "counts": [9, 9]}]]
        if mode == "large mask": answer["mask"] = [[1, {"size": [480, 640], "counts": [0, 307200]}]]
        if mode == "endless mask":
            answer["mask"] = [[1, {"size": [240, 2147483647], "counts": [0, 240 * 2147483647]}]]
        if mode == "outside": answer["box"] = [[1, 320, 0, 5, 5]]
        if mode == "corner outside": answer["rebel"] = [[10, -3]]
        if mode == "large id": answer["box"] = [[2**64 - 1, 0, 0, 5, 5]]
        if mode == "crowd": answer["box"] = [[i, 0, 0, 5, 5] for i in range(1001)]
        if mode == "nested index": print('{"index": ' + lists + '}', flush=True)
        if mode == "nested row": print('{"index": 3, "rebel": [' + lists + ']}', flush=True)
        if mode == "nested mask": print('{"index": 3, "mask": [[1, ' + lists + ']]}', flush=True)
        if mode == "nested word": print('{"index": 3, "nobody": ' + lists + '}', flush=True)
        if mode == "nested objects": print('{"index": 3, "a": ' + '{"a": ' * 100000, flush=True)
        if mode == "endless": print("[" + "0, " * 10000000, flush=True)
        if mode == "twice": print(json.dumps(answer), flush=True)
        if mode == "skips": answer["index"] = 4
        if mode == "dies": print("no more", file=sys.stderr); raise ValueError("of frame 3")
        if mode == "killed": os.kill(os.getpid(), signal.SIGSEGV)
        if mode == "ends": sys.exit(0)
        if mode == "closes": os.close(1); time.sleep(1000)
        if mode == "asks for more": answer["rebel"] = [0]
        if mode in ("long", "asks for more"): print(" " * 1500000, end="")
    print(json.dumps(answer), flush=True)
if mode == "one more": print(json.dumps({"index": k + 1}), flush=True)
if mode == "fails late": sys.exit(3)
if mode == "stays": time.sleep(1000)
)";

class OwnDetector : public testing::Test {
 protected:
  void SetUp() override {
    if (python().empty()) {
      // in the same places as tools/test
      std::cout << "SKIPPED: there is no python3 with OpenCV (Debian: python3-opencv)\n";
      GTEST_SKIP();
    }
    std::ofstream(folder_.path() / "mine.py") << kProgram;
    scenario("near");
  }
  void scenario(const std::string& name, const std::string& more = "") const {
    fs::create_directories(folder_.path() / "scenarios");
    std::ofstream(folder_.path() / "scenarios" / (name + ".yaml"))
        << "scene: lab\nframes: 8\nego: {start: [-4 m, 0 m], speed: 0.5 m/s}\n"
           "camera: {size: [320, 240]}\nactors: {box: {shape: box, trajectory: {line: {from: [0 m, "
           "-1 m], "
           "heading: 90 deg, speed: 0.7 m/s}}}}\n"
        << more;
  }
  CommandResult lcs(const std::vector<std::string>& arguments) const {
    return test::run_lcs(arguments, {.folder = folder_.path()});
  }
  static std::string mine(const std::string& mode) { return python() + " mine.py '" + mode + "'"; }
  std::vector<std::string> run_arguments(const std::string& mode) const {
    return {"run",  "scenarios/near.yaml", "--out",   "out", "--quiet", "--no-video", "--detector",
            "mine", "--detector-command",  mine(mode)};
  }
  std::vector<Json> lines_of(const fs::path& file) const {
    std::vector<Json> lines;
    std::ifstream stream(folder_.path() / file);
    for (std::string line; std::getline(stream, line);) lines.push_back(Json::parse(line));
    return lines;
  }

  const test::TemporaryFolder folder_;
};

TEST_F(OwnDetector, IsToldWhatTheFilterIsAndSeesEachPicture) {
  const CommandResult command =
      lcs({"run", "scenarios/near.yaml", "--seed", "5", "--out", "out", "--quiet", "--no-video",
           "--detector", "mine", "--detector-command", python() + " mine.py writes told.jsonl"});
  ASSERT_EQ(command.exit_code, 0) << command.err;
  const std::vector<Json> told = lines_of("told.jsonl"), layers = lines_of("out/layers.jsonl"),
                          truth = lines_of("out/truth.jsonl");
  ASSERT_EQ(told.size(), 9U);
  const Json& header = told[0];
  EXPECT_EQ(header["protocol"], 1);
  EXPECT_EQ(header["scenario"], "near");
  EXPECT_EQ(header["seed"], 5);
  EXPECT_EQ(header["frames"], 8);
  EXPECT_EQ(header["rate_hz"], 10);
  EXPECT_EQ(header["picture"],
            (Json{{"pixels", "bgr8"}, {"bytes", 320 * 240 * 3}, {"compressed", false}}));
  EXPECT_EQ(header["camera"], Json::parse(read(folder_.path() / "out" / "camera.json")));
  EXPECT_EQ(header["camera"]["centre_px"], (Json{159.5, 119.5}));
  for (std::size_t k = 0; k < 8; ++k) {
    const Json& frame = told[k + 1];
    EXPECT_EQ(frame["t_ns"], layers[k]["t_ns"]);
    EXPECT_EQ(frame["told_motion"], layers[k]["told_motion"]) << "to the last bit";
    if (k > 0) {  // the first frame has no motion
      EXPECT_NE(frame["told_motion"]["v_C_mps"], truth[k + 1]["true_motion"]["v_C_mps"])
          << "never the exact one";
    }
    EXPECT_EQ(frame["corners"]["x"], layers[k]["corners"]["x"]);
    EXPECT_EQ(frame["corners"]["y"], layers[k]["corners"]["y"]);
    EXPECT_EQ(frame["picture"][0], 320 * 240 * 3);
    EXPECT_GT(frame["picture"][1], 320 * 240 * 3 * 20) << "it is not black";
    EXPECT_EQ(frame.size(), 5U) << "nothing else, least of all a truth: " << frame;
  }
}

TEST_F(OwnDetector, HasATimeOfItsOwnKindAndFiguresThatItCannotHaveAreNull) {
  const CommandResult command = lcs(run_arguments("fine"));
  ASSERT_EQ(command.exit_code, 0) << command.err;
  const Json metrics = Json::parse(read(folder_.path() / "out" / "metrics.json"));
  EXPECT_GT(metrics["time.process_ms_median"], 0);
  for (const char* unknown : {"time.filter_ms_median", "time.filter_over_fast", "dimension.mean",
                              "rebel.false_objects_per_100_frames", "rebel.circle_recall"}) {
    EXPECT_TRUE(metrics[unknown].is_null()) << unknown;
  }
  EXPECT_EQ(metrics["rebel.recall"], 0);
  EXPECT_EQ(metrics["rebel.false_corners_per_frame"], 0);
  const CommandResult again = lcs({"score", "out"});
  EXPECT_NE(again.out.find("near by mine"), std::string::npos) << again.out;
  EXPECT_NE(again.out.find("  process "), std::string::npos) << again.out;
}

TEST_F(OwnDetector, MayGiveMasksAsCocosToolsHaveThem) {
  const CommandResult command = lcs(run_arguments("masks"));
  ASSERT_EQ(command.exit_code, 0) << command.err;
  const recording::FrameRecord frame =
      recording::read_recording(folder_.path() / "out").frames.at(2);
  const auto& squares = frame.layers.squares;
  ASSERT_EQ(squares.size(), 2U);
  ASSERT_EQ(frame.masks.size(), 2U);
  EXPECT_EQ(frame.masks.at(squares[1].id).runs, (sim::PixelRuns{0, 240}));
  EXPECT_EQ(recording::edges_of(squares[0]), Eigen::Vector4d(5, 45, 7, 66))
      << "as pycocotools has it";
  EXPECT_EQ(recording::edges_of(squares[1]), Eigen::Vector4d(0, 0, 1, 240));
}

TEST_F(OwnDetector, ProtocolFaultEndsTheRunWithOneMessageAndNoOutput) {
  const std::map<std::string, std::string> faults{
      {"silent",
       "its greeting: no answer within 4 s; end each answer with a line end and flush it"},
      {"newer", "its greeting: it does not say {\"protocol\": 1}, but '{\"protocol\":2}'"},
      {"hangs",
       "frame 3: no answer within 4 s; end each answer with a line end and flush it, or give "
       "more time by --detector-timeout; it wrote to stderr: still thinking"},
      {"garbage", "frame 3: its answer '\\x1b[31mrebels: 7': not JSON at byte 1; write one"},
      {"list", "frame 3: its answer is no object: '[]'"},
      {"nested greeting", "its greeting: its answer '{\"protocol\": [[["},
      {"nested index", "frame 3: its answer '{\"index\": [[["},
      {"nested row", "frame 3: its answer '{\"index\": 3, \"rebel\": [[["},
      {"nested mask", "frame 3: its answer '{\"index\": 3, \"mask\": [[1, [[["},
      {"nested word", "frame 3: its answer '{\"index\": 3, \"nobody\": [[["},
      {"nested objects", "frame 3: its answer '{\"index\": 3, \"a\": {\"a\": "},
      {"long", "frame 3: its line is longer than 1000000 bytes; write a shorter one, or say "},
      {"endless", "frame 3: its line is longer than 1000000 bytes; write a shorter one, or say "},
      {"asks for all", "its greeting: its \"answer_bytes\" is 1099511627776; give a whole number "},
      {"no index", "frame 3: its answer has no \"index\""},
      {"corner", "frame 3: there is no corner 99999: frame 3 has "},
      {"word", "frame 3: there is no type 'rebels'; give ignored, pending, normal, rebel, box"},
      {"nan",
       "frame 3: its answer '{\"index\": 3, \"box\": [[1, NaN, 2, 3, 4]]}': not JSON at byte 26"},
      {"mask", "frame 3: the mask's counts do not add up to 240 x 320 pixels"},
      {"circle", "frame 3: it gives circles, and has not said \"circles\": true in its greeting"},
      {"early", "frame 3: it answered before it had read the last "},
      {"twice", "frame 4: it"},  // before the request, or with the index of the last one
      {"skips", "frame 3: its answer has the index 4"},
      {"dies", "frame 3: it ended with exit code 1; it wrote to stderr: no more | Traceback"},
      {"killed", "frame 3: it was ended by signal 11 (Segmentation fault)"},
      {"ends", "frame 3: it ended with exit code 0"},
      {"closes", "frame 3: it has closed its output, and still runs"},
      {"one more", "after the last frame: it wrote '{\"index\": 8}' after its last answer"},
      {"fails late", "after the last frame: it ended with exit code 3"},
      {"stays", "after the last frame: it has not ended within 4 s after its input did"},
  };
  for (const auto& [mode, said] : faults) {
    std::vector<std::string> arguments = run_arguments(mode);
    const bool is_waited_for = said.find("4 s") != std::string::npos;
    if (is_waited_for) arguments.insert(arguments.end(), {"--detector-timeout", "4 s"});
    const CommandResult command = lcs(arguments);
    EXPECT_EQ(command.exit_code, 2) << mode;
    EXPECT_TRUE(command.err.starts_with("lcs: detector mine, " + said))
        << mode << ": " << command.err;
    EXPECT_EQ(std::count(command.err.begin(), command.err.end(), '\n'), 1) << command.err;
    if (mode.starts_with("nested")) {
      EXPECT_NE(command.err.find("nested more than 64 deep at byte "), std::string::npos)
          << command.err;
    }
    EXPECT_EQ(entries(folder_.path()), (std::set<std::string>{"mine.py", "scenarios"})) << mode;
  }
}

TEST_F(OwnDetector, IsCheckedAgainstTheCamera) {
  const std::map<std::string, std::string> faults{
      {"large mask",
       "the mask is of 640 x 480 pixels, and the picture of 320 x 240; give one of the picture's "
       "size"},
      {"endless mask",
       "the mask is of 2147483647 x 240 pixels, and the picture of 320 x 240; give one of the "
       "picture's size"},
      {"outside", "the box from 319.5, -0.5 to 324.5, 4.5 lies outside of the picture, which has"},
      {"corner outside", "the corner at 10, -3 lies outside of the picture, which has 320 x 240"},
      {"large id", "the id is 18446744073709551615; give a whole number up to 9007199254740991"},
      {"crowd", "there are more than 1000 boxes in the frame; give objects' boxes"},
  };
  for (const auto& [mode, said] : faults) {
    const CommandResult command = lcs(run_arguments(mode));
    EXPECT_EQ(command.exit_code, 2) << mode;
    EXPECT_TRUE(command.err.starts_with("lcs: detector mine, frame 3: " + said))
        << mode << ": " << command.err;
    EXPECT_EQ(std::count(command.err.begin(), command.err.end(), '\n'), 1) << command.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "out")) << mode;
  }
}

TEST_F(OwnDetector, ExceptionIsToldWithItsLastLine) {
  EXPECT_NE(lcs(run_arguments("dies")).err.find("ValueError: of frame 3"), std::string::npos);
}

TEST_F(OwnDetector, MissingOrMisnamedOneIsToldBeforeAnyOutput) {
  const auto said = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"run", "scenarios/near.yaml", "--out", "out"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const CommandResult command = lcs(arguments);
    EXPECT_EQ(command.exit_code, 2) << command.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "out"));
    return command.err;
  };
  EXPECT_NE(said({"--detector-command", "./nowhere --fast"})
                .find("detector nowhere, its greeting: it ended with exit code 127"),
            std::string::npos);
  EXPECT_NE(said({"--detector", "klt", "--detector-command", mine("fine")})
                .find("klt is a detector of this program; give yours another name by --detector"),
            std::string::npos);
  EXPECT_NE(said({"--detector", "a/b", "--detector-command", mine("fine")})
                .find("'a/b' cannot be a detector's name"),
            std::string::npos);
  EXPECT_NE(
      said({"--detector-timeout", "1 s"}).find("--detector-timeout requires --detector-command"),
      std::string::npos);
  EXPECT_NE(said({"--detector-timeout", "0 s", "--detector-command", mine("fine")})
                .find("--detector-timeout"),
            std::string::npos);
}

TEST_F(OwnDetector, LeavesNoProcessBehindHoweverTheRunEnds) {
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    Command command(run_arguments("hangs"), {.folder = folder_.path()});
    std::vector<pid_t> children;  // the scene is also tried in a child
    const auto has_program = [&] {
      children = test::children_of(command.pid());
      return std::any_of(children.begin(), children.end(), [](pid_t child) {
        return test::command_line_of(child).find("mine.py") != std::string::npos;
      });
    };
    for (int i = 0; i < 1000 && !has_program(); ++i) std::this_thread::sleep_for(10ms);
    ASSERT_FALSE(children.empty());
    std::this_thread::sleep_for(300ms);
    command.send(signal);
    const CommandResult result = command.wait();
    EXPECT_EQ(result.exit_code, signal == SIGKILL ? 128 + SIGKILL : 130) << result.err;
    const auto any_runs = [&] {
      return std::any_of(children.begin(), children.end(), test::is_running);
    };
    for (int i = 0; i < 200 && any_runs(); ++i) std::this_thread::sleep_for(10ms);
    EXPECT_FALSE(any_runs()) << "after signal " << signal;
  }
}

TEST_F(OwnDetector, MayAskForLongerAnswersInItsGreeting) {
  const CommandResult command = lcs(run_arguments("asks for more"));
  ASSERT_EQ(command.exit_code, 0) << command.err;
  const recording::FrameRecord frame =
      recording::read_recording(folder_.path() / "out").frames.at(3);
  ASSERT_FALSE(frame.verdicts.empty());
  EXPECT_EQ(frame.verdicts.front(), Verdict::rebel);
}

/// All processes with a word in their command line.
std::vector<pid_t> processes_with(const std::string& word) {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const pid_t process = std::stoi(name);
    if (test::command_line_of(process).find(word) != std::string::npos) found.push_back(process);
  }
  return found;
}

TEST_F(OwnDetector, OfAnyCommandOfAShellEndsWithAProgramThatIsKilled) {
  const std::string naps = "import time;time.sleep(1000);'" + folder_.path().string() + "'";
  const std::string nap = python() + " -c \"" + naps + "\"";
  for (const std::string& shell :
       {nap, "cd . && " + nap + "; true", nap + " & " + nap + " & wait", "( " + nap + " | cat ); :",
        "{ sh -c '" + python() + " -c \"import time;time.sleep(1000)\" x " +
            folder_.path().string() + "; true'; true; } <&-"}) {
    SCOPED_TRACE(shell);
    Command command({"run", "scenarios/near.yaml", "--out", "out", "--quiet", "--no-video",
                     "--detector", "mine", "--detector-command", shell},
                    {.folder = folder_.path()});
    const auto naps_now = [&] {
      auto all = processes_with(folder_.path().string());
      std::erase(all, command.pid());
      return all;
    };
    // `python3` may be a script that starts a Python of another path
    const auto has_nap = [&] {
      const auto all = naps_now();
      return std::ranges::any_of(all, [](pid_t process) {
        const std::string line = test::command_line_of(process);
        return fs::path(line.substr(0, line.find('\0'))).filename().string().starts_with("python");
      });
    };
    for (int i = 0; i < 1000 && !has_nap(); ++i) std::this_thread::sleep_for(10ms);
    ASSERT_TRUE(has_nap());
    command.send(SIGKILL);
    command.wait();
    for (int i = 0; i < 200 && !naps_now().empty(); ++i) std::this_thread::sleep_for(10ms);
    EXPECT_TRUE(naps_now().empty());
    for (const pid_t process : naps_now()) ::kill(process, SIGKILL);
    fs::remove_all(folder_.path() / "out");
  }
}

TEST_F(OwnDetector, FailureInOneRunOfASuiteLeavesTheOthers) {
  scenario("far");
  const CommandResult command =
      lcs({"suite", "scenarios", "--seeds", "1", "--out", "suite", "--quiet", "--detector", "mine",
           "--detector-command", mine("dies for far")});
  EXPECT_EQ(command.exit_code, 2);
  EXPECT_NE(command.err.find("far seed 1: detector mine, frame 0: it was ended by signal 11"),
            std::string::npos)
      << command.err;
  const suite::SuiteResult result = suite::read_suite(folder_.path() / "suite");
  EXPECT_EQ(result.detector, "mine");
  EXPECT_EQ(result.scenarios.at(0).runs.at(0).command,
            "lcs run scenarios/far.yaml --seed 1 --detector mine --detector-command '" + python() +
                R"( mine.py '\''dies for far'\''')");
  EXPECT_EQ(result.scenarios.at(0).runs.at(0).outcome, suite::Outcome::error);
  EXPECT_EQ(result.scenarios.at(1).runs.at(0).outcome, suite::Outcome::passed);
  EXPECT_EQ(scoring::value(result.scenarios.at(1).runs.at(0).metrics, "rebel.recall"), 0);
}

/// Figures except times.
std::map<std::string, std::optional<double>> figures_of(const suite::RunResult& run) {
  std::map<std::string, std::optional<double>> figures;
  for (const auto& [name, figure] : run.metrics) {
    if (!name.starts_with("time.") && !name.starts_with("sim.")) figures[name] = figure;
  }
  return figures;
}

TEST_F(OwnDetector, TheExampleHasTheSameFiguresByItsProgramAndByFilesOverASuite) {
  scenario("near", "criteria: [{metric: rebel.recall, min: 0.3}]\n");
  scenario("far", "image: {noise: none}\ncriteria: [{metric: frames, min: 9}]\n");
  const std::string example = python() + " " + LCS_EXAMPLE_DETECTOR;
  const auto suite = [&](const std::string& out, std::vector<std::string> more) {
    more.insert(more.begin(), {"suite", "scenarios", "--seeds", "2", "--out", out});
    const CommandResult command = lcs(more);
    EXPECT_EQ(command.exit_code, 1) << "a criterion of far: " << command.err;
    return suite::read_suite(folder_.path() / out);
  };
  suite("frames", {});
  const suite::SuiteResult asked =
      suite("asked", {"--recorded", "frames", "--detector", "lk", "--detector-command", example});
  for (const suite::ScenarioResult& scenario : asked.scenarios) {
    for (const suite::RunResult& run : scenario.runs) {
      ASSERT_NE(run.outcome, suite::Outcome::error) << run.error;
      const fs::path csv = fs::path("csv") / scenario.name;
      fs::create_directories(folder_.path() / csv);
      const CommandResult written =
          lcs({"score", (fs::path("asked") / run.folder).string(), "--quiet", "--write-detections",
               (csv / ("seed-" + std::to_string(run.seed) + ".csv")).string()});
      ASSERT_EQ(written.exit_code, 0) << written.err;
    }
  }
  const suite::SuiteResult said =
      suite("said", {"--recorded", "frames", "--detector", "lk", "--detections", "csv"});
  ASSERT_EQ(said.scenarios.size(), 2U);
  for (std::size_t s = 0; s < 2; ++s) {
    for (std::size_t r = 0; r < 2; ++r) {
      const suite::RunResult &a = asked.scenarios[s].runs.at(r), &b = said.scenarios[s].runs.at(r);
      EXPECT_EQ(figures_of(a), figures_of(b));
      EXPECT_GT(scoring::value(a.metrics, "rebel.f1"), 0.3) << "it does find something";
      EXPECT_TRUE(scoring::value(a.metrics, "rebel.false_objects_per_100_frames"));
      EXPECT_FALSE(scoring::value(b.metrics, "time.process_ms_median")) << "nobody was asked";
      EXPECT_EQ(a.outcome, b.outcome);
    }
  }
  EXPECT_EQ(asked.scenarios[0].runs[0].outcome, suite::Outcome::failed);
  EXPECT_EQ(asked.scenarios[1].runs[0].outcome, suite::Outcome::passed);
  EXPECT_NE(lcs({"score", "asked"}).out.find("near"), std::string::npos);
  EXPECT_EQ(lcs({"compare", "asked", "said"}).exit_code, 0);

  // As in a separate run; recorded frames are compressed, so their results differ.
  const CommandResult live = lcs({"run", "scenarios/near.yaml", "--out", "live", "--no-video",
                                  "--quiet", "--detector", "lk", "--detector-command", example});
  EXPECT_EQ(live.exit_code, 0) << live.err;
  const auto live_metrics = scoring::read_metrics(folder_.path() / "live" / "metrics.json");
  EXPECT_GT(scoring::value(live_metrics, "rebel.f1"), 0.3);
}

TEST_F(OwnDetector, EachRivalFindsTheCrossingBox) {
  const fs::path folder = LCS_RIVALS;
  for (const std::string rival : {"homography", "foels", "geoimo"}) {
    const CommandResult command =
        lcs({"run", "scenarios/near.yaml", "--out", rival, "--no-video", "--quiet", "--detector",
             rival, "--detector-command", python() + " " + (folder / (rival + ".py")).string()});
    ASSERT_EQ(command.exit_code, 0) << command.err;
    const auto metrics = scoring::read_metrics(folder_.path() / rival / "metrics.json");
    EXPECT_GT(scoring::value(metrics, "rebel.recall"), 0.6) << rival;
    EXPECT_GT(scoring::value(metrics, "rebel.precision"), 0.15) << rival;
    EXPECT_GT(scoring::value(metrics, "square.recall_50_movers"), 0.2) << rival;
  }
}

TEST_F(OwnDetector, FilesOfDetectionsThatAreMissingAreAllNamedBeforeAnythingRuns) {
  scenario("far");
  ASSERT_EQ(lcs({"suite", "scenarios", "--seeds", "2", "--out", "frames", "--quiet"}).exit_code, 0);
  fs::create_directories(folder_.path() / "csv" / "far");
  std::ofstream(folder_.path() / "csv" / "far" / "seed-2.csv") << "";
  const auto said = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"suite", "scenarios", "--seeds", "2", "--out", "said"});
    const CommandResult command = lcs(more);
    EXPECT_EQ(command.exit_code, 2);
    EXPECT_FALSE(fs::exists(folder_.path() / "said"));
    return command.err;
  };
  EXPECT_NE(said({"--recorded", "frames", "--detections", "csv"})
                .find("csv lacks 3 of the files of detections: far/seed-1.csv, near/seed-1.csv, "
                      "near/seed-2.csv; write them"),
            std::string::npos);
  EXPECT_NE(said({"--detections", "csv"}).find("--detections requires --recorded"),
            std::string::npos);
  EXPECT_NE(
      said({"--recorded", "frames", "--detections", "none"}).find("--detections none is no folder"),
      std::string::npos);
  // An invalid row is an error of its run, by file and line.
  for (const char* file : {"far/seed-1.csv", "near/seed-1.csv"}) {
    fs::create_directories((folder_.path() / "csv" / file).parent_path());
    std::ofstream(folder_.path() / "csv" / file) << "";
  }
  std::ofstream(folder_.path() / "csv" / "near" / "seed-2.csv") << "9,rebel,1\n";
  const CommandResult one = lcs({"suite", "scenarios", "--seeds", "2", "--out", "said",
                                 "--recorded", "frames", "--detections", "csv", "--quiet"});
  EXPECT_EQ(one.exit_code, 2);
  EXPECT_NE(one.err.find("near seed 2: csv/near/seed-2.csv:1: there is no frame 9"),
            std::string::npos)
      << one.err;
  const suite::SuiteResult result = suite::read_suite(folder_.path() / "said");
  EXPECT_EQ(result.detector, "csv");
  EXPECT_EQ(result.scenarios.at(0).runs.at(1).command,
            "lcs run scenarios/far.yaml --seed 2 --detector csv --recorded frames/runs/far/seed-2 "
            "--detections csv/far/seed-2.csv");
  EXPECT_EQ(result.scenarios.at(0).runs.at(1).outcome, suite::Outcome::passed);
}

TEST_F(OwnDetector, WatchesRecordedFramesToo) {
  ASSERT_EQ(
      lcs({"generate", "scenarios/near.yaml", "--frames", "5", "--out", "sequence", "--quiet"})
          .exit_code,
      0);
  const CommandResult replayed =
      lcs({"replay", "sequence", "--out", "replayed", "--no-video", "--quiet", "--detector", "mine",
           "--detector-command", python() + " mine.py writes replayed.jsonl"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  const CommandResult run =
      lcs({"run", "scenarios/near.yaml", "--out", "out", "--no-video", "--quiet", "--detector",
           "mine", "--detector-command", python() + " mine.py writes run.jsonl"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::vector<Json> a = lines_of("replayed.jsonl"), b = lines_of("run.jsonl");
  ASSERT_EQ(a.size(), 6U);
  b.resize(6);
  for (Json* header : {&a[0], &b[0]}) {
    for (const char* own : {"scenario", "frames", "seed"}) header->erase(own);
  }
  EXPECT_EQ(a, b) << "to the last bit and pixel";
}

TEST_F(OwnDetector, IsHandedThePicturesThatAnEarlierRunKeptAndToldSo) {
  ASSERT_EQ(lcs({"run", "scenarios/near.yaml", "--out", "bare", "--no-video", "--quiet"}).exit_code,
            0);
  std::vector<std::string> arguments{"run",
                                     "scenarios/near.yaml",
                                     "--out",
                                     "out",
                                     "--no-video",
                                     "--quiet",
                                     "--detector",
                                     "mine",
                                     "--detector-command",
                                     python() + " mine.py writes told.jsonl",
                                     "--recorded",
                                     "bare"};
  const CommandResult without = lcs(arguments);
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_NE(without.err.find("bare has no pictures to hand to mine; record it with --events"),
            std::string::npos)
      << without.err;
  ASSERT_EQ(
      lcs({"run", "scenarios/near.yaml", "--out", "kept", "--no-video", "--quiet", "--events"})
          .exit_code,
      0);
  arguments.back() = "kept";
  EXPECT_EQ(lcs(arguments).exit_code, 0);
  const std::vector<Json> told = lines_of("told.jsonl");
  ASSERT_EQ(told.size(), 9U);
  EXPECT_EQ(told[0]["picture"]["compressed"], true);
  EXPECT_EQ(told[8]["picture"][0], 320 * 240 * 3);
}

}  // namespace
}  // namespace lcs
