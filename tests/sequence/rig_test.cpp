// Sequences of a rig of cameras, read by OpenCV: pictures, truth and calibrations of two cameras
// belong to each other.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/video/tracking.hpp>
#include <sstream>

#include "tests/sequence/rows.h"
#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"
#include "tools/recording/recording_io.h"
#include "tools/replay/recorded.h"
#include "tools/sequence/replay_settings.h"
#include "tools/sequence/true_flow.h"

namespace lcs::sequence {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_lcs;

constexpr const char* kWorld = R"(scene: lab
frames: 3
ego: {start: [-3 m, 0 m], speed: 0.5 m/s}
odometry: {}
actors:
  crate:
    shape: box
    size: [0.4 m, 0.5 m, 0.7 m]
    trajectory: {line: {from: [-1 m, -0.5 m], heading: 90 deg, speed: 0.5 m/s}}
)";
constexpr double kBaseline_m = 0.12;
constexpr const char* kParallel = R"(cameras:
  left: {size: [320, 240], position: [0.2 m, 0.06 m, 0.45 m]}
  right: {size: [320, 240], position: [0.2 m, -0.06 m, 0.45 m]}
)";
/// Turned inwards, with lenses of their own.
constexpr const char* kConverging = R"(cameras:
  left:
    size: [320, 240]
    focal: [210 px, 208 px]
    centre: [157 px, 122 px]
    distortion: [-0.12, 0.02, 0.001, -0.0005, 0]
    position: [0.2 m, 0.2 m, 0.5 m]
    rotation: [1 deg, 4 deg, -6 deg]
  right:
    size: [360, 250]
    focal: [190 px, 191 px]
    distortion: {equidistant: [0.0035, 0.0007, -0.0021, 0.0002]}
    position: [0.15 m, -0.2 m, 0.45 m]
    rotation: [-2 deg, 2 deg, 7 deg]
)";

/// A camera as its sensor.yaml states it.
class View {
 public:
  View(const fs::path& sequence, int place)
      : place_(place),
        sequence_(sequence),
        calibration_(replay::read_calibration(mav() / "sensor.yaml")) {}

  fs::path mav() const { return sequence_ / "mav0" / fmt::format("cam{}", place_); }
  cv::Mat1b picture(int k) const {
    return cv::imread((mav() / "data" / rows_of(mav() / "data.csv").at(k)[1]).string(),
                      cv::IMREAD_GRAYSCALE);
  }
  cv::Mat1f depth_m(int k) const {
    const fs::path own = place_ == 0 ? sequence_ : sequence_ / fmt::format("cam{}", place_);
    cv::Mat1f depth;
    const cv::Mat code =
        cv::imread((own / fmt::format("depth/{:06}.png", k)).string(), cv::IMREAD_UNCHANGED);
    code.convertTo(depth, CV_32F, 1 / 256.0);  // KITTI: 256 codes a metre
    return depth;
  }
  Eigen::Isometry3d T_WC(int k) const {
    const std::vector<std::string> row = rows_of(mav() / "pose.csv").at(k);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 12; ++i) T(i / 4, i % 4) = std::stod(row.at(1 + i));
    return T;
  }
  Eigen::Isometry3d T_SC() const {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = calibration_.T_BS->R;
    T.translation() = calibration_.T_BS->p;
    return T;
  }
  Eigen::Vector3d point(const cv::Point2d& px, double depth_m) const {
    std::vector<cv::Point2d> ray;
    if (is_fisheye()) {
      cv::fisheye::undistortPoints(std::vector{px}, ray, K(), lens().coefficients);
    } else {
      cv::undistortPoints(std::vector{px}, ray, K(), lens().coefficients);
    }
    return {ray[0].x * depth_m, ray[0].y * depth_m, depth_m};
  }
  cv::Point2d project(const Eigen::Vector3d& p_C) const {
    const std::vector<cv::Point3d> point{{p_C.x(), p_C.y(), p_C.z()}};
    const cv::Vec3d none(0, 0, 0);
    std::vector<cv::Point2d> px;
    if (is_fisheye()) {
      cv::fisheye::projectPoints(point, px, none, none, K(), lens().coefficients);
    } else {
      cv::projectPoints(point, none, none, K(), lens().coefficients, px);
    }
    return px[0];
  }
  const replay::Lens& lens() const { return *calibration_.lens; }

 private:
  bool is_fisheye() const { return lens().distortion == replay::Lens::Distortion::equidistant; }
  cv::Matx33d K() const {
    return {lens().fu_px, 0, lens().cu_px, 0, lens().fv_px, lens().cv_px, 0, 0, 1};
  }

  int place_;
  fs::path sequence_;
  replay::SensorCalibration calibration_;
};

