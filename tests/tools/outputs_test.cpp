// Every option of every command that names an output, as listed by the program's own help: no byte
// of a foreign file is lost, whatever the option names.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/pictures.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::test {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

constexpr const char* kScene =
    "<mujoco><worldbody><light pos='0 0 5'/><geom name='floor' type='plane' size='20 20 .1'/>"
    "<body name='crate' pos='4 1 .3'><geom type='box' size='.3 .3 .3' rgba='.9 .9 .9 1'/></body>"
    "</worldbody></mujoco>";
constexpr const char* kScenario = R"(purpose: a box goes by
scene: scene.xml
frames: 4
camera: {size: [160, 120]}
ego: {start: [0 m, 0 m], speed: 0.5 m/s}
actors:
  walker: {shape: box, trajectory: {line: {from: [3 m, -1 m], heading: 90 deg, speed: 1 m/s}}}
)";

/// An option that names an output.
struct Option {
  std::string command, name, type;
  bool is_file() const { return type == "FILE"; }
  std::string key() const { return command + " " + name; }
};

/// One option of a command's help: its heading, name and type.
struct Listed {
  std::string heading, name, type;
};

std::vector<Listed> listed(const std::string& help) {
  const std::regex heading(R"(^(\w+):$)"), option(R"(^  (?:-\w,)?(--[\w-]+) ?(\S*).*)");
  std::vector<Listed> all;
  std::string under;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, heading)) under = match.str(1);
    if (line.starts_with("Examples:")) break;
    if (std::regex_match(line, match, option)) all.push_back({under, match.str(1), match.str(2)});
  }
  return all;
}

/// Options that name inputs. Any other option with a path must be an output.
const std::set<std::string> kInputs{
    "run --recorded",      "run --detections",  "suite --recorded",     "suite --detections",
    "suite --baseline",    "suite --times",     "merge --baseline",     "score --detections",
    "replay --poses",      "replay --times",    "replay --calibration", "replay --imu-calibration",
    "replay --imu",        "replay --odometry", "replay --mask",        "replay --labels",
    "kinematics --config", "world --pictures",  "tune --validate"};

class Outputs : public testing::Test {
 protected:
  /// Inputs of all commands, made once.
  static void SetUpTestSuite() {
    made_ = std::make_unique<TemporaryFolder>();
    const fs::path home = made_->path();
    write(home / "scenarios" / "scene.xml", kScene);
    write(home / "scenarios" / "mine.yaml", kScenario);
    write(home / "poses.txt", "0 0 0 0 0 0 0 1\n0.1 0 0 0 0 0 0 1\n");
    fs::create_directory(home / "pictures");
    for (int i = 0; i < 4; ++i) {
      cv::Mat1b picture(48, 64, static_cast<uchar>(90));
      picture(cv::Rect(10 + i, 10, 20, 20)) = 200;
      write_picture(home / "pictures" / fmt::format("{}.png", i), picture);
    }
    for (const Arguments& arguments :
         {Arguments{"run", "scenarios/mine.yaml", "--out", "run", "--no-video", "--quiet"},
          Arguments{"suite", "scenarios/mine.yaml", "--seeds", "1", "--out", "suite", "--quiet"},
          Arguments{"suite", "scenarios/mine.yaml", "--seeds", "1", "--shard", "1/1", "--out",
                    "part", "--quiet"},
          Arguments{"score", "run", "--write-detections", "said.csv", "--quiet"}}) {
      const CommandResult result = run_lcs(arguments, {.folder = home});
      ASSERT_EQ(result.exit_code, 0) << result.err;
    }
  }
  static void TearDownTestSuite() { made_.reset(); }

  Outputs() { fs::copy(made_->path(), home_.path(), fs::copy_options::recursive); }

  static std::string help(const std::string& command) {
    const Arguments arguments =
        command.empty() ? Arguments{"--help"} : Arguments{command, "--help"};
    return run_lcs(arguments, {.folder = made_->path()}).out;
  }
  static std::vector<std::string> commands() {
    const std::string text = help("");
    const std::regex name(R"(^  (\w+) +\S.*)");
    std::vector<std::string> all;
    std::istringstream lines(text.substr(text.find("Subcommands:")));
    std::string line;
    std::getline(lines, line);
    for (std::smatch match; std::getline(lines, line) && std::regex_match(line, match, name);) {
      all.push_back(match.str(1));
    }
    return all;
  }
  static std::vector<Option> options() {
    std::vector<Option> all;
    for (const std::string& command : commands()) {
      for (const Listed& one : listed(help(command))) {
        if (one.heading == "Outputs" && !one.type.empty()) {
          all.push_back({command, one.name, one.type});
        }
      }
    }
    return all;
  }

