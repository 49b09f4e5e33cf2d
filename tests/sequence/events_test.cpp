// Sequences with events: RPG's text and DSEC's HDF5 have the events of the simulation.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "scenarios/load.h"
#include "sim/simulation.h"
#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/process/child.h"
#include "tools/recording/recording_io.h"

namespace lcs::sequence {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_lcs;

constexpr const char* kWorld = R"(scene: lab
frames: 4
ego: {start: [-3 m, 0 m], speed: 1.5 m/s}
camera: {size: [320, 240], distortion: [-0.1, 0.01, 0.001, 0.002, 0], time_offset: 2 ms}
events: {}
)";

class Events : public testing::Test {
 protected:
  Events() { test::write(file(), kWorld); }
  fs::path file() const { return home_.path() / "drive.yaml"; }
  fs::path folder() const { return home_.path() / "out"; }
  CommandResult generate(const std::string& formats) const {
    return run_lcs({"generate", file(), "--formats", formats, "--out", folder(), "--quiet"},
                   {home_.path()});
  }
  std::vector<sim::Event> simulated() const {
    sim::Simulation simulation(scenario::load(file(), {}));
    std::vector<sim::Event> all;
    while (const auto o = simulation.next())
      all.insert(all.end(), o->events.begin(), o->events.end());
    return all;
  }
  test::TemporaryFolder home_;
};

TEST_F(Events, AreReadBackFromRpgsText) {
  const CommandResult made = generate("events");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const fs::path rpg = folder() / "rpg";
  std::ifstream events(rpg / "events.txt");
  std::int64_t s = 0, ns = 0;
  char point = 0;
  int x = 0, y = 0, p = 0;
  std::vector<sim::Event> read;
  // the stamps are by the camera's clock, 2 ms before the IMU's
  while (events >> s >> point >> ns >> x >> y >> p) {
    read.push_back({(s - 1'000'000'000) * 1'000'000'000 + ns + 2'000'000,
                    static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), p == 1});
  }
  EXPECT_GT(read.size(), 1000U);
  EXPECT_EQ(read, simulated());

  std::ifstream images(rpg / "images.txt");
  std::string stamp, name;
  int pictures = 0;
  for (; images >> stamp >> name; ++pictures) {
    EXPECT_EQ(cv::imread((rpg / name).string()).size(), cv::Size(320, 240)) << name;
  }
  EXPECT_EQ(pictures, 4);
  std::istringstream calibration(test::read(rpg / "calib.txt"));
  std::vector<double> numbers;
  for (double number = 0; calibration >> number;) numbers.push_back(number);
  ASSERT_EQ(numbers.size(), 9U);
  EXPECT_NEAR(numbers[0], 120 / std::tan(std::acos(-1) / 6), 1e-9);  // 60 deg over 240 rows
  EXPECT_EQ(std::vector<double>(numbers.begin() + 4, numbers.end()),
            (std::vector<double>{-0.1, 0.01, 0.001, 0.002, 0}));
}

