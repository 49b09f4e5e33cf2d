// All options of all commands. The program lists them itself: each complains in at most one line,
// and means the same before and after an argument. The rows of tools/app/option.h come back from
// the command line that they make.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/app/generate.h"
#include "tools/app/kinematics.h"
#include "tools/app/replay.h"
#include "tools/app/run.h"
#include "tools/app/suite.h"
#include "tools/app/tune.h"
#include "tools/app/world.h"

namespace lcs::test {
namespace {

using Arguments = std::vector<std::string>;

/// A value of the type of an option. There is no file or folder of such a name.
std::string value_of(const std::string& type) {
  static const std::map<std::string, std::string> values{
      {"N", "1"},          {"HZ", "1"},      {"PX", "1"},        {"TIME", "1 s"},
      {"I/N", "1/2"},      {"NAME", "room"}, {"SPLIT", "train"}, {"KEY=VALUE", "ego.speed=1"},
      {"NAME=DIR", "a=b"}, {"WHAT", "all"},  {"LIST", "flow"},   {"USE", "flow"}};
  const auto found = values.find(type);
  return found == values.end() ? "out/none" : found->second;
}

// ---- The program

/// The first two groups of each line that the expression matches, before the examples.
std::vector<std::pair<std::string, std::string>> found_in(const std::string& help,
                                                          const char* expression) {
  const std::regex form(expression);
  std::vector<std::pair<std::string, std::string>> found;
  std::istringstream lines(help.substr(0, help.find("Examples:")));
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, form)) found.emplace_back(match.str(1), match.str(2));
  }
  return found;
}

class EveryOption : public testing::Test {
 protected:
  /// Files are in the place of the default folders, so that no work is begun.
  EveryOption() {
    for (const char* name : {"out", "data"}) write(folder_.path() / name, "");
  }

  CommandResult lcs(const Arguments& arguments) const {
    return run_lcs(arguments, {.folder = folder_.path()});
  }

  std::vector<std::string> commands() const {
    const std::string top = lcs({"--help"}).out;
    std::vector<std::string> names;
    for (const auto& [name, about] :
         found_in(top.substr(top.find("Subcommands:")), R"(^  (\w+)  +(\S.*))")) {
      if (name != "lcs") names.push_back(name);
    }
    return names;
  }

  /// The command does as it is told, or complains in one line.
  CommandResult expect_plain(const Arguments& arguments) const {
    const CommandResult result = lcs(arguments);
    const std::string line = testing::PrintToString(arguments);
    if (result.exit_code == 0) return result;
    EXPECT_EQ(result.exit_code, 2) << line << '\n' << result.err;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << line << '\n' << result.err;
    EXPECT_TRUE(result.err.starts_with("lcs: ")) << line << '\n' << result.err;
    return result;
  }

  TemporaryFolder folder_;
};

TEST_F(EveryOption, MeansTheSameBeforeAndAfterAnArgument) {
  int count = 0;
  for (const std::string& command : commands()) {
    expect_plain({command});
    const std::string help = lcs({command, "--help"}).out;
    Arguments arguments;
    for (const auto& [name, more] : found_in(help, R"(^  ([A-Z]+)( .*)?$)")) {
      arguments.push_back("no_such_" + name);
    }
    for (const auto& [option, type] :
         found_in(help, R"(^  (?:-h,)?(--[a-z-]+)(?: ([A-Z][^ :]*))?(?: .*)?$)")) {
      ++count;
      expect_plain({command, option});
      Arguments words{option};
      if (!type.empty()) words.push_back(value_of(type));
      Arguments before{command}, after{command};
      before.insert(before.end(), words.begin(), words.end());
      expect_plain(before);
      if (arguments.empty()) continue;
      before.insert(before.end(), arguments.begin(), arguments.end());
      after.insert(after.end(), arguments.begin(), arguments.end());
      after.insert(after.end(), words.begin(), words.end());
      const CommandResult first = expect_plain(before), last = lcs(after);
      EXPECT_EQ(first.exit_code, last.exit_code) << command << ' ' << option;
      EXPECT_EQ(first.out, last.out) << command << ' ' << option;
      EXPECT_EQ(first.err, last.err) << command << ' ' << option;
    }
  }
  EXPECT_GT(count, 150);
}

TEST_F(EveryOption, IsNamedByItsComplaint) {
  const std::pair<Arguments, const char*> mistakes[] = {
      {{"run", "a.yaml", "--frames", "0"},
       "lcs: --frames: the number is '0'; give a whole number from 1 to 1000000"},
      {{"run", "a.yaml", "--frames", "many"}, "lcs: --frames: "},
      {{"generate"}, "lcs: give one scenario, --suite or --worlds"},
      {{"generate", "--formats", "coco", "a.yaml"}, "lcs: a.yaml: there is no such file"},
      {{"compare", "a", "b"}, "lcs: a: there is no such file; name the folder of a suite"},
      {{"suite", "--jobs", "0"}, "lcs: --jobs: "},
      {{"run", "a.yaml", "--keep", "some"}, "figures, events or all"},
      {{"run", "a.yaml", "--out", ""}, "--out: is given without a value"}};
  for (const auto& [arguments, message] : mistakes) {
    EXPECT_NE(expect_plain(arguments).err.find(message), std::string::npos) << message << " in\n"
                                                                            << lcs(arguments).err;
  }
}

