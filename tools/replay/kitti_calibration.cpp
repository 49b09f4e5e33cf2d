#include "tools/replay/kitti_calibration.h"

#include <fmt/format.h>

#include <sstream>

#include "scenarios/input/input_file.h"
#include "tools/files/csv.h"
#include "tools/replay/poses_file.h"

namespace lcs::replay {
namespace {

constexpr input::FileKind kCalibration{input::kMebibyte, "give the file as KITTI has it"};
constexpr std::size_t kRows = 12;  // numbers of three rows of a matrix

}  // namespace

std::string kitti_camera(const scenario::RecordingSource& asked, std::span<const char* const> names,
                         const char* otherwise) {
  if (!asked.camera.empty()) return asked.camera;
  for (const char* name : names) {
    if (fs::is_directory(asked.path / name)) return name;
  }
  return otherwise;
}

KittiCalibration::KittiCalibration(const fs::path& file) : file_(file) {
  input::InputFile input(file, kCalibration);
  int unnamed = 0;
  for (std::string line; input.next_line(line);) {
    if (files::trimmed(line).empty()) continue;
    const std::string_view text = files::trimmed(line);
    const std::size_t end = text.find_first_of(": ");  // KITTI tracking names some without a colon
    const bool is_named =
        end != text.npos && !files::number_in<double>(text.substr(0, end)).has_value();
    std::istringstream words{std::string(is_named ? text.substr(end + 1) : text)};
    std::vector<double>& numbers =
        values_[is_named ? std::string(text.substr(0, end)) : fmt::format("P{}", unnamed++)];
    for (double number; words >> number;) numbers.push_back(number);
  }
}

const std::vector<double>& KittiCalibration::numbers(const std::string& name,
                                                     std::size_t count) const {
  const auto found = values_.find(name);
  if (found == values_.end() || found->second.size() != count) {
    throw input::Error({file_.string(), 0}, "{} is missing, or is not {} numbers; {}", name, count,
                       kCalibration.remedy);
  }
  return found->second;
}

Eigen::Matrix3d KittiCalibration::rotation(const std::string& name) const {
  const auto R = rotation_of(
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers(name, 9).data()));
  if (!R) {
    throw input::Error({file_.string(), 0}, "{} is no rotation; {}", name, kCalibration.remedy);
  }
  return *R;
}

sim::Pose KittiCalibration::pose(const std::string& name) const {
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> rows(
      numbers(name, kRows).data());
  const auto R = rotation_of(rows.leftCols<3>());
  if (!R) {
    throw input::Error({file_.string(), 0}, "{} has no rotation; {}", name, kCalibration.remedy);
  }
  return {*R, rows.col(3)};
}

sim::Pose KittiCalibration::pose() const {
  return {rotation("R"), Eigen::Map<const Vector3d>(numbers("T", 3).data())};
}

Lens KittiCalibration::lens(const std::string& name) const {
  const std::vector<double>& P = numbers(name, kRows);
  Lens lens = pinhole({P[0], P[5], P[2], P[6]}, {file_.string(), 0});
  constexpr std::string_view kRectified = "P_rect_";
  if (!name.starts_with(kRectified)) return lens;
  const std::string size = "S_rect_" + name.substr(kRectified.size());
  if (values_.contains(size)) {
    lens.width_px = static_cast<int>(numbers(size, 2)[0]);
    lens.height_px = static_cast<int>(numbers(size, 2)[1]);
  }
  return lens;
}

sim::Pose KittiCalibration::beside(const std::string& name) const {
  const std::vector<double>& P = numbers(name, kRows);
  return {Eigen::Matrix3d::Identity(), {P[3] / P[0], P[7] / P[5], P[11]}};
}

}  // namespace lcs::replay
