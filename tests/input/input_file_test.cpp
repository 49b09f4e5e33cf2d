// Each input must be a regular file of an allowed size; other inputs are reported.
#include "scenarios/input/input_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

#include "tests/scenarios/scenario_file.h"
#include "tests/tools/files.h"
#include "tests/tools/refusal.h"

namespace lcs::input {
namespace {

constexpr FileKind kKind{kMebibyte, "give a table"};

std::string refusal(const std::filesystem::path& file) {
  return test::refusal_of<Error>([&] { read_file(file, kKind); });
}

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  InputFile input(file, kKind);
  std::vector<std::string> lines;
  for (std::string line; input.next_line(line);) {
    lines.push_back(line);
    EXPECT_EQ(input.here().line, static_cast<int>(lines.size()));
  }
  return lines;
}

TEST(InputFile, PipeDeviceFolderOrSocketIsRefusedUnread) {
  const scenario::ScenarioFolder folder;
  const std::filesystem::path pipe = folder.path() / "pipe", socket = folder.path() / "socket";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);  // no process ever writes to it
  EXPECT_EQ(refusal(pipe),
            pipe.string() +
                ": this is a pipe, which may never end; write what comes out of it to "
                "a file first");
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: this is a device; give a table");
  EXPECT_EQ(refusal(folder.path()), folder.path().string() + ": this is a folder; give a table");
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, socket.c_str(), sizeof(address.sun_path) - 1);
  const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  EXPECT_EQ(refusal(socket), socket.string() + ": this is a socket; give a table");
  ::close(listener);
}

TEST(InputFile, APipeOfAShellIsRefusedAndItsWriterIsNotDisturbed) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const std::string name = "/dev/fd/" + std::to_string(ends[0]);  // as <(...) gives it
  EXPECT_NE(refusal(name).find("write what comes out of it to a file first"), std::string::npos);
  EXPECT_EQ(::write(ends[1], "x", 1), 1);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(InputFile, MissingOrTooLargeFileIsRefused) {
  const scenario::ScenarioFolder folder;
  const std::string missing = folder.path() / "none.csv";
  EXPECT_EQ(refusal(missing), missing + ": there is no such file; give a table");
  const auto large = folder.write("large.csv", "");
  std::filesystem::resize_file(large, kKind.most_bytes + 1);
  EXPECT_EQ(refusal(large), large.string() + ": the file is larger than 1 MiB; give a table");
  std::filesystem::resize_file(large, kKind.most_bytes);
  EXPECT_EQ(read_file(large, kKind).size(), kMebibyte);
}

TEST(InputFile, TheLineThatNamesItIsBlamed) {
  EXPECT_EQ(test::refusal_of<Error>([] {
              InputFile("/dev/zero", kKind, {"scene.xml", 7});
            }),
            "scene.xml:7: '/dev/zero': this is a device; give a table");
}

TEST(InputFile, HasItsLinesWhateverEndsTheLastOneAndWithoutAByteOrderMark) {
  const scenario::ScenarioFolder folder;
  using Lines = std::vector<std::string>;
  EXPECT_EQ(lines_of(folder.write("a", "")), Lines{});
  EXPECT_EQ(lines_of(folder.write("a", "\n")), Lines{""});
  EXPECT_EQ(lines_of(folder.write("a", "one\n\ntwo")), (Lines{"one", "", "two"}));
  EXPECT_EQ(lines_of(folder.write("a", "one\ntwo\n")), (Lines{"one", "two"}));
  EXPECT_EQ(lines_of(folder.write("a", "\xef\xbb\xbfone\n\xef\xbb\xbftwo\n")),
            (Lines{"one", "\xef\xbb\xbftwo"}));
  // Longer than the read buffer, with lines across its ends.
  Lines lines;
  std::string text;
  for (std::size_t i = 0; i < 7; ++i) {
    lines.push_back(std::string(40000 * i + i, static_cast<char>('a' + i)));
    text += lines.back() + '\n';
  }
  EXPECT_EQ(lines_of(folder.write("a", text)), lines);
}

#ifndef __SANITIZE_ADDRESS__  // which needs its own memory
TEST(InputFile, ACompressedOneIsReadLikeItsText) {
  const scenario::ScenarioFolder folder;
  const std::filesystem::path plain = folder.write("table", "one\ntwo\n"),
                              compressed = plain.string() + ".gz";
  // Members of several programs behind each other, as gzip allows.
  const std::string shell = "cd " + folder.path().string() + " && ";
  ASSERT_EQ(std::system((shell + "gzip -9 -k table && python3 -c 'import gzip, sys; "
                                 "sys.stdout.buffer.write(gzip.compress(b\"three\"))' >> table.gz")
                            .c_str()),
            0);
  EXPECT_EQ(lines_of(compressed), (std::vector<std::string>{"one", "two", "three"}));

  const std::string bytes = test::read(compressed);
  test::write(compressed, bytes.substr(0, bytes.size() - 3));
  EXPECT_EQ(refusal(compressed),
            compressed.string() + ": this is no whole gzip file; give a table");
  test::write(compressed, "one\n");
  EXPECT_EQ(refusal(compressed),
            compressed.string() + ": this is no whole gzip file; give a table");
  test::write(compressed, "");
  EXPECT_NE(refusal(compressed).find("the file is empty"), std::string::npos);
  ASSERT_EQ(std::system((shell + "head -c 3000000 /dev/zero | gzip > table.gz").c_str()), 0);
  EXPECT_EQ(refusal(compressed),
            compressed.string() + ": the file is larger than 1 MiB; give a table");
}

TEST(InputFile, AGzipMemberIsBoundedWhateverTheSizeOfItsKind) {
  const scenario::ScenarioFolder folder;
  const std::filesystem::path bomb = folder.write("table.gz", "");
  ASSERT_EQ(std::system(("head -c 1100M /dev/zero | gzip -1 > " + bomb.string()).c_str()), 0);
  const auto read = [&] { read_file(bomb, {64 * kGibibyte, "give a table"}); };
  EXPECT_EQ(
      test::refusal_of<Error>(read),
      bomb.string() + ": the file has 1 GiB or more in one gzip member; decompress it (gunzip)");
}

TEST(InputFileDeathTest, MemoryThatRunsOutIsNoEndOfFile) {
  const scenario::ScenarioFolder folder;
  const auto large = folder.write("large", "");
  std::filesystem::resize_file(large, kGibibyte);
  const auto read_with_little = [&] {
    const rlimit limit{512 * kMebibyte, 512 * kMebibyte};
    ::setrlimit(RLIMIT_AS, &limit);
    try {
      read_file(large, {kGibibyte, "give less"});
    } catch (const std::bad_alloc&) {
      ::_exit(7);
    }
    ::_exit(0);
  };
  EXPECT_EXIT(read_with_little(), testing::ExitedWithCode(7), "");
}
#endif

}  // namespace
}  // namespace lcs::input
