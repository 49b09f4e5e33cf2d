#include "tools/files/output_folder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <functional>
#include <set>

#include "tests/tools/files.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::bench {
namespace {

namespace fs = std::filesystem;

const ResultFiles kFiles{{"metrics.json", "video.mp4"}, "by lcs: "};

class OutputFolderTest : public testing::Test {
 protected:
  /// A finished result.
  static void make_result(const fs::path& target, const std::string& text) {
    OutputFolder folder(target, kFiles);
    write(folder.staging() / "metrics.json", "by lcs: " + text);
    folder.commit();
  }
  static std::string refusal(const fs::path& target) {
    return refusal_of<OutputError>([&] { OutputFolder(target, kFiles); });
  }
  TemporaryFolder temporary_;
  fs::path top_ = fs::canonical(temporary_.path());
};

TEST_F(OutputFolderTest, ResultsAppearAtTheTargetOnCommitAndNotBefore) {
  OutputFolder folder(top_ / "run", kFiles);
  write(folder.staging() / "metrics.json", "{}");
  EXPECT_FALSE(fs::exists(top_ / "run"));
  folder.commit();
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "{}");
  EXPECT_EQ(entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputFolderTest, NothingIsLeftWhenItIsNotCommitted) {
  try {
    const OutputFolder folder(top_ / "out" / "deep" / "run", kFiles);
    write(folder.staging() / "metrics.json", "{}");
    throw std::runtime_error("the run failed");
  } catch (const std::runtime_error&) {
  }
  EXPECT_TRUE(entries(top_).empty()) << "the folders made above the target are gone too";
}

TEST_F(OutputFolderTest, FoldersAboveTheTargetThatWereThereStay) {
  fs::create_directory(top_ / "out");
  { const OutputFolder folder(top_ / "out" / "deep" / "run", kFiles); }
  EXPECT_EQ(entries(top_), std::set<std::string>{"out"});
  EXPECT_TRUE(entries(top_ / "out").empty());
}

TEST_F(OutputFolderTest, AnEarlierResultIsReplacedAsAWhole) {
  {
    OutputFolder folder(top_ / "run", kFiles);
    write(folder.staging() / "metrics.json", "by lcs: old");
    write(folder.staging() / "video.mp4", "old");
    folder.commit();
  }
  make_result(top_ / "run", "new");
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "by lcs: new");
  EXPECT_EQ(entries(top_ / "run"), std::set<std::string>{"metrics.json"}) << "no old video is left";
  EXPECT_EQ(entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputFolderTest, AnEarlierResultStaysWhenTheNextOneFails) {
  make_result(top_ / "run", "old");
  {
    const OutputFolder folder(top_ / "run", kFiles);
    write(folder.staging() / "metrics.json", "new");
  }
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "by lcs: old");
  EXPECT_EQ(entries(top_), std::set<std::string>{"run"});
}

// ---- What killed processes left

/// A process that is killed while it writes to a target: all that it made stays.
class Abandoned : public OutputFolderTest {
 protected:
  static fs::path abandon(const fs::path& target, const ResultFiles& files,
                          const std::function<void(OutputFolder&)>& write_some) {
    const pid_t process = ::fork();
    if (process == 0) {
      OutputFolder folder(target, files);
      write_some(folder);
      ::_exit(0);
    }
    ::waitpid(process, nullptr, 0);
    return target.string() + ".partial-" + std::to_string(process);
  }
  static void write_metrics(const OutputFolder& folder) {
    write(folder.staging() / "metrics.json", "half");
  }
};

TEST_F(Abandoned, IsTakenAway) {
  const fs::path left = abandon(top_ / "run", kFiles, write_metrics);
  ASSERT_EQ(entries(top_), std::set<std::string>{left.filename()});
  make_result(top_ / "run", "new");
  EXPECT_EQ(entries(top_), std::set<std::string>{"run"});
}

TEST_F(Abandoned, IsLeftAloneWhileItsProcessLivesOrByOthers) {
  const fs::path left = abandon(top_ / "run", kFiles, write_metrics);
  make_result(top_ / "walk", "new");
  {
    const FolderLock living(left);
    ASSERT_TRUE(living.is_held());
    make_result(top_ / "run", "new");
  }
  EXPECT_EQ(entries(top_), (std::set<std::string>{"run", "walk", left.filename()}));
}

TEST_F(Abandoned, FoldersOfTheUserThatAreCalledLikeItAreNeverTouched) {
  std::set<std::string> mine;
  for (const char* name : {"run.partial-notes", "run.partial-1", "run.partial-2", "run.old-3"}) {
    fs::create_directories(top_ / name / "in");
    write(top_ / name / "in" / "metrics.json", "precious");
    mine.insert(name);
  }
  // a copy of a real one, under another name
  const fs::path left = abandon(top_ / "run", kFiles, write_metrics);
  fs::copy(left, top_ / "run.partial-copy", fs::copy_options::recursive);
  mine.insert({"run.partial-copy", "run"});
  make_result(top_ / "run", "new");
  EXPECT_EQ(entries(top_), mine);
  for (const char* name : {"run.partial-notes", "run.partial-1", "run.partial-2", "run.old-3"}) {
    EXPECT_EQ(read(top_ / name / "in" / "metrics.json"), "precious");
  }
}

