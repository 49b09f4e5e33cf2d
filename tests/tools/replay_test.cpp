// `lcs replay` from its command line to its files, on pictures that the test draws.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/tools/command.h"
#include "tests/tools/pictures.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/figures_file.h"

namespace lcs::test {
namespace {

namespace fs = std::filesystem;

constexpr double kFocal_px = 300, kSpeed_mps = 0.2, kFps = 5;

/// Picture from a camera that drives towards a wall of dark patches, `depth_m` away in the first
/// frame.
cv::Mat1b wall(int frame, double depth_m = 3) {
  cv::Mat1b image(240, 320, 200);
  const double depth = depth_m - frame * kSpeed_mps / kFps;
  const auto px = [&](double metres, double centre) {
    return static_cast<int>(std::lround(centre + kFocal_px * metres / depth));
  };
  for (int row = -2; row <= 2; ++row) {
    for (int column = -3; column <= 3; ++column) {
      const double x = 0.4 * column + 0.05 * ((row + 2) % 3), y = 0.4 * row + 0.04 * (column % 2);
      cv::rectangle(image, {px(x - 0.08, 159.5), px(y - 0.06, 119.5)},
                    {px(x + 0.08, 159.5), px(y + 0.06, 119.5)}, cv::Scalar(30), cv::FILLED);
    }
  }
  // Ideal edges have adjacent corners of equal strength, which suppress each other.
  cv::GaussianBlur(image, image, {}, 0.8);
  return image;
}

struct Replay : testing::Test {
  Replay() { fs::create_directory(pictures()); }
  fs::path pictures() const { return folder_.path() / "pictures"; }
  fs::path out() const { return folder_.path() / "out" / "pictures"; }

  void draw(int frames) const {
    for (int k = 0; k < frames; ++k) {
      // Numbers without leading zeros: by name, 10 would come before 2.
      write_picture(pictures() / ("view" + std::to_string(k + 1) + ".png"), wall(k));
    }
  }
  CommandResult replay(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"replay",  "--images", pictures(), "--fps", "5",
                                       "--speed", "0.2",      "--focal",  "300"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_lcs(arguments, {.folder = folder_.path()});
  }
  nlohmann::json metrics() const {
    std::ifstream file(out() / scoring::kMetricsFile);
    return nlohmann::json::parse(file);
  }

  const TemporaryFolder folder_;
};

TEST_F(Replay, TracksAWallThatComesNearerAndLearnsItsDepth) {
  draw(12);
  const CommandResult result = replay();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json figures = metrics();
  EXPECT_EQ(figures["frames"], 12);
  EXPECT_GT(figures["edges.rematched"], 0.8);
  EXPECT_TRUE(figures["rebel.f1"].is_null()) << "there is no truth";
  const recording::Recording recording = recording::read_recording(out());
  const Layers& layers = recording.frames.back().layers;
  ASSERT_GT(layers.normal_edges.size(), 50u);
  // Whole pixels over 11 frames: most depths are within 10 % of the wall's.
  const double ratio = 3.0 / (3 - 11 * kSpeed_mps / kFps);  // Z_ref / Z
  const auto near =
      std::count_if(layers.normal_edges.begin(), layers.normal_edges.end(),
                    [&](const Edge& edge) { return std::abs(edge.depth_ratio / ratio - 1) < 0.1; });
  EXPECT_GT(static_cast<double>(near), 0.5 * static_cast<double>(layers.normal_edges.size()));
  EXPECT_TRUE(fs::exists(out() / "video.mp4"));
}

TEST_F(Replay, TheSamePicturesGiveTheSameBytesWithOneThreadAndTwo) {
  draw(6);
  std::vector<std::string> bytes;
  for (const char* threads : {"1", "1", "2"}) {
    ASSERT_EQ(replay({"--no-video", "--quiet", "--threads", threads}).exit_code, 0);
    std::ifstream file(out() / recording::kLayersFile, std::ios::binary);
    bytes.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  EXPECT_FALSE(bytes[0].empty());
  EXPECT_EQ(bytes[0], bytes[1]);
  EXPECT_EQ(bytes[0], bytes[2]);
}

TEST_F(Replay, SkipsAndNamesWhatItCannotUseAndLetsItsTimePass) {
  draw(6);
  write_picture(pictures() / "view3.png", cv::Mat1b(100, 100, 20));
  std::ofstream(pictures() / "view4.png") << "not a picture";
  std::ofstream(pictures() / "notes.txt") << "neither named nor looked at";
  const CommandResult result = replay({"--no-video"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("view3.png is 100x100"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("view4.png: this is no picture that can be read"), std::string::npos)
      << result.err;
  EXPECT_NE(result.out.find("4 pictures, 2 skipped"), std::string::npos) << result.out;
  const recording::Recording recording = recording::read_recording(out());
  ASSERT_EQ(recording.frames.size(), 4u);
  EXPECT_EQ(recording.frames[2].t_ns, 800'000'000);
  EXPECT_DOUBLE_EQ(recording.frames[2].motion.dt_s, 0.6);
}

TEST_F(Replay, MistakesAreToldInOneLineBeforeAnyOutput) {
  draw(2);
  fs::create_directory(folder_.path() / "empty");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--fps", "0"}, "--fps"},
      {{"--focal", "-1"}, "--focal"},
      {{"--focal", "nan"}, "--focal"},
      {{"--speed", "inf"}, "--speed"},
      {{"--fast-threshold", "0"}, "threshold"},
      {{"--preset", "office"}, "office"},
      {{"--set", "circle.gap0=3"}, "circle.gap"},
      {{"--set", "circle.mu_0"}, "KEY=VALUE"},
      {{"--images", folder_.path() / "nowhere"}, "nowhere"},
      {{"--images", folder_.path() / "empty"}, "holds no pictures"},
  };
  for (const auto& [arguments, expected] : cases) {
    SCOPED_TRACE(arguments[0] + " " + arguments[1]);
    std::vector<std::string> all{"replay"};
    for (const auto& [name, value] : std::map<std::string, std::string>{
             {"--images", pictures()}, {"--fps", "5"}, {"--speed", "0.2"}, {"--focal", "300"}}) {
      if (name == arguments[0]) continue;
      all.push_back(name);
      all.push_back(value);
    }
    all.insert(all.end(), arguments.begin(), arguments.end());
    const CommandResult result = run_lcs(all, {.folder = folder_.path()});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(expected), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "out"));
  }
}

TEST_F(Replay, PicturesWithoutCornersHaveNoFiguresRatherThanWrongOnes) {
  for (int k = 0; k < 3; ++k) {
    write_picture(pictures() / (std::to_string(k) + ".png"), cv::Mat1b(60, 80, 90));
  }
  const CommandResult result = replay({"--no-video"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out.find("nan"), std::string::npos) << result.out;
  EXPECT_TRUE(metrics()["edges.rematched"].is_null());
}

}  // namespace
}  // namespace lcs::test
