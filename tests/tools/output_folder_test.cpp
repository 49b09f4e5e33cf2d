#include "tools/bench/output_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::bench {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kFiles{"metrics.json", "video.mp4"};

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

class OutputFolderTest : public testing::Test {
 protected:
  /// A finished result.
  static void make_result(const fs::path& target, const std::string& text) {
    OutputFolder folder(target, kFiles);
    write(folder.staging() / "metrics.json", text);
    folder.commit();
  }
  static std::string refusal(const fs::path& target) {
    try {
      const OutputFolder folder(target, kFiles);
    } catch (const OutputError& error) {
      return error.what();
    }
    return "";
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
    write(folder.staging() / "metrics.json", "old");
    write(folder.staging() / "video.mp4", "old");
    folder.commit();
  }
  make_result(top_ / "run", "new");
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "new");
  EXPECT_EQ(entries(top_ / "run"), std::set<std::string>{"metrics.json"}) << "no old video is left";
  EXPECT_EQ(entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputFolderTest, AnEarlierResultStaysWhenTheNextOneFails) {
  make_result(top_ / "run", "old");
  {
    const OutputFolder folder(top_ / "run", kFiles);
    write(folder.staging() / "metrics.json", "new");
  }
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "old");
  EXPECT_EQ(entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputFolderTest, WhatAKilledProcessLeftIsTakenAwayAndWhatALivingOneWritesIsNot) {
  for (const char* name : {"run.partial-1", "run.partial-2", "walk.partial-1"}) {
    fs::create_directory(top_ / name);
    write(top_ / name / "metrics.json", "half");
  }
  const FolderLock living(top_ / "run.partial-2", /*wait=*/false);
  ASSERT_TRUE(living.is_held());
  make_result(top_ / "run", "new");
  EXPECT_EQ(entries(top_), (std::set<std::string>{"run", "run.partial-2", "walk.partial-1"}));
}

TEST_F(OutputFolderTest, AnEmptyFolderIsTaken) {
  fs::create_directory(top_ / "run");
  make_result(top_ / "run", "new");
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "new");
}

TEST_F(OutputFolderTest, AFolderThatHoldsSomethingElseIsRefusedAndUntouched) {
  make_result(top_ / "run", "old");
  write(top_ / "run" / "thesis.tex", "precious");
  EXPECT_NE(refusal(top_ / "run").find("thesis.tex"), std::string::npos);
  EXPECT_EQ(read(top_ / "run" / "thesis.tex"), "precious");
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "old");
  EXPECT_EQ(entries(top_), std::set<std::string>{"run"});
}

TEST_F(OutputFolderTest, AFolderWithoutTheFirstFileIsNoResult) {
  fs::create_directory(top_ / "run");
  write(top_ / "run" / "video.mp4", "somebody's own");
  EXPECT_NE(refusal(top_ / "run").find("metrics.json"), std::string::npos);
  EXPECT_EQ(read(top_ / "run" / "video.mp4"), "somebody's own");
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
  const std::vector<std::string> kNested{"suite.json", "runs/*/seed-*/metrics.json"};
  NestedOutputFolder() {
    OutputFolder folder(target_, kNested);
    write(folder.staging() / "suite.json", "old");
    fs::create_directories(folder.staging() / "runs" / "near" / "seed-1");
    write(folder.staging() / "runs" / "near" / "seed-1" / "metrics.json", "old");
    folder.commit();
  }
  std::string refusal() const {
    try {
      const OutputFolder folder(target_, kNested);
    } catch (const OutputError& error) {
      return error.what();
    }
    return "";
  }
  const fs::path target_ = top_ / "suite";
};

TEST_F(NestedOutputFolder, IsReplacedAsAWhole) {
  {
    OutputFolder folder(target_, kNested);
    write(folder.staging() / "suite.json", "new");
    folder.commit();
  }
  EXPECT_EQ(read(target_ / "suite.json"), "new");
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
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "new");
}

TEST_F(OutputFolderTest, ALinkToAnEarlierResultIsFollowed) {
  make_result(top_ / "run", "old");
  fs::create_directory_symlink(top_ / "run", top_ / "latest");
  make_result(top_ / "latest", "new");
  EXPECT_TRUE(fs::is_symlink(top_ / "latest"));
  EXPECT_EQ(read(top_ / "run" / "metrics.json"), "new");
}

}  // namespace
}  // namespace lcs::bench
