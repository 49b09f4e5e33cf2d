#include "tools/replay/kitti_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tools/files/csv.h"
#include "tools/input/input_file.h"
#include "tools/replay/poses_file.h"

namespace lcs::replay {
namespace {

constexpr input::FileKind kCalibration{input::kMebibyte, "give the file as KITTI has it"};
constexpr std::size_t kProjection = 12;

}  // namespace

KittiCalibration::KittiCalibration(const std::filesystem::path& file) : file_(file) {
  input::InputFile input(file, kCalibration);
  int unnamed = 0;
  for (std::string line; input.next_line(line);) {
    if (bench::trimmed(line).empty()) continue;
    const std::size_t colon = line.find(':');
    const bool is_named = colon != line.npos;
    std::istringstream words(is_named ? line.substr(colon + 1) : line);
    std::vector<double>& numbers =
        values_[is_named ? line.substr(0, colon) : fmt::format("P{}", unnamed++)];
    for (double number; words >> number;) numbers.push_back(number);
  }
}

const std::vector<double>& KittiCalibration::numbers(const std::string& name,
                                                     std::size_t count) const {
  const auto found = values_.find(name);
  if (found == values_.end() || found->second.size() != count) {
    throw input::Error({file_.string(), 0}, fmt::format("{} is missing, or is not {} numbers; {}",
                                                        name, count, kCalibration.remedy));
  }
  return found->second;
}

Eigen::Matrix3d KittiCalibration::rotation(const std::string& name) const {
  const auto R = rotation_of(
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers(name, 9).data()));
  if (!R) {
    throw input::Error({file_.string(), 0},
                       fmt::format("{} is no rotation; {}", name, kCalibration.remedy));
  }
  return *R;
}

sim::Pose KittiCalibration::pose() const {
  return {rotation("R"), Eigen::Map<const Eigen::Vector3d>(numbers("T", 3).data())};
}

Lens KittiCalibration::lens(const std::string& name) const {
  const std::vector<double>& P = numbers(name, kProjection);
  Lens lens;
  lens.fu_px = P[0];
  lens.fv_px = P[5];
  lens.cu_px = P[2];
  lens.cv_px = P[6];
  lens.source = {file_.string(), 0};
  return lens;
}

sim::Pose KittiCalibration::beside(const std::string& name) const {
  const std::vector<double>& P = numbers(name, kProjection);
  return {Eigen::Matrix3d::Identity(), {P[3] / P[0], P[7] / P[5], P[11]}};
}

}  // namespace lcs::replay
