#include "tools/replay/poses_file.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "tools/files/csv.h"
#include "tools/replay/motion_source.h"
#include "tools/replay/text_table.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

constexpr std::size_t kTumFields = 8, kThreeRows = 12, kMatrix = 16;
/// Tolerance for poses with few digits, or computed in single precision.
constexpr double kTolerance = 1e-2;
/// Farther from the origin, a position has no precise digits left.
constexpr double kFarthest_m = 1e9;

bool is_place(const Vector3d& p) {
  return p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthest_m;
}

/// The places of t x y z qx qy qz qw in a row.
using Places = std::array<std::size_t, 8>;
constexpr Places kTumPlaces{0, 1, 2, 3, 4, 5, 6, 7};

std::optional<PosesFile::Line> quaternion_line(const TextTable::Row& row, const Places& at,
                                               std::int64_t unit_ns) {
  const auto t_ns = time_in(TextTable::field(row, at[0]), unit_ns);
  const auto numbers = TextTable::numbers(row, std::span(at).subspan(1));
  if (!numbers) return std::nullopt;
  const Vector3d p(numbers->data());
  const Eigen::Quaterniond q(numbers->data() + 3);
  if (!t_ns || !is_place(p) || !(std::abs(q.norm() - 1) <= kTolerance)) return std::nullopt;
  return PosesFile::Line{t_ns, {}, {q.normalized().toRotationMatrix(), p}};
}

/// \param first place of a matrix of 12 or 16 numbers; the number of the picture is before it.
std::optional<PosesFile::Line> matrix_line(const TextTable::Row& row, std::size_t first,
                                           std::size_t count) {
  const auto n = TextTable::numbers(row, first, count);
  if (!n) return std::nullopt;
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> rows(n->data());
  const auto R = rotation_of(rows.leftCols<3>());
  if (!is_place(rows.col(3)) || !R) return std::nullopt;
  PosesFile::Line line{{}, {}, {*R, rows.col(3)}};
  if (first > 0) {
    line.number = files::number_in<std::size_t>(row.fields[0]);
    if (!line.number) return std::nullopt;
  }
  return line;
}

/// The columns by the names in the header; absent if it does not name all.
std::optional<Places> named_places(const TextTable& table) {
  static const std::array<std::vector<const char*>, 7> kNames{{
      {"p_RS_R_x", "x", "tx", "px", "p_x", "pos_x", "field.pose.position.x"},
      {"p_RS_R_y", "y", "ty", "py", "p_y", "pos_y", "field.pose.position.y"},
      {"p_RS_R_z", "z", "tz", "pz", "p_z", "pos_z", "field.pose.position.z"},
      {"q_RS_x", "qx", "q_x", "quat_x", "field.pose.orientation.x"},
      {"q_RS_y", "qy", "q_y", "quat_y", "field.pose.orientation.y"},
      {"q_RS_z", "qz", "q_z", "quat_z", "field.pose.orientation.z"},
      {"q_RS_w", "qw", "q_w", "quat_w", "field.pose.orientation.w"},
  }};
  const auto time = table.time_column();
  Places places{time.value_or(0)};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    std::optional<std::size_t> found;
    for (const char* name : kNames[i]) found = found ? found : table.find(name);
    if (!found || !time) return std::nullopt;
    places[i + 1] = *found;
  }
  return places;
}

/// Refuses positions that contradict the velocities of the same table, as EuRoC's truth has them.
void require_velocities(const TextTable& table, const PosesFile& poses) {
  const auto column = table.find("v_RS_R_x");
  if (!column) return;
  constexpr double kLeast_m = 1, kFactor = 2;
  double by_places_m = 0, by_velocities_m = 0;
  const PosesFile::Line* before = nullptr;
  for (std::size_t i = 0; i < poses.lines.size(); ++i) {
    const auto& line = poses.lines[i];
    const auto v_mps =
        TextTable::numbers(table.rows[i], std::array{*column, *column + 1, *column + 2});
    if (!line || !v_mps) continue;
    if (before) {
      by_places_m += (line->T_WC.p - before->T_WC.p).norm();
      by_velocities_m +=
          1e-9 * static_cast<double>(*line->t_ns - *before->t_ns) * Vector3d(v_mps->data()).norm();
    }
    before = &*line;
  }
  if (std::max(by_places_m, by_velocities_m) < kLeast_m ||
      (by_places_m < kFactor * by_velocities_m && by_velocities_m < kFactor * by_places_m)) {
    return;
  }
  throw input::Error({table.file.string(), 0},
                     "its positions move by {:.3g} m in all, and its velocities by {:.3g} m; "
                     "correct one of the two, or give other poses",
                     by_places_m, by_velocities_m);
}

}  // namespace

std::optional<Eigen::Matrix3d> rotation_of(const Eigen::Matrix3d& R) {
  if (!R.allFinite() || !(R.determinant() > 0) || !(R * R.transpose()).isIdentity(kTolerance)) {
    return std::nullopt;
  }
  return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}

PosesFile read_poses(const fs::path& file, const std::string& time_unit, Tally& tally) {
  const TextTable table = read_table(file);
  const auto refuse = [&](int line, const std::string& why) {
    throw input::Error({file.string(), line}, why);
  };
  if (table.rows.empty()) refuse(0, "holds no pose; give a line for each");
  const TextTable::Row& first = table.rows.front();
  const std::size_t fields = first.fields.size();
  const std::optional<Places> named = named_places(table);
  PosesFile poses;
  poses.of_body = table.find("p_RS_R_x").has_value();
  poses.timed = named || fields == kTumFields;
  poses.numbered = !poses.timed && fields == kMatrix + 1;
  if (!poses.timed && fields != kThreeRows && fields != kMatrix && fields != kMatrix + 1) {
    refuse(first.line,
           fmt::format("a pose has 8 numbers (TUM: t x y z qx qy qz qw), 12 or 16 (KITTI: rows of "
                       "a matrix) or 17 (KITTI-360), and this has {}; give a file of one of these, "
                       "or a header with time, x, y, z, qx, qy, qz, qw",
                       fields));
  }
  if (!named && fields == kTumFields && table.separator == ',') {
    refuse(first.line,
           "a table with commas has EuRoC's order of a quaternion, w first, or TUM's, w last; give "
           "it a header, as time, x, y, z, qx, qy, qz, qw");
  }
  constexpr double kSlowest_hz = 0.6, kFastest_hz = 590;
  std::int64_t unit_ns = kSecond_ns;
  if (poses.timed) {
    unit_ns =
        time_unit_of(table, named ? (*named)[0] : 0, time_unit, {kSlowest_hz, kFastest_hz, {}},
                     poses.of_body ? kNanosecond_ns : kSecond_ns, tally);
  }
  for (const TextTable::Row& row : table.rows) {
    auto& line = poses.lines.emplace_back();
    if (poses.timed) {
      if (row.fields.size() == fields)
        line = quaternion_line(row, named.value_or(kTumPlaces), unit_ns);
    } else {
      line = matrix_line(row, fields > kMatrix ? 1 : 0, fields > kMatrix ? kMatrix : fields);
    }
    if (!line) tally.add("rows cannot be read and are left out", table.at(row));
  }
  require_velocities(table, poses);
  if (std::ranges::none_of(poses.lines, [](const auto& line) { return line.has_value(); })) {
    refuse(0, "holds no pose; give a line of 8 numbers (TUM) or 12 (KITTI) for each");
  }
  return poses;
}

}  // namespace lcs::replay
