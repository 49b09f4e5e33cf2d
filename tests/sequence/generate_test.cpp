// `lcs generate` from its command line to its files, read by OpenCV and by code of the test.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <set>
#include <span>
#include <sstream>
#include <thread>
#include <tuple>

#include "scenarios/input/sha256.h"
#include "scenarios/load.h"
#include "sim/simulation.h"
#include "tests/sequence/rows.h"
#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/sequences.h"
#include "tests/tools/temporary_folder.h"
#include "tools/files/csv.h"
#include "tools/recording/recording_io.h"
#include "tools/sequence/sequence_folder.h"
#include "tools/sequence/true_flow.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

namespace fs = std::filesystem;
using test::bytes_in;
using test::CommandResult;
using test::run_lcs;

const std::string kCrossing = LCS_SCENARIOS_DIR "/crossing.yaml";
constexpr int kFrames = 4;
// A start far enough back that both movers are in view from the first frame on.
const std::vector<std::string> kSets{"ego.start=[-3 m, 0 m]", "image.samples=1"};

std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.insert(entry.path().lexically_relative(folder).string());
  }
  return files;
}

std::vector<std::string> arguments(std::vector<std::string> more) {
  std::vector<std::string> all{"generate", kCrossing, "--frames", std::to_string(kFrames)};
  for (const std::string& set : kSets) all.insert(all.end(), {"--set", set});
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// One sequence for all tests, and the simulation that it must match.
class Generated : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    home_ = std::make_unique<test::TemporaryFolder>();
    result_ = run_lcs(arguments({"--out", folder()}), {.folder = home_->path()});
    scenario_ = scenario::load(kCrossing, {.sets = kSets, .seed = {}});
    sim::Simulation simulation(scenario_);
    camera_ = simulation.calibration().camera;
    frames_.clear();
    for (int k = 0; k < kFrames; ++k) frames_.push_back(*simulation.next());
  }
  static void TearDownTestSuite() {
    home_.reset();
    frames_.clear();
  }
  static fs::path folder() { return home_->path() / "crossing"; }
  void SetUp() override { ASSERT_EQ(result_.exit_code, 0) << result_.err; }

  inline static std::unique_ptr<test::TemporaryFolder> home_;
  inline static CommandResult result_;
  inline static scenario::Scenario scenario_;
  inline static sim::Pinhole camera_;
  inline static std::vector<sim::Observation> frames_;
};

TEST_F(Generated, TheManifestHasEveryFileWithItsHashAndWhatTookPart) {
  const auto manifest = nlohmann::json::parse(read_file(folder() / kManifestFile));
  std::set<std::string> listed;
  for (const auto& [path, record] : manifest.at("files").items()) {
    listed.insert(path);
    EXPECT_EQ(record.at("sha256"), input::sha256_of_file(folder() / path)) << path;
    EXPECT_EQ(record.at("bytes"), fs::file_size(folder() / path)) << path;
  }
  std::set<std::string> there = files_in(folder());
  EXPECT_EQ(there.erase(kManifestFile), 1u);
  EXPECT_EQ(there.erase(".lcs-written"), 1u);
  EXPECT_EQ(listed, there);
  const auto& plan = manifest.at("plan");
  EXPECT_EQ(plan.at("scenario"), "crossing");
  EXPECT_EQ(plan.at("seed"), 1);
  EXPECT_EQ(plan.at("frames"), kFrames);
  EXPECT_EQ(plan.at("set"), kSets);
  EXPECT_NE(plan.at("renderer").get<std::string>().find("Mesa"), std::string::npos);
  EXPECT_FALSE(plan.at("mujoco").get<std::string>().empty());
  EXPECT_NE(plan.at("program").get<std::string>().find('('), std::string::npos) << "the commit";
  EXPECT_GT(manifest.at("checks").at("flow_px").at("compared"), 1000);
}

TEST_F(Generated, PicturesAreThoseOfTheSimulationToTheLastBit) {
  const auto rows = rows_of(folder() / "mav0/cam0/data.csv");
  ASSERT_EQ(rows.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    EXPECT_EQ(rows[k][0], std::to_string(kEpoch_ns + frames_[k].t_ns));
    const cv::Mat picture =
        cv::imread((folder() / "mav0/cam0/data" / rows[k][1]).string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(picture.type(), CV_8UC3);
    EXPECT_EQ(cv::norm(picture, frames_[k].image, cv::NORM_INF), 0);
  }
}

TEST_F(Generated, ReadingsAndPosesAreThoseOfTheSimulationToTheLastBit) {
  const auto number = [](const std::string& text) { return *files::number_in<double>(text); };
  const auto imu = rows_of(folder() / "mav0/imu0/data.csv");
  const auto truth = rows_of(folder() / "mav0/state_groundtruth_estimate0/data.csv");
  std::size_t row = 0;
  for (const sim::Observation& frame : frames_) {
    for (std::size_t i = 0; i < frame.imu.size(); ++i, ++row) {
      ASSERT_LT(row, imu.size());
      ASSERT_EQ(imu[row].size(), 7u);
      ASSERT_EQ(truth[row].size(), 17u) << "as tools expect of EuRoC's truth";
      EXPECT_EQ(imu[row][0], std::to_string(kEpoch_ns + frame.imu[i].t_ns));
      EXPECT_EQ(truth[row][0], imu[row][0]);
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        EXPECT_EQ(number(imu[row][1 + a]), frame.imu[i].gyro_radps[axis]);
        EXPECT_EQ(number(imu[row][4 + a]), frame.imu[i].accel_mps2[axis]);
        EXPECT_EQ(number(truth[row][1 + a]), frame.imu_truth[i].T_WS.p[axis]);
        EXPECT_EQ(number(truth[row][8 + a]), frame.imu_truth[i].v_WS_mps[axis]);
        EXPECT_EQ(number(truth[row][11 + a]), frame.imu_truth[i].gyro_bias_radps[axis]);
        EXPECT_EQ(number(truth[row][14 + a]), frame.imu_truth[i].accel_bias_mps2[axis]);
      }
      const Eigen::Quaterniond q(number(truth[row][4]), number(truth[row][5]),
                                 number(truth[row][6]), number(truth[row][7]));
      EXPECT_TRUE(q.toRotationMatrix().isApprox(frame.imu_truth[i].T_WS.R, 1e-12)) << "w x y z";
    }
  }
  EXPECT_EQ(row, imu.size());
  EXPECT_EQ(row, truth.size());
}

