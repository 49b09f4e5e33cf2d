/// Checks `filter/EQUATIONS.md`: each row of its tables names code and tests, and they exist.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/files.h"

namespace {

const std::filesystem::path kFilter = LCS_FILTER_SOURCE_DIR;

/// Names of all tests of this program, without the instantiation and parameter of parameterised
/// tests.
std::set<std::string> test_names() {
  std::set<std::string> names;
  const auto& program = *::testing::UnitTest::GetInstance();
  for (int s = 0; s < program.total_test_suite_count(); ++s) {
    const auto& suite = *program.GetTestSuite(s);
    std::string suite_name = suite.name();
    suite_name = suite_name.substr(suite_name.find('/') + 1);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const std::string name = suite.GetTestInfo(t)->name();
      names.insert(suite_name + "." + name.substr(0, name.find('/')));
    }
  }
  return names;
}

struct Row {
  int line = 0;
  std::vector<std::string> cells;
};

/// Rows of the tables of equations: rows of five columns, without the headings.
std::vector<Row> rows() {
  std::ifstream file(kFilter / "EQUATIONS.md");
  std::vector<Row> found;
  std::string text;
  for (int line = 1; std::getline(file, text); ++line) {
    if (text.rfind("| ", 0) != 0) continue;
    Row row{line, {}};
    std::stringstream cells(text.substr(1));
    for (std::string cell; std::getline(cells, cell, '|');) row.cells.push_back(cell);
    if (row.cells.size() == 5 && row.cells[0] != " As printed ") found.push_back(row);
  }
  return found;
}

std::vector<std::string> quoted(const std::string& cell) {
  std::vector<std::string> words;
  for (std::size_t open = cell.find('`'); open != std::string::npos;) {
    const std::size_t close = cell.find('`', open + 1);
    if (close == std::string::npos) break;
    words.push_back(cell.substr(open + 1, close - open - 1));
    open = cell.find('`', close + 1);
  }
  return words;
}

TEST(Equations, EveryRowNamesCodeAndTestsThatExist) {
  const std::set<std::string> tests = test_names();
  const std::vector<Row> all = rows();
  ASSERT_GT(all.size(), 80u);
  for (const Row& row : all) {
    SCOPED_TRACE("EQUATIONS.md:" + std::to_string(row.line));
    std::string source;
    const auto code = quoted(row.cells[3]);
    EXPECT_FALSE(code.empty());
    for (const std::string& word : code) {
      if (word.find(".cpp") != std::string::npos || word.find(".h") != std::string::npos) {
        source = lcs::bench::read(kFilter / word);
        EXPECT_FALSE(source.empty()) << word;
      } else {
        EXPECT_NE(source.find(word), std::string::npos) << word;
      }
    }
    const auto named = quoted(row.cells[4]);
    EXPECT_FALSE(named.empty());
    for (const std::string& name : named) EXPECT_TRUE(tests.count(name)) << name;
  }
}

}  // namespace