TEST_F(Abandoned, WhatTheUserPutIntoItStays) {
  const fs::path left = abandon(top_ / "run", kFiles, write_metrics);
  write(left / "in" / "thesis.tex", "precious");
  write(left / "notes.txt", "precious");
  fs::create_symlink(left / "notes.txt", left / "in" / "video.mp4");
  make_result(top_ / "run", "new");
  EXPECT_EQ(entries(top_), (std::set<std::string>{"run", left.filename()}));
  EXPECT_EQ(entries(left), (std::set<std::string>{"in", "notes.txt"}));
  EXPECT_EQ(entries(left / "in"), (std::set<std::string>{"thesis.tex", "video.mp4"}));
}

TEST_F(Abandoned, SuitesGoWithTheRunsThatWereUnderWayInThem) {
  const ResultFiles suite{{"suite.json", "runs/*/seed-*/metrics.json"}, "by lcs: "};
  abandon(top_ / "suite", suite, [](OutputFolder& folder) {
    const fs::path run = folder.staging() / "runs" / "near" / "seed-1";
    fs::create_directories(run.parent_path());
    abandon(run, kFiles, write_metrics);
    write(folder.staging() / "suite.json.77-0.partial", "half");
  });
  {
    OutputFolder folder(top_ / "suite", suite);
    write(folder.staging() / "suite.json", "by lcs: new");
    folder.commit();
  }
  EXPECT_EQ(entries(top_), std::set<std::string>{"suite"});
}

TEST_F(Abandoned, AnEarlierResultOnItsWayOutIsPutBack) {
  const fs::path left = abandon(top_ / "run", kFiles, write_metrics);
  fs::create_directory(left / "out");  // as where two folders cannot be exchanged at once
  write(left / "out" / "metrics.json", "by lcs: old");
  { const OutputFolder folder(top_ / "run", kFiles); }
  EXPECT_EQ(entries(top_), std::set<std::string>{"run"});
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "by lcs: old");
}

// ---- What is not replaced

TEST_F(OutputFolderTest, AFileOfThatNameByAnotherProgramIsNoResult) {
  fs::create_directory(top_ / "run");
  write(top_ / "run" / "metrics.json", "{\"accuracy\": 0.9}");
  EXPECT_NE(refusal(top_ / "run").find("that lcs has not written"), std::string::npos);
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "{\"accuracy\": 0.9}");
}

TEST_F(OutputFolderTest, TheFolderThatOneIsInIsNotReplaced) {
  make_result(top_ / "run", "old");
  const fs::path before = fs::current_path();
  fs::current_path(top_ / "run");
  const std::string refused = refusal(".");
  fs::current_path(before);
  EXPECT_NE(refused.find("the folder that this runs in"), std::string::npos) << refused;
}

TEST_F(OutputFolderTest, AnEmptyFolderIsTaken) {
  fs::create_directory(top_ / "run");
  make_result(top_ / "run", "new");
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "by lcs: new");
}

TEST_F(OutputFolderTest, AFolderThatHoldsSomethingElseIsRefusedAndUntouched) {
  make_result(top_ / "run", "old");
  write(top_ / "run" / "thesis.tex", "precious");
  EXPECT_NE(refusal(top_ / "run").find("thesis.tex"), std::string::npos);
  EXPECT_EQ(read(top_ / "run" / "thesis.tex"), "precious");
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "by lcs: old");
  EXPECT_EQ(entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputFolderTest, AFolderWithoutTheFirstFileIsNoResult) {
  fs::create_directory(top_ / "run");
  write(top_ / "run" / "video.mp4", "somebody's own");
  EXPECT_NE(refusal(top_ / "run").find("metrics.json"), std::string::npos);
  EXPECT_EQ(read(top_ / "run" / "video.mp4"), "somebody's own");
}

/// How folders are exchanged on the file system of the test.
enum class Exchange { works, is_unknown, comes_late };
Exchange exchange = Exchange::works;
fs::path late;  ///< what somebody writes just then

}  // namespace
}  // namespace lcs::bench

/// In place of the C library's.
extern "C" int renameat2(int, const char* from, int, const char* to, unsigned flags) {
  using namespace lcs::bench;
  if (exchange == Exchange::comes_late) std::ofstream(late) << "precious";
  if (exchange == Exchange::is_unknown) {
    errno = EINVAL;
    return -1;
  }
  exchange = Exchange::works;
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, flags));
}