TEST_F(Generated, FlowReadByOpenCvIsTheMotionOfThePixels) {
  for (std::size_t k = 0; k + 1 < frames_.size(); ++k) {
    const TrueFlow motion = true_flow(camera_, frames_[k].truth, frames_[k].geom,
                                      {frames_[k + 1].truth.depth_m, frames_[k + 1].geom});
    const auto check = [&](const std::string& kind, const cv::Mat2f& truth, const cv::Mat1b& seen) {
      const cv::Mat flo =
          cv::readOpticalFlow(folder() / kind / "middlebury" / fmt::format("{:06}.flo", k));
      const cv::Mat3w kitti =
          cv::imread(folder() / kind / "kitti" / fmt::format("{:06}.png", k), cv::IMREAD_UNCHANGED);
      ASSERT_EQ(flo.size(), truth.size());
      ASSERT_EQ(kitti.size(), truth.size());
      int valid = 0, differ = 0;
      for (int y = 0; y < truth.rows; ++y) {
        for (int x = 0; x < truth.cols; ++x) {
          const cv::Vec2f& u = truth(y, x);
          const cv::Vec2f& read = flo.at<cv::Vec2f>(y, x);
          const bool is_known = !std::isnan(u[0]);
          if (is_known ? u != read : !(read[0] > 1e9F && read[1] > 1e9F)) ++differ;
          const cv::Vec3w& code = kitti(y, x);  // blue, green, red
          if (code[0] != seen(y, x)) ++differ;
          if (code[0] == 0) continue;
          ++valid;
          // Half the quantum of 1/64 px.
          if (std::abs((code[2] - 32768) / 64.0 - u[0]) > 1.0 / 128 ||
              std::abs((code[1] - 32768) / 64.0 - u[1]) > 1.0 / 128) {
            ++differ;
          }
        }
      }
      EXPECT_EQ(differ, 0) << kind;
      EXPECT_GT(valid, 200000) << kind;
    };
    check("flow", motion.full_px, motion.seen);
    check("flow_ego", motion.ego_px, motion.ego_seen);
  }
  EXPECT_FALSE(fs::exists(folder() / "flow/kitti" / fmt::format("{:06}.png", kFrames - 1)))
      << "nothing follows the last frame";
}

TEST_F(Generated, DepthReadByOpenCvIsThatOfTheSimulationToItsQuantum) {
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    const cv::Mat1w code =
        cv::imread(folder() / "depth" / fmt::format("{:06}.png", k), cv::IMREAD_UNCHANGED);
    const cv::Mat1f& depth = frames_[k].truth.depth_m;
    ASSERT_EQ(code.size(), depth.size());
    double worst = 0;
    for (int y = 0; y < code.rows; ++y) {
      for (int x = 0; x < code.cols; ++x) {
        worst = std::max(worst, std::abs(code(y, x) / 256.0 - depth(y, x)));
      }
    }
    EXPECT_LE(worst, 1.0 / 512 + 1e-6);
  }
}

TEST_F(Generated, LandmarksAreTheCornersAndTheTruthOfARun) {
  std::vector<std::string> run{"run",
                               kCrossing,
                               "--set",
                               fmt::format("frames={}", kFrames),
                               "--no-video",
                               "--out",
                               home_->path() / "run"};
  for (const std::string& set : kSets) run.insert(run.end(), {"--set", set});
  ASSERT_EQ(run_lcs(run, {.folder = home_->path()}).exit_code, 0);
  const recording::Recording recording = recording::read_recording(home_->path() / "run");
  const auto rows = rows_of(folder() / "landmarks.csv");
  std::size_t row = 1;  // after the header
  const auto equal = [](const std::string& text, double value) {
    return std::isfinite(value) ? files::number_in<double>(text) == value : text.empty();
  };
  std::set<std::string> labels;
  for (const recording::FrameRecord& frame : recording.frames) {
    for (std::size_t i = 0; i < frame.corners_px.size(); ++i, ++row) {
      ASSERT_LT(row, rows.size());
      const auto& fields = rows[row];
      ASSERT_EQ(fields.size(), 11u);
      const sim::CornerTruth& truth = frame.corner_truth[i];
      EXPECT_EQ(fields[0], std::to_string(frame.index));
      EXPECT_TRUE(equal(fields[1], frame.corners_px[i].x()));
      EXPECT_TRUE(equal(fields[2], frame.corners_px[i].y()));
      EXPECT_EQ(fields[3], std::to_string(truth.object));
      labels.insert(fields[9]);
      if (truth.label == sim::Label::none) continue;
      EXPECT_TRUE(equal(fields[4], truth.depth_m));
      EXPECT_TRUE(equal(fields[5], truth.motion_px.x()));
      EXPECT_TRUE(equal(fields[6], truth.motion_px.y()));
      EXPECT_TRUE(equal(fields[7], truth.static_motion_px.x()));
      EXPECT_TRUE(equal(fields[8], truth.static_motion_px.y()));
      EXPECT_EQ(fields[9], (std::vector{"none", "fixed", "indistinct",
                                        "rebel"})[static_cast<std::size_t>(truth.label)]);
    }
  }
  EXPECT_EQ(row, rows.size());
  EXPECT_TRUE(labels.contains("rebel") && labels.contains("fixed"));
}

