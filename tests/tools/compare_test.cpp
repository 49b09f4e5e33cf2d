// `lcs compare` from its command line to its exit codes.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "tests/tools/command.h"
#include "tests/tools/recordings.h"
#include "tests/tools/suites.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/recording_io.h"

namespace lcs::suite {
namespace {

using test::CommandResult;

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
    return test::run_lcs(arguments, {.folder = folder_.path()});
  }
  const test::TemporaryFolder folder_;
};

TEST_F(CompareCommand, ExitsWithZeroForTheSameAndForTheBetter) {
  suite("a", {0.5, 0.6});
  suite("b", {0.7, 0.8});
  const CommandResult same = compare({"a", "a/suite.json"});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_TRUE(
      same.out.ends_with("\nequal: no loss above 0.000 of rebel.f1; of 1 mean 0 regressed, 0 "
                         "improved; of 1 scenario 0 regressed, 0 improved, 1 as before; 2 runs "
                         "without an error, no criteria asked for\n"))
      << same.out;
  const CommandResult better = compare({"a", "b"});
  EXPECT_EQ(better.exit_code, 0) << better.err;
  EXPECT_NE(better.out.find("near      rebel.f1   0.550  0.750  +0.200  improved\n"),
            std::string::npos)
      << better.out;
}

TEST_F(CompareCommand, PrintsItsTablesAloneInTheFormatThatIsAskedFor) {
  suite("a", {0.5, 0.625});
  suite("b", {0.25, 0.375});
  const CommandResult csv = compare({"a", "b", "--format", "csv"});
  EXPECT_EQ(csv.exit_code, 1) << "regressed";
  EXPECT_NE(csv.out.find("scenario,figure,before,after,change,change_half,verdict\n"
                         "near,rebel.f1,0.5625,0.3125,-0.25,0,regressed\n"),
            std::string::npos)
      << csv.out;
  EXPECT_TRUE(csv.err.starts_with("regressed: rebel.f1 0.562 -> 0.312")) << csv.err;
  const CommandResult latex = compare({"a", "b", "--format", "latex"});
  EXPECT_NE(latex.out.find("near & rebel.f1 & $0.562$ & $0.312$ & $-0.250$ & regressed \\\\\n"),
            std::string::npos)
      << latex.out;
  const CommandResult none = compare({"a", "b", "--format", "tex"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_EQ(none.out, "");
  EXPECT_NE(none.err.find("it takes text, markdown, csv, latex"), std::string::npos) << none.err;
}

/// The output of a command on a terminal.
std::string on_terminal(const std::vector<std::string>& arguments,
                        const std::filesystem::path& folder) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  EXPECT_EQ(::grantpt(terminal), 0);
  EXPECT_EQ(::unlockpt(terminal), 0);
  const std::string name = ::ptsname(terminal);
  const int held = ::open(name.c_str(), O_RDWR | O_NOCTTY);  // else the output is lost at the end
  test::run_lcs(arguments, {.folder = folder, .out = name});
  std::string text(4096, ' ');
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::read(terminal, &text[0], 4096))));
  ::close(held);
  ::close(terminal);
  return text;
}

TEST_F(CompareCommand, TheVerdictIsGreenOrRedOnATerminalUnlessNoColourIsAskedFor) {
  suite("a", {0.7, 0.8});
  suite("b", {0.5, 0.6});
  ::setenv("TERM", "xterm", 1);
  ::unsetenv("NO_COLOR");
  EXPECT_NE(on_terminal({"compare", "a", "a"}, folder_.path()).find("\x1b[32mequal: "),
            std::string::npos);
  EXPECT_NE(on_terminal({"compare", "a", "b"}, folder_.path()).find("\x1b[31mregressed: "),
            std::string::npos);
  EXPECT_EQ(compare({"a", "b"}).out.find("\x1b["), std::string::npos) << "a pipe";
  ::setenv("NO_COLOR", "1", 1);
  const std::string plain = on_terminal({"compare", "a", "b"}, folder_.path());
  EXPECT_EQ(plain.find("\x1b["), std::string::npos);
  EXPECT_NE(plain.find("regressed: "), std::string::npos);
  ::unsetenv("NO_COLOR");
}