/// By h5py, which also gives the first event of each millisecond.
TEST_F(Events, AreReadBackFromDsecsHdf5) {
  const CommandResult made = generate("dsec,events");
  if (made.err.find("needs h5py") != std::string::npos) GTEST_SKIP() << made.err;
  ASSERT_EQ(made.exit_code, 0) << made.err;
  test::write(home_.path() / "read.py", R"(
import sys
import h5py, numpy as np
with h5py.File(sys.argv[1] + "/dsec/events.h5") as file:
    t, x, y, p = (file["events/" + name][:] for name in "txyp")
    offset, firsts = int(file["t_offset"][()]), file["ms_to_idx"][:].astype(int)
rows = [line.split() for line in open(sys.argv[1] + "/rpg/events.txt")]
assert len(rows) == len(t) > 1000
text_us = np.array([int(row[0].replace(".", "")) // 1000 for row in rows])
assert (t.astype(np.int64) + offset == text_us).all()
for column, place in ((x, 1), (y, 2), (p, 3)):
    assert (column == np.array([int(row[place]) for row in rows])).all()
assert len(firsts) == t[-1] // 1000 + 1
for ms, first in enumerate(firsts):
    assert t[first] >= ms * 1000 and (first == 0 or t[first - 1] < ms * 1000)
)");
  const std::vector<std::string> arguments{folder().string()};
  const process::PythonEnd end = process::run_python(home_.path() / "read.py", arguments);
  EXPECT_TRUE(end.is_fine) << end.err;
}

TEST_F(Events, TakeNoLongerThanDsecsTimesOf32Bits) {
  test::write(file(), std::string(kWorld) + "duration: 5000 s\n");
  std::string text = test::read(file());
  text.replace(text.find("frames: 4\n"), 10, "");
  text.replace(text.find("camera: {"), 9, "camera: {rate: 1 Hz, ");
  test::write(file(), text);
  const CommandResult made = generate("dsec");
  if (made.err.find("needs h5py") != std::string::npos) GTEST_SKIP() << made.err;
  EXPECT_EQ(made.exit_code, 2);
  EXPECT_NE(made.err.find("drive.yaml: the sequence takes 5000 s, and DSEC's times in 32 bits end "
                          "after 4295 s; give fewer frames"),
            std::string::npos)
      << made.err;
  EXPECT_FALSE(fs::exists(folder()));
}

/// The corners are those of the events, so that pictures without contrast give the same.
TEST_F(Events, AreReplayedAsCorners) {
  ASSERT_EQ(generate("events").exit_code, 0);
  const auto replay = [&](const std::string& name) {
    const fs::path out = home_.path() / name;
    const CommandResult result = run_lcs({"replay", folder() / "rpg", "--corners", "events",
                                          "--nothing-moves", "--out", out, "--no-video", "--quiet"},
                                         {home_.path()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::vector<std::vector<Eigen::Vector2f>> corners;
    for (const recording::FrameRecord& frame : recording::read_recording(out).frames) {
      corners.push_back(frame.corners_px);
    }
    return corners;
  };
  const auto corners = replay("seen");
  ASSERT_EQ(corners.size(), 4U);
  EXPECT_TRUE(corners[0].empty());
  EXPECT_GT(corners[1].size() + corners[2].size() + corners[3].size(), 30U);
  for (const auto& entry : fs::directory_iterator(folder() / "rpg/images")) {
    fs::remove(entry);
    cv::imwrite(entry.path().string(), cv::Mat3b(240, 320, cv::Vec3b(90, 90, 90)));
  }
  EXPECT_EQ(replay("blind"), corners);
}

/// A turn on the spot, by the truth and, with a calibration, by the IMU.
TEST_F(Events, ComeWithTheMotionOfTruthOrImu) {
  ASSERT_EQ(run_lcs({"generate", file(), "--formats", "events,kalibr", "--out", folder(), "--quiet",
                     "--set", "ego={start: [-3 m, 0 m], yaw_rate: 0.5 rad/s}", "--set",
                     "imu={preset: ideal}", "--set", "camera.time_offset="},
                    {home_.path()})
                .exit_code,
            0);
  const auto turns_of = [&](const std::string& name, std::vector<std::string> more) {
    const fs::path out = home_.path() / name;
    std::vector<std::string> words{
        "replay", folder() / "rpg", "--nothing-moves", "--no-video", "--quiet", "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult result = run_lcs(words, {home_.path()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::vector<EgoMotion> motions;
    for (const recording::FrameRecord& frame : recording::read_recording(out).frames) {
      motions.push_back(frame.motion);
    }
    return motions;
  };
  const std::vector<EgoMotion> by_truth = turns_of("truth", {});
  const std::vector<EgoMotion> by_imu =
      turns_of("imu", {"--calibration", folder() / "kalibr/camchain.yaml"});
  ASSERT_EQ(by_truth.size(), 4U);
  ASSERT_EQ(by_imu.size(), 4U);
  for (std::size_t k = 1; k < 4; ++k) {
    const Eigen::AngleAxisd apart(by_truth[k].R_cur_prev.transpose() * by_imu[k].R_cur_prev);
    EXPECT_NEAR(Eigen::AngleAxisd(by_truth[k].R_cur_prev).angle(), 0.05, 1e-6);
    EXPECT_LT(apart.angle(), 1e-4) << k;
    EXPECT_NE(by_truth[k].R_cur_prev, by_imu[k].R_cur_prev);
  }
}

TEST_F(Events, OfOtherPicturesAndInDisorderAreRefusedWithTheirPlace) {
  ASSERT_EQ(generate("events").exit_code, 0);
  const fs::path file = folder() / "rpg/events.txt";
  const std::string whole = test::read(file);
  const auto refusal = [&](const std::string& events) {
    test::write(file, events);
    const CommandResult result = run_lcs({"replay", folder() / "rpg", "--corners", "events",
                                          "--out", home_.path() / "none", "--quiet"},
                                         {home_.path()});
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_NE(refusal("1000000000.5 320 3 1\n").find("an event of "), std::string::npos);
  EXPECT_NE(refusal("5.5 1 3 1\n5.4 1 3 1\n").find("events.txt:2: is earlier"), std::string::npos);
  EXPECT_NE(refusal("").find("corners.from is 'events', and "), std::string::npos);
}

TEST_F(Events, OfACameraWithoutEventPixelsAreRefused) {
  const CommandResult result = run_lcs(
      {"generate", file(), "--formats", "events", "--out", folder(), "--quiet", "--set", "events="},
      {home_.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("the camera has no event pixels; add 'events: {}', or leave events out "
                            "of --formats"),
            std::string::npos)
      << result.err;
  EXPECT_FALSE(fs::exists(folder()));
}

}  // namespace
}  // namespace lcs::sequence