  /// A short call of the command without the option.
  static Arguments use_of(const Option& option) {
    static const std::map<std::string, Arguments> uses{
        {"run", {"run", "scenarios/mine.yaml", "--no-video", "--quiet"}},
        {"preview", {"preview", "scenarios/mine.yaml", "--quiet"}},
        {"replay",
         {"replay", "pictures", "--focal", "60", "--fps", "10", "--speed", "1", "--no-video",
          "--quiet"}},
        {"score", {"score", "run", "--detections", "said.csv", "--quiet"}},
        {"suite", {"suite", "scenarios/mine.yaml", "--seeds", "1", "--quiet"}},
        {"merge", {"merge", "part", "--quiet"}},
        {"compare", {"compare", "suite", "suite"}},
        {"explain", {"explain", "run", "0", "--track", "1"}},
        {"generate", {"generate", "scenarios/mine.yaml", "--formats", "tum", "--quiet"}},
        {"kinematics", {"kinematics", "--config", "scenarios/mine.yaml", "--quick", "--quiet"}},
        {"world", {"world", "room", "--pictures", "pictures", "--quiet"}},
        {"tune", {"tune", "suite", "--evaluations", "1", "--quiet"}}};
    const auto found = uses.find(option.command);
    EXPECT_NE(found, uses.end()) << "lcs " << option.command
                                 << " writes something: say here how it is used";
    return found == uses.end() ? Arguments{option.command} : found->second;
  }
  static Arguments naming(const Option& option, const std::string& target) {
    Arguments all = use_of(option);
    if (option.name != "--out" && option.command != "score" && option.command != "compare" &&
        option.command != "explain" && option.name != "--write") {
      all.insert(all.end(), {"--out", option.command == "preview" ? "other.html" : "other"});
    }
    all.insert(all.end(), {option.name, option.type == "NAME=DIR" ? "klt=" + target : target});
    return all;
  }
  CommandResult lcs(const Arguments& arguments) const {
    return run_lcs(arguments, {.folder = home_.path()});
  }
  /// The command is refused with one line, and all files are unchanged.
  void expect_refused(const Arguments& arguments, const CommandOptions& options) const {
    const auto before = bytes_in(home_.path());
    const CommandResult result = run_lcs(arguments, options);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_TRUE(result.err.starts_with("lcs: ")) << result.err;
    const auto after = bytes_in(home_.path());
    for (const auto& [path, bytes] : before) {
      ASSERT_TRUE(after.contains(path)) << path << " is lost; " << result.err;
      EXPECT_EQ(after.at(path), bytes) << path;
    }
    for (const auto& [path, bytes] : after) EXPECT_TRUE(before.contains(path)) << path;
  }
  void expect_refused(const Arguments& arguments) const {
    expect_refused(arguments, {.folder = home_.path()});
  }
  /// Also with the option that replaces files.
  void expect_refused_even_by_force(const Option& option, const std::string& target) const {
    Arguments arguments = naming(option, target);
    expect_refused(arguments);
    if (!option.is_file()) return;
    arguments.emplace_back("--force");
    expect_refused(arguments);
  }

  const TemporaryFolder home_;

 private:
  static std::unique_ptr<TemporaryFolder> made_;
};
std::unique_ptr<TemporaryFolder> Outputs::made_;

TEST_F(Outputs, AreUnderAHeadingOfTheirOwn) {
  EXPECT_GE(commands().size(), 10u);
  EXPECT_GE(options().size(), 14u);
  const std::regex path("FILE|DIR|FOLDER|SUITE");
  for (const std::string& command : commands()) {
    for (const Listed& one : listed(help(command))) {
      if (!std::regex_search(one.type, path) || one.heading == "Outputs") continue;
      EXPECT_TRUE(kInputs.contains(command + " " + one.name))
          << "lcs " << command << " " << one.name << " takes a path: is it read or written?";
    }
  }
}

