// `lcs compare` from its command line to its exit codes.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/tools/command.h"
#include "tests/tools/suites.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::suite {
namespace {

using bench::CommandResult;

class CompareCommand : public testing::Test {
 protected:
  /// Writes a suite's folder with one scenario and one figure.
  void suite(const std::string& name, const std::vector<std::optional<double>>& values,
             const std::string& scenario = "near") {
    std::filesystem::create_directories(folder_.path() / name);
    write_suite(folder_.path() / name / kSuiteFile,
                suite_with({scenario_with(scenario, "rebel.f1", values)}));
  }
  CommandResult compare(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "compare");
    return bench::run_lcs(arguments, {.folder = folder_.path()});
  }
  const bench::TemporaryFolder folder_;
};

TEST_F(CompareCommand, ExitsWithZeroForTheSameAndForTheBetter) {
  suite("a", {0.5, 0.6});
  suite("b", {0.7, 0.8});
  const CommandResult same = compare({"a", "a/suite.json"});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_TRUE(
      same.out.ends_with("\nnot regressed: of 1 means 0 regressed, 0 improved; of single "
                         "scenarios 0 regressed, 0 improved, 1 as before\n"))
      << same.out;
  const CommandResult better = compare({"a", "b"});
  EXPECT_EQ(better.exit_code, 0) << better.err;
  EXPECT_NE(better.out.find("improved:\n  near  rebel.f1"), std::string::npos) << better.out;
}

TEST_F(CompareCommand, ExitsWithOneForARegressionAmongTheFiguresAskedFor) {
  suite("a", {0.7, 0.8});
  suite("b", {0.5, 0.6});
  EXPECT_EQ(compare({"a", "b"}).exit_code, 1);
  EXPECT_EQ(compare({"a", "b", "--fail-on-regression"}).exit_code, 1);
  EXPECT_EQ(compare({"a", "b", "--metric", "f1$"}).exit_code, 1);
  EXPECT_EQ(compare({"a", "b", "--metric", "square"}).exit_code, 0);
}

TEST_F(CompareCommand, TellsMistakesInOneLineAndExitsWithTwo) {
  suite("a", {0.5});
  suite("other", {0.5}, "far");
  std::ofstream(folder_.path() / "broken.json") << "{";
  const std::vector<std::pair<std::vector<std::string>, const char*>> mistakes{
      {{"a"}, "AFTER"},
      {{"a", "no_such"}, "no_such"},
      {{"broken.json", "a"}, "not JSON"},
      {{"a", "other"}, "no scenario in common"},
      {{"a", "a", "--metric", "("}, "regular expression"},
      {{"a", "a", "--metric", std::string(20000, '(')}, "repeats more than 1000 characters"}};
  for (const auto& [arguments, said] : mistakes) {
    const CommandResult result = compare(arguments);
    EXPECT_EQ(result.exit_code, 2) << said;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(said), std::string::npos) << result.err;
  }
}

TEST_F(CompareCommand, HelpTeachesExamplesAndExitCodes) {
  const CommandResult help = compare({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* part : {"Examples", "lcs compare", "Exit codes", "interval"}) {
    EXPECT_NE(help.out.find(part), std::string::npos) << part << " in\n" << help.out;
  }
}

}  // namespace
}  // namespace lcs::suite