// ---- The rows

/// Reads words as the program does.
void parse(const Arguments& words, const app::Options& options) {
  for (auto word = words.begin(); word != words.end(); ++word) {
    const auto option = std::ranges::find_if(options, [&](const app::Option& one) {
      return word->starts_with("--") ? one.name == *word : one.is_argument();
    });
    ASSERT_NE(option, options.end()) << *word;
    if (option->kind == app::Option::Kind::flag) {
      option->read(option->is_negative() ? "false" : "true");
    } else {
      option->read(option->is_argument() ? *word : *++word);
    }
  }
}

template <class Request>
class Rows : public testing::Test {};
using Requests = testing::Types<app::RunRequest, app::ReplayRequest, app::SuiteRequest,
                                app::MergeRequest, app::GenerateRequest, app::KinematicsRequest,
                                app::WorldRequest, app::TuneRequest>;
TYPED_TEST_SUITE(Rows, Requests);

TYPED_TEST(Rows, ComeBackFromTheCommandLineThatTheyMake) {
  TypeParam unset;
  EXPECT_EQ(app::arguments_of(unset), Arguments{options_of(unset).command});
  TypeParam request;
  const app::Options options = options_of(request);
  for (const app::Option& option : options) {
    if (option.name.empty() || option.name == "--for") continue;
    const bool is_flag = option.kind == app::Option::Kind::flag;
    option.read(is_flag                      ? (option.is_negative() ? "false" : "true")
                : option.name == "--threads" ? "2"
                : option.name == "--seed"    ? "18446744073709551615"
                : option.name == "--keep"    ? "events"
                                             : value_of(option.type));
    if (option.takes_several()) option.read("another");
  }
  const Arguments words = app::arguments_of(request);
  TypeParam again;
  const app::Options parsed = options_of(again);
  parse({words.begin() + 1, words.end()}, parsed);
  for (std::size_t i = 0; i < options.size(); ++i) {
    EXPECT_EQ(parsed[i].words(), options[i].words()) << options[i].name;
    EXPECT_EQ(app::words_of(options, parsed), Arguments());
  }
}

TEST(RowsOfDetectors, LimitOfTimeGoesWithAProgramAlone) {
  const auto arguments = [](const app::DetectorChoice& choice) {
    return app::arguments_of(app::RunRequest{.detector = choice});
  };
  EXPECT_EQ(arguments({"klt", "", 30, ""}), (Arguments{"run", "--detector", "klt"}));
  EXPECT_EQ(arguments({"", "./mine", 2.5, ""}),
            (Arguments{"run", "--detector-command", "./mine", "--detector-timeout", "2.5"}));
  EXPECT_EQ(arguments({"", "", 2.5, ""}), Arguments{"run"});
}

TEST(Help, EndsWithoutAWordWhereItsReaderHasEnough) {
  const TemporaryFolder folder;
  // The pipe's reader has gone before the help is written.
  const std::string command =
      "(sleep 0.2; " + std::string(LCS_PROGRAM) + " suite --help) 2>said | true";
  ASSERT_EQ(std::system(("cd " + folder.path().string() + " && " + command).c_str()), 0);
  EXPECT_EQ(read(folder.path() / "said"), "");
}

TEST(Help, HasEveryTextOfTheFileOfTexts) {
  const TemporaryFolder folder;
  const std::filesystem::path scenarios = LCS_SCENARIOS_DIR;
  std::istringstream lines(read(scenarios.parent_path() / "tools/app/options.txt"));
  std::map<std::string, std::vector<std::string>> texts;  // by command
  std::string command;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('[')) command = line.substr(1, line.size() - 2);
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) texts[command].push_back(line.substr(colon + 2));
  }
  std::string all;
  for (const auto& [name, own] : texts) {
    if (name == "*") continue;
    const CommandResult help = run_lcs({name, "--help"}, {.folder = folder.path()});
    EXPECT_EQ(help.exit_code, 0) << name;
    for (const std::string& text : own) {
      EXPECT_NE(help.out.find(text), std::string::npos) << name << ": " << text;
    }
    all += help.out;
  }
  EXPECT_GT(texts.size(), 10);
  for (const std::string& text : texts["*"]) EXPECT_NE(all.find(text), std::string::npos) << text;
}

TEST(Scenarios, ThatAreMisspeltAreSuggested) {
  const TemporaryFolder folder;
  const CommandResult result = run_lcs({"run", "crosing"}, {.folder = folder.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "lcs: 'crosing' is no scenario and no file; did you mean 'crossing'?\n");
}

}  // namespace
}  // namespace lcs::test
