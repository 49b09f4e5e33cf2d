// Faulty recordings: each fault is handled, counted and reported.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <regex>

#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/pictures.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/recording_io.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::read;
using test::write;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}
std::string joined(const std::vector<std::string>& lines, const std::string& end = "\n") {
  std::string text;
  for (const std::string& line : lines) text += line + end;
  return text;
}

/// A generated sequence, which each test damages anew.
class BrokenRecording : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    original_ = std::make_unique<test::TemporaryFolder>();
    const CommandResult result =
        test::run_lcs({"generate", LCS_SCENARIOS_DIR "/crossing.yaml", "--frames", "8", "--formats",
                       "euroc", "--quiet", "--out", original_->path() / "sequence"},
                      {.folder = original_->path()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  static void TearDownTestSuite() { original_.reset(); }
  void SetUp() override {
    fs::copy(original_->path() / "sequence", sequence(), fs::copy_options::recursive);
    ASSERT_EQ(replay().exit_code, 0);
    whole_ = layers();
  }

  fs::path sequence() const { return home_.path() / "sequence"; }
  fs::path pictures() const { return sequence() / "mav0/cam0/data"; }
  fs::path csv(const char* sensor) const { return sequence() / "mav0" / sensor / "data.csv"; }
  static std::string picture(int k) {
    return fmt::format("{}.png", 1'000'000'000'000'000'000 + 100'000'000LL * k);
  }
  CommandResult replay() const {
    return test::run_lcs({"replay", sequence(), "--no-video", "--out", home_.path() / "out"},
                         {.folder = home_.path()});
  }
  std::string layers() const { return read(home_.path() / "out" / recording::kLayersFile); }
  recording::Recording recording() const { return recording::read_recording(home_.path() / "out"); }

  inline static std::unique_ptr<test::TemporaryFolder> original_;
  const test::TemporaryFolder home_;
  std::string whole_;  ///< layers of the replay of the intact sequence
};

TEST_F(BrokenRecording, LineEndsAndSpacesInHeadersMakeNoDifference) {
  for (const char* sensor : {"cam0", "imu0", "odometry0"}) {
    std::vector<std::string> lines = lines_of(read(csv(sensor)));
    std::string& header = lines.front();
    for (std::size_t at = 0; (at = header.find(',', at)) != header.npos; at += 3) {
      header.replace(at, 1, " , ");
    }
    header.insert(1, " ");
    write(csv(sensor), "\xef\xbb\xbf" + joined(lines, " \r\n") + "\r\n");
  }
  const CommandResult result = replay();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(layers() == whole_);
}

TEST_F(BrokenRecording, RowsOutOfOrderAreSortedAndRowsThatComeTwiceAreUsedOnce) {
  for (const char* sensor : {"cam0", "imu0"}) {
    std::vector<std::string> lines = lines_of(read(csv(sensor)));
    std::swap(lines[3], lines[5]);
    lines.insert(lines.begin() + 4, lines[2]);
    write(csv(sensor), joined(lines));
  }
  const CommandResult result = replay();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(layers() == whole_);
  for (const char* told : {"2 tables are not in the order", "1 pictures have the time of",
                           "1 rows have the time of"}) {
    EXPECT_NE(result.err.find(told), std::string::npos) << told << "\n" << result.err;
  }
}

TEST_F(BrokenRecording, ColumnsAreFoundByTheirNames) {
  std::vector<std::string> lines = lines_of(read(csv("imu0")));
  for (std::string& line : lines) {  // the accelerometer first
    std::vector<std::string> f;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) f.push_back(field);
    line = fmt::format("{},{},{},{},{},{},{}", f[0], f[4], f[5], f[6], f[1], f[2], f[3]);
  }
  write(csv("imu0"), joined(lines));
  EXPECT_EQ(replay().exit_code, 0);
  EXPECT_TRUE(layers() == whole_);
}

TEST_F(BrokenRecording, RowsThatCannotBeReadAreLeftOutAndCounted) {
  std::vector<std::string> lines = lines_of(read(csv("imu0")));
  lines[4] = "1000000000015000000,nan,0,0,0,0,9.81";
  lines[9] = lines[9].substr(0, 30);
  write(csv("imu0"), joined(lines));
  const CommandResult result = replay();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("2 rows cannot be read"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("data.csv:5"), std::string::npos) << result.err;
}

TEST_F(BrokenRecording, GapsInTheImuAreCountedAndBridged) {
  std::vector<std::string> lines = lines_of(read(csv("imu0")));
  lines.erase(lines.begin() + 40, lines.begin() + 90);
  write(csv("imu0"), joined(lines));
  const CommandResult result = replay();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("1 gaps are in the readings of the IMU"), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("0.255 s"), std::string::npos) << result.err;
  EXPECT_EQ(recording().frames.size(), 8u);
}

