#include "tools/replay/recorded.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>

#include "filter/ego_motion/imu_watch.h"
#include "tools/files/csv.h"
#include "tools/sequence/pose_text.h"

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
  const auto numbers = row.numbers(at);
  if (!numbers) return std::nullopt;
  const Vector3d p(numbers->data());
  const Eigen::Quaterniond q(numbers->data() + 3);
  if (!t_ns || !is_place(p) || !(std::abs(q.norm() - 1) <= kTolerance)) return std::nullopt;
  return PosesFile::Line{t_ns, {}, {q.normalized().toRotationMatrix(), p}};
}

/// \param first place of a matrix of 12 or 16 numbers; the number of the picture is before it.
std::optional<PosesFile::Line> matrix_line(const TextTable::Row& row, std::size_t first,
                                           std::size_t count) {
  const auto n = row.numbers(first, count);
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
  refuse({table.file, 1},
         "the header does not name one position in m and one quaternion: {}; give the columns "
         "time, x, y, z, qx, qy, qz, qw of the camera, or p_RS_R_x, p_RS_R_y, p_RS_R_z, q_RS_w, "
         "q_RS_x, q_RS_y, q_RS_z of a body",
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
    const auto v_mps = table.rows[i].numbers(std::array{*column, *column + 1, *column + 2});
    if (!line || !v_mps) continue;
    if (before) {
      by_places_m += (line->T_WC.p - before->T_WC.p).norm();
      by_velocities_m += seconds(*line->t_ns - *before->t_ns) * Vector3d(v_mps->data()).norm();
    }
    before = &*line;
  }
  if (std::max(by_places_m, by_velocities_m) < kLeast_m ||
      (by_places_m < kFactor * by_velocities_m && by_velocities_m < kFactor * by_places_m)) {
    return;
  }
  refuse({table.file},
         "its positions move by {:.3g} m in all, and its velocities by {:.3g} m; correct one of "
         "the two, or give other poses",
         by_places_m, by_velocities_m);
}

constexpr double kStandardGravity_mps2 = 9.80665;

/// A time and the numbers of the requested columns.
struct NumberRow {
  std::int64_t t_ns = 0;
  std::vector<double> numbers;
};

/// \param last an optional further column.
std::vector<NumberRow> rows_of(const TextTable& table, const TimeColumn& time,
                               std::span<const std::size_t> columns,
                               std::optional<std::size_t> last, Tally& tally) {
  std::vector<NumberRow> rows;
  for (const TextTable::Row& row : table.rows) {
    const auto t_ns = time.of(row);
    auto numbers = row.numbers(columns);
    if (!t_ns || !numbers) {
      tally.add("rows cannot be read and are left out", table.at(row));
      continue;
    }
    const auto more = last ? row.number(*last) : std::nullopt;
    if (more) numbers->push_back(*more);
    rows.push_back({*t_ns, std::move(*numbers)});
  }
  sort_by_time(rows, "rows", table.file.string(), tally);
  return rows;
}

/// \param names of columns in a header; without one they follow the time in this order.
/// \param last name of an optional further column.
std::vector<NumberRow> read_numbers(const fs::path& file, std::span<const char* const> names,
                                    const TableTimes& times, Tally& tally,
                                    std::optional<std::string_view> last = std::nullopt) {
  const TextTable table = read_table(file);
  std::vector<std::size_t> columns;
  for (const char* name : names) columns.push_back(table.column(name, columns.size() + 1));
  std::optional<std::size_t> last_column;
  if (last && (table.header.empty() || table.find(*last))) {
    last_column = table.column(*last, columns.size() + 1);
  }
  return rows_of(table, {0, times.unit_ns(table, 0, tally)}, columns, last_column, tally);
}

Vector3d vector_at(const NumberRow& row, std::size_t first) {
  return {row.numbers[first], row.numbers[first + 1], row.numbers[first + 2]};
}

