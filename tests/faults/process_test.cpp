// Environment of a process: descriptors, limits, signals, numbers as text.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <set>
#include <string>
#include <thread>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/processes.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/recording_io.h"

namespace lcs::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Arguments = std::vector<std::string>;

const std::string kCrossing = LCS_SCENARIOS_DIR "/crossing.yaml";

class Process : public testing::Test {
 protected:
  Process() { fs::create_directory(folder_.path() / "home"); }
  CommandOptions options() const { return {.folder = home()}; }
  fs::path home() const { return folder_.path() / "home"; }

  static Arguments brief(Arguments arguments, const Arguments& more = {}) {
    arguments.insert(arguments.end(), {"--set", "frames=4", "--set", "camera.size=[320,240]"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  static Arguments run(const Arguments& more = {}) { return brief({"run", kCrossing}, more); }

 private:
  const TemporaryFolder folder_;
};

// ---- Descriptors

class ClosedDescriptors : public Process, public testing::WithParamInterface<std::vector<int>> {};
INSTANTIATE_TEST_SUITE_P(Sets, ClosedDescriptors,
                         testing::Values(std::vector{0}, std::vector{1}, std::vector{2},
                                         std::vector{1, 2}, std::vector{0, 1, 2}));

TEST_P(ClosedDescriptors, LeaveTheSameFilesAsOpenOnes) {
  ASSERT_EQ(run_lcs(run({"--out", "open"}), options()).exit_code, 0);
  CommandOptions closed = options();
  closed.closed = GetParam();
  EXPECT_EQ(run_lcs(run({"--out", "closed"}), closed).exit_code, 0);
  for (const char* file : {recording::kLayersFile, recording::kTruthFile}) {
    EXPECT_EQ(read(home() / "closed" / file), read(home() / "open" / file)) << file;
  }
}

TEST_P(ClosedDescriptors, StopNoCommand) {
  CommandOptions closed = options();
  closed.closed = GetParam();
  const Arguments suite = brief({"suite", kCrossing, "--seeds", "1"});
  const Arguments generate = brief({"generate", kCrossing, "--formats", "tum"});
  for (const Arguments& arguments : {suite, generate, {"compare", "out/suite", "out/suite"}}) {
    EXPECT_EQ(run_lcs(arguments, closed).exit_code, 0) << arguments.front();
  }
}

TEST_F(Process, FullStandardOutputIsAnErrorInEveryCommand) {
  ASSERT_EQ(run_lcs(run({"--out", "run", "--quiet"}), options()).exit_code, 0);
  ASSERT_EQ(run_lcs(brief({"suite", kCrossing, "--seeds", "1", "--quiet"}), options()).exit_code,
            0);
  CommandOptions full = options();
  full.out = "/dev/full";
  for (const Arguments& arguments :
       {Arguments{"--help"}, Arguments{"--version"}, Arguments{"run", "--help"},
        Arguments{"score", "run"}, Arguments{"compare", "out/suite", "out/suite"},
        Arguments{"suite", "--list"}, run(), brief({"generate", kCrossing, "--formats", "tum"})}) {
    const CommandResult result = run_lcs(arguments, full);
    EXPECT_EQ(result.exit_code, 2) << arguments.front();
    EXPECT_NE(result.err.find("standard output: No space left on device"), std::string::npos)
        << arguments.front() << ": " << result.err;
  }
}

// ---- Limits

TEST_F(Process, ALimitOfOpenFilesIsToldAsSuchAndLeavesNothing) {
  int refused = 0;
  for (std::size_t files = 4; files < 8; ++files) {
    CommandOptions few = options();
    few.open_files = files;
    const CommandResult result = run_lcs(run({"--quiet"}), few);
    if (result.exit_code == 0) continue;
    ++refused;
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("limit of open files"), std::string::npos) << result.err;
    EXPECT_TRUE(entries(home()).empty()) << "with " << files;
  }
  EXPECT_GT(refused, 0) << "the limit was never reached";
}

TEST_F(Process, ALimitOfAFilesSizeIsToldAsSuchAndLeavesNothing) {
  CommandOptions small = options();
  small.largest_file = 20'000;
  const CommandResult result = run_lcs(run({"--quiet"}), small);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("limit of a file's size"), std::string::npos) << result.err;
  EXPECT_TRUE(entries(home()).empty());
}

// ---- Signals

TEST_F(Process, ALimitOfMemoryIsToldAsSuchAndLeavesNothing) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer itself takes terabytes";
#endif
  CommandOptions little = options();
  little.most_memory = std::size_t{600} << 20;  // the libraries alone are 400 MB
  const CommandResult result = run_lcs(run(), little);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_NE(result.err.find("memory"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("ulimit -v"), std::string::npos) << result.err;
  EXPECT_TRUE(entries(home()).empty());
}

TEST_F(Process, ALimitOfMemoryThatIsEnoughStopsNoCommand) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer itself takes terabytes";
#endif
  CommandOptions enough = options();
  enough.most_memory = std::size_t{8} << 30;
  const Arguments generate = brief({"generate", kCrossing, "--formats", "tum", "--quiet"});
  const Arguments preview = brief({"preview", kCrossing, "--quiet"});
  for (const Arguments& arguments : {run({"--quiet"}), generate, preview, {"--version"}}) {
    const CommandResult result = run_lcs(arguments, enough);
    EXPECT_EQ(result.exit_code, 0) << arguments.front() << ": " << result.err;
  }
}