TEST_F(BrokenRecording, AFrozenImuIsNamed) {
  std::vector<std::string> lines = lines_of(read(csv("imu0")));
  const std::string reading = lines[40].substr(lines[40].find(','));
  for (std::size_t i = 41; i < 90; ++i) lines[i] = lines[i].substr(0, lines[i].find(',')) + reading;
  write(csv("imu0"), joined(lines));
  const CommandResult result = replay();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("40 readings of the IMU repeat the one before"), std::string::npos)
      << result.err;
}

TEST_F(BrokenRecording, TimesThatNoClockHasAreLeftOut) {
  for (const char* sensor : {"cam0", "imu0"}) {
    std::vector<std::string> lines = lines_of(read(csv(sensor)));
    for (const char* time :
         {"9223372036854775807", "-9223372036854775808", "99999999999999999999"}) {
      lines.push_back(time + lines.back().substr(lines.back().find(',')));
    }
    write(csv(sensor), joined(lines));
  }
  const CommandResult result = replay();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("6 rows cannot be read"), std::string::npos) << result.err;
  EXPECT_TRUE(layers() == whole_);
}

TEST_F(BrokenRecording,
       PicturesThatAreMissingTruncatedOrOfAnotherSizeAreSkippedAndTheirTimePasses) {
  fs::remove(pictures() / picture(2));
  const std::string whole = read(pictures() / picture(4));
  write(pictures() / picture(4), whole.substr(0, whole.size() / 2));
  test::write_picture(pictures() / picture(5), cv::Mat3b(100, 100, cv::Vec3b(1, 2, 3)));
  const CommandResult result = replay();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find(picture(2) + " is missing"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find(picture(4) + ": the picture is broken"), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find(picture(5) + " is 100x100"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("5 pictures, 3 skipped"), std::string::npos) << result.out;
  const recording::Recording left = recording();
  ASSERT_EQ(left.frames.size(), 5u);
  EXPECT_EQ(left.frames[2].t_ns, 300'000'000);
  EXPECT_DOUBLE_EQ(left.frames[2].motion.dt_s, 0.2);
  EXPECT_DOUBLE_EQ(left.frames[3].motion.dt_s, 0.3);
}

TEST_F(BrokenRecording, APipeAmongThePicturesIsSkippedAndNamed) {
  fs::remove(pictures() / picture(2));
  ASSERT_EQ(::mkfifo((pictures() / picture(2)).c_str(), 0600), 0);
  const CommandResult result = replay();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find(picture(2) + ": this is a pipe"), std::string::npos) << result.err;
  EXPECT_EQ(recording().frames.size(), 7u);
}

TEST_F(BrokenRecording, EachTableHasTheRateOfItsOwnSensor) {
  fs::remove(sequence() / "lcs.json");
  const std::string whole = replay().err;
  EXPECT_EQ(whole.find("rows a second"), std::string::npos) << whole;
  for (const char* sensor : {"imu0", "odometry0"}) {
    const fs::path file = sequence() / "mav0" / sensor / "sensor.yaml";
    const std::string right = read(file);
    write(file, std::regex_replace(right, std::regex("rate_hz: [0-9.]+"), "rate_hz: 77"));
    const std::string told = replay().err,
                      said = fmt::format("{}/sensor.yaml states 77 Hz", sensor);
    EXPECT_NE(told.find(said), std::string::npos) << told;
    write(file, right);
  }
}

TEST_F(BrokenRecording, OdometryWithoutAReadingIsToldWhereItIsNotNeeded) {
  write(csv("odometry0"), lines_of(read(csv("odometry0"))).front() + "\n");
  fs::remove(sequence() / "lcs.json");
  const CommandResult result = replay();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("1 tables of odometry hold no reading and are not used"),
            std::string::npos)
      << result.err;
}

TEST_F(BrokenRecording, YawRatesByTheWheelsAreThoseOfRowsThatHaveThem) {
  const fs::path file = home_.path() / "wheels.csv";
  const auto yaw_rates = [&](const std::string& text) {
    write(file, text);
    Tally tally;
    std::vector<std::optional<double>> all;
    for (const sim::OdometrySample& sample : read_odometry_csv(file, {"ns", {}, {}}, tally)) {
      all.push_back(sample.yaw_rate_radps);
    }
    return all;
  };
  using Rates = std::vector<std::optional<double>>;
  const std::string rows = "1,0.5,0,0,0.2\n2,0.5,0,0\n3,0.5,0,0,left\n";
  const Rates first = {0.2, std::nullopt, std::nullopt}, none(3);
  EXPECT_EQ(yaw_rates(rows), first);
  EXPECT_EQ(yaw_rates("#timestamp [ns],v_RB_B_x,v_RB_B_y,v_RB_B_z,w_RB_B_z [rad s^-1]\n" + rows),
            first);
  EXPECT_EQ(yaw_rates("#timestamp [ns],v_RB_B_x,v_RB_B_y,v_RB_B_z,mode\n" + rows), none);
}

TEST_F(BrokenRecording, EscapeCodesOfDataAreNotForTheTerminal) {
  std::vector<std::string> lines = lines_of(read(csv("cam0")));
  lines[3] = lines[3].substr(0, lines[3].find(',')) + ",\x1b[31m.png";
  write(csv("cam0"), joined(lines));
  const CommandResult result = replay();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("\\x1b[31m.png is missing"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find('\x1b'), std::string::npos) << result.err;
}

