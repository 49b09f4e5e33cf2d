// State after `kill -9` at any moment: a partial result never passes for a whole one, nothing is
// left behind, and the next run gives the same bytes as an uninterrupted one.
//
// LCS_KILLS sets the number of moments; the default is small.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/processes.h"
#include "tests/tools/temporary_folder.h"
#include "tools/files/output.h"
#include "tools/files/written.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/figures_file.h"
#include "tools/sequence/sequence_folder.h"
#include "tools/suite/suite_result.h"

namespace lcs::test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

int kills() {
  const char* text = std::getenv("LCS_KILLS");
  return text == nullptr ? 3 : std::atoi(text);
}

class Killed : public testing::Test {
 protected:
  Killed() {
    fs::create_directory(home_.path() / "scenarios");
    for (const char* name : {"far", "near"}) {
      std::ofstream(home_.path() / "scenarios" / (std::string(name) + ".yaml"))
          << "purpose: none\nscene: lab\nframes: 6\n"
             "ego: {start: [-4 m, 0 m], speed: 0.5 m/s}\ncamera: {size: [160, 120]}\n";
    }
  }
  CommandResult run(const std::vector<std::string>& arguments) const {
    return run_lcs(arguments, {.folder = home_.path()});
  }
  /// Kills the command at a random moment within 1.1 times its usual duration.
  void run_and_kill(const std::vector<std::string>& arguments, Seconds whole) {
    Command command(arguments, {.folder = home_.path()});
    std::this_thread::sleep_for(1.1 * whole * static_cast<double>(random_()) /
                                static_cast<double>(std::mt19937::max()));
    const std::vector<pid_t> children = children_of(command.pid());
    command.send(SIGKILL);
    command.wait();
    expect_gone(children);
  }
  Seconds time(const std::vector<std::string>& arguments) const {
    const Clock::time_point start = Clock::now();
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return Clock::now() - start;
  }

  /// Whether a process is writing a result.
  bool has_locked_folder() const {
    for (const auto& entry : fs::directory_iterator(home_.path())) {
      const bool is_staging = entry.path().string().find(".partial-") != std::string::npos;
      if (is_staging && files::FolderLock(entry.path()).is_of_another()) return true;
    }
    return false;
  }

  const TemporaryFolder home_;

 private:
  static void expect_gone(const std::vector<pid_t>& processes) {
    const Clock::time_point deadline = Clock::now() + std::chrono::seconds(20);
    for (const pid_t process : processes) {
      // Only the system can collect it now: a zombie counts as ended.
      while (is_running(process) && Clock::now() < deadline) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
      EXPECT_FALSE(is_running(process)) << "a child is left";
    }
  }

  std::mt19937 random_{1};
};

TEST_F(Killed, SuiteLeavesTheEarlierOneOrTheNewOne) {
  const std::vector<std::string> earlier{"suite", "scenarios", "--seeds", "1", "--quiet"};
  std::vector<std::string> later = earlier;
  later.insert(later.end(), {"--set", "ego.speed=0.6 m/s"});
  const Seconds whole = time(earlier);
  const fs::path out = home_.path() / "out" / "suite";
  bool is_earlier = true;
  for (int i = 0; i < kills(); ++i) {
    const auto before = bytes_in(out);
    run_and_kill(is_earlier ? later : earlier, whole);
    const auto after = bytes_in(out);
    if (after == before) continue;
    is_earlier = !is_earlier;
    const suite::SuiteResult suite = suite::read_suite(out);
    EXPECT_EQ(suite.sets.empty(), is_earlier);
    ASSERT_EQ(suite.scenarios.size(), 2u);
    for (const suite::ScenarioResult& scenario : suite.scenarios) {
      EXPECT_EQ(scenario.runs.at(0).outcome, suite::Outcome::passed) << scenario.runs[0].error;
      EXPECT_EQ(scoring::read_metrics(out / scenario.runs[0].folder / scoring::kMetricsFile),
                scenario.runs[0].metrics);
    }
    for (const auto& [path, bytes] : after) EXPECT_EQ(path.find("partial"), path.npos) << path;
  }
  // The last kill may have left runs of the other settings, which are dropped by request alone.
  std::vector<std::string> anew = earlier;
  anew.emplace_back("--anew");
  time(anew);
  EXPECT_EQ(entries(home_.path() / "out"), std::set<std::string>{"suite"});
  EXPECT_TRUE(suite::read_suite(out).sets.empty());
}