class Rig : public testing::Test {
 protected:
  fs::path scenario(const std::string& cameras) const {
    test::write(home_.path() / "rig.yaml", kWorld + cameras);
    return home_.path() / "rig.yaml";
  }
  CommandResult lcs(std::vector<std::string> arguments) const {
    return run_lcs(arguments, {.folder = home_.path()});
  }
  void generate(const std::string& cameras, const std::string& formats,
                const std::string& out = "sequence") const {
    const CommandResult result = lcs({"generate", scenario(cameras), "--formats", formats, "--out",
                                      home_.path() / out, "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  fs::path sequence() const { return home_.path() / "sequence"; }

  const test::TemporaryFolder home_;
};

/// KITTI's P, by its name.
cv::Matx34d projection(const fs::path& calib, const std::string& name) {
  std::ifstream file(calib);
  for (std::string word; file >> word;) {
    if (word != name + ":") continue;
    cv::Matx34d P;
    for (double& number : P.val) file >> number;
    return P;
  }
  ADD_FAILURE() << "no " << name;
  return {};
}

TEST_F(Rig, DepthByTheDisparityOfTwoPicturesIsTheDepthOfTheTruth) {
  generate(kParallel, "kitti,landmarks");
  const cv::Matx34d P0 = projection(sequence() / "kitti/calib.txt", "P0");
  const cv::Matx34d P1 = projection(sequence() / "kitti/calib.txt", "P1");
  EXPECT_NEAR(P1(0, 3), -P0(0, 0) * kBaseline_m, 1e-9);
  const auto picture = [&](int camera) {
    return cv::imread((sequence() / fmt::format("kitti/image_{}/000001.png", camera)).string(),
                      cv::IMREAD_GRAYSCALE);
  };
  std::vector<cv::Point2f> corners, found;
  std::vector<double> depths_m;
  for (const auto& row : rows_of(sequence() / "landmarks.csv")) {
    if (row[0] != "1" || row[4].empty()) continue;
    corners.emplace_back(std::stof(row[1]), std::stof(row[2]));
    depths_m.push_back(std::stod(row[4]));
  }
  ASSERT_GT(corners.size(), 50u);
  std::vector<unsigned char> is_found, is_back;
  std::vector<cv::Point2f> back;
  const cv::Size window(11, 11);
  cv::calcOpticalFlowPyrLK(picture(0), picture(1), corners, found, is_found, cv::noArray(), window);
  cv::calcOpticalFlowPyrLK(picture(1), picture(0), found, back, is_back, cv::noArray(), window);
  cv::Mat1f points;
  cv::triangulatePoints(P0, P1, corners, found, points);
  std::vector<double> errors_px;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const int column = static_cast<int>(i);
    const double disparity_px = P0(0, 0) * kBaseline_m / depths_m[i];
    const bool is_tracked = is_found[i] && is_back[i] && cv::norm(back[i] - corners[i]) < 0.3;
    if (!is_tracked || disparity_px < 2) continue;
    const double depth_m = points(2, column) / points(3, column);
    errors_px.push_back(P0(0, 0) * kBaseline_m / depth_m - disparity_px);
  }
  ASSERT_GT(errors_px.size(), 80u);
  const auto share = [&](double most_px) {
    return static_cast<double>(
               std::ranges::count_if(errors_px, [&](double e) { return std::abs(e) < most_px; })) /
           static_cast<double>(errors_px.size());
  };
  // Noise makes tracks exact to some 0.2 px. Corners on outlines have the depths of two surfaces.
  EXPECT_GT(share(0.5), 0.8);
  EXPECT_GT(share(1), 0.93);
  std::ranges::nth_element(errors_px, errors_px.begin() + std::ssize(errors_px) / 2);
  EXPECT_NEAR(errors_px[errors_px.size() / 2], 0, 0.1) << "no shift of one picture by the other";
}

class RigOf : public Rig, public testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Cameras, RigOf, testing::Values(kParallel, kConverging),
                         [](const auto& test) {
                           return test.index == 0 ? "Parallel" : "Converging";
                         });

TEST_P(RigOf, PointsOfOneCameraAreWhereOpenCvSeesThemInTheOther) {
  generate(GetParam(), "euroc,depth,kalibr");
  const View left(sequence(), 0), right(sequence(), 1);
  for (const int k : {0, 2}) {
    const Eigen::Isometry3d T_RL = right.T_WC(k).inverse() * left.T_WC(k);
    EXPECT_TRUE(T_RL.isApprox(right.T_SC().inverse() * left.T_SC(), 1e-9)) << "the rig is rigid";
    const cv::Mat1f from = left.depth_m(k), to = right.depth_m(k);
    int compared = 0, same = 0;
    for (int y = 5; y < from.rows; y += 5) {
      for (int x = 5; x < from.cols; x += 5) {
        if (from(y, x) == 0) continue;
        const Eigen::Vector3d p_R =
            T_RL * left.point(cv::Point2d(x, y), static_cast<double>(from(y, x)));
        const cv::Point px = right.project(p_R);
        if (!cv::Rect(0, 0, to.cols, to.rows).contains(px)) continue;
        ++compared;
        // Half a pixel on the floor at the horizon is 2 % of the depth; the rest is hidden from
        // one.
        same += std::abs(static_cast<double>(to(px)) / p_R.z() - 1) < 0.02;
      }
    }
    EXPECT_GT(compared, 1000);
    EXPECT_GT(same, 0.93 * compared) << compared;
  }
  std::ifstream file(sequence() / "kalibr/camchain.yaml");
  const std::string chain{std::istreambuf_iterator<char>(file), {}};
  std::string numbers = chain.substr(chain.find("T_cn_cnm1:") + 10, 600);
  for (char& c : numbers) c = std::strchr("[],\n", c) ? ' ' : c;
  std::istringstream words(numbers);
  Eigen::Matrix4d T_10;
  for (int row = 0; row < 4; ++row) {
    std::string dash;
    words >> dash;
    for (int column = 0; column < 4; ++column) words >> T_10(row, column);
  }
  EXPECT_TRUE(T_10.isApprox((right.T_SC().inverse() * left.T_SC()).matrix(), 1e-9)) << T_10;
  const auto of_kalibr = replay::read_calibration(sequence() / "kalibr/camchain.yaml", "cam1");
  EXPECT_TRUE(of_kalibr.T_BS->R.isApprox(right.T_SC().linear(), 1e-9));
  EXPECT_EQ(of_kalibr.lens->fu_px, right.lens().fu_px);
}

TEST_F(Rig, EachCameraHasTheFilesOfASingleOne) {
  const std::string formats = "euroc,tum,depth,flow,landmarks,coco,mot";
  generate(kParallel, formats);
  const std::string left = "camera: {size: [320, 240], position: [0.2 m, 0.06 m, 0.45 m]}\n";
  const std::string right = "camera: {size: [320, 240], position: [0.2 m, -0.06 m, 0.45 m]}\n";
  generate(left, formats, "left");
  generate(right + "image: {noise: none}\n", formats, "right");
  const auto rig = test::bytes_in(sequence());
  for (const auto& [path, bytes] : test::bytes_in(home_.path() / "left")) {
    if (path.find('/') == std::string::npos && !path.starts_with("landmarks") &&
        !path.starts_with("truth"))
      continue;
    EXPECT_TRUE(rig.at(path) == bytes) << path;
  }
  for (const auto& [path, bytes] : test::bytes_in(home_.path() / "right")) {
    if (!path.starts_with("depth/") && !path.starts_with("flow")) continue;
    EXPECT_TRUE(rig.at("cam1/" + path) == bytes) << path;
  }
  EXPECT_EQ(rig.at("mav0/cam1/data.csv"), rig.at("mav0/cam0/data.csv"));
  EXPECT_TRUE(rig.contains("cam1/tum/camera.txt") && !rig.contains("cam1/tum/imu.txt"));
  EXPECT_TRUE(rig.contains("cam1/coco/annotations.json") && rig.contains("cam1/landmarks.csv"));
  EXPECT_TRUE(rig.contains("cam1/mot/rig/img1/000001.png"));
  EXPECT_NE(rig.at("scenario.yaml").find("right: {size"), std::string::npos);
  EXPECT_NE(rig.at("README.md").find("| cam1 | right |"), std::string::npos);
}

TEST_F(Rig, CamerasAtOnePlaceDifferByTheirNoiseAlone) {
  const std::string twice = "cameras: {one: {size: [320, 240]}, two: {size: [320, 240]}}\n";
  generate(twice, "euroc");
  generate(twice + "image: {noise: none}\n", "euroc", "exact");
  const fs::path exact = home_.path() / "exact";
  EXPECT_EQ(cv::norm(View(exact, 0).picture(1), View(exact, 1).picture(1), cv::NORM_INF), 0);
  cv::Mat1f noise[2];
  for (const int i : {0, 1}) {
    cv::subtract(View(sequence(), i).picture(1), View(exact, i).picture(1), noise[i], {}, CV_32F);
  }
  const double correlation = noise[0].dot(noise[1]) / (cv::norm(noise[0]) * cv::norm(noise[1]));
  // The rounding of the exact picture to grey levels is common: a variance of 1/12 beside some 0.9.
  EXPECT_LT(std::abs(correlation), 0.15) << "1 if both cameras had the same noise";
}

TEST_F(Rig, TheReplayOfEachCameraIsTheRunOfTheFilterOnIt) {
  generate(std::string(kConverging) + "filter_camera: right\n", "euroc,landmarks");
  const auto layers = [&](const char* folder) {
    return test::read(home_.path() / folder / recording::kLayersFile);
  };
  const auto replay = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"replay",  sequence(), "--no-video",
                                 "--quiet", "--out",    home_.path() / "replay"};
    all.insert(all.end(), more.begin(), more.end());
    return lcs(all);
  };
  for (const char* name : {"left", "right"}) {
    const CommandResult run =
        lcs({"run", scenario(kConverging), "--set", fmt::format("filter_camera={}", name),
             "--no-video", "--quiet", "--out", home_.path() / "run"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const bool is_left = std::string(name) == "left";
    std::vector<std::vector<std::string>> ways{{"--camera", name},
                                               {"--camera", is_left ? "cam0" : "cam1"}};
    if (!is_left) ways.emplace_back();  // the camera that the scenario names
    for (const std::vector<std::string>& way : ways) {
      const CommandResult result = replay(way);
      ASSERT_EQ(result.exit_code, 0) << result.err;
      EXPECT_TRUE(layers("replay") == layers("run")) << name;
    }
  }
  const CommandResult unknown = replay({"--camera", "middle"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("'middle'; give one of left (cam0), right (cam1)"), std::string::npos)
      << unknown.err;
}

TEST_F(Rig, UnrectifiedCamerasAreRefusedForKitti) {
  for (const std::string& cameras :
       {std::string(kConverging),
        std::string("cameras: {a: {}, b: {position: [0.3 m, -0.1 m, 0.45 m]}}\n"),
        std::string("cameras: {a: {}, b: {fovy: 50 deg, position: [0.2 m, -0.1 m, 0.45 m]}}\n")}) {
    const CommandResult result =
        lcs({"generate", scenario(cameras), "--formats", "kitti", "--out", sequence(), "--quiet"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("KITTI's calib.txt is of rectified cameras; leave kitti out"),
              std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("rig.yaml:"), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(sequence()));
  }
}

}  // namespace
}  // namespace lcs::sequence
