#include "tools/files/output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <random>
#include <set>
#include <thread>

#include "scenarios/input/inputs_read.h"
#include "scenarios/input/sha256.h"
#include "tests/tools/files.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/files/written.h"

namespace lcs::files {
namespace {

namespace fs = std::filesystem;

const ResultNames kFiles{"metrics.json", "video.mp4"};

class OutputTest : public testing::Test {
 protected:
  /// A finished result.
  static void make_result(const fs::path& target, const std::string& text) {
    Output folder(target, kFiles);
    test::write(folder.staging() / "metrics.json", "by lcs: " + text);
    folder.commit();
  }
  static std::string refusal(const fs::path& target) {
    return test::refusal_of<OutputError>([&] { Output(target, kFiles); });
  }
  static std::string file_refusal(const fs::path& target, Overwrite overwrite = Overwrite::own) {
    return test::refusal_of<OutputError>([&] { Output(target, overwrite); });
  }
  test::TemporaryFolder temporary_;
  fs::path top_ = fs::canonical(temporary_.path());
};

TEST_F(OutputTest, ResultsAppearAtTheTargetOnCommitAndNotBefore) {
  Output folder(top_ / "run", kFiles);
  test::write(folder.staging() / "metrics.json", "{}");
  EXPECT_FALSE(fs::exists(top_ / "run"));
  folder.commit();
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), "{}");
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputTest, NothingIsLeftWhenItIsNotCommitted) {
  try {
    const Output folder(top_ / "out" / "deep" / "run", kFiles);
    test::write(folder.staging() / "metrics.json", "{}");
    throw std::runtime_error("the run failed");
  } catch (const std::runtime_error&) {
  }
  EXPECT_TRUE(test::entries(top_).empty()) << "the folders made above the target are gone too";
}

/// Between the making of a staging folder and its lock it looks like that of a killed process.
TEST_F(OutputTest, ACompressedTextIsReadByOtherPrograms) {
  TextFile text(top_ / "text", true);
  std::string all;
  for (int i = 0; i < 300'000; ++i) {  // more than one member
    all += fmt::format("{}\n", i);
    text.write(fmt::format("{}\n", i));
  }
  text.close();
  test::write(top_ / "plain", all);
  const std::string shell = "cd " + top_.string() + " && ";
  EXPECT_EQ(std::system((shell + "zcat text.gz | cmp - plain").c_str()), 0);
  EXPECT_EQ(std::system((shell + "python3 -c 'import gzip; assert gzip.open(\"text.gz\").read() == "
                                 "open(\"plain\", \"rb\").read()'")
                            .c_str()),
            0);
  EXPECT_LT(fs::file_size(top_ / "text.gz"), all.size() / 2);
}

TEST_F(OutputTest, AnUnfinishedResultIsKeptOnRequestAndTheNextGoesOnThere) {
  const auto begin = [&] {
    return std::make_unique<Output>(top_ / "run", kFiles, Unfinished::kept);
  };
  begin();
  EXPECT_EQ(test::entries(top_), std::set<std::string>{}) << "nothing was kept";
  auto first = begin();
  test::write(first->staging() / "metrics.json", "{}");
  first->keep();
  first.reset();
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"run.unfinished"});

  begin();
  auto next = begin();
  EXPECT_EQ(test::read(next->staging() / "metrics.json"), "{}")
      << "also after one that did nothing";
  const std::string busy = test::refusal_of<OutputError>([&] { begin(); });
  EXPECT_NE(busy.find("would go into each other"), std::string::npos) << busy;
  next->commit();
  next.reset();
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"run"});

  first = begin();
  test::write(first->staging() / "metrics.json", "[]");
  first->keep();
  first.reset();
  next = begin();
  next->empty();
  EXPECT_TRUE(fs::is_empty(next->staging()));
  next.reset();
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputTest, AnUnfinishedResultStaysAsItIsWhenTheNextCannotBegin) {
  {
    Output first(top_ / "run", kFiles, Unfinished::kept);
    test::write(first.staging() / "metrics.json", "{}");
    first.keep();
  }
  const auto kept = test::bytes_in(top_ / "run.unfinished");
  {
    const FolderLock of_another(top_ / "run.unfinished");
    ASSERT_TRUE(of_another.is_held());
    const std::string busy =
        test::refusal_of<OutputError>([&] { Output(top_ / "run", kFiles, Unfinished::kept); });
    EXPECT_NE(busy.find("another process writes it"), std::string::npos) << busy;
    EXPECT_EQ(test::bytes_in(top_ / "run.unfinished"), kept);
    const auto interrupted = [] { throw std::runtime_error("interrupted"); };
    EXPECT_EQ(test::refusal_of<std::runtime_error>(
                  [&] { Output(top_ / "run", kFiles, Unfinished::kept, interrupted); }),
              "interrupted");
    EXPECT_EQ(test::bytes_in(top_ / "run.unfinished"), kept);
  }
  // Something fails once the folder is known as ours: "in" cannot be a folder.
  fs::rename(top_ / "run.unfinished" / "in", top_ / "aside");
  test::write(top_ / "run.unfinished" / "in", "no folder");
  EXPECT_NE(test::refusal_of<OutputError>([&] {
              Output(top_ / "run", kFiles, Unfinished::kept);
            }).find("cannot create"),
            std::string::npos);
  EXPECT_EQ(test::read(top_ / "run.unfinished" / "in"), "no folder");
  fs::remove(top_ / "run.unfinished" / "in");
  fs::rename(top_ / "aside", top_ / "run.unfinished" / "in");
  EXPECT_EQ(test::bytes_in(top_ / "run.unfinished"), kept);
}