TEST_F(Generated, TrajectoriesAreInTheirOwnFormatsToTheLastBit) {
  std::ifstream file(folder() / "tum/camera.txt");
  for (const sim::Observation& frame : frames_) {
    std::string line;
    ASSERT_TRUE(std::getline(file, line));
    EXPECT_EQ(std::count(line.begin(), line.end(), ' '), 7) << "single spaces, none at the end";
    const sim::Pose& T_WC = frame.truth.now.T_WC;
    EXPECT_TRUE(line.starts_with(
        fmt::format("1000000000.{:09} {} {} {} ", frame.t_ns, T_WC.p.x(), T_WC.p.y(), T_WC.p.z())))
        << line;
    double t = 0;
    Eigen::Vector3d p;
    Eigen::Quaterniond q;
    std::istringstream(line) >> t >> p.x() >> p.y() >> p.z() >> q.x() >> q.y() >> q.z() >> q.w();
    EXPECT_TRUE(q.toRotationMatrix().isApprox(T_WC.R, 1e-12)) << "x y z w";
  }
  EXPECT_EQ(rows_of(folder() / "mav0/cam0/pose.csv").size(), frames_.size());
}

TEST_F(Generated, BoxesOfMotChallengeAreThoseOfTheTruthCountedFromOne) {
  const auto rows = rows_of(folder() / "mot/crossing/gt/gt.txt");
  std::size_t row = 0;
  std::set<std::string> moving;
  for (const sim::Observation& frame : frames_) {
    for (const sim::ObjectTruth& object : frame.objects) {
      ASSERT_LT(row, rows.size());
      const auto& fields = rows[row++];
      ASSERT_EQ(fields.size(), 9u);
      const std::vector<std::string> expected{std::to_string(frame.index + 1),
                                              std::to_string(object.object),
                                              std::to_string(object.left + 1),
                                              std::to_string(object.top + 1),
                                              std::to_string(object.right - object.left),
                                              std::to_string(object.bottom - object.top),
                                              object.moving ? "1" : "0"};
      EXPECT_EQ(std::vector(fields.begin(), fields.begin() + 7), expected);
      if (object.moving) moving.insert(fields[7]);
      EXPECT_EQ(files::number_in<double>(fields[8]), object.visible_fraction);
    }
  }
  EXPECT_EQ(row, rows.size());
  EXPECT_EQ(moving, (std::set<std::string>{"1", "8"})) << "a pedestrian and a box";
  const std::string info = read_file(folder() / "mot/crossing/seqinfo.ini");
  EXPECT_NE(info.find("seqLength=4\n"), std::string::npos) << info;
  EXPECT_EQ(read_file(folder() / "mot/crossing/img1/000001.png"),
            read_file(folder() / picture_path(kEpoch_ns)));
}

TEST_F(Generated, MasksOfCocoAndDavisAreTheObjectsPixelByPixel) {
  const auto coco = nlohmann::json::parse(read_file(folder() / "coco/annotations.json"));
  ASSERT_EQ(coco.at("images").size(), frames_.size());
  std::set<int> ids;
  std::size_t annotation = 0;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    EXPECT_TRUE(fs::exists(folder() / coco["images"][k]["file_name"].get<std::string>()));
    const cv::Mat1i& object = frames_[k].truth.object;
    const fs::path davis =
        folder() / "davis/Annotations/480p/crossing" / fmt::format("{:05}.png", k);
    const cv::Mat3b colours = cv::imread(davis.string(), cv::IMREAD_COLOR);
    ASSERT_EQ(colours.size(), object.size());
    for (const sim::ObjectTruth& truth : frames_[k].objects) {
      const auto& a = coco["annotations"][annotation++];
      EXPECT_TRUE(ids.insert(a["id"].get<int>()).second && a["id"] >= 1);
      EXPECT_EQ(a["image_id"], coco["images"][k]["id"]);
      EXPECT_EQ(a["bbox"], (std::vector{truth.left, truth.top, truth.right - truth.left,
                                        truth.bottom - truth.top}));
      EXPECT_EQ(a["area"], truth.visible_px);
      // Runs down the columns, alternating between background and object.
      int place = 0, wrong = 0;
      bool is_object = false;
      for (const int length : a["segmentation"]["counts"].get<std::vector<int>>()) {
        for (const int end = place + length; place < end; ++place) {
          const bool is_there = object(place % object.rows, place / object.rows) == truth.object;
          wrong += is_there != is_object;
        }
        is_object = !is_object;
      }
      EXPECT_EQ(place, static_cast<int>(object.total()));
      EXPECT_EQ(wrong, 0);
      // Each object has one colour of DAVIS's palette, constant over its area.
      cv::Mat1b is_truth;
      cv::compare(object, truth.object, is_truth, cv::CMP_EQ);
      cv::Scalar mean, deviation;
      cv::meanStdDev(colours, mean, deviation, is_truth);
      EXPECT_LT(cv::norm(deviation), 1e-3) << "but for rounding; one other pixel makes it 0.1";
    }
  }
  EXPECT_EQ(annotation, coco.at("annotations").size());
}

TEST_F(Generated, TheReadmeNamesEveryObjectAndEveryFile) {
  const std::string readme = read_file(folder() / "README.md");
  for (const char* word :
       {"crossing_box", "crossing_pedestrian", "sensor.yaml", "depth/<k>.png", "landmarks.csv",
        "not** the\n  length of the ray", "x right, y down", "640x480", "10 Hz"}) {
    EXPECT_NE(readme.find(word), std::string::npos) << word;
  }
}

TEST_F(Generated, TheSameAgainIsCheckedAndLeftAlone) {
  const auto before = bytes_in(folder());
  const CommandResult again = run_lcs(arguments({"--out", folder()}), {.folder = home_->path()});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.out.find("is complete"), std::string::npos) << again.out;
  EXPECT_EQ(bytes_in(folder()), before);
}

// ---- Other commands

class Generate : public testing::Test {
 protected:
  CommandResult generate(std::vector<std::string> more) {
    return run_lcs(arguments(std::move(more)), {.folder = home_.path()});
  }
  fs::path folder() const { return home_.path() / "sequence"; }
  /// Where the frames are until all are finished.
  fs::path unfinished() const { return home_.path() / "sequence.unfinished"; }
  const test::TemporaryFolder home_;
};