TEST_F(Outputs, TakeTheirPlaceAndThatOfTheirOwnEarlierOnes) {
  for (const Option& option : options()) {
    SCOPED_TRACE(option.key());
    if (option.command == "kinematics") continue;  // takes long: its own test does it
    for (int time = 0; time < 2; ++time) {
      const CommandResult result = lcs(naming(option, "place"));
      EXPECT_EQ(result.exit_code, 0) << result.err;
      EXPECT_TRUE(fs::exists(home_.path() / "place"));
    }
    for (const char* name : {"place", ".place.lcs-written", "other", "other.html"}) {
      fs::remove_all(home_.path() / name);
    }
    fs::remove(home_.path() / ".other.html.lcs-written");
  }
}

TEST_F(Outputs, TakeNoForeignFilesPlace) {
  // Users have such files, too, and this program looks for them.
  write(home_.path() / "mine.csv", "frame,type\n0,rebel,1\n");
  write(home_.path() / "mine.json", R"({"rebel.f1": 0.9, "detector": "mine"})");
  write(home_.path() / "mine.html", "<!DOCTYPE html>\n<html lang=\"en\">\n");
  write(home_.path() / "notes.txt", "/// Written by `lcs tune`\n# lcs tune: mine\nprecious\n");
  fs::copy_file(home_.path() / "said.csv", home_.path() / "edited.csv");
  fs::copy_file(home_.path() / ".said.csv.lcs-written", home_.path() / ".edited.csv.lcs-written");
  for (const Option& option : options()) {
    SCOPED_TRACE(option.key());
    for (const char* file : {"mine.csv", "mine.json", "mine.html", "notes.txt", "edited.csv"}) {
      expect_refused(naming(option, file));
    }
    if (option.is_file()) expect_refused_even_by_force(option, "pictures");
  }
}

TEST_F(Outputs, TakeNoForeignFoldersPlace) {
  write(home_.path() / "mine" / "metrics.json", R"({"rebel.f1": 0.9})");
  write(home_.path() / "mine" / "suite.json", R"({"detector": "mine"})");
  write(home_.path() / "mine" / "evaluations.csv", "# my own\n1,2,3\n");
  write(home_.path() / "mine" / "manifest.json", R"({"plan": {}})");
  write(home_.path() / "mine" / "scene.xml", "<mujoco/>");
  fs::copy(home_.path() / "run", home_.path() / "edited", fs::copy_options::recursive);
  write(home_.path() / "edited" / "frames.csv", "my own table\n");
  fs::copy(home_.path() / "suite", home_.path() / "more", fs::copy_options::recursive);
  write(home_.path() / "more" / "runs" / "notes.txt", "precious");
  for (const Option& option : options()) {
    SCOPED_TRACE(option.key());
    for (const char* folder : {"mine", "edited", "more"}) {
      // `lcs tune` adds missing files to its own folder.
      if (option.command == "tune" && std::string(folder) != "mine") continue;
      expect_refused_even_by_force(option, folder);
    }
  }
}

TEST_F(Outputs, FollowNoLinks) {
  write(home_.path() / "precious.txt", "precious");
  write(home_.path() / "mine" / "precious.txt", "precious");
  fs::create_symlink("precious.txt", home_.path() / "to_a_file");
  fs::create_directory_symlink("mine", home_.path() / "to_a_folder");
  fs::create_directory_symlink("run", home_.path() / "to_a_result");
  fs::create_symlink("said.csv", home_.path() / "to_an_own_file");
  fs::create_symlink("nowhere", home_.path() / "to_nothing");
  for (const Option& option : options()) {
    SCOPED_TRACE(option.key());
    for (const char* link :
         {"to_a_file", "to_a_folder", "to_a_result", "to_an_own_file", "to_nothing"}) {
      expect_refused_even_by_force(option, link);
    }
  }
}