/// Angular rates, then accelerations.
const Quantities& imu_quantities() {
  static const Quantities kImu{
      {"gyro", "gyr", "gyroscope", "gyros", "omega", "w", "g", "angular", "ang", "rotation"},
      {"acc", "accel", "acceleration", "accelerometer", "alpha", "a"},
      {"covariance", "b", "bias", "orientation", "user", "motion", "temp", "raw", "magnetic"}};
  return kImu;
}

/// The factor to rad/s or m/s^2 of a unit in a header. \throws input::Error for an unknown one.
double factor_of(const TextTable& table, std::size_t column, bool is_rate) {
  const std::string& unit = table.header[column].unit;
  const auto has = [&](const char* text) { return unit.find(text) != unit.npos; };
  if (unit.empty()) return 1;
  if (is_rate && (has("deg") || has("°") || has("dps"))) return std::numbers::pi / 180;
  if (is_rate && has("rad")) return 1;
  if (!is_rate && (has("m/s") || has("m s") || has("m*s"))) return 1;
  if (!is_rate && (unit == "g" || unit == "G")) return kStandardGravity_mps2;
  refuse({table.file, 1}, "the unit '{}' of {} is not known; give {}", unit,
         table.header[column].name, is_rate ? "rad/s or deg/s" : "m/s^2 or g");
}

struct ImuColumns {
  TimeColumn time;
  std::array<std::size_t, 6> places;
  std::array<double, 6> factors{1, 1, 1, 1, 1, 1};
};

/// \throws input::Error for a header without the six columns.
ImuColumns find_columns(const TextTable& table, const TableTimes& times,
                        const std::array<std::size_t, 6>& places, Tally& tally) {
  std::array<bool, 6> is_found{};
  const auto refuse_header = [&](const std::string& why) {
    refuse({table.file, 1},
           "{}: {}; give the time, and w_RS_S_x, w_RS_S_y, w_RS_S_z [rad/s], a_RS_S_x, a_RS_S_y, "
           "a_RS_S_z [m/s^2]{}",
           why, table.columns(),
           table.header.empty() ? " in a header (KAIST's xsens_imu.csv: time "
                                  "[ns],qx,qy,qz,qw,ex,ey,ez, these six, mx,my,mz)"
                                : "");
  };
  const std::size_t fields = table.rows.empty() ? 0 : table.rows.front().fields.size();
  if (table.header.empty() && fields > 7 && !table.rows.front().fields[7].empty())
    refuse_header("its columns are not those of an IMU alone");
  ImuColumns columns{time_column_of(table, times, tally), places};
  if (table.header.empty()) return columns;
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    const auto place = imu_quantities().place_of(table.header[i].name);
    if (!place || *place >= is_found.size()) continue;
    if (is_found[*place]) {
      refuse_header(fmt::format("the columns {} and {} both may be one of the IMU's",
                                table.header[columns.places[*place]].name, table.header[i].name));
    }
    is_found[*place] = true;
    columns.places[*place] = i;
    columns.factors[*place] = factor_of(table, i, *place < 3);
  }
  if (!std::ranges::all_of(is_found, [](bool found) { return found; })) {
    refuse_header("the header does not name three angular rates and three accelerations");
  }
  return columns;
}

/// Removes single readings beyond the range of any sensor; where most are, another fault is told.
void drop_impossible(std::vector<sim::ImuSample>& samples, const fs::path& file, Tally& tally) {
  constexpr double kMostRate_radps = 100, kMostForce_mps2 = 2000;
  const auto is_beyond = [](const sim::ImuSample& sample) {
    return sample.gyro_radps.stableNorm() > kMostRate_radps ||
           sample.accel_mps2.stableNorm() > kMostForce_mps2;
  };
  const auto first = std::ranges::find_if(samples, is_beyond);
  const auto count = std::count_if(first, samples.end(), is_beyond);
  if (count == 0 || 2 * count > std::ssize(samples)) return;
  tally.add("readings are beyond those of any IMU and are left out",
            fmt::format("{} at {} ns", file.string(), first->t_ns), static_cast<int>(count));
  std::erase_if(samples, is_beyond);
}