TEST_F(Generate, OnlyWhatIsAskedForIsWritten) {
  ASSERT_EQ(generate({"--out", folder(), "--formats", "depth", "--quiet"}).exit_code, 0);
  for (const std::string& file : files_in(folder())) {
    EXPECT_TRUE(file.starts_with("depth/") || file.starts_with("mav0/cam0/data") ||
                (std::set<std::string>{".lcs-written", "README.md", "lcs.json", "manifest.json",
                                       "scenario.yaml"})
                    .contains(file))
        << file;
  }
}

/// The rover turns through a heading of 180 degrees, at which w is 0.
TEST_F(Generate, QuaternionsKeepTheirSignFromRowToRow) {
  const CommandResult made = generate({"--formats", "euroc,tum", "--set", "ego.heading=179 deg",
                                       "--set", "ego.yaw_rate=20 deg/s", "--out", "sequence"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const fs::path folder = home_.path() / "sequence";
  const auto quaternions = [](const std::vector<std::vector<std::string>>& rows) {
    std::vector<Eigen::Vector4d> all;
    for (const auto& row : rows) {
      Eigen::Vector4d& q = all.emplace_back();
      for (int i = 0; i < 4; ++i) q[i] = std::stod(row.at(static_cast<std::size_t>(4 + i)));
    }
    return all;
  };
  std::vector<std::vector<std::string>> tum;
  std::ifstream file(folder / "tum/imu.txt");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    tum.emplace_back(std::istream_iterator<std::string>(words),
                     std::istream_iterator<std::string>());
  }
  const auto euroc = quaternions(rows_of(folder / "mav0/state_groundtruth_estimate0/data.csv"));
  const auto of_tum = quaternions(tum);
  ASSERT_EQ(euroc.size(), of_tum.size());
  ASSERT_GT(euroc.size(), 20u);
  bool is_negative = false;
  for (std::size_t i = 0; i < euroc.size(); ++i) {
    EXPECT_NEAR(euroc[i].norm(), 1, 1e-12);
    const Eigen::Vector4d xyzw(euroc[i][1], euroc[i][2], euroc[i][3], euroc[i][0]);
    EXPECT_EQ(of_tum[i], xyzw);
    is_negative |= euroc[i][0] < 0;
    if (i > 0) {
      EXPECT_GT(euroc[i].dot(euroc[i - 1]), 0.99) << "row " << i;
    }
  }
  EXPECT_TRUE(is_negative) << "without the rule w >= 0 would hold, by a jump";
}

/// The rows of a rolling shutter are later than the stamp of their picture.
TEST_F(Generate, SensorsAndTruthReachBeyondTheLastRow) {
  const auto rows_by = [&](const std::string& out, const std::string& frames) {
    const CommandResult made =
        run_lcs({"generate", kCrossing, "--formats", "euroc", "--frames", frames, "--set",
                 "camera.rolling_shutter=30 ms", "--set", "image.samples=1", "--out", out},
                {.folder = home_.path()});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    const fs::path mav0 = home_.path() / out / "mav0";
    return std::tuple(rows_of(mav0 / "cam0/data.csv"), rows_of(mav0 / "imu0/data.csv"),
                      rows_of(mav0 / "state_groundtruth_estimate0/data.csv"));
  };
  const auto [pictures, imu, truth] = rows_by("short", "2");
  const auto [more_pictures, more_imu, more_truth] = rows_by("long", "3");
  ASSERT_FALSE(pictures.empty() || imu.empty() || truth.empty() || more_imu.empty());
  const auto stamp_ns = [](const std::vector<std::string>& row) { return std::stoll(row.front()); };
  const std::int64_t last_row_ns = stamp_ns(pictures.back()) + 30'000'000;
  const std::int64_t step_ns = stamp_ns(imu[1]) - stamp_ns(imu[0]);
  for (const auto& [rows, more] : {std::tie(imu, more_imu), std::tie(truth, more_truth)}) {
    EXPECT_GE(stamp_ns(rows.back()), last_row_ns);
    EXPECT_LT(stamp_ns(rows.back()), last_row_ns + step_ns);
    ASSERT_GT(more.size(), rows.size());
    EXPECT_TRUE(std::ranges::equal(rows, std::span(more).first(rows.size())))
        << "the readings are those of a longer sequence";
  }
}

TEST_F(Generate, TheScenarioInASequenceMakesTheSameSequence) {
  ASSERT_EQ(generate({"--out", folder(), "--formats", "euroc", "--quiet", "--seed", "7", "--set",
                      "ego.speed=0.9 m/s", "--set", "image.noise={full_well: 9000, read: 5}"})
                .exit_code,
            0);
  const fs::path again = home_.path() / "again";
  ASSERT_EQ(run_lcs({"generate", folder() / "scenario.yaml", "--out", again, "--formats", "euroc",
                     "--quiet"},
                    {.folder = home_.path()})
                .exit_code,
            0);
  for (const char* file : {"mav0/imu0/data.csv", "mav0/cam0/pose.csv", "mav0/cam0/data.csv"}) {
    EXPECT_EQ(read_file(folder() / file), read_file(again / file)) << file;
  }
  EXPECT_EQ(read_file(folder() / picture_path(kEpoch_ns)),
            read_file(again / picture_path(kEpoch_ns)));
}

TEST_F(Generate, EglGivesTheSameBytesAsOsmesa) {
  const auto pictures_by = [&](const char* library) {
    ::setenv("LCS_GL", library, 1);
    const fs::path out = home_.path() / library;
    const CommandResult result = generate({"--out", out, "--formats", "depth", "--quiet"});
    ::unsetenv("LCS_GL");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return bytes_in(out);
  };
  const auto osmesa = pictures_by("osmesa"), egl = pictures_by("egl");
  EXPECT_GT(osmesa.size(), 2 * kFrames);
  EXPECT_EQ(osmesa, egl);

  ::setenv("LCS_GL", "vulkan", 1);
  const CommandResult wrong = generate({"--out", folder(), "--quiet"});
  ::unsetenv("LCS_GL");
  EXPECT_NE(wrong.exit_code, 0);
  EXPECT_NE(wrong.err.find("set it to osmesa, egl or gpu"), std::string::npos) << wrong.err;
}

TEST_F(Generate, AFolderThatHoldsSomethingElseIsRefusedAndLeftAsItIs) {
  fs::create_directory(folder());
  test::write(folder() / "thesis.tex", "years of work");
  const CommandResult result = generate({"--out", folder()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("thesis.tex is not a file that lcs has written"), std::string::npos)
      << result.err;
  EXPECT_EQ(files_in(folder()), std::set<std::string>{"thesis.tex"});
}

TEST_F(Generate, TwoFloorsAtOneHeightThatThePictureMixesAreNamedByTheirLines) {
  test::write(home_.path() / "floors.xml", R"(<mujoco><asset>
    <texture name="fine" type="2d" builtin="checker" rgb1=".2 .3 .4" rgb2=".1 .2 .3" width="64" height="64"/>
    <texture name="light" type="2d" builtin="checker" rgb1=".7 .6 .5" rgb2=".5 .4 .3" width="64" height="64"/>
    <material name="fine" texture="fine" texuniform="true" texrepeat="2 2"/>
    <material name="light" texture="light" texuniform="true" texrepeat="3 3"/></asset>
    <worldbody><light pos="0 0 3" directional="true"/>
    <geom name="floor" type="plane" size="0 0 .1" material="fine"/>
    <geom name="carpet" type="plane" size="12 9 .1" material="light"/>
    <body name="crate" pos="3 .5 .3"><geom type="box" size=".3 .3 .3"/></body></worldbody></mujoco>)");
  test::write(home_.path() / "floors.yaml",
              "scene: floors.xml\nframes: 4\nego: {start: [0 m, 0 m], speed: 0.5 m/s}\n"
              "camera: {size: [320, 240]}\nimage: {noise: none}\n");
  const CommandResult result =
      run_lcs({"generate", "floors.yaml", "--out", folder().string(), "--formats", "depth"},
              {.folder = home_.path()});
  EXPECT_EQ(result.exit_code, 2);
  for (const char* words :
       {"do not look as they do where the flow leads; the truth does not agree", "perhaps as ",
        "floors.xml:7: geom 'floor'", "floors.xml:8: geom 'carpet'", "move one by a millimetre"}) {
    EXPECT_NE(result.err.find(words), std::string::npos) << words << "\n" << result.err;
  }
}

TEST_F(Generate, SettingsThatTheFilterDoesNotTakeAreRefusedBeforeTheFolderIsMade) {
  for (const char* setting : {"filter.gap=1", "filter.circle.mu_0=20", "filter.circle.gap=wide"}) {
    const CommandResult result = generate({"--out", folder(), "--set", setting});
    EXPECT_EQ(result.exit_code, 2) << setting;
    EXPECT_NE(result.err.find(std::string("--set ") + setting), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(folder()));
  }
}

TEST_F(Generate, AnotherSequenceIsRefusedAndToldApart) {
  ASSERT_EQ(generate({"--out", folder(), "--formats", "depth", "--quiet"}).exit_code, 0);
  const auto before = bytes_in(folder());
  const std::vector<std::pair<std::vector<std::string>, std::string>> others{
      {{"--formats", "depth", "--seed", "2"}, "seed differs ('1' and '2')"},
      {{"--formats", "depth,euroc"}, "formats differs"},
      {{"--formats", "depth", "--set", "ego.speed=1 m/s"}, "set differs"},
  };
  for (const auto& [more, expected] : others) {
    std::vector<std::string> all{"--out", folder()};
    all.insert(all.end(), more.begin(), more.end());
    const CommandResult result = generate(all);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(expected), std::string::npos) << result.err;
  }
  EXPECT_EQ(bytes_in(folder()), before);
}

TEST_F(Generate, APlanThatCannotBeReadIsRefusedWithItsPlace) {
  const std::string lists = std::string(100'000, '[') + std::string(100'000, ']');
  const std::vector<std::pair<std::string, std::string>> plans{
      {"{\"formats\": " + lists + "}", ":1: lists and objects are nested more than 64 deep"},
      {std::string(100'000, '['), ":1: lists and objects are nested more than 64 deep"},
      {"{\"formats\":\n\n", ":3: not JSON at byte "},
      {"", ":1: not JSON at byte 1; "},
      {"{\"formats\": 5}", ": read is missing; "},
  };
  ASSERT_EQ(generate({"--out", folder(), "--shard", "1/2", "--quiet"}).exit_code, 0);
  const fs::path file = unfinished() / "work" / "plan.json";
  for (const auto& [plan, expected] : plans) {
    test::write(file, plan);
    const CommandResult result = generate({"--out", folder()});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(file.string() + expected), std::string::npos) << result.err;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(folder()));
  }
}

TEST_F(Generate, DamageToAFinishedSequenceIsFound) {
  ASSERT_EQ(generate({"--out", folder(), "--formats", "depth", "--quiet"}).exit_code, 0);
  test::write(folder() / "depth/000001.png", "not what it was");
  fs::remove(folder() / "depth/000002.png");
  const CommandResult result = generate({"--out", folder(), "--formats", "depth"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("000001.png was changed since"), std::string::npos) << result.err;
}

TEST_F(Generate, ABagWithoutRosbagsIsRefusedWithItsInstallation) {
  test::write(home_.path() / "python" / "rosbags.py", "raise ImportError\n");
  ASSERT_EQ(::setenv("PYTHONPATH", (home_.path() / "python").c_str(), 1), 0);
  const CommandResult result = generate({"--out", folder(), "--formats", "mcap"});
  ::unsetenv("PYTHONPATH");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("writing bags needs the Python package rosbags; install it with: "),
            std::string::npos)
      << result.err;
  EXPECT_FALSE(fs::exists(folder()));
}

TEST_F(Generate, AUseNamesItsFormats) {
  const std::vector<std::pair<std::string, std::set<std::string>>> uses{
      {"vio", {"kalibr", "mav0", "tum"}},
      {"detection", {"coco", "davis", "mav0", "mot"}},
      {"flow", {"depth", "flow", "flow_ego", "mav0"}}};
  for (const auto& [use, expected] : uses) {
    const fs::path out = home_.path() / use;
    const CommandResult result = generate({"--out", out, "--for", use});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    std::set<std::string> folders;
    for (const auto& entry : fs::directory_iterator(out)) {
      if (entry.is_directory()) folders.insert(entry.path().filename().string());
    }
    EXPECT_EQ(folders, expected);
  }
  EXPECT_NE(generate({"--out", folder(), "--for", "slam"}).err.find("vio, detection or flow"),
            std::string::npos);
  EXPECT_EQ(generate({"--out", folder(), "--for", "vio", "--formats", "tum"}).exit_code, 2);
}

std::uintmax_t bytes_of(const fs::path& folder) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) bytes += entry.file_size() / entry.hard_link_count();
  }
  return bytes;
}

