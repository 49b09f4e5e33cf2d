#include "tools/suite/plan.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "tests/tools/refusal.h"

namespace lcs::suite {
namespace {

bool fits(const std::string& pattern, std::string_view name) {
  return Pattern(pattern, "--filter", "cross.*far").is_in(name);
}

std::string refusal(const std::string& pattern) {
  return test::refusal_of<std::runtime_error>([&] { fits(pattern, ""); });
}

TEST(Pattern, IsARegularExpressionForAPartOfAName) {
  EXPECT_TRUE(fits("", "crossing"));
  EXPECT_TRUE(fits("ross", "crossing"));
  EXPECT_TRUE(fits("rebel\\.f1$", "rebel.f1"));
  EXPECT_FALSE(fits("^ross", "crossing"));
  EXPECT_TRUE(fits("(night|rain)_\\d{2}", "a_rain_12"));
  EXPECT_FALSE(fits("^x$", "xx"));
}

TEST(Pattern, InvalidPatternIsRefused) {
  for (const char* text : {"(", "[", "*", "a{2,1}", "(a)\\1"}) {
    EXPECT_EQ(refusal(text), std::string("--filter ") + text +
                                 " is not a regular expression; give a part of a name, or as "
                                 "'cross.*far'");
  }
}

TEST(Pattern, OfAnyLengthAndDepthIsRefusedOrEnds) {
  for (const std::string& text :
       {std::string(20000, '('), std::string(1001, 'a'), std::string("((x?){99}){99}"),
        std::string("x{999999999}"), std::string("x{0,99999999999999}")}) {
    EXPECT_NE(refusal(text).find(" repeats more than 1000 characters; "), std::string::npos)
        << text;
  }
  const std::string name(1'000'000, 'x');
  for (const std::string& text :
       {std::string(490, '(') + "x" + std::string(490, ')') + "y", std::string("(x*)*y"),
        std::string("(x|x|x)*y"), std::string("(.*)(.*)(.*)y"), std::string(".*y")}) {
    EXPECT_FALSE(fits(text, name)) << text;
  }
}

}  // namespace
}  // namespace lcs::suite
