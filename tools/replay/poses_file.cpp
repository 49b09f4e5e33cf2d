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

/// The places of x y z qx qy qz qw in a row.
using Places = std::array<std::size_t, 7>;
constexpr Places kTumPlaces{1, 2, 3, 4, 5, 6, 7};

std::optional<PosesFile::Line> quaternion_line(const TextTable::Row& row, const Places& at,
                                               const TimeColumn& time) {
  const auto t_ns = time.of(row);
  const auto numbers = TextTable::numbers(row, at);
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

/// Positions, then quaternions.
const Quantities& pose_quantities() {
  static const Quantities kPose{{"", "p", "pos", "position", "t", "translation"},
                                {"q", "quat", "quaternion", "orientation", "rot", "rotation"},
                                {"v", "vel", "velocity", "twist", "b", "bias", "a", "acc",
                                 "acceleration", "covariance", "std"}};
  return kPose;
}

/// The columns by the names in the header; absent without a header.
/// \throws input::Error for one that does not name all.
std::optional<Places> named_places(const TextTable& table) {
  Places places{};
  std::array<int, 7> found{};
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    const auto place = pose_quantities().place_of(table.header[i].name);
    if (!place) continue;
    places[*place] = i;
    const std::string& unit = table.header[i].unit;
    found[*place] += *place < 3 && !unit.empty() && unit != "m" ? 2 : 1;
  }
  if (std::ranges::all_of(found, [](int count) { return count == 1; })) return places;
  const bool is_text = table.is_comment && std::ranges::count(found, 0) > 5;
  if (table.header.empty() || is_text) return std::nullopt;
  throw input::Error({table.file.string(), 1},
                     "the header does not name one position in m and one quaternion: {}; give the "
                     "columns time, x, y, z, qx, qy, qz, qw of the camera, or p_RS_R_x, p_RS_R_y, "
                     "p_RS_R_z, q_RS_w, q_RS_x, q_RS_y, q_RS_z of a body",
                     table.columns());
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
  const std::string path = file.string();
  if (table.rows.empty()) throw input::Error({path, 0}, "holds no pose; give a line for each");
  const TextTable::Row& first = table.rows.front();
  const input::Source where{path, first.line};
  const std::size_t fields = first.fields.size();
  const std::optional<Places> named = named_places(table);
  PosesFile poses;
  poses.of_body = table.find("p_RS_R_x").has_value();
  poses.timed = named || fields == kTumFields;
  poses.numbered = !poses.timed && fields == kMatrix + 1;
  if (!named && table.separator == ',' && first.fields.back().empty()) {
    throw input::Error(
        where,
        "lines that end with a comma are of VINS-Mono or VINS-Fusion, with poses of the IMU; write "
        "time [ns],p_RS_R_x,p_RS_R_y,p_RS_R_z,q_RS_w,q_RS_x,q_RS_y,q_RS_z,{} as its first line, "
        "and give the camera's place on the IMU by a calibration",
        fields > kTumFields + 1 ? "vx,vy,vz," : "");
  }
  if (!poses.timed && fields != kThreeRows && fields != kMatrix && fields != kMatrix + 1) {
    throw input::Error(where,
                       "a pose has 8 numbers (TUM: t x y z qx qy qz qw), 12 or 16 (KITTI: rows of "
                       "a matrix) or 17 (KITTI-360), and this has {}; give a file of one of these, "
                       "or a header with time, x, y, z, qx, qy, qz, qw",
                       fields);
  }
  if (!named && fields == kTumFields && table.separator == ',') {
    throw input::Error(where,
                       "a table with commas has EuRoC's order of a quaternion, w first, or TUM's, "
                       "w last; give it a header, as time, x, y, z, qx, qy, qz, qw");
  }
  constexpr double kSlowest_hz = 0.6, kFastest_hz = 590;
  TimeColumn time;
  if (poses.timed) {
    const TableTimes times{
        time_unit, {kSlowest_hz, kFastest_hz, {}}, poses.of_body ? kNanosecond_ns : kSecond_ns};
    time =
        named ? time_column_of(table, times, tally) : TimeColumn{0, times.unit_ns(table, 0, tally)};
  }
  for (const TextTable::Row& row : table.rows) {
    auto& line = poses.lines.emplace_back();
    if (!poses.timed) {
      line = matrix_line(row, fields > kMatrix ? 1 : 0, fields > kMatrix ? kMatrix : fields);
    } else if (row.fields.size() == fields) {
      line = quaternion_line(row, named.value_or(kTumPlaces), time);
    }
    if (!line) tally.add("rows cannot be read and are left out", table.at(row));
  }
  require_velocities(table, poses);
  if (std::ranges::none_of(poses.lines, [](const auto& line) { return line.has_value(); })) {
    throw input::Error({path, 0},
                       "holds no pose: {}; give a line of 8 numbers (TUM) or 12 (KITTI) for each",
                       table.columns());
  }
  return poses;
}

}  // namespace lcs::replay