TEST_F(Outputs, AreNoInputsNorLieInsideOrRoundThem) {
  const std::map<std::string, std::vector<std::string>> inputs{
      {"run", {"scenarios/mine.yaml", "scenarios"}},
      {"preview", {"scenarios/mine.yaml", "scenarios/scene.xml"}},
      {"replay", {"pictures", "pictures/deep/out"}},
      {"score", {"said.csv", "run", "run/figures.json"}},
      {"suite", {"scenarios/mine.yaml", "scenarios"}},
      {"merge", {"part", "part/deep/out"}},
      {"compare", {"suite", "suite/deep/out"}},
      {"explain", {"run", "run/layers.jsonl"}},
      {"generate", {"scenarios/mine.yaml", "scenarios"}},
      {"kinematics", {"scenarios/mine.yaml", "scenarios"}},
      {"world", {"pictures", "pictures/deep/world"}},
      {"tune", {"suite", "suite/tune"}}};
  for (const Option& option : options()) {
    SCOPED_TRACE(option.key());
    ASSERT_TRUE(inputs.contains(option.command));
    for (const std::string& input : inputs.at(option.command)) {
      SCOPED_TRACE(input);
      expect_refused_even_by_force(option, input);
    }
  }
  // The program's own results that are read.
  expect_refused({"run", "scenarios/mine.yaml", "--recorded", "run", "--no-video", "--out", "run"});
  expect_refused(
      {"run", "scenarios/mine.yaml", "--recorded", "run", "--no-video", "--beside", "lcs:lab=run"});
  expect_refused(
      {"suite", "scenarios/mine.yaml", "--seeds", "1", "--recorded", "suite", "--out", "suite"});
  expect_refused(
      {"suite", "scenarios/mine.yaml", "--seeds", "1", "--baseline", "suite", "--out", "suite"});
  expect_refused({"suite", "scenarios", "--seeds", "1", "--out", "scenarios/out"});
  expect_refused({"score", "run", "--write-detections", "run/said.csv"});
  const Arguments replay{"replay", "pictures", "--focal", "60", "--poses", "poses.txt", "--write"};
  Arguments onto_poses = replay;
  onto_poses.insert(onto_poses.end(), {"poses.txt", "--force"});
  expect_refused(onto_poses);
}

TEST_F(Outputs, OfOneCommandAreApart) {
  expect_refused({"run", "scenarios/mine.yaml", "--out", "a", "--beside", "klt=a"});
  expect_refused({"run", "scenarios/mine.yaml", "--out", "a", "--beside", "klt=a/klt"});
  expect_refused({"run", "scenarios/mine.yaml", "--out", "a/b", "--beside", "klt=a"});
  expect_refused({"preview", "scenarios/mine.yaml", "--out", "same.x", "--mjcf", "same.x"});
  expect_refused({"score", "run", "--out", "same.x", "--write-detections", "./same.x"});
}

TEST_F(Outputs, AreAllOldWhereOneOfThemCannotBe) {
  const Arguments both{
      "run", "scenarios/mine.yaml", "--no-video", "--quiet", "--out", "own", "--beside", "klt=k"};
  ASSERT_EQ(lcs(both).exit_code, 0);
  write(home_.path() / "k" / "notes.txt", "precious");
  Arguments again = both;
  again.insert(again.end(), {"--seed", "7"});
  expect_refused(again);
  const Arguments files{"preview",  "scenarios/mine.yaml", "--quiet", "--mjcf", "keep.xml", "--out",
                        "notes.txt"};
  write(home_.path() / "keep.xml", "precious");
  write(home_.path() / "notes.txt", "precious");
  expect_refused(files);
}

TEST_F(Outputs, OnAFullDiskLeaveNothing) {
  for (const Option& option : options()) {
    SCOPED_TRACE(option.key());
    if (option.command == "kinematics") continue;  // takes long before it writes
    const auto before = entries(home_.path());
    // A generated sequence and a search keep their existing files.
    const bool grows = option.command == "generate" || option.command == "tune";
    const CommandOptions full{.folder = home_.path(), .largest_file = 300};
    if (option.key() == "replay --write") {
      // The file is as short as the message, which goes to another file of the test.
    } else if (!grows) {
      expect_refused(naming(option, "place"), full);
      EXPECT_EQ(entries(home_.path()), before);
    } else {
      EXPECT_EQ(run_lcs(naming(option, "place"), full).exit_code, 2);
      fs::remove_all(home_.path() / "place");
    }
    if (option.is_file()) expect_refused(naming(option, "/dev/full"));
  }
}

TEST_F(Outputs, InAFolderThatCannotBeWrittenToAreRefused) {
  fs::create_directory(home_.path() / "closed");
  ::chmod((home_.path() / "closed").c_str(), 0555);
  CommandOptions options_of_a_user{.folder = home_.path()};
  options_of_a_user.obeys_permissions = true;
  for (const Option& option : options()) {
    SCOPED_TRACE(option.key());
    expect_refused(naming(option, "closed/place"), options_of_a_user);
    expect_refused(naming(option, "closed/deep/place"), options_of_a_user);
  }
  EXPECT_TRUE(fs::is_empty(home_.path() / "closed"));
}

}  // namespace
}  // namespace lcs::test
