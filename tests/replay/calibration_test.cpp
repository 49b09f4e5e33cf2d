// One camera, as the calibrations of several tools state it, and lenses compared with the formulas
// of their authors.
#include "tools/replay/recorded.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "sim/camera/rectifier.h"
#include "tests/tools/files.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::replay {
namespace {

using sim::Rectifier;

using test::refusal_of;

class CalibrationFile : public testing::Test {
 protected:
  SensorCalibration read(const std::string& text, const std::string& camera = "") const {
    test::write(path_, text);
    return read_calibration(path_, camera);
  }
  std::string refusal(const std::string& text) const {
    return refusal_of<input::Error>([&] { read(text); });
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "calibration.yaml";
};

void expect_lens(const std::optional<Lens>& lens, const std::vector<double>& coefficients,
                 Lens::Distortion distortion = Lens::Distortion::radial_tangential) {
  ASSERT_TRUE(lens);
  EXPECT_EQ(lens->fu_px, 458.5);
  EXPECT_EQ(lens->fv_px, 457.25);
  EXPECT_EQ(lens->cu_px, 367.5);
  EXPECT_EQ(lens->cv_px, 248.25);
  EXPECT_EQ(lens->distortion, distortion);
  EXPECT_EQ(lens->coefficients, coefficients);
}

void expect_size(const std::optional<Lens>& lens) {
  EXPECT_EQ(lens->width_px, 752);
  EXPECT_EQ(lens->height_px, 480);
}

/// Camera 20 cm ahead of the IMU: x right, y down, z ahead; x ahead, y left, z up.
void expect_ahead(const std::optional<sim::Pose>& T_BC) {
  ASSERT_TRUE(T_BC);
  EXPECT_LT((T_BC->p - Eigen::Vector3d(0.2, 0, 0)).norm(), 1e-12);
  EXPECT_LT((T_BC->R.col(2) - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((T_BC->R.col(0) + Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

constexpr const char* kT_BC = "0, 0, 1, 0.2, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 1";

TEST_F(CalibrationFile, OfKalibrHasTheCameraByTheInverseOfTheImuInIt) {
  const std::string chain = R"(
cam0:
  T_cam_imu:
  - [0.0, -1.0, 0.0, 0.0]
  - [0.0, 0.0, -1.0, 0.0]
  - [1.0, 0.0, 0.0, -0.2]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: pinhole
  distortion_coeffs: [-0.25, 0.07, 0.0002, 1.5e-05]
  distortion_model: radtan
  intrinsics: [458.5, 457.25, 367.5, 248.25]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
  timeshift_cam_imu: -0.00812
cam1:
  T_cn_cnm1: [[1, 0, 0, -0.11], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
  camera_model: omni
  distortion_coeffs: [0.1, 0.2, 0.3, 0.4]
  distortion_model: radtan
  intrinsics: [1.5, 458.5, 457.25, 367.5, 248.25]
)";
  const SensorCalibration left = read(chain);
  expect_lens(left.lens, {-0.25, 0.07, 0.0002, 1.5e-05});
  expect_size(left.lens);
  expect_ahead(left.T_BS);
  EXPECT_EQ(left.time_offset_s, -0.00812);
  const SensorCalibration right = read(chain, "cam1");
  expect_lens(right.lens, {0.1, 0.2, 0.3, 0.4});
  EXPECT_EQ(right.lens->xi, 1.5);
  ASSERT_TRUE(right.T_BS);
  EXPECT_LT((right.T_BS->p - Eigen::Vector3d(0.2, -0.11, 0)).norm(), 1e-12) << "to the right";
  EXPECT_THROW(read(chain, "cam2"), input::Error);
  EXPECT_EQ(read(chain, "image_02").lens->xi, 0) << "another layout's name: the first one";
}

TEST_F(CalibrationFile, OfOpenVinsEurocAndVinsHaveTheCameraInTheImu) {
  const SensorCalibration openvins = read(fmt::format(R"(%YAML:1.0
cam0:
  T_imu_cam: [{}]
  camera_model: pinhole
  distortion_coeffs: [0.1, 0.2, 0.3, 0.4]
  distortion_model: equidistant
  intrinsics: [458.5, 457.25, 367.5, 248.25]
  resolution: [752, 480]
)",
                                                      kT_BC));
  expect_lens(openvins.lens, {0.1, 0.2, 0.3, 0.4}, Lens::Distortion::equidistant);
  expect_ahead(openvins.T_BS);
  const SensorCalibration euroc = read(fmt::format(R"(sensor_type: camera
T_BS: {{cols: 4, rows: 4, data: [{}]}}
rate_hz: 20
intrinsics: [458.5, 457.25, 367.5, 248.25]
distortion_model: radial-tangential
distortion_coefficients: [0.1, 0.2, 0.3, 0.4]
)",
                                                   kT_BC));
  expect_lens(euroc.lens, {0.1, 0.2, 0.3, 0.4});
  EXPECT_EQ(euroc.rate_hz, 20);
  expect_ahead(euroc.T_BS);
  test::write(folder_.path() / "cam0.yaml", R"(%YAML:1.0
---
model_type: PINHOLE
image_width: 752
image_height: 480
distortion_parameters: {k1: 0.1, k2: 0.2, p1: 0.3, p2: 0.4}
projection_parameters: {fx: 458.5, fy: 457.25, cx: 367.5, cy: 248.25}
)");
  const SensorCalibration vins = read(fmt::format(R"(%YAML:1.0
cam0_calib: "cam0.yaml"
body_T_cam0: !!opencv-matrix
   rows: 4
   cols: 4
   dt: d
   data: [{}]
acc_n: 0.1
gyr_n: 0.01
acc_w: 0.001
gyr_w: 0.0001
td: 0.25
)",
                                                  kT_BC));
  EXPECT_EQ(vins.time_offset_s, 0.25);
  expect_lens(vins.lens, {0.1, 0.2, 0.3, 0.4});
  expect_size(vins.lens);
  expect_ahead(vins.T_BS);
  ASSERT_TRUE(vins.noise);
  EXPECT_EQ(vins.noise->gyroscope_random_walk, 0.0001);
}

TEST_F(CalibrationFile, NamesNoFileThatNamesAFurtherOne) {
  const std::string itself = refusal("# VINS\ncam0_calib: calibration.yaml\n");
  EXPECT_NE(itself.find("calibration.yaml:2: cam0_calib names a further calibration"),
            std::string::npos)
      << itself;
  test::write(folder_.path() / "one.yaml", "cam0_calib: two.yaml\n");
  test::write(folder_.path() / "two.yaml", "cam0_calib: one.yaml\n");
  const std::string ring = refusal("cam0_calib: two.yaml\n");
  EXPECT_NE(ring.find("two.yaml:1: cam0_calib names a further calibration"), std::string::npos)
      << ring;
}

TEST_F(CalibrationFile, OfOpenCvRosAndOrbSlamHaveAMatrixOrNumbers) {
  const SensorCalibration opencv = read(R"(%YAML:1.0
---
image_width: 752
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 4.585e+02, 0., 3.675e+02, 0., 457.25, 248.25, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ 0.1, 0.2, 0.3, 0.4, 0.5 ]
)");
  expect_lens(opencv.lens, {0.1, 0.2, 0.3, 0.4, 0.5});
  expect_size(opencv.lens);
  const SensorCalibration ros = read(R"(image_width: 752
image_height: 480
camera_name: left
camera_matrix: {rows: 3, cols: 3, data: [458.5, 0, 367.5, 0, 457.25, 248.25, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0.1, 0.2, 0.3, 0.4, 0]}
)");
  expect_lens(ros.lens, {0.1, 0.2, 0.3, 0.4, 0});
  expect_size(ros.lens);
  const SensorCalibration orb = read(fmt::format(R"(%YAML:1.0
Camera.type: "KannalaBrandt8"
Camera1.fx: 458.5
Camera1.fy: 457.25
Camera1.cx: 367.5
Camera1.cy: 248.25
Camera1.k1: 0.1
Camera1.k2: 0.2
Camera1.k3: 0.3
Camera1.k4: 0.4
Camera.width: 752
Camera.height: 480
IMU.T_b_c1: !!opencv-matrix
  rows: 4
  cols: 4
  dt: f
  data: [{}]
)",
                                                 kT_BC));
  expect_lens(orb.lens, {0.1, 0.2, 0.3, 0.4}, Lens::Distortion::equidistant);
  expect_size(orb.lens);
  expect_ahead(orb.T_BS);
}

TEST_F(CalibrationFile, OfAnotherKindIsRefusedWithTheOnesThatWork) {
  EXPECT_NE(refusal("colour: red\n").find("holds no calibration that is known; give the YAML of"),
            std::string::npos);
  EXPECT_NE(refusal("intrinsics: [1, 2, 3, 4]\ncamera_model: eucm\n")
                .find("the camera_model 'eucm' is not supported; give a pinhole, omni or ds"),
            std::string::npos);
  EXPECT_NE(refusal("intrinsics: [9, 9, 3, 4]\ndistortion_model: fov\ndistortion_coeffs: [1]\n")
                .find("the distortion 'fov' is not supported"),
            std::string::npos);
  EXPECT_NE(refusal("intrinsics: [9, 9, 3, 4]\ndistortion_coeffs: [1, 0, 0, 0]\n")
                .find("has coefficients and no model"),
            std::string::npos);
  EXPECT_NE(refusal("T_BS: [1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n")
                .find("T_BS is no rigid transform"),
            std::string::npos);
  EXPECT_NE(refusal("accelerometer_noise_density: 1\n").find("is missing; give all four"),
            std::string::npos);
}

/// A point in a picture by the double sphere model, Usenko et al., 3DV 2018, equations 40 to 42.
Eigen::Vector2f double_sphere(const Lens& lens, const Eigen::Vector3d& p) {
  const double d1 = p.norm(), z = lens.xi * d1 + p.z();
  const double d2 = std::sqrt(p.x() * p.x() + p.y() * p.y() + z * z);
  const double below = lens.alpha * d2 + (1 - lens.alpha) * z;
  return Eigen::Vector2d(lens.fu_px * p.x() / below + lens.cu_px,
                         lens.fv_px * p.y() / below + lens.cv_px)
      .cast<float>();
}

TEST(Rectifier, TakesCornersOfSphericalLensesToAPinhole) {
  for (const auto& [xi, alpha] : {std::pair{1.6, 0.0}, {-0.2, 0.6}, {0.1, 0.4}}) {
    Lens lens{300 * (1 + xi), 310 * (1 + xi), 319.5, 239.5, {}, {}, xi, alpha};
    const Rectifier rectifier(lens, {640, 480});
    for (const Eigen::Vector3d& ray : {Eigen::Vector3d(0, 0, 1), {0.5, -0.3, 1}, {-0.9, 0.7, 1}}) {
      std::vector<Eigen::Vector2f> corners{double_sphere(lens, ray)};
      rectifier.rectify(corners);
      ASSERT_EQ(corners.size(), 1u) << xi << " " << ray.transpose();
      const Eigen::Vector2d expected = rectifier.camera().project(ray);
      EXPECT_LT((corners[0].cast<double>() - expected).norm(), 2e-3) << xi << " " << alpha;
    }
  }
}

}  // namespace
}  // namespace lcs::replay