/// Whether a process handles a signal itself. It does not until `main`, while the loader runs,
/// which may take long.
bool catches(pid_t process, int signal) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("SigCgt:")) continue;
    return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
  }
  return false;
}

TEST_F(Process, ASignalInItsFirstMomentsLeavesNothing) {
  const Arguments arguments{"run", kCrossing, "--quiet"};
  int ended_by_itself = 0;
  for (const auto after : {0ms, 20ms, 50ms, 100ms, 200ms, 400ms, 800ms}) {
    for (const int signal : {SIGTERM, SIGHUP, SIGINT}) {
      Command command(arguments, options());
      std::this_thread::sleep_for(after);
      const bool is_caught = catches(command.pid(), signal);
      command.send(signal);
      const int exit_code = command.wait().exit_code;
      EXPECT_TRUE(exit_code == 130 || (!is_caught && exit_code == 128 + signal)) << exit_code;
      ended_by_itself += exit_code == 130;
      EXPECT_TRUE(entries(home()).empty()) << "signal " << signal;
    }
  }
  EXPECT_GT(ended_by_itself, 0);
}

/// A full pipe without a reader.
class FullPipe {
 public:
  explicit FullPipe(const fs::path& path) {
    EXPECT_EQ(::mkfifo(path.c_str(), 0600), 0);
    reads_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    writes_ = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    const std::string block(4096, 'x');
    while (::write(writes_, block.data(), block.size()) > 0) {
    }
  }
  ~FullPipe() {
    ::close(reads_);
    ::close(writes_);
  }
  FullPipe(const FullPipe&) = delete;
  FullPipe& operator=(const FullPipe&) = delete;

 private:
  int reads_ = -1, writes_ = -1;
};

/// Whether the process sleeps in the kernel for a second.
bool is_asleep(pid_t process) {
  for (int i = 0; i < 10; ++i) {
    if (state_of(std::to_string(process)).state != 'S') return false;
    std::this_thread::sleep_for(100ms);
  }
  return true;
}

TEST_F(Process, ASignalEndsTheWaitForAPipeThatNobodyReads) {
  ASSERT_EQ(run_lcs(run({"--out", "run", "--quiet"}), options()).exit_code, 0);
  const FullPipe pipe(home() / "pipe");
  CommandOptions full = options();
  full.out = home() / "pipe";
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    Command command({"score", "run"}, full);
    for (int i = 0; i < 5000 && !is_asleep(command.pid()); ++i) std::this_thread::sleep_for(10ms);
    ASSERT_TRUE(command.is_running());
    command.send(signal);
    const CommandResult result = command.wait();
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_EQ(result.err, "lcs: interrupted before all was told\n");
  }
}

TEST_F(Process, ASignalEndsAnyWaitAtLast) {
  const FullPipe pipe(home() / "pipe");
  CommandOptions full = options();
  full.out = home() / "pipe";
  Command command({"--help"}, full);  // written by the library that parses the command line
  for (int i = 0; i < 5000 && !is_asleep(command.pid()); ++i) std::this_thread::sleep_for(10ms);
  ASSERT_TRUE(command.is_running());
  command.send(SIGTERM);
  std::this_thread::sleep_for(5s);
  EXPECT_TRUE(command.is_running()) << "what tidies up has time for it";
  const CommandResult result = command.wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.err, "lcs: interrupted\n");
}

// ---- Numbers

TEST_F(Process, NumbersOfOptionsAreReadLikeThoseOfScenarios) {
  for (const char* number : {"-1", "99999999999999999999", "010", "1.5", "0x10", " 3", "1e3"}) {
    for (const Arguments& command : {Arguments{"run", kCrossing, "--seed", number},
                                     Arguments{"generate", kCrossing, "--seed", number},
                                     Arguments{"generate", kCrossing, "--frames", number},
                                     Arguments{"generate", kCrossing, "--jobs", number},
                                     Arguments{"suite", "--list", "--seeds", number},
                                     Arguments{"suite", "--list", "--jobs", number},
                                     Arguments{"replay", ".", "--fast-threshold", number}}) {
      const CommandResult result = run_lcs(command, options());
      const std::string& option = command[command.size() - 2];
      EXPECT_EQ(result.exit_code, 2) << option << " '" << number << "'";
      EXPECT_NE(result.err.find(option + ": "), std::string::npos) << result.err;
      EXPECT_NE(result.err.find("give a whole number from"), std::string::npos) << result.err;
    }
  }
  for (const auto& [option, number] : {std::pair{"--fps", "0"},
                                       {"--fps", "nan"},
                                       {"--focal", "-1"},
                                       {"--focal", "1e999"},
                                       {"--speed", "1 kg"},
                                       {"--centre", "1,two"},
                                       {"--mount", "1,2,inf"}}) {
    const CommandResult result = run_lcs({"replay", ".", option, number}, options());
    EXPECT_EQ(result.exit_code, 2) << option << " '" << number << "'";
    EXPECT_NE(result.err.find(std::string(option) + ": "), std::string::npos) << result.err;
  }
  EXPECT_TRUE(entries(home()).empty());
}

}  // namespace
}  // namespace lcs::test
