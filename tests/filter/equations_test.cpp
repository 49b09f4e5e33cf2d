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

/// Rows of the tables of equations: rows of three columns, without the headings.
std::vector<Row> rows() {
  std::ifstream file(kFilter / "EQUATIONS.md");
  std::vector<Row> found;
  std::string text;
  for (int line = 1; std::getline(file, text); ++line) {
    if (text.rfind("| ", 0) != 0) continue;
    Row row{line, {}};
    std::stringstream cells(text.substr(1));
    for (std::string cell; std::getline(cells, cell, '|');) row.cells.push_back(cell);
    if (row.cells.size() == 3 && row.cells[0] != " As printed ") found.push_back(row);
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
  std::set<std::string> named;
  for (const Row& row : rows()) {
    SCOPED_TRACE("EQUATIONS.md:" + std::to_string(row.line));
    std::string source;
    int functions = 0;
    bool has_tests = false;
    for (const std::string& word : quoted(row.cells[2])) {
      if (word.ends_with(".cpp") || word.ends_with(".h")) {
        source = lcs::test::read(kFilter / word);
        EXPECT_FALSE(source.empty()) << word;
      } else if (word.find('.') != std::string::npos) {
        has_tests = true;
        named.insert(word);
        EXPECT_TRUE(tests.count(word)) << word;
      } else {
        ++functions;
        EXPECT_NE(source.find(word), std::string::npos) << word;
      }
    }
    EXPECT_GT(functions, 0);
    EXPECT_TRUE(has_tests);
  }
  EXPECT_GE(named.size(), 166u) << "rows may be merged, but each rule keeps its test";
}

}  // namespace