TEST_F(CompareCommand, ExitsWithOneForARegressionAmongTheFiguresAskedFor) {
  suite("a", {0.7, 0.8});
  suite("b", {0.5, 0.6});
  EXPECT_EQ(compare({"a", "b"}).exit_code, 1);
  EXPECT_EQ(compare({"a", "b", "--fail-on-regression"}).exit_code, 1);
  EXPECT_EQ(compare({"a", "b", "--metric", "f1$"}).exit_code, 1);
  EXPECT_EQ(compare({"a", "b", "--metric", "square"}).exit_code, 2) << "neither suite has any";
}

TEST_F(CompareCommand, ExitsWithTwoWhereASeedIsMissingUnlessAllowed) {
  suite("a", {0.7, 0.8});
  suite("b", {0.7});
  const CommandResult fewer = compare({"a", "b"});
  EXPECT_EQ(fewer.exit_code, 2);
  EXPECT_NE(fewer.out.find("\nnot judged: missing or other frames than before: near seed 2; "
                           "--allow-missing judges the others; "),
            std::string::npos)
      << fewer.out;
  EXPECT_EQ(compare({"a", "b", "--allow-missing"}).exit_code, 0);
}

TEST_F(CompareCommand, ExitsWithZeroAndIsYellowWhereALossIsNotExcluded) {
  suite("a", {0.7, 0.8});
  suite("b", {0.6, 0.9});
  ::setenv("TERM", "xterm", 1);
  ::unsetenv("NO_COLOR");
  EXPECT_NE(
      on_terminal({"compare", "a", "b"}, folder_.path()).find("\x1b[33mno regression found, "),
      std::string::npos);
  EXPECT_EQ(compare({"a", "b"}).exit_code, 0);
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
  for (const char* part : {"Examples", "lcs compare", "Exit codes", "not judged"}) {
    EXPECT_NE(help.out.find(part), std::string::npos) << part << " in\n" << help.out;
  }
}

TEST_F(CompareCommand, FramesAreOfRunsAndOnlyAllGoesWithThem) {
  suite("a", {0.5});
  const CommandResult none = compare({"a", "a", "--frames"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("a has no frames of near seed 1; make it with --keep all"),
            std::string::npos)
      << none.err;
  const CommandResult both = compare({"a", "a", "--frames", "--metric", "f1"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_NE(both.err.find("leave out --metric, --allow-missing and --format"), std::string::npos)
      << both.err;
}

TEST_F(CompareCommand, FramesNameTheFirstThatDiffersAndRunsOfOneSide) {
  const auto run = [&](const std::string& name, int frames, Verdict verdict) {
    std::filesystem::create_directories(folder_.path() / name);
    recording::RecordingWriter writer(folder_.path() / name, test::recording_of({}));
    for (int k = 0; k < frames; ++k) {
      const Verdict here = k == 1 ? verdict : Verdict::normal;
      writer.write(test::FrameMaker(k).corner(here, sim::Label::fixed));
    }
    writer.close();
  };
  run("a", 3, Verdict::normal);
  run("b", 3, Verdict::rebel);
  const CommandResult same = compare({"a", "a", "--frames"});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_EQ(same.out, "equal: 0 of 1 run differ, in 0 of 3 frames\n");
  const CommandResult other = compare({"a", "b", "--frames"});
  EXPECT_EQ(other.exit_code, 1) << other.err;
  EXPECT_EQ(other.out,
            "frame 1 (t = 0.100 s) is the first of 1 that differ, of 3, in corners/verdict\n"
            "  (300, 300) px: normal -> rebel\n"
            "different: 1 of 1 run differ, in 1 of 3 frames\n");
}

}  // namespace
}  // namespace lcs::suite
