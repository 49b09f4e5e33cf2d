#include "tools/replay/sensor_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "filter/ego_motion/imu_watch.h"
#include "tools/files/csv.h"
#include "tools/replay/in_order.h"
#include "tools/replay/navigation.h"
#include "tools/replay/times.h"
#include "tools/sequence/pose_text.h"

namespace lcs::replay {
namespace {

using Eigen::Vector3d;

/// A time and the numbers of the requested columns.
struct NumberRow {
  std::int64_t t_ns = 0;
  std::vector<double> numbers;
};

/// \param names of columns in a header; without one they follow the time in this order.
/// \param last name of an optional further column.
std::vector<NumberRow> read_numbers(const std::filesystem::path& file,
                                    std::span<const char* const> names, Tally& tally,
                                    std::optional<std::string_view> last = std::nullopt) {
  const TextTable table = read_table(file, ',');
  std::vector<std::size_t> columns;
  for (const char* name : names) columns.push_back(table.column(name, columns.size() + 1));
  std::optional<std::size_t> last_column;
  if (last && (table.header.empty() ||
               std::find(table.header.begin(), table.header.end(), *last) != table.header.end())) {
    last_column = table.column(*last, columns.size() + 1);
  }
  std::vector<NumberRow> rows;
  for (const TextTable::Row& row : table.rows) {
    const auto text = [&](std::size_t column) -> std::string_view {
      return column < row.fields.size() ? std::string_view(row.fields[column]) : "";
    };
    const auto t_ns = time_in(text(0), 1);
    NumberRow read{t_ns.value_or(0), {}};
    const auto take = [&](std::size_t column) {
      if (const auto number = bench::number_in<double>(text(column))) {
        read.numbers.push_back(*number);
      }
    };
    for (const std::size_t column : columns) take(column);
    const bool whole = t_ns && read.numbers.size() == columns.size();
    if (last_column) take(*last_column);
    if (whole) {
      rows.push_back(std::move(read));
    } else {
      tally.add("rows cannot be read and are left out", table.at(row));
    }
  }
  sort_by_time(rows, "rows", file.string(), tally);
  return rows;
}

Vector3d vector_at(const NumberRow& row, std::size_t first) {
  return {row.numbers[first], row.numbers[first + 1], row.numbers[first + 2]};
}

/// The upper median for an even number of values. \pre not empty
template <typename T>
T median(std::vector<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Gravity dominates an accelerometer's readings, at rest and in motion.
/// \throws std::runtime_error if the readings are in g.
void check_units(const std::vector<sim::ImuSample>& samples, const std::filesystem::path& file) {
  std::vector<double> sizes;
  for (const sim::ImuSample& sample : samples) sizes.push_back(sample.accel_mps2.norm());
  const double usual = median(std::move(sizes));
  if (usual < ImuWatch::kLeast_g || usual > ImuWatch::kMost_g) return;
  throw std::runtime_error(
      fmt::format("{}: accelerations have a size of {:.2f}, gravity in g; multiply them by 9.80665 "
                  "to have m/s^2 "
                  "(and see whether rates are in rad/s)",
                  file.string(), usual));
}

}  // namespace

std::vector<sim::ImuSample> read_imu_csv(const std::filesystem::path& file, Tally& tally) {
  static constexpr std::array<const char*, 6> kNames{"w_RS_S_x", "w_RS_S_y", "w_RS_S_z",
                                                     "a_RS_S_x", "a_RS_S_y", "a_RS_S_z"};
  std::vector<sim::ImuSample> samples;
  for (const NumberRow& row : read_numbers(file, kNames, tally)) {
    samples.push_back({row.t_ns, vector_at(row, 0), vector_at(row, 3)});
  }
  if (samples.empty()) {
    throw std::runtime_error(
        fmt::format("{} holds no reading of an IMU; give a row for each", file.string()));
  }
  check_units(samples, file);
  count_gaps(samples, tally);
  return samples;
}

std::vector<sim::OdometrySample> read_odometry_csv(const std::filesystem::path& file,
                                                   Tally& tally) {
  static constexpr std::array<const char*, 3> kNames{"v_RB_B_x", "v_RB_B_y", "v_RB_B_z"};
  std::vector<sim::OdometrySample> samples;
  for (const NumberRow& row : read_numbers(file, kNames, tally, "w_RB_B_z")) {
    samples.push_back({row.t_ns, vector_at(row, 0)});
    if (row.numbers.size() > kNames.size()) samples.back().yaw_rate_radps = row.numbers.back();
  }
  return samples;
}

std::vector<SensorReadings::CameraPose> read_pose_csv(const std::filesystem::path& file,
                                                      Tally& tally) {
  static constexpr std::array<const char*, 12> kNames{
      "R_00", "R_01", "R_02", "p_x", "R_10", "R_11", "R_12", "p_y", "R_20", "R_21", "R_22", "p_z"};
  std::vector<SensorReadings::CameraPose> poses;
  for (const NumberRow& row : read_numbers(file, kNames, tally)) {
    std::array<double, 16> matrix{};
    std::copy(row.numbers.begin(), row.numbers.end(), matrix.begin());
    matrix[15] = 1;
    try {
      poses.push_back({row.t_ns, sequence::pose_of(matrix)});
    } catch (const std::invalid_argument&) {
      tally.add("rows have no rigid transform and are left out", file.string());
    }
  }
  return poses;
}

std::vector<TrueState> read_truth_csv(const std::filesystem::path& file, Tally& tally) {
  static constexpr std::array<const char*, 16> kNames{
      "p_RS_R_x",   "p_RS_R_y",   "p_RS_R_z",   "q_RS_w",    "q_RS_x",     "q_RS_y",
      "q_RS_z",     "v_RS_R_x",   "v_RS_R_y",   "v_RS_R_z",  "b_w_RS_S_x", "b_w_RS_S_y",
      "b_w_RS_S_z", "b_a_RS_S_x", "b_a_RS_S_y", "b_a_RS_S_z"};
  constexpr double kUnit = 1e-2;  // largest error in the length of a rounded quaternion
  std::vector<TrueState> states;
  for (const NumberRow& row : read_numbers(file, kNames, tally)) {
    TrueState& truth = states.emplace_back();
    truth.t_ns = truth.state.t_ns = row.t_ns;
    const Eigen::Quaterniond q(row.numbers[3], row.numbers[4], row.numbers[5], row.numbers[6]);
    if (!(std::abs(q.norm() - 1) <= kUnit)) {
      states.pop_back();
      tally.add("rows have no unit quaternion and are left out", file.string());
      continue;
    }
    if (!is_speed(row.numbers[7], row.numbers[8], row.numbers[9])) {
      states.pop_back();
      tally.add("rows have a speed above 1000 m/s and are left out", file.string());
      continue;
    }
    truth.state.q_WB = q.normalized();
    truth.state.v_WB_mps = vector_at(row, 7);
    truth.gyro_bias_radps = vector_at(row, 10);
    truth.accel_bias_mps2 = vector_at(row, 13);
  }
  return states;
}

void count_gaps(const std::vector<sim::ImuSample>& samples, Tally& tally) {
  constexpr int kSilentPeriods = 4;
  std::vector<std::int64_t> periods;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    periods.push_back(samples[i].t_ns - samples[i - 1].t_ns);
  }
  if (periods.empty()) return;
  const std::int64_t usual = median(periods);
  for (std::size_t i = 0; i < periods.size(); ++i) {
    if (periods[i] / kSilentPeriods > usual) {
      tally.add("gaps are in the readings of the IMU, in which the last one is held",
                fmt::format("{:.3f} s after {} ns", static_cast<double>(periods[i]) * 1e-9,
                            samples[i].t_ns));
    }
  }
}

}  // namespace lcs::replay