TEST_F(OutputTest, TheMarkerOfAnUnfinishedResultIsNotWrittenAgain) {
  {
    Output first(top_ / "run", kFiles, Unfinished::kept);
    test::write(first.staging() / "metrics.json", "{}");
    first.keep();
  }
  const fs::path marker = top_ / "run.unfinished" / ".lcs-partial";
  const auto before = fs::last_write_time(marker) - std::chrono::hours(1);
  fs::last_write_time(marker, before);
  { const Output next(top_ / "run", kFiles, Unfinished::kept); }
  EXPECT_EQ(fs::last_write_time(marker), before);
}

TEST_F(OutputTest, AFolderInThePlaceOfTheUnfinishedResultIsRefusedAndUntouched) {
  test::write(top_ / "run.unfinished" / "notes.txt", "mine");
  const std::string refused =
      test::refusal_of<OutputError>([&] { Output(top_ / "run", kFiles, Unfinished::kept); });
  EXPECT_NE(refused.find("is in the way"), std::string::npos) << refused;
  EXPECT_EQ(test::read(top_ / "run.unfinished" / "notes.txt"), "mine");
}

TEST_F(OutputTest, BeginsWhileAnotherProcessTidiesUp) {
  const fs::path target = top_ / "out";
  std::atomic<bool> stops = false;
  std::thread other([&] {
    while (!stops) remove_abandoned(target, kFiles, true);
  });
  for (int i = 0; i < 1000; ++i) {
    EXPECT_NO_THROW(test::write(Output(target, kFiles).staging() / "metrics.json", "begun")) << i;
  }
  stops = true;
  other.join();
}

TEST_F(OutputTest, FoldersAboveTheTargetThatWereThereStay) {
  fs::create_directory(top_ / "out");
  { const Output folder(top_ / "out" / "deep" / "run", kFiles); }
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"out"});
  EXPECT_TRUE(test::entries(top_ / "out").empty());
}

TEST_F(OutputTest, AnEarlierResultIsReplacedAsAWhole) {
  {
    Output folder(top_ / "run", kFiles);
    test::write(folder.staging() / "metrics.json", "by lcs: old");
    test::write(folder.staging() / "video.mp4", "old");
    folder.commit();
  }
  make_result(top_ / "run", "new");
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), "by lcs: new");
  EXPECT_EQ(test::entries(top_ / "run"), std::set<std::string>{"metrics.json"})
      << "no old video is left";
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputTest, AnEarlierResultStaysWhenTheNextOneFails) {
  make_result(top_ / "run", "old");
  {
    const Output folder(top_ / "run", kFiles);
    test::write(folder.staging() / "metrics.json", "new");
  }
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), "by lcs: old");
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"run"});
}

// ---- Remains of killed processes

