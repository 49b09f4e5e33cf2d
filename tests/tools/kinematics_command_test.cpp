// `lcs kinematics` from outside: its files, each figure of its answer, and its errors.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <thread>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/files/csv.h"

namespace lcs::test {
namespace {

namespace fs = std::filesystem;

class Kinematics : public testing::Test {
 protected:
  CommandResult run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "kinematics");
    return run_lcs(arguments, {.folder = folder_.path()});
  }
  const TemporaryFolder folder_;
};

struct Figure {
  double value = 0;
  std::optional<double> expected;
};

/// Returns each figure once by its name, and keeps the rest.
class Answer {
 public:
  explicit Answer(const std::string& csv) {
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "topic,figure,value,unit,expected");
    while (std::getline(lines, line)) {
      const auto fields = files::fields_of(line);
      figures_[std::string(fields.at(1))] = {files::number_in<double>(fields.at(2)).value(),
                                             files::number_in<double>(fields.at(4))};
    }
  }
  Figure take(const std::string& name) {
    const auto found = figures_.find(name);
    if (found == figures_.end()) {
      ADD_FAILURE() << "no figure " << name;
      return {};
    }
    const Figure figure = found->second;
    figures_.erase(found);
    return figure;
  }
  /// Requires that the measured value equals the expected one within a share.
  void expect(const std::string& name, double share) {
    const Figure figure = take(name);
    ASSERT_TRUE(figure.expected) << name;
    EXPECT_NEAR(figure.value, *figure.expected, share * *figure.expected) << name;
  }
  std::set<std::string> left() const {
    std::set<std::string> names;
    for (const auto& [name, figure] : figures_) names.insert(name);
    return names;
  }

 private:
  std::map<std::string, Figure> figures_;
};

