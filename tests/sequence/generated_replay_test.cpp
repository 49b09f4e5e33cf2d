// Replaying a generated sequence gives the results of a run of its scenario.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>

#include "scenarios/input/document.h"
#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/recording_io.h"
#include "tools/replay/recorded.h"
#include "tools/scoring/figures_file.h"
#include "tools/sequence/replay_settings.h"
#include "tools/sequence/sequence_folder.h"

namespace lcs::sequence {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_lcs;

struct Case {
  const char* name;
  std::string scenario;
  std::vector<std::string> sets;
};

const fs::path kScenarios = LCS_SCENARIOS_DIR;

class GeneratedReplay : public testing::Test {
 protected:
  /// With one sample a pixel: a replay has the same bits however pictures are made.
  void make(const std::string& command, const std::string& scenario,
            const std::vector<std::string>& sets, std::vector<std::string> more) {
    std::vector<std::string> arguments{command, kScenarios / scenario, "--quiet", "--set",
                                       "image.samples=1"};
    for (const std::string& set : sets) arguments.insert(arguments.end(), {"--set", set});
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = run_lcs(arguments, {.folder = home_.path()});
    ASSERT_TRUE(result.exit_code == 0 || result.exit_code == 1) << result.err;  // 1: criteria
  }
  CommandResult replay(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"replay", home_.path() / "sequence", "--no-video", "--out",
                                       home_.path() / "replay"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_lcs(arguments, {.folder = home_.path()});
  }
  std::string layers(const char* folder) const {
    return read_file(home_.path() / folder / recording::kLayersFile);
  }
  const test::TemporaryFolder home_;
};

class GeneratedReplayOf : public GeneratedReplay, public testing::WithParamInterface<Case> {};
INSTANTIATE_TEST_SUITE_P(
    Scenarios, GeneratedReplayOf,
    testing::Values(Case{"ExactMotion", "crossing.yaml", {"frames=6", "ego_motion=truth"}},
                    Case{"OddTimesFilterAndThreshold",
                         "crossing.yaml",
                         {"frames=8", "camera.rate=7 Hz", "imu.rate=130 Hz", "corners.threshold=30",
                          "filter.preset=lab", "filter.circle.mu_0=20"}},
                    Case{"ThresholdOfThePictures",
                         "crossing.yaml",
                         {"frames=6", "corners.threshold=auto", "image.jpeg=50"}},
                    Case{"WheelsOnRoughGround", "suite/rough_ground.yaml", {"frames=6"}},
                    Case{"Lens",
                         "crossing.yaml",
                         {"frames=6", "camera.focal=[420, 410]", "camera.centre=[330, 225]",
                          "camera.distortion=[-0.28, 0.07, 0.0002, 0.00002, 0]"}},
                    Case{"CarriedFisheye", "examples/flying.yaml", {"frames=6"}},
                    Case{"AnotherClock", "crossing.yaml", {"frames=6", "camera.time_offset=12 ms"}},
                    Case{"GapInTheImu", "suite/imu_gap.yaml", {"frames=22"}}),
    [](const auto& test) { return test.param.name; });

TEST_P(GeneratedReplayOf, HasEveryBitOfTheRun) {
  const Case& c = GetParam();
  make("run", c.scenario, c.sets, {"--no-video", "--out", home_.path() / "run"});
  make("generate", c.scenario, c.sets, {"--formats", "euroc", "--out", home_.path() / "sequence"});
  const CommandResult result = replay();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string of_run = layers("run");
  EXPECT_NE(of_run.find("\"signatures\":\""), std::string::npos);
  EXPECT_TRUE(layers("replay") == of_run)
      << "motion, corners, signatures, verdicts and layers, as text";
}

/// The times of its frames are those that the filter is told, 7 ms before those of the run.
TEST_F(GeneratedReplay, HasTheMotionOfARunThatIsToldAWrongClock) {
  const std::vector<std::string> sets{"frames=4", "camera.time_offset=12 ms",
                                      "camera.told.time_offset_error=-7 ms"};
  make("run", "crossing.yaml", sets, {"--no-video", "--out", home_.path() / "run"});
  make("generate", "crossing.yaml", sets,
       {"--formats", "euroc", "--out", home_.path() / "sequence"});
  const CommandResult result = replay();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto without_times = [](const std::string& text) {
    return std::regex_replace(text, std::regex(R"("t_ns":-?\d+)"), "");
  };
  EXPECT_NE(layers("run").find("\"t_ns\":200000000"), std::string::npos);
  EXPECT_NE(layers("replay").find("\"t_ns\":193000000"), std::string::npos);
  EXPECT_TRUE(without_times(layers("replay")) == without_times(layers("run")));
}

TEST_F(GeneratedReplay, HasTheLensAndItsPlaceInEveryCalibration) {
  make("generate", "examples/flying.yaml", {"frames=2"},
       {"--formats", "euroc,kalibr", "--out", home_.path() / "sequence"});
  for (const char* file : {"kalibr/camchain.yaml", "mav0/cam0/sensor.yaml"}) {
    const auto read = replay::read_calibration(home_.path() / "sequence" / file);
    const replay::Lens& lens = read.lens.value();
    EXPECT_EQ(lens.fu_px, 285.3) << file;
    EXPECT_EQ(lens.fv_px, 285.1) << file;
    EXPECT_EQ(lens.cu_px, 237.4) << file;
    EXPECT_EQ(lens.cv_px, 181.2) << file;
    EXPECT_EQ(lens.distortion, replay::Lens::Distortion::equidistant) << file;
    EXPECT_EQ(lens.coefficients, (std::vector<double>{0.0035, 0.0007, -0.0021, 0.0002})) << file;
    Eigen::Matrix3d R;
    R << 0, -0.3420201433, 0.9396926208, -1, 0, 0, 0, -0.9396926208, -0.3420201433;
    EXPECT_LT((read.T_BS.value().R - R).norm(), 1e-9) << file;
    EXPECT_LT((read.T_BS.value().p - Eigen::Vector3d(0.08, 0.01, -0.02)).norm(), 1e-9) << file;
  }
  const auto imu = replay::read_calibration(home_.path() / "sequence/kalibr/imu.yaml");
  EXPECT_EQ(imu.noise.value().gyroscope_noise_density, 1.6968e-4);
  EXPECT_EQ(imu.rate_hz, 200);
  const auto chain = replay::read_calibration(home_.path() / "sequence/kalibr/camchain.yaml");
  EXPECT_EQ(chain.time_offset_s, 0.004);
  const input::Value yaml = input::parse_file(home_.path() / "sequence/kalibr/imu.yaml");
  const auto at = [](const input::Value& map, std::string_view key) {
    return std::ranges::find(map.entries, key, &input::Entry::key)->value;
  };
  EXPECT_EQ(at(yaml, "model").text, "scale-misalignment");
  EXPECT_EQ(at(at(yaml, "gyroscopes"), "M").items[1].items[0].text, "-0.002");
  EXPECT_EQ(at(at(yaml, "accelerometers"), "M").items[2].items[2].text, "1.002");
}

/// Figures except times and those that the world determines.
std::map<std::string, std::optional<double>> figures_of(const fs::path& run) {
  std::map<std::string, std::optional<double>> figures;
  for (const auto& [name, figure] : scoring::read_metrics(run / "metrics.json")) {
    const bool is_own =
        name.starts_with("time.") || name.starts_with("sim.") || name.starts_with("warnings.");
    if (!is_own) figures[name] = figure;
  }
  return figures;
}

TEST_F(GeneratedReplay, OfAComparatorHasTheVerdictsAndTheFiguresOfItsRun) {
  const std::vector<std::string> sets{"frames=8"};
  make("run", "crossing.yaml", sets,
       {"--no-video", "--detector", "klt", "--out", home_.path() / "run"});
  make("generate", "crossing.yaml", sets,
       {"--formats", "euroc,landmarks", "--out", home_.path() / "sequence"});
  const CommandResult result = replay({"--detector", "klt"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(layers("replay") == layers("run"));
  const auto figures = figures_of(home_.path() / "run");
  EXPECT_GT(figures.at("truth.rebel_corners"), 0);
  EXPECT_TRUE(figures.at("rebel.f1") && figures.at("square.recall_50"));
  EXPECT_TRUE(figures.at("ego.rotation_error_mrad_median"));
  EXPECT_EQ(figures_of(home_.path() / "replay"), figures);

  // Corners without truth are not counted, and are reported.
  const CommandResult fainter = replay({"--fast-threshold", "15"});
  ASSERT_EQ(fainter.exit_code, 0) << fainter.err;
  EXPECT_NE(fainter.err.find(" corners are none of those whose truth truth.jsonl has, and count"),
            std::string::npos)
      << fainter.err;
  EXPECT_NEAR(figures_of(home_.path() / "replay").at("truth.fixed_corners").value_or(0),
              figures.at("truth.fixed_corners").value(), 0.1 * *figures.at("truth.fixed_corners"));
  // With every other picture the motions differ, so the truth does not apply.
  ASSERT_EQ(replay({"--every", "2"}).exit_code, 0);
  EXPECT_FALSE(figures_of(home_.path() / "replay").at("truth.rebel_corners"));
  std::ofstream(home_.path() / "sequence" / kTruthFile) << "{\"objects\":3}\n";
  const CommandResult broken = replay();
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_NE(broken.err.find("truth.jsonl:1: objects"), std::string::npos) << broken.err;
}

TEST_F(GeneratedReplay, OfFilesThatContradictEachOtherIsRefusedAtTheLine) {
  make("generate", "suite/rough_ground.yaml", {"frames=3"},
       {"--formats", "euroc", "--out", home_.path() / "sequence"});
  ASSERT_EQ(replay().exit_code, 0);
  const fs::path mav = home_.path() / "sequence" / "mav0";
  struct Edit {
    const char *sensor, *key, *line;
  };
  for (const Edit& edit :
       {Edit{"cam0", "intrinsics", "intrinsics: [500, 500, 319.5, 239.5]"},
        Edit{"cam0", "resolution", "resolution: [320, 240]"},
        Edit{"cam0", "rate_hz", "rate_hz: 25"},
        Edit{"cam0", "distortion_coefficients", "distortion_coefficients: [0.1, 0, 0, 0]"},
        Edit{"imu0", "gyroscope_noise_density", "gyroscope_noise_density: 0.5"},
        Edit{"imu0", "accelerometer_random_walk", "accelerometer_random_walk: 0"},
        Edit{"cam0", "T_BS", nullptr}, Edit{"imu0", "T_BS", nullptr},
        Edit{"odometry0", "T_BS", nullptr}, Edit{"state_groundtruth_estimate0", "T_BS", nullptr}}) {
    SCOPED_TRACE(std::string(edit.sensor) + " " + edit.key);
    const fs::path file = mav / edit.sensor / "sensor.yaml";
    const std::string before = read_file(file);
    // Moves a pose by a metre.
    const std::size_t start = before.find(edit.line ? edit.key : "data: ");
    ASSERT_NE(start, std::string::npos);
    std::string text = before;
    text.replace(start, before.find('\n', start) - start,
                 edit.line ? edit.line : "data: [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]");
    test::write(file, text);
    const CommandResult result = replay();
    EXPECT_EQ(result.exit_code, 2);
    const std::size_t key = before.find(fmt::format("\n{}:", edit.key));
    const auto end = before.begin() + static_cast<std::ptrdiff_t>(key);
    EXPECT_NE(result.err.find(file.string() + ":" +
                              std::to_string(2 + std::count(before.begin(), end, '\n')) + ": " +
                              edit.key + " is not as lcs.json of the sequence says; "),
              std::string::npos)
        << result.err;
    test::write(file, before);
  }
  EXPECT_EQ(replay().exit_code, 0);
}

TEST_F(GeneratedReplay, ByEurocsOwnFilesAloneIsTheSameToTheNoise) {
  make("run", "suite/turning_0_3.yaml", {"frames=10"},
       {"--no-video", "--out", home_.path() / "run"});
  make("generate", "suite/turning_0_3.yaml", {"frames=10"},
       {"--formats", "euroc", "--out", home_.path() / "sequence"});
  ASSERT_EQ(replay().exit_code, 0);
  EXPECT_TRUE(layers("replay") == layers("run")) << "as long as lcs.json is there";
  fs::remove(home_.path() / "sequence" / kSettingsFile);
  for (const char* source : {"imu", "truth"}) {
    const CommandResult result = replay({"--ego-motion", source});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const recording::Recording run = recording::read_recording(home_.path() / "run");
    const recording::Recording replayed = recording::read_recording(home_.path() / "replay");
    ASSERT_EQ(replayed.frames.size(), run.frames.size());
    int same = 0, all = 0;
    for (std::size_t k = 1; k < run.frames.size(); ++k) {
      const EgoMotion& a = run.frames[k].true_motion;
      const EgoMotion& b = replayed.frames[k].motion;
      // The truth's file contains the initial biases, so only noise remains: 1.7e-4 rad/s/sqrt(Hz)
      // on three axes gives a standard deviation of 1.3e-4 in the norm of the matrix over 0.1 s. A
      // swapped axis or frame gives 0.04 or more, at 0.3 rad/s.
      EXPECT_LT((a.R_cur_prev - b.R_cur_prev).norm(), 6e-4) << source;
      EXPECT_LT((a.v_C_mps - b.v_C_mps).norm(), 0.01) << source;
      EXPECT_EQ(a.dt_s, b.dt_s);
      for (std::size_t i = 0; i < run.frames[k].verdicts.size(); ++i, ++all) {
        same += run.frames[k].verdicts[i] == replayed.frames[k].verdicts[i];
      }
    }
    EXPECT_GT(same, 0.97 * all) << source;
  }
}

}  // namespace
}  // namespace lcs::sequence
