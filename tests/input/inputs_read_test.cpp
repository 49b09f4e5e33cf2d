#include "scenarios/input/inputs_read.h"

#include <gtest/gtest.h>

#include "scenarios/input/input_file.h"
#include "scenarios/input/sha256.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::input {
namespace {

using test::TemporaryFolder;
using test::write;

namespace fs = std::filesystem;

class InputsRead : public testing::Test {
 protected:
  InputsRead() { forget_inputs(); }
  ~InputsRead() override { forget_inputs(); }

  TemporaryFolder temporary_;
  fs::path top_ = fs::canonical(temporary_.path());
};

TEST_F(InputsRead, EachOpenedFileIsRecordedWithTheDigestOfItsFirstReading) {
  write(top_ / "file", "first");
  read_file(top_ / "file", {kMebibyte, "give another"});
  write(top_ / "file", "second");
  read_file(top_ / "file", {kMebibyte, "give another"});
  const auto read = inputs_read();
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read.at(top_ / "file"), sha256("first"));
}

TEST_F(InputsRead, FolderAndMissingFileHaveNoDigest) {
  note_input(top_);
  note_input(top_ / "missing");
  EXPECT_EQ(inputs_read().at(top_), "");
  EXPECT_EQ(inputs_read().at(top_ / "missing"), "");
}

TEST_F(InputsRead, NameWithDotsIsTheShortOneUnlessALinkIsOnTheWay) {
  fs::create_directories(top_ / "a" / "deep");
  fs::create_directory_symlink(top_ / "a" / "deep", top_ / "link");
  write(top_ / "file", "outer");
  write(top_ / "a" / "file", "inner");
  note_input(top_ / "a" / ".." / "file");
  note_input(top_ / "link" / ".." / "file");  // a/file
  const auto read = inputs_read();
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read.at(top_ / "file"), sha256("outer"));
  EXPECT_EQ(read.at(top_ / "link" / ".." / "file"), sha256("inner"));
}

TEST_F(InputsRead, LinkIsRecordedByItsOwnNameWithTheBytesBehindIt) {
  write(top_ / "file", "behind");
  fs::create_symlink(top_ / "file", top_ / "link");
  note_input(top_ / "link");
  EXPECT_EQ(inputs_read().at(top_ / "link"), sha256("behind"));
}

}  // namespace
}  // namespace lcs::input
