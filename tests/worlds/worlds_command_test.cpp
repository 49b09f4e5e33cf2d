// `lcs world` and `lcs suite --worlds` from their command lines to their files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/suite/suite_result.h"

namespace lcs::worlds {
namespace {

namespace fs = std::filesystem;
using bench::CommandResult;

class WorldCommand : public testing::Test {
 protected:
  CommandResult run(const std::vector<std::string>& arguments) {
    return bench::run_lcs(arguments, {.folder = folder_.path()});
  }
  const bench::TemporaryFolder folder_;
};

TEST_F(WorldCommand, WritesAScenarioThatRunsLikeAnyOther) {
  const CommandResult made = run({"world", "corridor", "--seed", "4", "--out", "mine"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(
      bench::entries(folder_.path() / "mine"),
      (std::set<std::string>{"corridor_4.yaml", "scene.xml", "plan.png", "textures", "meshes"}));
  fs::rename(folder_.path() / "mine", folder_.path() / "moved");  // nothing knows where it was made
  const CommandResult ran =
      run({"run", "moved/corridor_4.yaml", "--no-video", "--set", "frames=4"});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "corridor_4" / "metrics.json"));
}

TEST_F(WorldCommand, ASheetShowsIt) {
  ASSERT_EQ(run({"world", "corridor", "--seed", "4", "--sheet", "--out", "mine"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder_.path() / "mine" / "sheet.png"));
}

TEST_F(WorldCommand, ReplacesNothing) {
  const std::vector<std::string> command{"world", "corridor", "--seed", "4", "--out", "mine"};
  ASSERT_EQ(run(command).exit_code, 0);
  std::ofstream(folder_.path() / "mine" / "scene.xml") << "edited";
  const CommandResult again = run(command);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.err.find("perhaps a world that was edited"), std::string::npos) << again.err;
  EXPECT_EQ(bench::read(folder_.path() / "mine" / "scene.xml"), "edited");
}

TEST_F(WorldCommand, MistakesAreToldInOneLineAndNothingIsWritten) {
  fs::create_directory(folder_.path() / "empty");
  fs::create_directory(folder_.path() / "broken");
  std::ofstream(folder_.path() / "broken" / "a.png") << "no picture";
  const auto refused = [&](std::vector<std::string> arguments, const std::string& with) {
    const CommandResult command = run(arguments);
    EXPECT_EQ(command.exit_code, 2);
    EXPECT_NE(command.err.find(with), std::string::npos) << command.err;
    EXPECT_EQ(std::count(command.err.begin(), command.err.end(), '\n'), 1) << command.err;
  };
  refused({"world", "moon"}, "no family of worlds 'moon'; there are room, corridor, warehouse");
  refused({"world", "room", "--pictures", "empty"}, "no picture (.png, .jpg, .jpeg, .bmp)");
  refused({"world", "room", "--pictures", "broken"}, "no picture that can be read");
  std::string huge("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x7d\0\0\0\x7d\0\x8\2\0\0\0",
                   29);  // 32000 x 32000
  std::ofstream(folder_.path() / "broken" / "a.png", std::ios::binary) << huge;
  refused({"world", "room", "--pictures", "broken"},
          "a.png: the picture has 32000 x 32000 pixels, and can have 67 million in all; give a");
  refused({"world", "room", "--out", "broken"}, "broken");
  refused({"suite", "--worlds", "dev"}, "no split 'dev'; give train, validate or test");
  refused({"suite", "--worlds", "train", "--family", "moon"}, "no family of worlds 'moon'");
  refused({"suite", "--count", "3"}, "--worlds");
  refused({"suite", "scenarios", "--worlds", "train"}, "PATH");
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
}

TEST_F(WorldCommand, ASuiteOfWorldsRunsEachOnceAndKeepsThem) {
  const std::vector<std::string> command{"suite",    "--worlds", "train", "--count", "2",
                                         "--family", "corridor", "--set", "frames=4"};
  const CommandResult first = run(command);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("= corridor (2)"), std::string::npos) << first.out;
  const suite::SuiteResult result =
      suite::read_suite(folder_.path() / "out" / "suite" / suite::kSuiteFile);
  ASSERT_EQ(result.scenarios.size(), 2u);
  EXPECT_EQ(result.scenarios[0].name, "corridor_1");
  EXPECT_EQ(result.scenarios[0].runs.size(), 1u);
  ASSERT_TRUE(result.scenarios[0].drawn);
  EXPECT_EQ(result.scenarios[0].drawn->family, "corridor");
  EXPECT_GT(result.scenarios[0].drawn->features.size(), 2u);
  const fs::path kept = folder_.path() / result.scenarios[0].file;
  // what is kept is used as it is
  std::ofstream(kept, std::ios::app) << "# looked at\n";
  ASSERT_EQ(run(command).exit_code, 0);
  EXPECT_NE(bench::read(kept).find("# looked at"), std::string::npos);
}

TEST_F(WorldCommand, ASuiteOfWorldsLeavesAPageToLookAtAndSaysWhatTheSplitIsFor) {
  const CommandResult command =
      run({"suite", "--worlds", "test", "--count", "2", "--family", "corridor", "--set", "frames=4",
           "--beside", "lcs:lab", "--beside", "klt"});
  ASSERT_EQ(command.exit_code, 0) << command.err;
  EXPECT_NE(command.out.find(" drawn again\n"), std::string::npos) << command.out;
  EXPECT_NE(command.out.find("The split test is to state figures: nothing is chosen by it"),
            std::string::npos)
      << command.out;
  const fs::path out = folder_.path() / "out" / "suite";
  EXPECT_EQ(bench::entries(out / "worlds"),
            (std::set<std::string>{"corridor_2000000.jpg", "corridor_2000001.jpg"}));
  const std::string page = bench::read(out / "worlds.html");
  for (const char* part : {"worlds/corridor_2000001.jpg", "<td>lcs:lab</td>", "<td>klt</td>",
                           "report.html#scenario-1", "runs/corridor_2000001/seed-2000001/"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  // It is an earlier suite like any other.
  fs::create_directory(folder_.path() / "scenarios");
  std::ofstream(folder_.path() / "scenarios" / "near.yaml")
      << "purpose: near\nscene: lab\nframes: 2\nego: {start: [-4 m, 0 m], speed: 0.5 m/s}\n"
         "camera: {size: [160, 120]}\n";
  const CommandResult again = run({"suite", "scenarios", "--seeds", "1"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_FALSE(fs::exists(out / "worlds.html"));
  EXPECT_FALSE(fs::exists(out / "worlds"));
}

}  // namespace
}  // namespace lcs::worlds
