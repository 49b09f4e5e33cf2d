#include "tools/sequence/self_check.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "sim/camera/linear_light.h"
#include "sim/truth/inner_pixels.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMostFlowError_px = 0.05;
constexpr int kFlowStride = 4;
// Limits on deviations of inverse depth from that of a plane: 0 up to the rounding of the
// depth buffer (24 bits between 0 and 1 / near) and of a float.
constexpr double kFlatAbsolute = 6e-6;  // 1/m
constexpr double kFlatRelative = 2e-5;
constexpr double kDeviations = 6;
// Tolerated difference of grey levels beyond those round the goal: mip levels of textures.
constexpr double kGreyLevels = 36;
constexpr double kMostScaling = 0.25;  // change of the flow between neighbouring pixels, px
constexpr int kBlock_px = 16;
constexpr int kLeastCompared = 64;  // of the pixels of a block
constexpr double kMostDiffering = 0.1;
constexpr int kDisplaced_px = 3;
constexpr int kLongOutline = 200;       // in pairs of neighbouring pixels
constexpr double kMostContrast = 1.75;  // of a displaced outline, over that in place
constexpr double kLeastContrast = 10;   // by which it must be larger, in grey levels

template <class... Arguments>
[[noreturn]] void disagree(int frame, fmt::format_string<Arguments...> what,
                           Arguments&&... arguments) {
  throw TruthError(fmt::format("frame {}: {}; the truth does not agree with itself", frame,
                               fmt::format(what, std::forward<Arguments>(arguments)...)));
}

/// Interpolated inverse depth on a flat surface, where it is linear in the ray; absent if not flat.
std::optional<double> plane_inverse_depth(const sim::Optics& camera, const sim::FrameTruth& truth,
                                          const Vector2d& px) {
  const int x = static_cast<int>(px.x()), y = static_cast<int>(px.y());
  if (x < 1 || y < 1 || x + 2 >= truth.depth_m.cols || y + 2 >= truth.depth_m.rows) return {};
  Eigen::Matrix<double, 16, 3> rays;
  Eigen::Matrix<double, 16, 1> w;
  for (int i = 0; i < 16; ++i) {
    const cv::Point at(x - 1 + i % 4, y - 1 + i / 4);
    if (truth.carrier()(at) != truth.carrier()(y, x)) return {};
    rays.row(i) = camera.ray(at.x, at.y).homogeneous();
    w[i] = 1 / static_cast<double>(truth.depth_m(at));
  }
  const Vector3d plane = (rays.transpose() * rays).ldlt().solve(rays.transpose() * w);
  const double centre = w[5];
  if ((rays * plane - w).cwiseAbs().maxCoeff() > kFlatAbsolute + kFlatRelative * centre) return {};
  return plane.dot(camera.back_project(px, 1));
}

