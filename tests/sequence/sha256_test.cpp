#include "tools/sequence/sha256.h"

#include <gtest/gtest.h>

namespace lcs::sequence {
namespace {

TEST(Sha256, IsThatOfTheStandard) {
  // FIPS 180-4's own examples.
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Sha256, NamesAFileThatIsNotThere) {
  EXPECT_THROW(sha256_of_file("/nowhere/at/all"), std::runtime_error);
}

}  // namespace
}  // namespace lcs::sequence