/// Median angle, rad, by which the accelerometer's direction at the end of a second is off that at
/// its start, turned by the gyroscope. \param factor of the angular rates.
double tilt_error_rad(const std::vector<sim::ImuSample>& samples, double factor) {
  constexpr double kSpan_s = 1;
  constexpr std::size_t kMost = 20'000, kMean = 20;
  std::vector<double> errors;
  const auto force = [&](std::size_t from) {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = from; i < std::min(from + kMean, samples.size()); ++i) {
      sum += samples[i].accel_mps2;
    }
    return sum;
  };
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  std::size_t begin = 0;
  for (std::size_t i = 1; i < std::min(samples.size(), kMost); ++i) {
    const double dt_s = seconds(samples[i].t_ns - samples[i - 1].t_ns);
    const Vector3d turn = factor * dt_s * samples[i].gyro_radps;
    if (turn.norm() > 0) q = q * Eigen::AngleAxisd(turn.norm(), turn.normalized());
    if (seconds(samples[i].t_ns - samples[begin].t_ns) < kSpan_s) continue;
    const Vector3d predicted = q.conjugate() * force(begin);
    errors.push_back(std::atan2(predicted.cross(force(i)).norm(), predicted.dot(force(i))));
    q.setIdentity();
    begin = i;
  }
  return usual(std::move(errors)).value_or(0);
}

/// Refuses readings that no IMU on a camera has. Gravity dominates an accelerometer's readings, at
/// rest and in motion; no camera turns at 10 rad/s for long.
void require_possible(const std::vector<sim::ImuSample>& samples, const fs::path& file) {
  constexpr double kLeast_mps2 = 6, kMost_mps2 = 25, kFastTurn_radps = 10, kShare = 0.05;
  constexpr double kTilted_rad = 0.25, kBetter = 0.25, kDegree = std::numbers::pi / 180;
  const input::Source where{file.string(), 0};
  std::vector<double> forces, rates;
  for (const sim::ImuSample& sample : samples) {
    forces.push_back(sample.accel_mps2.norm());
    rates.push_back(sample.gyro_radps.norm());
  }
  const auto fast =
      rates.begin() + std::llround((1 - kShare) * static_cast<double>(rates.size() - 1));
  std::nth_element(rates.begin(), fast, rates.end());
  const double often_radps = *fast, usual_radps = *usual(rates);
  const double usual_mps2 = *usual(std::move(forces));
  if (usual_radps > kLeast_mps2 && usual_radps < kMost_mps2 && usual_mps2 < kLeast_mps2) {
    refuse(where,
           "its angular rates have a size of {:.2f} and its accelerations of {:.2f}: the two seem "
           "interchanged; name the columns in a header",
           usual_radps, usual_mps2);
  }
  if (usual_mps2 >= ImuWatch::kLeast_g && usual_mps2 <= ImuWatch::kMost_g) {
    refuse(
        where,
        "accelerations have a size of {:.2f}, gravity in g; multiply them by 9.80665 to have m/s^2 "
        "(and see whether rates are in rad/s), or put their unit into the header, as a_RS_S_x [g]",
        usual_mps2);
  }
  if (usual_mps2 < kLeast_mps2 || usual_mps2 > kMost_mps2) {
    refuse(where,
           "accelerations have a size of {:.3g}, and an IMU at rest measures gravity, 9.81 m/s^2; "
           "give the accelerometer's readings, gravity included, in m/s^2",
           usual_mps2);
  }
  const double tilt_rad = tilt_error_rad(samples, 1);
  const bool is_tilted =
      tilt_rad > kTilted_rad && tilt_error_rad(samples, kDegree) < kBetter * tilt_rad;
  if (often_radps > kFastTurn_radps || is_tilted) {
    refuse(where,
           "its angular rates exceed {:.3g} rad/s for a twentieth of the time, which no camera "
           "does for long{}; if they are in deg/s, put that into the header, as w_RS_S_x [deg/s]",
           often_radps, is_tilted ? ", and contradict the accelerometer" : "");
  }
}