cv::Mat1b grey_of(const cv::Mat3f& light) {
  cv::Mat3b codes;
  cv::Mat1b grey;
  sim::to_codes(light, codes);
  cv::cvtColor(codes, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

/// Whether the surface at a pixel is nearly as large in the next frame: textures keep their detail.
bool is_steady(const cv::Mat2f& motion_px, int x, int y) {
  const auto change_px = [&](int column, int row) {
    return cv::norm(motion_px(row, column) - motion_px(y, x));
  };
  return x + 1 < motion_px.cols && y + 1 < motion_px.rows && change_px(x + 1, y) < kMostScaling &&
         change_px(x, y + 1) < kMostScaling;
}

}  // namespace

Agreement check_flow(const sim::Optics& camera, const sim::Observation& now,
                     const sim::Observation& next, const cv::Mat2f& motion_px,
                     const cv::Mat1b& seen) {
  const sim::PointMotion here(now.truth, motion_px.rows), after(next.truth, motion_px.rows);
  constexpr double zero = kKittiFlowZero, scale = kKittiFlowScale;
  Agreement agreement;
  for (int y = 0; y < motion_px.rows; y += kFlowStride) {
    for (int x = 0; x < motion_px.cols; x += kFlowStride) {
      const cv::Vec3w code = kitti_code(motion_px(y, x), seen(y, x) != 0);
      if (code[2] == 0) continue;
      const Vector2d decoded = Vector2d(code[0] - zero, code[1] - zero) / scale;
      const Vector2d goal = Vector2d(x, y) + decoded;
      const int carrier = now.truth.carrier()(y, x);
      const auto there = cv::Point(static_cast<int>(goal.x()), static_cast<int>(goal.y()));
      if (carrier < 0 || next.truth.carrier()(there) != carrier) continue;
      const std::optional<double> inverse_depth = plane_inverse_depth(camera, next.truth, goal);
      if (!inverse_depth) continue;
      const Vector3d p_N = camera.back_project(goal, 1 / *inverse_depth);
      const auto id = static_cast<std::size_t>(carrier);
      const Vector3d p_O = after.T_WO(id, goal.y()).inverse() * (after.T_WC(goal.y()) * p_N);
      const Vector3d p_C = here.T_WC(y).inverse() * (here.T_WO(id, y) * p_O);
      const double distance = (camera.project(p_C) - Vector2d(x, y)).norm();
      agreement.add(distance);
      if (!(distance < kMostFlowError_px)) {
        disagree(now.index,
                 "the flow at ({}, {}) leads to ({:.2f}, {:.2f}), and depth and poses from there "
                 "lead back to a place {:.3f} px away",
                 x, y, goal.x(), goal.y(), distance);
      }
    }
  }
  return agreement;
}

Agreement check_picture(const sim::Observation& now, const sim::Observation& next,
                        const TrueFlow& flow) {
  cv::Mat1b darkest, brightest;
  const cv::Mat1b grey = grey_of(now.rendered), next_grey = grey_of(next.rendered);
  cv::erode(next_grey, darkest, {});
  cv::dilate(next_grey, brightest, {});
  const cv::Mat1b now_inner = sim::inner_pixels(now.geom),
                  next_inner = sim::inner_pixels(next.geom);

  /// A compared pixel: its grey level, and the range of levels round its goal.
  struct Compared {
    double grey, low, high;
  };
  Agreement agreement;
  std::vector<Compared> block;
  std::vector<double> changes;
  for (int top = 0; top < grey.rows; top += kBlock_px) {
    for (int left = 0; left < grey.cols; left += kBlock_px) {
      block.clear();
      changes.clear();
      const cv::Rect pixels =
          cv::Rect(left, top, kBlock_px, kBlock_px) & cv::Rect({0, 0}, grey.size());
      for (int y = pixels.y; y < pixels.br().y; ++y) {
        for (int x = pixels.x; x < pixels.br().x; ++x) {
          if (!flow.seen(y, x) || !is_steady(flow.full_px, x, y)) continue;
          const cv::Point2f goal_px =
              cv::Point2f(cv::Point(x, y)) + cv::Point2f(flow.full_px(y, x));
          const cv::Rect goal(static_cast<int>(goal_px.x), static_cast<int>(goal_px.y), 2, 2);
          if ((goal & cv::Rect({1, 1}, grey.size() - cv::Size(2, 2))) != goal) continue;
          Compared pixel{static_cast<double>(grey(y, x)), 255, 0};
          bool is_inside = now_inner(y, x) != 0;
          for (const cv::Point at : {goal.tl(), goal.tl() + cv::Point(1, 0),
                                     goal.tl() + cv::Point(0, 1), goal.tl() + cv::Point(1, 1)}) {
            is_inside &= next_inner(at) && next.geom(at) == now.geom(y, x);
            pixel.low = std::min<double>(pixel.low, darkest(at));
            pixel.high = std::max<double>(pixel.high, brightest(at));
          }
          if (!is_inside) continue;
          block.push_back(pixel);
          changes.push_back(pixel.grey - std::clamp(pixel.grey, pixel.low, pixel.high));
        }
      }
      if (block.size() < kLeastCompared) continue;
      const auto middle = changes.begin() + std::ssize(changes) / 2;
      std::nth_element(changes.begin(), middle, changes.end());
      const auto differ = std::ranges::count_if(block, [&](const Compared& pixel) {
        const double level = pixel.grey - *middle;
        return level < pixel.low - kGreyLevels || level > pixel.high + kGreyLevels;
      });
      const double share = static_cast<double>(differ) / static_cast<double>(block.size());
      agreement.add(share);
      if (share > kMostDiffering) {
        disagree(now.index,
                 "{} of {} pixels in the block of {} px at ({}, {}) do not look as they do where "
                 "the flow leads",
                 differ, block.size(), kBlock_px, left, top);
      }
    }
  }
  return agreement;
}

Agreement check_outlines(const sim::Observation& frame, const cv::Mat1w& mask) {
  constexpr int kSide = 2 * kDisplaced_px + 1;
  struct Outline {
    int pairs = 0;
    std::array<double, kSide * kSide> contrast{};  ///< by displacement, sums over pairs
  };
  const cv::Mat1b grey = grey_of(frame.rendered);
  std::map<int, Outline> outlines;  // by object
  for (int y = kDisplaced_px; y + kDisplaced_px + 1 < grey.rows; ++y) {
    for (int x = kDisplaced_px; x + kDisplaced_px + 1 < grey.cols; ++x) {
      for (const cv::Point step : {cv::Point(1, 0), cv::Point(0, 1)}) {
        const cv::Point a(x, y), b = a + step;
        if (mask(a) == mask(b)) continue;
        std::array<double, kSide * kSide> contrast{};
        for (int i = 0; i < kSide * kSide; ++i) {
          const cv::Point by(i % kSide - kDisplaced_px, i / kSide - kDisplaced_px);
          contrast[static_cast<std::size_t>(i)] = std::abs(grey(a + by) - grey(b + by));
        }
        for (const int id : {mask(a), mask(b)}) {
          if (id == 0 || id == kVoid) continue;
          Outline& outline = outlines[id];
          ++outline.pairs;
          std::ranges::transform(contrast, outline.contrast, outline.contrast.begin(), std::plus());
        }
      }
    }
  }
  Agreement agreement;
  for (const auto& [id, outline] : outlines) {
    if (outline.pairs < kLongOutline) continue;
    const double in_place = outline.contrast[kSide * kSide / 2] / outline.pairs;
    const double best = *std::ranges::max_element(outline.contrast) / outline.pairs;
    if (best < kLeastContrast) continue;
    agreement.add(best / std::max(in_place, 1.0));
    if (best > kMostContrast * in_place && best > in_place + kLeastContrast) {
      disagree(frame.index,
               "the outline of object {} has a contrast of {:.1f} grey levels in its mask, and of "
               "{:.1f} at another place",
               id, in_place, best);
    }
  }
  return agreement;
}

void check_masks(int frame, const cv::Mat1w& mask, std::span<const sim::ObjectTruth> objects,
                 int count) {
  cv::Mat1i ids(mask.size(), 0);
  std::transform(mask.begin(), mask.end(), ids.begin(),
                 [&](std::uint16_t id) { return id <= count ? id : 0; });
  std::vector<sim::ObjectTruth> in_mask = sim::modal_boxes(ids, count);
  for (const sim::ObjectTruth& object : objects) {
    sim::ObjectTruth& seen = in_mask.at(static_cast<std::size_t>(object.object - 1));
    const bool agree = seen.left == object.left && seen.top == object.top &&
                       seen.right == object.right && seen.bottom == object.bottom &&
                       seen.visible_px == object.visible_px && seen.mask == object.mask;
    if (!agree) {
      disagree(frame,
               "the box of object {} is [{}, {}) x [{}, {}), its mask's box [{}, {}) x [{}, {})",
               object.object, object.left, object.right, object.top, object.bottom, seen.left,
               seen.right, seen.top, seen.bottom);
    }
    seen.visible_px = 0;  // matched
  }
  for (const sim::ObjectTruth& object : in_mask) {
    if (object.visible_px > 0) {
      disagree(frame, "object {} has {} pixels in the mask and no box", object.object,
               object.visible_px);
    }
  }
}

Agreement check_imu(const scenario::Imu& imu, double gravity_mps2, const sim::Observation& frame) {
  Agreement agreement;
  const std::vector<sim::ImuTruth>& truth = frame.imu_truth;
  // Skips a gap, which has fewer readings than there are states.
  if (truth.size() < 2 || frame.imu.size() != truth.size()) return agreement;

  const auto& [M, C_gyro_i, A, range_radps, resolution_radps] = imu.gyroscopes;
  const auto& [M_accel, range_mps2, resolution_mps2] = imu.accelerometers;
  const auto is_beyond = [](const Vector3d& reading, const std::optional<double>& range,
                            const std::optional<double>& resolution) {
    return range && reading.cwiseAbs().maxCoeff() >= *range - resolution.value_or(0);
  };
  const auto turn = [](const Vector3d& angle) {
    const double norm = angle.norm();
    return norm > 0 ? Eigen::AngleAxisd(norm, angle / norm).toRotationMatrix()
                    : Eigen::Matrix3d::Identity().eval();
  };
  struct Reading {
    Vector3d gyro, accel;
  };
  // without bias and errors
  const auto corrected = [&](std::size_t i) -> Reading {
    const sim::ImuSample& sample = frame.imu[i];
    const Vector3d accel =
        M_accel.triangularView<Eigen::Lower>().solve(sample.accel_mps2 - truth[i].accel_bias_mps2);
    return {C_gyro_i.transpose() * M.triangularView<Eigen::Lower>().solve(sample.gyro_radps -
                                                                          truth[i].gyro_bias_radps -
                                                                          A * (C_gyro_i * accel)),
            accel};
  };
  Eigen::Matrix3d R_WS = truth.front().T_WS.R;
  Vector3d v_WS_mps = truth.front().v_WS_mps;
  double unsure_rad = 0, unsure_mps = 0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const sim::ImuSample& sample = frame.imu[i];
    if (is_beyond(sample.gyro_radps, range_radps, resolution_radps) ||
        is_beyond(sample.accel_mps2, range_mps2, resolution_mps2)) {
      return agreement;  // the motion is not in the readings
    }
    const Reading now = corrected(i);
    // The mean rates of the step; of two samples within half of their difference.
    Reading mean = now;
    const double dt_s = static_cast<double>(truth[i].t_ns - truth[i - 1].t_ns) * 1e-9;
    if (imu.reading == scenario::ImuReading::sample) {
      const Reading before = corrected(i - 1);
      mean = {(before.gyro + now.gyro) / 2, (before.accel + now.accel) / 2};
      unsure_rad += dt_s * (now.gyro - before.gyro).norm() / 2;
      unsure_mps += dt_s * (now.accel - before.accel).norm() / 2;
    }
    const Eigen::Matrix3d R_middle = R_WS * turn(0.5 * dt_s * mean.gyro);
    v_WS_mps += dt_s * (R_middle * mean.accel - gravity_mps2 * Vector3d::UnitZ());
    R_WS *= turn(dt_s * mean.gyro);
  }
  const double span_s = static_cast<double>(truth.back().t_ns - truth.front().t_ns) * 1e-9;
  // Rounding errors of a static, noiseless IMU.
  constexpr double kRounding = 1e-9;
  // The scales of a triad are near 1; on three axes a resolution is off by sqrt(3) / 2 at most.
  const double most_rad = kRounding + unsure_rad +
                          kDeviations * imu.noise.gyroscope_noise_density * std::sqrt(span_s) +
                          resolution_radps.value_or(0) * span_s;
  const double most_mps = kRounding + unsure_mps +
                          kDeviations * imu.noise.accelerometer_noise_density * std::sqrt(span_s) +
                          resolution_mps2.value_or(0) * span_s + gravity_mps2 * span_s * most_rad;
  const double turned_rad =
      Eigen::AngleAxisd(Eigen::Matrix3d(truth.back().T_WS.R.transpose() * R_WS)).angle();
  const double off_mps = (v_WS_mps - truth.back().v_WS_mps).norm();
  agreement.add(turned_rad / most_rad);
  agreement.add(off_mps / most_mps);
  if (!(turned_rad <= most_rad && off_mps <= most_mps)) {
    disagree(frame.index,
             "the IMU's readings lead {:.2e} rad and {:.2e} m/s away from the poses, where the "
             "noise allows for {:.2e} rad and {:.2e} m/s",
             turned_rad, off_mps, most_rad, most_mps);
  }
  return agreement;
}

void check_times(const scenario::Scenario& scenario, const sim::Observation& frame) {
  const auto time_of = [](double k, double rate_hz) { return std::llround(k * 1e9 / rate_hz); };
  const double rate = scenario.camera.rate_hz;
  if (frame.t_ns != time_of(frame.index, rate)) {
    disagree(frame.index, "its time is {} ns, which is not on the grid of {} Hz", frame.t_ns, rate);
  }
  const std::int64_t told_ns = std::llround(1e9 * scenario.camera.told.time_offset_error_s);
  std::int64_t after = frame.index == 0 ? -1 : told_ns + time_of(frame.index - 1, rate);
  for (const sim::ImuTruth& state : frame.imu_truth) {
    const auto k = std::round(static_cast<double>(state.t_ns) * 1e-9 * scenario.imu.rate_hz);
    if (state.t_ns <= after || state.t_ns > frame.t_ns + told_ns ||
        state.t_ns != time_of(k, scenario.imu.rate_hz)) {
      disagree(frame.index, "a reading of the IMU at {} ns is out of step", state.t_ns);
    }
    after = state.t_ns;
  }
}

}  // namespace lcs::sequence