/// A process that is killed while it writes to a target, so that all its files remain.
class Abandoned : public OutputTest {
 protected:
  static fs::path abandon(const fs::path& target, const ResultNames& files,
                          const std::function<void(Output&)>& write_some) {
    const pid_t process = ::fork();
    if (process == 0) {
      Output folder(target, files);
      write_some(folder);
      ::_exit(0);
    }
    ::waitpid(process, nullptr, 0);
    return target.string() + ".partial-" + std::to_string(process);
  }
  static void write_metrics(const Output& folder) {
    test::write(folder.staging() / "metrics.json", "half");
  }
};

TEST_F(Abandoned, IsTakenAway) {
  const fs::path left = abandon(top_ / "run", kFiles, write_metrics);
  ASSERT_EQ(test::entries(top_), std::set<std::string>{left.filename()});
  make_result(top_ / "run", "new");
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"run"});
}

TEST_F(Abandoned, IsLeftAloneWhileItsProcessLivesOrByOthers) {
  const fs::path left = abandon(top_ / "run", kFiles, write_metrics);
  make_result(top_ / "walk", "new");
  {
    const FolderLock living(left);
    ASSERT_TRUE(living.is_held());
    make_result(top_ / "run", "new");
  }
  EXPECT_EQ(test::entries(top_), (std::set<std::string>{"run", "walk", left.filename()}));
}

TEST_F(Abandoned, FoldersOfTheUserThatAreCalledLikeItAreNeverTouched) {
  std::set<std::string> mine;
  for (const char* name : {"run.partial-notes", "run.partial-1", "run.partial-2", "run.old-3"}) {
    fs::create_directories(top_ / name / "in");
    test::write(top_ / name / "in" / "metrics.json", "precious");
    mine.insert(name);
  }
  // a copy of a real one, under another name
  const fs::path left = abandon(top_ / "run", kFiles, write_metrics);
  fs::copy(left, top_ / "run.partial-copy", fs::copy_options::recursive);
  mine.insert({"run.partial-copy", "run"});
  make_result(top_ / "run", "new");
  EXPECT_EQ(test::entries(top_), mine);
  for (const char* name : {"run.partial-notes", "run.partial-1", "run.partial-2", "run.old-3"}) {
    EXPECT_EQ(test::read(top_ / name / "in" / "metrics.json"), "precious");
  }
}

TEST_F(Abandoned, FilesOfTheUserInItStay) {
  const fs::path left = abandon(top_ / "run", kFiles, write_metrics);
  test::write(left / "in" / "thesis.tex", "precious");
  test::write(left / "notes.txt", "precious");
  fs::create_symlink(left / "notes.txt", left / "in" / "video.mp4");
  make_result(top_ / "run", "new");
  EXPECT_EQ(test::entries(top_), (std::set<std::string>{"run", left.filename()}));
  EXPECT_EQ(test::entries(left), (std::set<std::string>{"in", "notes.txt"}));
  EXPECT_EQ(test::entries(left / "in"), (std::set<std::string>{"thesis.tex", "video.mp4"}));
}

TEST_F(Abandoned, SuitesGoWithTheRunsThatWereUnderWayInThem) {
  const ResultNames suite{"suite.json", "runs/*/seed-*/metrics.json"};
  abandon(top_ / "suite", suite, [](Output& folder) {
    const fs::path run = folder.staging() / "runs" / "near" / "seed-1";
    fs::create_directories(run.parent_path());
    abandon(run, kFiles, write_metrics);
  });
  {
    Output folder(top_ / "suite", suite);
    test::write(folder.staging() / "suite.json", "by lcs: new");
    folder.commit();
  }
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"suite"});
}

TEST_F(Abandoned, AnEarlierResultOnItsWayOutIsPutBack) {
  const fs::path left = abandon(top_ / "run", kFiles, write_metrics);
  fs::create_directory(left / "out");  // as if two folders could not be exchanged atomically
  test::write(left / "out" / "metrics.json", "by lcs: old");
  write_record_of_folder(left / "out");
  { const Output folder(top_ / "run", kFiles); }
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"run"});
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), "by lcs: old");
}

// ---- Targets that are not replaced

