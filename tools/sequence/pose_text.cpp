#include "tools/sequence/pose_text.h"

#include <fmt/format.h>

#include <stdexcept>

namespace lcs::sequence {

using RowByRow = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

/// A loop, because GCC 13 warns within fmt 9 about `fmt::join` of numbers.
std::string numbers(std::span<const double> values, const char* separator) {
  std::string text;
  for (const double value : values) {
    text += fmt::format("{}{}", text.empty() ? "" : separator, value);
  }
  return text;
}

std::string seconds(std::int64_t t_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  return fmt::format("{}.{:09}", t_ns / kSecond_ns, t_ns % kSecond_ns);
}

std::string pose_line(std::int64_t t_ns, const sim::Pose& pose) {
  const Eigen::Quaterniond q = quaternion_of(pose);
  return fmt::format("{} {} {} {} {} {} {} {}\n", seconds(t_ns), pose.p.x(), pose.p.y(), pose.p.z(),
                     q.x(), q.y(), q.z(), q.w());
}

std::string reading_text(const scenario::Imu& imu) {
  if (imu.reading == scenario::ImuReading::sample) {
    return "a reading is the sample of the instant of its stamp (imu.reading: sample)";
  }
  return fmt::format(
      "a reading is the mean over the {} ms before its stamp (imu.reading: mean): exact for tools "
      "that integrate it over this time; tools that take it for a sample of its stamp see the "
      "motion {} ms late",
      1000 / imu.rate_hz, 500 / imu.rate_hz);
}

std::vector<double> four_coefficients(const sim::Lens& lens) {
  std::vector<double> coefficients = lens.coefficients;
  if (coefficients.empty() || (coefficients.size() == 5 && coefficients[4] == 0)) {
    coefficients.resize(4);
  }
  return coefficients;
}

Eigen::Quaterniond quaternion_of(const sim::Pose& pose) {
  Eigen::Quaterniond q(pose.R);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q;
}

std::array<double, 16> matrix_of(const sim::Pose& pose) {
  std::array<double, 16> matrix{};
  Eigen::Map<RowByRow>(matrix.data()) << pose.R, pose.p, Eigen::RowVector4d::UnitW();
  return matrix;
}

sim::Pose pose_of(const std::array<double, 16>& matrix) {
  constexpr double kTolerance = 1e-6;  // calibration matrices are printed with 7 digits or more
  const Eigen::Map<const RowByRow> all(matrix.data());
  const sim::Pose pose{all.topLeftCorner<3, 3>(), all.topRightCorner<3, 1>()};
  const bool is_rotation = (pose.R * pose.R.transpose()).isIdentity(kTolerance) &&
                           pose.R.determinant() > 0 && pose.p.allFinite();
  if (!is_rotation || all.row(3) != Eigen::RowVector4d::UnitW()) {
    throw std::invalid_argument("is not a rigid transform (a rotation, a translation, 0 0 0 1)");
  }
  return pose;
}

}  // namespace lcs::sequence