/// The whole study of the default camera. Every figure of the answer is compared with theory or a
/// bound.
TEST_F(Kinematics, EveryFigureOfTheAnswerIsBorneOut) {
  const CommandResult result = run({"--quick", "--tolerance", "0.3", "--out", "study"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const fs::path study = folder_.path() / "study";
  EXPECT_EQ(entries(folder_.path()), std::set<std::string>{"study"});
  EXPECT_EQ(
      entries(study),
      (std::set<std::string>{"answer.txt", "answer.csv", "kinematics.html", "rotation.csv",
                             "translation.csv", "foe_distance.csv", "focal_length.csv", "mount.csv",
                             "drives.csv", "imu.csv", "bumps.csv", "drift.csv", "run.json"}));
  const std::string text = read(study / "answer.txt");
  EXPECT_NE(result.out.find(text), std::string::npos);
  // Verdicts use the requested tolerance and the scenario's own frame rate and IMU.
  EXPECT_NE(text.find("\nwithin 0.3 px: IMU, mount, bumps, drift; beyond: translation ("),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("; untried: rotation (this drive does not turn)\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("at 10 frames/s, over 10 s"), std::string::npos) << text;
  EXPECT_LT(text.find("drift, adis16448 after"), text.find("drift, tumvi after")) << text;
  Answer answer(read(study / "answer.csv"));

  for (const std::string axis : {"pan", "tilt", "roll"}) {
    // Second order; the third order is a share of w x/f = 0.03 of it.
    answer.expect("first_order.limit." + axis, 0.05);
    // First order; the second is a share of half the angle, below 0.004 rad, and of y^2/f^2.
    answer.expect("as_printed.limit." + axis, 0.03);
    answer.expect("as_printed.kindest_limit." + axis, 0.03);
  }
  // Rounding of coordinates of 1e3 px, whose ulp is 1e-13.
  EXPECT_LT(answer.take("homography.worst").value, 1e-10);
  EXPECT_LT(answer.take("translation.truth.worst").value, 1e-10);

  // The reference depth errs by V_v t_f |Z_ref/Z - 1|, computed from the simulator's depths.
  answer.expect("translation.reference.median", 1e-6);
  const double reference_p95 = answer.take("translation.reference.p95").value;
  // Corners are in whole pixels (0.29 px each way, root mean square, and two sightings); a larger
  // median would be the filter's error. Its tail are corners at outlines, with another depth.
  EXPECT_LT(answer.take("translation.learnt.median").value, 0.29 * std::sqrt(2.0));
  EXPECT_LT(answer.take("translation.learnt.p95").value, reference_p95);

  // 5 seeds, 100 frames, 3 axes: a root mean square of 1500 draws is exact to 1/sqrt(3000) = 2 %.
  answer.expect("imu.rotation.rms", 0.06);
  // The velocity drifts from frame to frame: 5 seeds and 2 axes give 1/sqrt(20) = 22 %; the bound
  // is twice that.
  answer.expect("imu.dead_reckoning.rms", 0.45);
  answer.expect("imu.odometry.rms", 0.45);

  for (const std::string axis : {"pan", "tilt", "roll"}) {
    // First order in an error of 1 deg = 0.017 rad, and in the step.
    if (axis != "roll") answer.expect("mount." + axis + ".rms", 0.02);
    answer.expect("mount.panning." + axis + ".rms", 0.04);
  }
  EXPECT_LT(answer.take("mount.roll.rms").value, 1e-10);  // the step is along the axis
  answer.expect("mount.foe_shift", 1e-6);                 // f tan(1 deg)

  // Turns of up to 4 deg: the next order is a share of 0.07 rad at the edge.
  answer.expect("bumps.none.rms", 0.05);
  answer.expect("bumps.first_order.rms", 0.1);
  EXPECT_LT(answer.take("bumps.homography.rms").value, 1e-10);
  EXPECT_GT(answer.take("bumps.turn.p95").value, 1) << "deg: the ground is rough";
  // The IMU's 200 readings per second miss part of the shaking (0.7 px), and wheels that slip on
  // the bumps are not trusted: less than an eighth of the former error.
  EXPECT_LT(answer.take("bumps.imu.rms").value, 9.4 / 8);

  for (const std::string imu : {"adis16448", "tumvi", "esim"}) {
    const std::string of = "drift." + imu + ".";
    // 25 seeds: an RMS value is exact to 1/sqrt(50) = 14 %; 2.5 times that. Tilt has two axes.
    for (const char* what : {"forward", "lateral", "vertical", "heading", "odometry.heading"}) {
      answer.expect(of + what, 0.35);
    }
    answer.expect(of + "tilt", 0.25);
    // Likewise; the expectation omits the gyro's random walk and the start, 10 % more.
    for (const char* what : {"odometry.forward", "odometry.lateral", "odometry.vertical"}) {
      answer.expect(of + what, 0.4);
    }
    answer.expect(of + "odometry.tilt", 0.5);  // relative to a bound
  }
  // Without noise only odometry causes drift: its scale, 0.5 % of the mean speed.
  for (const char* what : {"forward", "lateral", "vertical"}) {
    EXPECT_LT(answer.take(std::string("drift.ideal.") + what).value, 1e-6) << what;
  }
  for (const char* what : {"tilt", "heading"}) {
    EXPECT_LT(answer.take(std::string("drift.ideal.") + what).value, 1e-9) << what;
  }
  answer.expect("drift.ideal.odometry.forward", 0.35);
  for (const char* what : {"lateral", "vertical"}) {
    EXPECT_LT(answer.take(std::string("drift.ideal.odometry.") + what).value, 1e-3) << what;
  }
  for (const char* what : {"tilt", "heading"}) {
    EXPECT_LT(answer.take(std::string("drift.ideal.odometry.") + what).value, 1e-4) << what;
  }
  // A drive straight on: the exact way differs from the field's by a share of the way over depth.
  answer.expect("camera.rolling_shutter.p95", 0.03);
  EXPECT_LT(answer.take("camera.time_offset.p95").value, 1e-2) << "its velocity hardly changes";
  EXPECT_EQ(answer.take("camera.distortion.p95").value, 0) << "a pinhole";
  EXPECT_EQ(answer.left(), std::set<std::string>{});
}

TEST_F(Kinematics, MistakesAreToldBeforeAnythingIsDone) {
  const struct {
    std::vector<std::string> arguments;
    std::string said;
  } cases[] = {
      {{"--config", "nowhere.yaml"}, "nowhere.yaml"},
      {{"--set", "camera.fovy=200 deg"}, "camera.fovy"},
      {{"--set", "camera.fov=60 deg"}, "camera.fov"},
      {{"--set", "filter.field.rotation=printed"}, "field.rotation"},
      {{"--quick", "more"}, "more"},
      {{"--tolerance", "0 px"}, "--tolerance"},
  };
  for (const auto& [arguments, said] : cases) {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << said;
    EXPECT_NE(result.err.find(said), std::string::npos) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(fs::is_empty(folder_.path())) << said;
  }
}

TEST_F(Kinematics, AFolderWithSomethingElseIsLeftAlone) {
  fs::create_directory(folder_.path() / "mine");
  std::ofstream(folder_.path() / "mine" / "thesis.tex") << "all of it";
  const CommandResult result = run({"--quick", "--out", "mine"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("thesis.tex"), std::string::npos) << result.err;
  EXPECT_EQ(read(folder_.path() / "mine" / "thesis.tex"), "all of it");
}

TEST_F(Kinematics, AnInterruptLeavesNothing) {
  Command command({"kinematics", "--quick", "--out", "study"}, {.folder = folder_.path()});
  // The command is at work once its folder exists.
  for (int i = 0; i < 600 && fs::is_empty(folder_.path()); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  ASSERT_TRUE(command.is_running());
  command.send(SIGINT);
  const CommandResult result = command.wait();
  EXPECT_EQ(result.exit_code, 130) << result.err;
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

}  // namespace
}  // namespace lcs::test
