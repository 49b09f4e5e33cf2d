// Checks BAD_INPUT.md: each row states the result of the input and names existing tests.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/files.h"

namespace {

namespace fs = std::filesystem;

const fs::path kTests = LCS_TESTS_DIR;

std::vector<std::smatch> matches(const std::string& text, const std::regex& pattern) {
  return {std::sregex_iterator(text.begin(), text.end(), pattern), {}};
}

/// Test names as in the sources: "Suite.Test" in C++, "test_..." in Python.
std::set<std::string> tests_in_the_tree() {
  const std::regex definition(R"(\nTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\))");
  const std::regex in_python(R"(\n    def (test_\w+)\()");
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(kTests)) {
    const std::string type = entry.path().extension();
    if (type != ".cpp" && type != ".py") continue;
    const std::string text = lcs::bench::read(entry.path());
    for (const std::smatch& match : matches(text, in_python)) names.insert(match.str(1));
    for (const std::smatch& match : matches(text, definition)) {
      names.insert(match.str(1) + "." + match.str(2));
    }
  }
  return names;
}

TEST(BadInputTable, EveryRowNamesTestsThatExist) {
  const std::set<std::string> tests = tests_in_the_tree();
  ASSERT_GT(tests.size(), 500u);
  const std::regex row(R"(^\| (.+) \| (.+) \| (.+) \|$)"), quoted("`([^`]+)`");
  std::istringstream table(lcs::bench::read(kTests / "faults" / "BAD_INPUT.md"));
  int rows = 0, line = 0;
  for (std::string text; std::getline(table, text);) {
    SCOPED_TRACE("BAD_INPUT.md:" + std::to_string(++line));
    std::smatch cells;
    if (!text.starts_with('|') || text.starts_with("| Input ") || text.starts_with("|---"))
      continue;
    ASSERT_TRUE(std::regex_match(text, cells, row)) << text;
    const std::string named = cells.str(3);
    const std::vector<std::smatch> names = matches(named, quoted);
    EXPECT_FALSE(names.empty()) << named;
    for (const std::smatch& name : names) EXPECT_TRUE(tests.contains(name.str(1))) << name.str(1);
    ++rows;
  }
  EXPECT_GT(rows, 30);
}

}  // namespace