TEST_F(OutputTest, AFolderOfTheSameNamesByAnotherProgramIsRefused) {
  const std::string mine = R"({"detector": "mine", "rebel.f1": 0.9})";
  fs::create_directory(top_ / "run");
  test::write(top_ / "run" / "metrics.json", mine);
  EXPECT_NE(refusal(top_ / "run").find("metrics.json is not a file that lcs has written"),
            std::string::npos);
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), mine);
  // A record of other bytes does not help either.
  test::write(top_ / "run" / ".lcs-written", std::string(64, '0') + "  metrics.json\n");
  EXPECT_NE(refusal(top_ / "run").find("metrics.json was changed"), std::string::npos);
  test::write(top_ / "run" / ".lcs-written", "by lcs\n");
  EXPECT_NE(refusal(top_ / "run").find("metrics.json is not a file"), std::string::npos);
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), mine);
}

TEST_F(OutputTest, AResultThatWasEditedIsRefusedAndUntouched) {
  make_result(top_ / "run", "old");
  test::write(top_ / "run" / "metrics.json", "by lcs: my notes");
  EXPECT_NE(refusal(top_ / "run").find("metrics.json was changed since lcs wrote it"),
            std::string::npos);
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), "by lcs: my notes");
}

TEST_F(OutputTest, AResultWithoutSomeOfItsFilesOrCopiedElsewhereIsReplaced) {
  {
    Output folder(top_ / "run", kFiles);
    test::write(folder.staging() / "metrics.json", "old");
    test::write(folder.staging() / "video.mp4", "old");
    folder.commit();
  }
  fs::remove(top_ / "run" / "video.mp4");
  fs::copy(top_ / "run", top_ / "copy", fs::copy_options::recursive);
  make_result(top_ / "run", "new");
  make_result(top_ / "copy", "new");
  EXPECT_EQ(test::bytes_in(top_ / "run"), test::bytes_in(top_ / "copy"));
}

TEST_F(OutputTest, TheFolderThatOneIsInIsNotReplaced) {
  make_result(top_ / "run", "old");
  const fs::path before = fs::current_path();
  fs::current_path(top_ / "run");
  const std::string refused = refusal(".");
  fs::current_path(before);
  EXPECT_NE(refused.find("the folder that this runs in"), std::string::npos) << refused;
}

TEST_F(OutputTest, AnEmptyFolderIsTaken) {
  fs::create_directory(top_ / "run");
  make_result(top_ / "run", "new");
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), "by lcs: new");
}

TEST_F(OutputTest, AFolderThatHoldsSomethingElseIsRefusedAndUntouched) {
  make_result(top_ / "run", "old");
  test::write(top_ / "run" / "thesis.tex", "precious");
  EXPECT_NE(refusal(top_ / "run").find("thesis.tex"), std::string::npos);
  EXPECT_EQ(test::read(top_ / "run" / "thesis.tex"), "precious");
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), "by lcs: old");
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputTest, FilesOfAnotherKindOfResultAreForeign) {
  make_result(top_ / "run", "old");
  const ResultNames others{"answer.md"};
  EXPECT_NE(
      test::refusal_of<OutputError>([&] { Output(top_ / "run", others); }).find("would be lost"),
      std::string::npos);
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), "by lcs: old");
}

/// How the test's file system exchanges folders.
enum class Exchange { works, is_unknown, comes_late };
Exchange exchange = Exchange::works;
fs::path late;  ///< a file written by another process meanwhile

}  // namespace
}  // namespace lcs::files

/// Replaces the C library's function.
extern "C" int renameat2(int, const char* from, int, const char* to, unsigned flags) {
  using namespace lcs::files;
  if (exchange == Exchange::comes_late) std::ofstream(late) << "precious";
  if (exchange == Exchange::is_unknown) {
    errno = EINVAL;
    return -1;
  }
  exchange = Exchange::works;
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, flags));
}

