#include "tools/replay/poses_file.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "tools/files/csv.h"
#include "tools/replay/navigation.h"
#include "tools/replay/text_table.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

constexpr std::size_t kTumFields = 8, kKittiFields = 12;
/// Tolerance for poses with few digits, or computed in single precision.
constexpr double kTolerance = 1e-2;
/// Farther from the origin, a position has no precise digits left.
constexpr double kFarthest_m = 1e9;

bool is_place(const Eigen::Vector3d& p) {
  return p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthest_m;
}

template <std::size_t N>
std::optional<std::array<double, N>> numbers_in(const std::vector<std::string>& fields,
                                                std::size_t first) {
  std::array<double, N> numbers{};
  if (fields.size() != first + N) return std::nullopt;
  for (std::size_t i = 0; i < N; ++i) {
    const auto number = bench::number_in<double>(fields[first + i]);
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  return numbers;
}

std::optional<PosesFile::Line> tum_line(const std::vector<std::string>& fields) {
  const auto t_ns = seconds_in(fields[0]);
  const auto n = numbers_in<kTumFields - 1>(fields, 1);
  if (!t_ns || !n) return std::nullopt;
  const Eigen::Vector3d p((*n)[0], (*n)[1], (*n)[2]);
  const Eigen::Quaterniond q((*n)[6], (*n)[3], (*n)[4], (*n)[5]);
  if (!is_place(p) || !(std::abs(q.norm() - 1) <= kTolerance)) return std::nullopt;
  return PosesFile::Line{*t_ns, {q.normalized().toRotationMatrix(), p}};
}

std::optional<PosesFile::Line> kitti_line(const std::vector<std::string>& fields) {
  const auto n = numbers_in<kKittiFields>(fields, 0);
  if (!n) return std::nullopt;
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> rows(n->data());
  const auto R = rotation_of(rows.leftCols<3>());
  if (!is_place(rows.col(3)) || !R) return std::nullopt;
  return PosesFile::Line{std::nullopt, {*R, rows.col(3)}};
}

}  // namespace

std::optional<Eigen::Matrix3d> rotation_of(const Eigen::Matrix3d& R) {
  if (!R.allFinite() || !(R.determinant() > 0) || !(R * R.transpose()).isIdentity(kTolerance)) {
    return std::nullopt;
  }
  return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}

PosesFile read_poses(const std::filesystem::path& file, Tally& tally) {
  const TextTable table = read_table(file, ' ');
  PosesFile poses;
  if (!table.rows.empty()) {
    const std::size_t fields = table.rows.front().fields.size();
    poses.timed = fields == kTumFields;
    if (fields != kTumFields && fields != kKittiFields) {
      throw input::Error(
          {file.string(), table.rows.front().line},
          fmt::format("a pose has 8 numbers (TUM: t x y z qx qy qz qw) or 12 (KITTI: three rows of "
                      "a matrix), and this has {}; give a file of one of these",
                      fields));
    }
  }
  bool any = false;
  for (const TextTable::Row& row : table.rows) {
    const bool is_whole = row.fields.size() == (poses.timed ? kTumFields : kKittiFields);
    auto& line = poses.lines.emplace_back();
    if (is_whole) line = poses.timed ? tum_line(row.fields) : kitti_line(row.fields);
    if (!line) tally.add("rows cannot be read and are left out", table.at(row));
    any |= line.has_value();
  }
  if (any) return poses;
  throw input::Error({file.string(), 0},
                     "holds no pose; give a line of 8 numbers (TUM) or 12 (KITTI) for each");
}

std::optional<Eigen::Vector3d> up_of_world(const scenario::Recorded& asked,
                                           const sim::Pose& T_WC_first,
                                           const std::optional<Eigen::Vector3d>& otherwise) {
  if (!asked.mount_rpy_rad) return otherwise;
  return T_WC_first.R * camera_mount(*asked.mount_rpy_rad).row(2).transpose();
}

}  // namespace lcs::replay
