// A message is one clean line, whatever it quotes.
#include "scenarios/input/message.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <new>
#include <stdexcept>

#include "scenarios/input/error.h"

namespace lcs::input {
namespace {

TEST(Message, BeginsWithTheNameOfAFileIfThereIsOne) {
  EXPECT_STREQ(Error({"a.yaml", 3}, "fault; remedy").what(), "a.yaml:3: fault; remedy");
  EXPECT_STREQ(Error({"a.yaml", 0}, "fault; remedy").what(), "a.yaml: fault; remedy");
  EXPECT_STREQ(Error({"", 0}, "fault; remedy").what(), "fault; remedy");
}

TEST(Message, UnprintableCharactersAreEscaped) {
  EXPECT_EQ(printable("caf\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80"),
            "caf\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80");
  EXPECT_EQ(printable(std::string_view("\x1b[2J\x00|\x7f|\r", 9)), "\\x1b[2J\\x00|\\x7f|\\x0d");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\x9b31m")
      << "a control character of two bytes";
  EXPECT_EQ(printable("a\xff\xc3"), "a\\xff\\xc3") << "no UTF-8";
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "b"),
            "\\u202eb")
      << "from right to left";
  EXPECT_EQ(printable("a\tb\nc"), "a\tb\nc");
}

TEST(Message, IsOneLineThatEndsWithTheRemedy) {
  EXPECT_EQ(one_line("a\nb\n"), "a b");
  EXPECT_EQ(one_line("re\tbel"), "re\\tbel");
  const std::string long_field(10'000'000, 'x');
  const std::string line = one_line("f.csv:3: the frame is '" + long_field + "'; give its number");
  EXPECT_LE(line.size(), 1000u);
  EXPECT_TRUE(line.starts_with("f.csv:3: the frame is 'xxx")) << line;
  EXPECT_TRUE(line.ends_with("xxx'; give its number")) << line;
  // No character is cut in two.
  std::string umlauts;
  for (int i = 0; i < 1000; ++i) umlauts += "\xc3\xa4";
  for (const char* shift : {"", "x"}) {
    const std::string cut = one_line(shift + umlauts);
    EXPECT_EQ(printable(cut), cut);
  }
}

TEST(Message, OfALibrarySaysWhatToDo) {
  EXPECT_EQ(message_of(std::runtime_error("a: b; c\n")), "a: b; c");
  EXPECT_NE(message_of(std::bad_alloc()).find("not enough memory; "), std::string::npos);
  const std::filesystem::filesystem_error error("status", "dir/x",
                                                std::make_error_code(std::errc::permission_denied));
  EXPECT_EQ(message_of(error), "dir/x: Permission denied; check the name and its permissions");
  const auto of_system = [](std::errc why, const char* what) {
    return message_of(std::system_error(std::make_error_code(why), what));
  };
  EXPECT_EQ(of_system(std::errc::too_many_files_open, "no pipe can be made"),
            "no pipe can be made: Too many open files; raise the limit of open files (ulimit -n)");
  EXPECT_NE(of_system(std::errc::resource_unavailable_try_again, "fork").find("(ulimit -u)"),
            std::string::npos);
  EXPECT_EQ(of_system(std::errc::io_error, "a; b"), "a; b: Input/output error");
}

}  // namespace
}  // namespace lcs::input