namespace lcs::files {
namespace {

TEST_F(OutputTest, IsReplacedWhereFoldersCannotBeExchanged) {
  make_result(top_ / "run", "old");
  exchange = Exchange::is_unknown;
  make_result(top_ / "run", "new");
  exchange = Exchange::works;
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), "by lcs: new");
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputTest, FileAddedInTheLastMomentIsNotLost) {
  make_result(top_ / "run", "old");
  late = top_ / "run" / "thesis.tex";
  exchange = Exchange::comes_late;
  EXPECT_THROW(make_result(top_ / "run", "new"), OutputError);
  EXPECT_EQ(exchange, Exchange::works) << "it did come";
  EXPECT_EQ(test::read(late), "precious");
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), "by lcs: old");
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputTest, FolderMadeForeignDuringTheRunIsNotReplaced) {
  Output folder(top_ / "run", kFiles);
  test::write(folder.staging() / "metrics.json", "new");
  fs::create_directory(top_ / "run");
  test::write(top_ / "run" / "thesis.tex", "precious");
  EXPECT_THROW(folder.commit(), OutputError);
  EXPECT_EQ(test::read(top_ / "run" / "thesis.tex"), "precious");
}

class NestedOutput : public OutputTest {
 protected:
  const ResultNames kNested{"suite.json", "runs/*/seed-*/metrics.json"};
  NestedOutput() {
    Output folder(target_, kNested);
    test::write(folder.staging() / "suite.json", "by lcs: old");
    fs::create_directories(folder.staging() / "runs" / "near" / "seed-1");
    test::write(folder.staging() / "runs" / "near" / "seed-1" / "metrics.json", "old");
    folder.commit();
  }
  std::string refusal() const {
    return test::refusal_of<OutputError>([&] { Output(target_, kNested); });
  }
  const fs::path target_ = top_ / "suite";
};

TEST_F(NestedOutput, IsReplacedAsAWhole) {
  {
    Output folder(target_, kNested);
    test::write(folder.staging() / "suite.json", "by lcs: new");
    folder.commit();
  }
  EXPECT_EQ(test::read(target_ / "suite.json"), "by lcs: new");
  EXPECT_EQ(test::entries(target_), std::set<std::string>{"suite.json"});
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"suite"});
}

TEST_F(NestedOutput, IsRefusedWhateverForeignLiesHoweverDeep) {
  for (const fs::path foreign :
       {"runs/thesis.tex", "runs/near/thesis.tex", "runs/near/seed-1/thesis.tex",
        "runs/near/seed-1/thesis/metrics.json", "runs/near/notes/metrics.json", "metrics.json",
        "runs/metrics.json", "suite.json/thesis.tex"}) {
    const bool replaces_file = foreign.parent_path() == "suite.json";
    if (replaces_file) fs::remove(target_ / "suite.json");
    fs::create_directories((target_ / foreign).parent_path());
    test::write(target_ / foreign, "precious");
    const std::string refused = refusal();
    EXPECT_NE(refused.find("would be lost"), std::string::npos) << foreign;
    EXPECT_EQ(test::read(target_ / foreign), "precious");
    fs::remove(target_ / foreign);
    for (const char* folder : {"runs/near/seed-1/thesis", "runs/near/notes"}) {
      fs::remove(target_ / folder);
    }
  }
}

TEST_F(NestedOutput, ALinkInsideItIsForeignAndNotFollowed) {
  fs::create_directory(top_ / "papers");
  test::write(top_ / "papers" / "metrics.json", "precious");
  fs::create_directory_symlink(top_ / "papers", target_ / "runs" / "near" / "seed-2");
  EXPECT_NE(refusal().find("runs/near/seed-2"), std::string::npos) << refusal();
  EXPECT_EQ(test::read(top_ / "papers" / "metrics.json"), "precious");
}

TEST_F(OutputTest, ATargetThatCannotBeIsRefusedWithTheReason) {
  test::write(top_ / "file", "");
  EXPECT_NE(refusal(top_ / "file").find("is not a folder"), std::string::npos);
  EXPECT_NE(refusal(top_ / "file" / "run").find("Not a directory"), std::string::npos);
  EXPECT_NE(refusal("/proc/run").find("/proc/run"), std::string::npos);
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"file"});
}

TEST_F(OutputTest, ATrailingSlashAndDotsMeanTheSameFolder) {
  make_result(top_ / "out" / ".." / "run" / "", "new");
  EXPECT_EQ(test::read(top_ / "run" / "metrics.json"), "by lcs: new");
}