TEST_F(BrokenRecording, WithoutTheCamerasPlaceOnTheImuIsRefused) {
  fs::remove(sequence() / "lcs.json");
  const fs::path sensor = sequence() / "mav0/cam0/sensor.yaml";
  std::string text = read(sensor);
  text.replace(text.find("T_BS:"), 5, "was: ");
  write(sensor, text);
  const CommandResult result = replay();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("does not say where the camera is on the IMU (T_BS or T_cam_imu in a "
                            "calibration, or mount);"),
            std::string::npos)
      << result.err;
}

TEST_F(BrokenRecording, UnplayableDataIsToldInOneLineAndLeavesNoOutput) {
  const auto refused = [&](const std::string& expected) {
    fs::remove_all(home_.path() / "out");
    const CommandResult result = replay();
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(expected), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(home_.path() / "out"));
  };
  const std::string imu = read(csv("imu0"));
  write(csv("imu0"), lines_of(imu).front() + "\n");
  refused("holds no reading of an IMU");
  write(csv("imu0"), "#timestamp [ns],x,y,z\n1,2,3,4\n");
  refused("the header does not name three angular rates and three accelerations");
  std::string in_g;
  for (const std::string& line : lines_of(imu)) {
    in_g +=
        line.starts_with('#') ? line + "\n" : line.substr(0, line.find(',')) + ",0,0,0,0.01,0,1\n";
  }
  write(csv("imu0"), in_g);
  refused("multiply them by 9.80665");
  fs::remove(csv("imu0"));
  refused("imu0/data.csv: there is no such file; ");
  ASSERT_EQ(::mkfifo(csv("imu0").c_str(), 0600), 0);
  refused("imu0/data.csv: this is a pipe");
  fs::remove(csv("imu0"));
  write(csv("imu0"), imu);
  const std::string odometry = read(csv("odometry0")), list = read(csv("cam0"));
  for (const std::string& nothing : {std::string(), lines_of(odometry).front() + "\n"}) {
    write(csv("odometry0"), nothing);
    refused("odometry0/data.csv: holds no reading of the odometry that lcs.json says there is; ");
  }
  write(csv("odometry0"), odometry);
  write(csv("cam0"), lines_of(list).front() + "\n");
  refused("cam0/data.csv: lists no picture with a time; ");
  write(csv("cam0"), list);
  std::string settings = read(sequence() / "lcs.json");
  write(sequence() / "lcs.json", "{\"scenario\": 7}");
  refused("lcs.json: scenario is not a text; correct it, or take it away");
  const std::string gravity = "\"gravity_mps2\": ";
  std::string heavy = settings;
  ASSERT_NE(heavy.find(gravity), heavy.npos);
  heavy.insert(heavy.find(gravity) + gravity.size(), "1e300, \"was\": ");
  write(sequence() / "lcs.json", heavy);
  refused("lcs.json: gravity_mps2 is not 0 or more and at most a million; correct it");
  const std::string width = "\"width_px\": 640";
  ASSERT_NE(settings.find(width), settings.npos);
  settings.replace(settings.find(width), width.size(), "\"width_px\": 8192");
  write(sequence() / "lcs.json", settings);
  refused("resolution is not as lcs.json of the sequence says; ");
  const fs::path sensor = sequence() / "mav0/cam0/sensor.yaml";
  fs::remove(sensor);
  refused("the calibration is of 8192 x 480 pixels, and the pictures have 640 x 480; ");
  fs::remove(sequence() / "lcs.json");
  const std::string lens =
      "resolution: [640, 480]\nintrinsics: [500, 500, 320, 240]\ndistortion_model: radtan\n"
      "distortion_coefficients: [0.1, 0, 0, 0]\n"
      "T_BS: [0, 0, 1, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 1]\n";
  const auto refused_lens = [&](const std::string& from, const std::string& to,
                                const std::string& expected) {
    std::string text = lens;
    text.replace(text.find(from), from.size(), to);
    write(sensor, text);
    refused("cam0/sensor.yaml:" + expected);
  };
  write(sensor, "T_BS: [1, 2\n");
  refused("sensor.yaml:");
  write(sensor, "rate_hz: often\n" + lens);
  refused("sensor.yaml:1: rate_hz: 'often' is not a number; ");
  refused_lens("[500, 500", "[0, 500", "1: a focal length of 0, 500 px");
  refused_lens("[500, 500", "[1e-300, 500", "1: a focal length of 1e-300, 500 px");
  refused_lens("[0.1, 0", "[1e300, 0", "4: distortion_coefficients is '1e300'; it must be");
  refused_lens("[0.1, 0", "[900, 0", "1: by its intrinsics and distortion the lens sees less than");
  refused_lens("[640, 480]", "[8192, 8192]", "1: the calibration is of 8192 x 8192 pixels, and");
  refused_lens("radtan", "fish", "1: the distortion 'fish' is not supported; give ");
}

}  // namespace
}  // namespace lcs::replay