constexpr std::array<const char*, 16> kTruthNames{
    "p_RS_R_x",   "p_RS_R_y",   "p_RS_R_z",   "q_RS_w",    "q_RS_x",     "q_RS_y",
    "q_RS_z",     "v_RS_R_x",   "v_RS_R_y",   "v_RS_R_z",  "b_w_RS_S_x", "b_w_RS_S_y",
    "b_w_RS_S_z", "b_a_RS_S_x", "b_a_RS_S_y", "b_a_RS_S_z"};

/// Counts gaps between readings that exceed four of their usual periods.
void count_gaps(const std::vector<sim::ImuSample>& samples, Tally& tally) {
  constexpr double kSilentPeriods = 4;
  const double longest_s = kSilentPeriods / usual_rate_hz(stamps_of(samples)).value_or(1);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double gap_s = seconds(samples[i].t_ns - samples[i - 1].t_ns);
    if (gap_s <= longest_s) continue;
    tally.add("gaps are in the readings of the IMU, in which the last one is held",
              fmt::format("{:.3f} s after {} ns", gap_s, samples[i - 1].t_ns));
  }
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
  if (table.rows.empty()) refuse({path}, "holds no pose; give a line for each");
  const TextTable::Row& first = table.rows.front();
  const input::Source where{path, first.line};
  const std::size_t fields = first.fields.size();
  const std::optional<Places> named = named_places(table);
  PosesFile poses;
  poses.of_body = table.find("p_RS_R_x").has_value();
  poses.timed = named || fields == kTumFields;
  poses.numbered = !poses.timed && fields == kMatrix + 1;
  if (!named && table.separator == ',' && first.fields.back().empty()) {
    refuse(where,
           "lines that end with a comma are of VINS-Mono or VINS-Fusion, with poses of the IMU; "
           "write time [ns],p_RS_R_x,p_RS_R_y,p_RS_R_z,q_RS_w,q_RS_x,q_RS_y,q_RS_z,{} as its first "
           "line, and give the camera's place on the IMU by a calibration",
           fields > kTumFields + 1 ? "vx,vy,vz," : "");
  }
  if (!poses.timed && fields != kThreeRows && fields != kMatrix && fields != kMatrix + 1) {
    refuse(where,
           "a pose has 8 numbers (TUM: t x y z qx qy qz qw), 12 or 16 (KITTI: rows of a matrix) or "
           "17 (KITTI-360), and this has {}; give a file of one of these, or a header with time, "
           "x, y, z, qx, qy, qz, qw",
           fields);
  }
  if (!named && fields == kTumFields && table.separator == ',') {
    refuse(where,
           "a table with commas has EuRoC's order of a quaternion, w first, or TUM's, w last; give "
           "it a header, as time, x, y, z, qx, qy, qz, qw");
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
    refuse({path},
           "holds no pose: {}, and its first row begins with '{}'; give a line of 8 numbers (TUM: "
           "with its time first) or 12 (KITTI) for each",
           table.columns(), first.fields.front());
  }
  return poses;
}