TEST_F(OutputTest, ALinkIsRefusedWhateverItLeadsTo) {
  make_result(top_ / "run", "old");
  const auto before = test::bytes_in(top_);
  fs::create_directory_symlink(top_ / "run", top_ / "latest");
  fs::create_directory_symlink(top_ / "nowhere", top_ / "dangling");
  for (const char* name : {"latest", "dangling", "latest/"}) {
    EXPECT_NE(refusal(top_ / name).find("is a link"), std::string::npos) << name;
  }
  EXPECT_EQ(test::bytes_in(top_), before);
  EXPECT_FALSE(fs::exists(top_ / "nowhere"));
}

TEST_F(OutputTest, AFolderAboveTheTargetMayBeALink) {
  fs::create_directory(top_ / "disk");
  fs::create_directory_symlink(top_ / "disk", top_ / "out");
  make_result(top_ / "out" / "run", "new");
  EXPECT_EQ(test::read(top_ / "disk" / "run" / "metrics.json"), "by lcs: new");
}

// ---- Inputs

TEST_F(OutputTest, AnInputIsNoOutputNorIsWhatLiesInsideOrRoundIt) {
  make_result(top_ / "recording", "old");
  test::write(top_ / "drive" / "poses.txt", "0 0 0");
  const auto before = test::bytes_in(top_);
  input::note_input(top_ / "recording");
  input::note_input(top_ / "drive" / "poses.txt");
  for (const char* target : {"recording", "recording/deep/run", "drive", ".", "drive/poses.txt"}) {
    EXPECT_NE(refusal(top_ / target).find("which is read"), std::string::npos)
        << target << ": " << refusal(top_ / target);
    EXPECT_NE(file_refusal(top_ / target, Overwrite::any_file).find("which is read"),
              std::string::npos)
        << target << ": --force does not help";
  }
  EXPECT_EQ(test::bytes_in(top_), before);
  make_result(top_ / "drive" / "run", "new");  // a file is an input, but not its folder
}

// ---- Single files

class OutputOfAFile : public OutputTest {
 protected:
  static void make_file(const fs::path& target, const std::string& text,
                        Overwrite overwrite = Overwrite::own) {
    Output file(target, overwrite);
    test::write(file.staging(), text);
    file.commit();
  }
};

TEST_F(OutputOfAFile, AppearsWithItsRecordAndIsReplacedWhileNobodyChangesIt) {
  make_file(top_ / "deep" / "figures.json", "old");
  EXPECT_EQ(test::entries(top_ / "deep"), std::set<std::string>{"figures.json"});
  EXPECT_EQ(test::read(top_ / "deep" / ".figures.json.lcs-written"),
            input::sha256("old") + "  figures.json\n");
  make_file(top_ / "deep" / "figures.json", "new");
  EXPECT_EQ(test::read(top_ / "deep" / "figures.json"), "new");
  test::write(top_ / "deep" / "figures.json", "new, and edited");
  EXPECT_NE(file_refusal(top_ / "deep" / "figures.json").find("was changed since"),
            std::string::npos);
  EXPECT_EQ(test::read(top_ / "deep" / "figures.json"), "new, and edited");
  EXPECT_EQ(test::bytes_in(top_ / "deep").size(), 2u);
}

TEST_F(OutputOfAFile, ItsRecordIsReadBySha256sum) {
  for (const char* name : {"figures.json", "two words", "back\\slash", "line\nend"}) {
    make_file(top_ / name, "text");
    const std::string record = (top_ / fmt::format(".{}.lcs-written", name)).string();
    EXPECT_EQ(std::system(fmt::format("cd '{}' && sha256sum --strict --status -c '{}'",
                                      top_.string(), record)
                              .c_str()),
              0)
        << name;
    make_file(top_ / name, "again");
    EXPECT_EQ(test::read(top_ / name), "again");
  }
}

TEST_F(OutputOfAFile, ByAnotherProgramIsReplacedByForceAlone) {
  test::write(top_ / "mine.csv", "frame,type\n0,rebel,1\n");
  EXPECT_NE(file_refusal(top_ / "mine.csv").find("is not a file that lcs has written"),
            std::string::npos);
  EXPECT_EQ(file_refusal(top_ / "mine.csv").find("--force"), std::string::npos);
  EXPECT_NE(file_refusal(top_ / "mine.csv", Overwrite::own_or_forced).find("--force"),
            std::string::npos);
  EXPECT_EQ(test::read(top_ / "mine.csv"), "frame,type\n0,rebel,1\n");
  make_file(top_ / "mine.csv", "by force", Overwrite::any_file);
  EXPECT_EQ(test::read(top_ / "mine.csv"), "by force");
  make_file(top_ / "mine.csv", "its own now");
}