TEST_F(Generate, TheSizeIsToldToAFactorOfTwo) {
  const std::vector<std::vector<std::string>> cases{
      {"--formats", "flow,depth"},
      {"--formats", "landmarks"},
      {"--formats", "euroc,tum,kalibr,kitti", "--set", "camera.size=[160, 120]"},
      {"--for", "detection", "--set", "image.light=2 lx", "--set", "image.exposure=20 ms"},
      {"--formats", "davis", "--set", "image.noise=none"},
      {"--formats", "tum", "--set", "image.jpeg=70"}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    std::vector<std::string> more{"--out", home_.path() / std::to_string(i)};
    more.insert(more.end(), cases[i].begin(), cases[i].end());
    const CommandResult result = generate(more);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::size_t at = result.err.find(": about ");
    ASSERT_NE(at, std::string::npos) << result.err;
    const double told = 1e6 * std::stod(result.err.substr(at + 8));
    const auto real = static_cast<double>(bytes_of(home_.path() / std::to_string(i)));
    EXPECT_LT(std::abs(std::log2(told / real)), 1) << i << ": " << told << " and not " << real;
  }
}

TEST_F(Generate, ASequenceThatTheDiskHasNoRoomForIsRefusedAtOnce) {
  const CommandResult result = run_lcs({"generate", kCrossing, "--out", folder(), "--set",
                                        "frames=1000000", "--set", "camera.size=[8192, 8192]"},
                                       {.folder = home_.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find(" free; make room, or choose fewer --formats"), std::string::npos)
      << result.err;
  EXPECT_FALSE(fs::exists(folder()));
}

TEST_F(Generate, ASequenceThatFailsAtItsStartLeavesNothing) {
  const std::vector<std::vector<std::string>> failing{
      {"--set", "actors.crossing_box={body: no_such_body, trajectory: {still: {}}}"},
      {"--set", "actors.crossing_box.trajectory={line: {from: [-3, 0], heading: 0, speed: 0}}"},
      {"--set", "camera.distortion=[-0.9, 0, 0, 0, 0]"},
      {"--set", "camera.distortion=[-0.9, 0, 0, 0, 0]", "--jobs", "2"},
      {"--set", "camera.distortion=[-0.1, 0, 0, 0, 0]", "--formats", "kitti"},
      {"--add"}};
  for (const std::vector<std::string>& why : failing) {
    std::vector<std::string> more{"--out", home_.path() / "new" / "place"};
    more.insert(more.end(), why.begin(), why.end());
    const CommandResult result = generate(more);
    EXPECT_EQ(result.exit_code, 2) << why.back();
    EXPECT_FALSE(fs::exists(home_.path() / "new")) << result.err;
  }
  fs::create_directory(folder());
  EXPECT_EQ(generate({"--out", folder(), "--add"}).exit_code, 2);
  EXPECT_TRUE(fs::is_empty(folder())) << "a folder that was there stays";
}

TEST_F(Generate, FormatsThatAreAddedMakeTheSequenceOfAllOfThem) {
  const auto times_in = [&] {
    std::map<std::string, fs::file_time_type> times;
    for (const std::string& file : files_in(folder())) {
      times[file] = fs::last_write_time(folder() / file);
    }
    return times;
  };
  ASSERT_EQ(generate({"--out", folder(), "--formats", "depth,mot", "--quiet"}).exit_code, 0);
  const auto earlier = times_in();
  for (const char* jobs : {"1", "2"}) {
    const std::string more = std::string(jobs) == "1" ? "coco,depth" : "tum";
    const CommandResult added =
        generate({"--out", folder(), "--formats", more, "--add", "--jobs", jobs});
    ASSERT_EQ(added.exit_code, 0) << added.err;
    EXPECT_NE(added.err.find(" more"), std::string::npos) << added.err;
  }
  for (const auto& [file, time] : times_in()) {
    if (file == "README.md" || file == ".lcs-written" || file == kManifestFile ||
        !earlier.contains(file)) {
      continue;
    }
    EXPECT_EQ(time, earlier.at(file)) << file << " was written again";
  }
  const fs::path whole = home_.path() / "whole";
  ASSERT_EQ(generate({"--out", whole, "--formats", "tum,mot,coco,depth", "--quiet"}).exit_code, 0);
  EXPECT_TRUE(bytes_in(folder()) == bytes_in(whole));
  const CommandResult again = generate({"--out", folder(), "--formats", "tum", "--add"});
  EXPECT_NE(again.out.find("is complete"), std::string::npos) << again.out << again.err;

  const std::vector<std::pair<std::vector<std::string>, std::string>> others{
      {{"--seed", "2"}, "seed differs"}, {{"--set", "ego.speed=1 m/s"}, "set differs"}};
  for (const auto& [other, expected] : others) {
    std::vector<std::string> more{"--out", folder(), "--formats", "kalibr", "--add"};
    more.insert(more.end(), other.begin(), other.end());
    const CommandResult result = generate(more);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(expected), std::string::npos) << result.err;
  }
  EXPECT_TRUE(bytes_in(folder()) == bytes_in(whole));
  test::write(folder() / "depth/000001.png", "not as it was");
  const CommandResult damaged = generate({"--out", folder(), "--formats", "kalibr", "--add"});
  EXPECT_EQ(damaged.exit_code, 2);
  EXPECT_NE(damaged.err.find("000001.png was changed since"), std::string::npos) << damaged.err;
}