namespace lcs::bench {
namespace {

TEST_F(OutputFolderTest, IsReplacedWhereFoldersCannotBeExchanged) {
  make_result(top_ / "run", "old");
  exchange = Exchange::is_unknown;
  make_result(top_ / "run", "new");
  exchange = Exchange::works;
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "by lcs: new");
  EXPECT_EQ(entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputFolderTest, WhatComesInTheLastMomentIsNotLost) {
  make_result(top_ / "run", "old");
  late = top_ / "run" / "thesis.tex";
  exchange = Exchange::comes_late;
  EXPECT_THROW(make_result(top_ / "run", "new"), OutputError);
  EXPECT_EQ(exchange, Exchange::works) << "it did come";
  EXPECT_EQ(read(late), "precious");
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "by lcs: old");
  EXPECT_EQ(entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputFolderTest, WhatBecameForeignDuringTheRunIsNotReplaced) {
  OutputFolder folder(top_ / "run", kFiles);
  write(folder.staging() / "metrics.json", "new");
  fs::create_directory(top_ / "run");
  write(top_ / "run" / "thesis.tex", "precious");
  EXPECT_THROW(folder.commit(), OutputError);
  EXPECT_EQ(read(top_ / "run" / "thesis.tex"), "precious");
}

class NestedOutputFolder : public OutputFolderTest {
 protected:
  const ResultFiles kNested{{"suite.json", "runs/*/seed-*/metrics.json"}, "by lcs: "};
  NestedOutputFolder() {
    OutputFolder folder(target_, kNested);
    write(folder.staging() / "suite.json", "by lcs: old");
    fs::create_directories(folder.staging() / "runs" / "near" / "seed-1");
    write(folder.staging() / "runs" / "near" / "seed-1" / "metrics.json", "old");
    folder.commit();
  }
  std::string refusal() const {
    return refusal_of<OutputError>([&] { OutputFolder(target_, kNested); });
  }
  const fs::path target_ = top_ / "suite";
};

TEST_F(NestedOutputFolder, IsReplacedAsAWhole) {
  {
    OutputFolder folder(target_, kNested);
    write(folder.staging() / "suite.json", "by lcs: new");
    folder.commit();
  }
  EXPECT_EQ(read(target_ / "suite.json"), "by lcs: new");
  EXPECT_EQ(entries(target_), std::set<std::string>{"suite.json"});
  EXPECT_EQ(entries(top_), std::set<std::string>{"suite"});
}

TEST_F(NestedOutputFolder, IsRefusedWhateverForeignLiesHoweverDeep) {
  for (const fs::path foreign :
       {"runs/thesis.tex", "runs/near/thesis.tex", "runs/near/seed-1/thesis.tex",
        "runs/near/seed-1/thesis/metrics.json", "runs/near/notes/metrics.json", "metrics.json",
        "runs/metrics.json", "suite.json/thesis.tex"}) {
    const bool replaces_file = foreign.parent_path() == "suite.json";
    if (replaces_file) fs::remove(target_ / "suite.json");
    fs::create_directories((target_ / foreign).parent_path());
    write(target_ / foreign, "precious");
    const std::string refused = refusal();
    EXPECT_NE(refused.find("would be lost"), std::string::npos) << foreign;
    EXPECT_EQ(read(target_ / foreign), "precious");
    fs::remove(target_ / foreign);
    for (const char* folder : {"runs/near/seed-1/thesis", "runs/near/notes"}) {
      fs::remove(target_ / folder);
    }
  }
}

TEST_F(NestedOutputFolder, ALinkInsideItIsForeignAndNotFollowed) {
  fs::create_directory(top_ / "papers");
  write(top_ / "papers" / "metrics.json", "precious");
  fs::create_directory_symlink(top_ / "papers", target_ / "runs" / "near" / "seed-2");
  EXPECT_NE(refusal().find("runs/near/seed-2"), std::string::npos) << refusal();
  EXPECT_EQ(read(top_ / "papers" / "metrics.json"), "precious");
}

TEST_F(OutputFolderTest, ATargetThatCannotBeIsRefusedWithTheReason) {
  write(top_ / "file", "");
  EXPECT_NE(refusal(top_ / "file").find("is not a folder"), std::string::npos);
  EXPECT_NE(refusal(top_ / "file" / "run").find("Not a directory"), std::string::npos);
  EXPECT_NE(refusal("/proc/run").find("/proc/run"), std::string::npos);
  EXPECT_EQ(entries(top_), std::set<std::string>{"file"});
}

TEST_F(OutputFolderTest, ATrailingSlashAndDotsMeanTheSameFolder) {
  make_result(top_ / "out" / ".." / "run" / "", "new");
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "by lcs: new");
}

TEST_F(OutputFolderTest, ALinkToAnEarlierResultIsFollowed) {
  make_result(top_ / "run", "old");
  fs::create_directory_symlink(top_ / "run", top_ / "latest");
  make_result(top_ / "latest", "new");
  EXPECT_TRUE(fs::is_symlink(top_ / "latest"));
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "by lcs: new");
}

}  // namespace
}  // namespace lcs::bench