TEST_F(OutputOfAFile, ForceReplacesNoLinkNoFolderAndNoRecordOfAnother) {
  test::write(top_ / "mine.csv", "precious");
  fs::create_symlink("mine.csv", top_ / "link");
  fs::create_symlink("nowhere", top_ / "dangling");
  fs::create_directory(top_ / "folder");
  test::write(top_ / ".x.lcs-written", "precious");
  const auto before = test::bytes_in(top_);
  for (const char* name : {"link", "dangling", "folder", "x"}) {
    EXPECT_NE(file_refusal(top_ / name, Overwrite::any_file), "nothing was refused") << name;
  }
  EXPECT_EQ(test::bytes_in(top_), before);
  EXPECT_FALSE(fs::exists(top_ / "nowhere"));
}

TEST_F(OutputOfAFile, AnEmptyFileIsTaken) {
  test::write(top_ / "empty", "");
  make_file(top_ / "empty", "new");
  EXPECT_EQ(test::read(top_ / "empty"), "new");
}

TEST_F(OutputOfAFile, ToADeviceOrAPipeThatIsReadIsWrittenDirectly) {
  make_file("/dev/null", "new");
  ASSERT_EQ(::mkfifo((top_ / "pipe").c_str(), 0600), 0);
  EXPECT_NE(file_refusal(top_ / "pipe").find("nobody reads"), std::string::npos);
  const int reader = ::open((top_ / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  make_file(top_ / "pipe", "new");
  std::array<char, 16> got{};
  EXPECT_EQ(::read(reader, got.data(), got.size()), 3);
  ::close(reader);
  EXPECT_EQ(std::string(got.data()), "new");
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"pipe"});
}

TEST_F(OutputOfAFile, LeftoverOfAKilledProcessIsTakenAway) {
  const pid_t process = ::fork();
  if (process == 0) {
    const Output file(top_ / "page.html", Overwrite::own);
    test::write(file.staging(), "half");
    ::_exit(0);
  }
  ::waitpid(process, nullptr, 0);
  EXPECT_EQ(test::entries(top_).size(), 1u);
  make_file(top_ / "page.html", "new");
  EXPECT_EQ(test::entries(top_), std::set<std::string>{"page.html"});
}

TEST_F(OutputOfAFile, CommitWithoutItsRecordIsFinishedByTheNext) {
  make_file(top_ / "figures.json", "old");
  const fs::path record = top_ / ".figures.json.lcs-written";
  const std::string old = test::read(record);
  make_file(top_ / "figures.json", "new");
  // As after `kill -9` between the two renames.
  const fs::path left = top_ / "figures.json.partial-4711";
  fs::create_directories(left / "in");
  fs::create_directories(left / "out");
  test::write(
      left / ".lcs-partial",
      "lcs writes its results here, and takes this folder away: figures.json.partial-4711\n");
  fs::rename(record, left / "in" / record.filename());
  test::write(record, old);
  make_file(top_ / "figures.json", "newer");
  EXPECT_EQ(test::read(top_ / "figures.json"), "newer");
  EXPECT_FALSE(fs::exists(left));
}

TEST_F(Abandoned, AFolderThatWasJustBegunIsTakenAway) {
  for (const char* name : {"run.partial-123", "run.partial-124-1"}) {
    fs::create_directory(top_ / name);
  }
  test::write(top_ / "run.partial-125" / ".lcs-partial", "");
  test::write(top_ / "run.partial-126" / ".lcs-partial", "lcs writes its res");
  const std::set<std::string> mine{"run.partial-notes", "run.partial-127"};
  fs::create_directory(top_ / "run.partial-notes");
  test::write(top_ / "run.partial-127" / ".lcs-partial", "my own");
  make_result(top_ / "run", "new");
  std::set<std::string> expected = mine;
  expected.insert("run");
  EXPECT_EQ(test::entries(top_), expected);
}

// ---- Several outputs of one command