TEST_F(Killed, RunBesideLeavesBothResultsOldOrBothNew) {
  const auto with_seed = [](int seed) {
    return std::vector<std::string>{
        "run",      "scenarios/near.yaml", "--no-video", "--quiet",           "--out", "own",
        "--beside", "klt=beside",          "--seed",     std::to_string(seed)};
  };
  const Seconds whole = time(with_seed(0));
  for (int i = 1; i <= kills(); ++i) {
    run_and_kill(with_seed(i), whole);
    // The process that renames both outputs ends by itself.
    while (has_locked_folder()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::uint64_t own = recording::read_recording(home_.path() / "own").seed;
    EXPECT_EQ(recording::read_recording(home_.path() / "beside").seed, own);
    for (const char* folder : {"own", "beside"}) {
      EXPECT_EQ(files::first_difference(home_.path() / folder), "") << "it is whole";
    }
  }
  time(with_seed(0));
  EXPECT_EQ(entries(home_.path()), (std::set<std::string>{"beside", "own", "scenarios"}));
}

TEST_F(Killed, GenerateGoesOnToTheSameBytes) {
  const auto to = [](const char* folder, const char* jobs) {
    return std::vector<std::string>{
        "generate", "scenarios/near.yaml", "--out", folder, "--jobs", jobs, "--quiet"};
  };
  const Seconds whole = time(to("never_stopped", "1"));
  const auto expected = bytes_in(home_.path() / "never_stopped");
  for (int i = 0; i < kills(); ++i) {
    run_and_kill(to("stopped", i % 2 == 0 ? "1" : "2"), whole);
    const fs::path folder = home_.path() / "stopped";
    if (!fs::exists(folder)) continue;
    EXPECT_EQ(files::first_difference(folder), "") << "it says that it is whole";
    time(to("stopped", "1"));
    EXPECT_TRUE(bytes_in(folder) == expected);
    fs::remove_all(folder);
  }
  time(to("stopped", "1"));
  EXPECT_TRUE(bytes_in(home_.path() / "stopped") == expected);
}

/// The numbers that `lcs tune` found, without the date.
std::string numbers_in(const fs::path& preset) {
  const std::string text = read(preset);
  return text.substr(text.find("#pragma once"));
}

TEST_F(Killed, TuneLosesNoRowAndEndsWithTheSameNumbers) {
  run({"suite", "scenarios", "--seeds", "2", "--out", "suite", "--quiet"});
  const auto to = [](const char* folder) {
    return std::vector<std::string>{
        "tune",          "suite",  "--out",
        folder,          "--keys", "hypotheses.prior,hypotheses.coupling",
        "--evaluations", "30",     "--quiet"};
  };
  const Seconds whole = time(to("never_stopped"));
  const fs::path stopped = home_.path() / "stopped", never = home_.path() / "never_stopped";
  const std::string expected = read(never / "evaluations.csv");
  const auto expect_whole = [&] {
    time(to("stopped"));
    EXPECT_EQ(read(stopped / "evaluations.csv"), expected);
    EXPECT_EQ(numbers_in(stopped / "learnt.h"), numbers_in(never / "learnt.h"));
  };
  std::string before;
  int torn = 0, grown = 0;
  for (int i = 0; i < kills(); ++i) {
    run_and_kill(to("stopped"), whole);
    const bool is_there = fs::exists(stopped / "evaluations.csv");
    const std::string after = is_there ? read(stopped / "evaluations.csv") : "";
    EXPECT_TRUE(after.starts_with(before)) << "a row was lost";
    grown += after.size() > before.size();
    torn += !after.empty() && !after.ends_with('\n');
    before = after;
    if (after != expected && i % 4 != 3) continue;
    expect_whole();
    fs::remove_all(stopped);
    before.clear();
  }
  expect_whole();
  RecordProperty("kills_that_found_a_longer_journal", grown);
  RecordProperty("kills_that_left_a_torn_row", torn);
}

}  // namespace
}  // namespace lcs::test
