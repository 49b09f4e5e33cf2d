#include "scenarios/input/sha256.h"

#include <gtest/gtest.h>

#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::input {
namespace {

using test::TemporaryFolder;
using test::write;

TEST(Sha256, IsThatOfTheStandard) {
  // FIPS 180-4's own examples.
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Sha256, OfAFileIsThatOfItsBytes) {
  const TemporaryFolder folder;
  const std::string long_text(3'000'000, 'x');  // several blocks
  for (const std::string& text : {std::string("abc"), std::string(), long_text}) {
    write(folder.path() / "file", text);
    EXPECT_EQ(sha256_of_file(folder.path() / "file"), sha256(text));
  }
}

TEST(Sha256, OfNoRegularFileIsNone) {
  const TemporaryFolder folder;
  write(folder.path() / "file", "abc");
  std::filesystem::create_symlink(folder.path() / "file", folder.path() / "link");
  EXPECT_FALSE(sha256_of_file(folder.path() / "link"));
  EXPECT_FALSE(sha256_of_file(folder.path()));
  EXPECT_FALSE(sha256_of_file("/dev/zero"));
  EXPECT_FALSE(sha256_of_file("/nowhere/at/all"));
}

}  // namespace
}  // namespace lcs::input