class Together : public OutputTest {
 protected:
  /// Two folders and a file with the same content.
  void make(const std::string& text) {
    make(text, [] {});
  }
  void make(const std::string& text, const std::function<void()>& before_commit) {
    Output one(top_ / "one", kFiles), other(top_ / "other", kFiles);
    Output page(top_ / "page.html", Overwrite::own);
    test::write(one.staging() / "metrics.json", text);
    test::write(other.staging() / "metrics.json", text);
    test::write(page.staging(), text);
    before_commit();
    commit_all(std::array{&one, &other, &page});
  }
  std::set<std::string> said() const {
    std::set<std::string> texts;
    for (const char* file : {"one/metrics.json", "other/metrics.json", "page.html"}) {
      texts.insert(fs::exists(top_ / file) ? test::read(top_ / file) : "nothing");
    }
    return texts;
  }
  void expect_no_staging() const {
    EXPECT_EQ(test::entries(top_), (std::set<std::string>{"one", "other", "page.html"}));
  }
};

TEST_F(Together, AreAllNew) {
  make("old");
  make("new");
  EXPECT_EQ(said(), std::set<std::string>{"new"});
  expect_no_staging();
}

TEST_F(Together, AreAllOldWhereAFileAppearsMeanwhile) {
  make("old");
  const fs::path mine = top_ / "other" / "thesis.tex";
  EXPECT_THROW(make("new", [&] { test::write(mine, "precious"); }), OutputError);
  EXPECT_EQ(said(), std::set<std::string>{"old"});
  EXPECT_EQ(test::read(mine), "precious");
  expect_no_staging();
}

TEST_F(Together, AreAllOldWhereAFileAppearsInTheLastMoment) {
  make("old");
  late = top_ / "other" / "thesis.tex";
  exchange = Exchange::comes_late;
  EXPECT_THROW(make("new"), OutputError);
  exchange = Exchange::works;
  EXPECT_EQ(said(), std::set<std::string>{"old"});
  EXPECT_EQ(test::read(late), "precious");
  expect_no_staging();
}

TEST_F(Together, AreAllNewOnAFileSystemThatExchangesNothing) {
  make("old");
  exchange = Exchange::is_unknown;
  make("new");
  exchange = Exchange::works;
  EXPECT_EQ(said(), std::set<std::string>{"new"});
  expect_no_staging();
}

TEST_F(Together, AreAllOldOrAllNewWhenTheProcessIsKilledAtAnyMoment) {
  make("0");
  std::mt19937 random(1);
  std::string last = "0";
  int changed = 0;
  for (int i = 1; i <= 100; ++i) {
    std::array<int, 2> ready{};
    ASSERT_EQ(::pipe(ready.data()), 0);
    const pid_t process = ::fork();
    if (process == 0) {
      make(std::to_string(i), [&] { ::close(ready[1]); });
      ::_exit(0);
    }
    ::close(ready[1]);
    char end = 0;
    EXPECT_EQ(::read(ready[0], &end, 1), 0);  // returns where the commit begins
    ::close(ready[0]);
    // Most kills hit the middle of the commit; some come after it, even on a busy machine.
    std::this_thread::sleep_for(
        std::chrono::microseconds(random() % (i % 5 == 0 ? 200'000 : 4000)));
    ::kill(process, SIGKILL);
    ::waitpid(process, nullptr, 0);
    // The second process of the commit may still be running: it holds the locks.
    const auto is_busy = [&] {
      for (const auto& entry : fs::directory_iterator(top_)) {
        if (entry.path().string().find(".partial-") == std::string::npos) continue;
        if (FolderLock(entry.path()).is_of_another()) return true;
      }
      return false;
    };
    while (is_busy()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(said().size(), 1u) << "after " << i;
    changed += *said().begin() != last;
    last = *said().begin();
  }
  EXPECT_GT(changed, 0) << "no kill came late enough";
  EXPECT_LT(changed, 100) << "no kill came early enough";
  make("end");
  expect_no_staging();
}

TEST_F(Together, DoNotGoIntoEachOther) {
  const Output one(top_ / "one", kFiles);
  for (const char* other : {"one", "one/deep/other", "one/../one", "."}) {
    EXPECT_NE(refusal(top_ / other).find("into each other"), std::string::npos) << other;
    EXPECT_NE(file_refusal(top_ / other).find("into each other"), std::string::npos) << other;
  }
}

}  // namespace
}  // namespace lcs::files