std::vector<sim::ImuSample> read_imu_csv(const fs::path& file, const TableTimes& times,
                                         Tally& tally, const std::array<std::size_t, 6>& places) {
  const TextTable table = read_table(file);
  const ImuColumns columns = find_columns(table, times, places, tally);
  std::vector<sim::ImuSample> samples;
  for (const NumberRow& row : rows_of(table, columns.time, columns.places, {}, tally)) {
    std::array<double, 6> n{};
    std::ranges::transform(row.numbers, columns.factors, n.begin(), std::multiplies());
    samples.push_back({row.t_ns, {n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
  }
  if (samples.empty()) {
    refuse({file}, "{}", tally.before("holds no reading of an IMU; give a row for each"));
  }
  drop_impossible(samples, file, tally);
  require_possible(samples, file);
  count_gaps(samples, tally);
  return samples;
}

std::vector<sim::OdometrySample> read_odometry_csv(const fs::path& file, const TableTimes& times,
                                                   Tally& tally) {
  static constexpr std::array<const char*, 3> kNames{"v_RB_B_x", "v_RB_B_y", "v_RB_B_z"};
  std::vector<sim::OdometrySample> samples;
  for (const NumberRow& row : read_numbers(file, kNames, times, tally, "w_RB_B_z")) {
    samples.push_back({row.t_ns, vector_at(row, 0)});
    if (row.numbers.size() > kNames.size()) samples.back().yaw_rate_radps = row.numbers.back();
  }
  return samples;
}

CameraPoses read_pose_csv(const fs::path& file, Tally& tally) {
  static constexpr std::array<const char*, 12> kNames{
      "R_00", "R_01", "R_02", "p_x", "R_10", "R_11", "R_12", "p_y", "R_20", "R_21", "R_22", "p_z"};
  CameraPoses poses;
  for (const NumberRow& row : read_numbers(file, kNames, {"ns", {}, {}}, tally)) {
    std::array<double, 16> matrix{};
    std::ranges::copy(row.numbers, matrix.begin());
    matrix[15] = 1;
    try {
      poses.push_back({row.t_ns, sequence::pose_of(matrix)});
    } catch (const std::invalid_argument&) {
      tally.add("rows have no rigid transform and are left out", file.string());
    }
  }
  return poses;
}

std::vector<TrueState> read_truth_csv(const fs::path& file, const TableTimes& times,
                                      bool has_velocities, Tally& tally) {
  constexpr std::size_t kOfPose = 7;
  constexpr std::int64_t kHalfSpan_ns = 25'000'000;  // longer than the noise of a marker's place
  const auto names = std::span(kTruthNames).first(has_velocities ? kTruthNames.size() : kOfPose);
  std::vector<TrueState> states;
  std::vector<Vector3d> places_m;
  for (const NumberRow& row : read_numbers(file, names, times, tally)) {
    if (has_velocities && !is_speed(vector_at(row, 7))) {
      tally.add("rows have a speed above 1000 m/s and are left out", file.string());
      continue;
    }
    const Eigen::Quaterniond q_WB(row.numbers[3], row.numbers[4], row.numbers[5], row.numbers[6]);
    if (!(std::abs(q_WB.norm() - 1) <= kTolerance)) {
      tally.add("rows have no unit quaternion and are left out", file.string());
      continue;
    }
    TrueState& state = states.emplace_back(TrueState{{row.t_ns, q_WB.normalized()}});
    places_m.push_back(vector_at(row, 0));
    if (!has_velocities) continue;
    state.v_WB_mps = vector_at(row, 7);
    state.gyro_bias_radps = vector_at(row, 10);
    state.accel_bias_mps2 = vector_at(row, 13);
  }
  if (has_velocities || states.empty()) return states;
  for (std::size_t i = 0; i < states.size(); ++i) {
    std::size_t a = i, b = i;
    while (a > 0 && states[i].t_ns - states[a].t_ns < kHalfSpan_ns) --a;
    while (b + 1 < states.size() && states[b].t_ns - states[i].t_ns < kHalfSpan_ns) ++b;
    const double span_s = seconds(states[b].t_ns - states[a].t_ns);
    if (span_s > 0) states[i].v_WB_mps = (places_m[b] - places_m[a]) / span_s;
  }
  tally.add(
      "truths have poses alone: velocities are their differences, the IMU's biases count as 0",
      file.string());
  return states;
}

}  // namespace lcs::replay