TEST_F(Generate, AFormatThatIsNotAddedToItsEndIsAddedByTheSameCommand) {
  ASSERT_EQ(generate({"--out", folder(), "--formats", "depth", "--quiet"}).exit_code, 0);
  const std::vector<std::string> add{"--out", folder(), "--formats", "flow", "--add", "--quiet"};
  test::Command command(arguments(add), {.folder = home_.path()});
  while (!test::has_frame(unfinished()) && command.is_running()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  command.send(SIGKILL);
  ASSERT_NE(command.wait().exit_code, 0) << "it was done before it could be stopped";
  ASSERT_EQ(generate(add).exit_code, 0);
  const fs::path whole = home_.path() / "whole";
  ASSERT_EQ(generate({"--out", whole, "--formats", "flow,depth", "--quiet"}).exit_code, 0);
  EXPECT_TRUE(bytes_in(folder()) == bytes_in(whole));
}

// ---- Stopping, resuming, parts

/// The same sequence, generated in one run.
class GenerateInParts : public Generate {
 protected:
  std::map<std::string, std::string> in_one_go() {
    EXPECT_EQ(generate({"--out", home_.path() / "whole", "--quiet"}).exit_code, 0);
    return bytes_in(home_.path() / "whole");
  }
};

TEST_F(GenerateInParts, AKilledRunGoesOnToTheSameBytes) {
  const auto whole = in_one_go();
  for (const int signal : {SIGKILL, SIGTERM}) {
    test::Command command(arguments({"--out", folder(), "--quiet"}), {.folder = home_.path()});
    while (!test::has_frame(unfinished()) && command.is_running()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    command.send(signal);
    const CommandResult stopped = command.wait();
    ASSERT_NE(stopped.exit_code, 0) << "it was done before it could be stopped";
    EXPECT_FALSE(fs::exists(folder()));
    if (signal == SIGTERM) {
      EXPECT_EQ(stopped.exit_code, 130);
      EXPECT_NE(stopped.err.find("goes on from there"), std::string::npos) << stopped.err;
    }
    // Remains of an interruption: a partial file, and a truncated one.
    test::write(unfinished() / "work/other-4711.partial", "half");
    fs::resize_file(unfinished() / "in/depth/000000.png", 100);
    const CommandResult result = generate({"--out", folder(), "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(bytes_in(folder()) == whole);
    EXPECT_FALSE(fs::exists(unfinished()));
    fs::remove_all(folder());
  }
}

TEST_F(GenerateInParts, FilesOfTheUserAreNeverReplacedAndBecomeNoPartOfTheSequence) {
  ASSERT_EQ(generate({"--out", folder(), "--shard", "1/2", "--quiet"}).exit_code, 0);
  for (const fs::path& file : {folder() / "thesis.tex", folder() / "README.md",
                               unfinished() / "in" / "depth" / "thesis.tex"}) {
    test::write(file, "precious");
    const CommandResult result = generate({"--out", folder(), "--quiet"});
    EXPECT_EQ(result.exit_code, 2) << file;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    EXPECT_EQ(test::read(file), "precious");
    fs::remove_all(folder());
    fs::remove(file);
  }
  EXPECT_EQ(generate({"--out", folder(), "--quiet"}).exit_code, 0);
  EXPECT_TRUE(bytes_in(folder()) == in_one_go());
}

TEST_F(GenerateInParts, ADiskThatFillsUpIsToldInOneLineAndWithRoomItGoesOnToTheSameBytes) {
  const auto whole = in_one_go();
  const auto all = arguments({"--out", folder(), "--quiet"});
  const CommandResult full = run_lcs(all, {.folder = home_.path(), .largest_file = 200'000});
  EXPECT_EQ(full.exit_code, 2);
  EXPECT_NE(full.err.find("File too large; raise the limit"), std::string::npos) << full.err;
  EXPECT_EQ(std::count(full.err.begin(), full.err.end(), '\n'), 1) << full.err;
  EXPECT_FALSE(fs::exists(folder()));
  EXPECT_EQ(run_lcs(all, {.folder = home_.path()}).exit_code, 0);
  EXPECT_TRUE(bytes_in(folder()) == whole);
}

TEST_F(GenerateInParts, TwoAtATimeIntoOneFolderLeaveAWholeSequence) {
  const auto whole = in_one_go();
  const auto all = arguments({"--out", folder(), "--quiet"});
  test::Command one(all, {.folder = home_.path()});
  test::Command other(all, {.folder = home_.path()});
  const int first = one.wait().exit_code, second = other.wait().exit_code;
  EXPECT_TRUE(first == 0 && second == 0) << first << ' ' << second;
  EXPECT_EQ(run_lcs(all, {.folder = home_.path()}).exit_code, 0);
  EXPECT_TRUE(bytes_in(folder()) == whole);
}

TEST_F(GenerateInParts, PartsByOtherProcessesInAnyOrderAreTheSameBytes) {
  const auto whole = in_one_go();
  for (const char* part : {"3/3", "1/3", "2/3"}) {
    const CommandResult result = generate({"--out", folder(), "--shard", part});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_FALSE(fs::exists(folder()));
  }
  ASSERT_EQ(generate({"--out", folder(), "--quiet"}).exit_code, 0);
  EXPECT_TRUE(bytes_in(folder()) == whole);
  ASSERT_EQ(generate({"--out", home_.path() / "jobs", "--jobs", "2", "--quiet"}).exit_code, 0);
  EXPECT_TRUE(bytes_in(home_.path() / "jobs") == whole);
}

/// Each exposure depends on the picture before it, which a part that begins later renders, too.
TEST_F(GenerateInParts, ExposuresAreThoseOfTheSimulationWhateverMakesThem) {
  const auto make = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> all{"generate",
                                 LCS_SCENARIOS_DIR "/examples/walkers.yaml",
                                 "--frames",
                                 "4",
                                 "--formats",
                                 "tum",
                                 "--set",
                                 "camera.size=[160, 120]",
                                 "--quiet",
                                 "--out",
                                 home_.path() / name};
    all.insert(all.end(), more.begin(), more.end());
    const CommandResult result = run_lcs(all, {.folder = home_.path()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  make("whole", {});
  make("parts", {"--shard", "2/2"});
  make("parts", {"--shard", "1/2"});
  make("parts", {});
  EXPECT_TRUE(bytes_in(home_.path() / "whole") == bytes_in(home_.path() / "parts"));
  std::string expected = "#timestamp [ns],exposure [s],gain []\n";
  sim::Simulation simulation(
      scenario::load(LCS_SCENARIOS_DIR "/examples/walkers.yaml",
                     {.sets = {"camera.size=[160, 120]", "frames=4"}, .seed = {}}));
  while (const auto o = simulation.next()) {
    expected +=
        fmt::format("{},{},{}\n", kEpoch_ns + o->t_ns, o->exposure.time_s, o->exposure.gain);
  }
  EXPECT_EQ(read_file(home_.path() / "whole" / "mav0/cam0/exposure.csv"), expected);
  EXPECT_NE(read_file(home_.path() / "whole" / "README.md").find("exposure.csv"),
            std::string::npos);
}

TEST_F(GenerateInParts, RoverCollisionIsToldOnceWithAnyNumberOfJobs) {
  const std::vector<std::string> into{
      "--set",
      "ego.speed=3 m/s",
      "--formats",
      "depth",
      "--set",
      "actors.crossing_box.trajectory.line={from: [-2.3 m, 0 m], heading: 90 deg, speed: 0}"};
  const auto told = [](const CommandResult& result) {
    const std::string sign = "the rover runs into actor 'crossing_box'";
    int count = 0;
    for (std::size_t at = result.err.find(sign); at != std::string::npos;
         at = result.err.find(sign, at + 1)) {
      ++count;
    }
    return count;
  };
  for (const char* jobs : {"1", "2"}) {
    std::vector<std::string> all{"--out", home_.path() / jobs, "--jobs", jobs, "--quiet"};
    all.insert(all.end(), into.begin(), into.end());
    const CommandResult result = generate(all);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(told(result), 1) << jobs << ": " << result.err;
  }
  fs::create_directory(home_.path() / "scenarios");
  fs::copy_file(kCrossing, home_.path() / "scenarios" / "one.yaml");
  std::vector<std::string> suite{"generate", "--suite", home_.path() / "scenarios",
                                 "--frames", "4",       "--set",
                                 kSets[0],   "--out",   home_.path() / "suite"};
  suite.insert(suite.end(), into.begin(), into.end());
  const CommandResult result = run_lcs(suite, {.folder = home_.path()});
  EXPECT_NE(result.err.find("warning: one-seed1: the rover runs into"), std::string::npos)
      << result.err;
}

TEST_F(GenerateInParts, ShardsOfASuiteAreTheSuiteAndOneBrokenScenarioDoesNotStopTheOthers) {
  test::write(home_.path() / "scenarios/broken.yaml", "frames: many\n");
  for (const char* name : {"a", "b", "c"}) {
    fs::copy_file(kCrossing, home_.path() / "scenarios" / fmt::format("{}.yaml", name));
  }
  const auto suite = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> all{"generate", "--suite", home_.path() / "scenarios",
                                 "--frames", "2",       "--formats",
                                 "depth",    "--out",   home_.path() / out};
    all.insert(all.end(), more.begin(), more.end());
    return run_lcs(all, {.folder = home_.path()});
  };
  const CommandResult all = suite("all", {"--jobs", "2"});
  EXPECT_EQ(all.exit_code, 2);
  EXPECT_NE(all.err.find("broken.yaml:1"), std::string::npos) << all.err;
  for (const char* part : {"1/2", "2/2"}) suite("parts", {"--shard", part});
  const auto whole = bytes_in(home_.path() / "all");
  EXPECT_TRUE(whole.contains("a-seed1/manifest.json") && whole.contains("c-seed1/manifest.json"));
  EXPECT_TRUE(bytes_in(home_.path() / "parts") == whole);
}

TEST_F(Generate, TheWorldsOfAllPartsAreThoseOfTheWhole) {
  const auto worlds = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> all{"generate",        "--worlds", "train",     "--count", "2",
                                 "--frames",        "2",        "--formats", "tum",     "--out",
                                 home_.path() / out};
    all.insert(all.end(), more.begin(), more.end());
    return run_lcs(all, {.folder = home_.path()});
  };
  const CommandResult second = worlds("parts", {"--shard", "2/2"});
  EXPECT_EQ(second.exit_code, 0) << second.err;
  const auto drawn = [&] {
    return std::distance(
        fs::directory_iterator(*fs::directory_iterator(home_.path() / "out/worlds")),
        fs::directory_iterator());
  };
  EXPECT_EQ(drawn(), 1) << "only the world of the part is drawn";
  EXPECT_EQ(worlds("parts", {"--shard", "1/2"}).exit_code, 0);
  EXPECT_EQ(worlds("all", {}).exit_code, 0);
  const auto whole = bytes_in(home_.path() / "all");
  EXPECT_FALSE(whole.empty());
  EXPECT_TRUE(bytes_in(home_.path() / "parts") == whole);
  const CommandResult too_many = worlds("more", {"--shard", "1/3"});
  EXPECT_EQ(too_many.exit_code, 2);
  EXPECT_NE(too_many.err.find("only 2 worlds"), std::string::npos) << too_many.err;
}

TEST_F(Generate, MistakesAreToldInOneLineBeforeAnythingIsWritten) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--formats", "rosbag"}, "'rosbag'; there are euroc"},
      {{"--frames", "0"}, "--frames"},
      {{"--shard", "3/2"}, "--shard"},
      {{"--shard", "half"}, "--shard"},
      {{"--shard", "1/2", "--jobs", "2"}, "--jobs"},
      {{"--worlds", "train"}, "--worlds"},
      {{"--set", "ego.sped=1 m/s"}, "speed"},
  };
  for (const auto& [more, expected] : cases) {
    std::vector<std::string> all{"--out", folder()};
    all.insert(all.end(), more.begin(), more.end());
    const CommandResult result = generate(all);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(expected), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(fs::exists(folder()));
  }
}

}  // namespace
}  // namespace lcs::sequence
