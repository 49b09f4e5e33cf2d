// KITTI odometry's layout: rectified cameras by their projections, times and poses.
#include <fmt/format.h>

#include "tools/sequence/pose_text.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

class KittiWriter : public Writer {
 public:
  explicit KittiWriter(const SequenceInfo& info) : Writer(info) { require_rectified(); }

  void write(const FrameView& frame, FrameOutput& output) const override {
    output.files.push_back({fmt::format("kitti/image_{}/{:06}.png", info_.place, frame.now.index),
                            "", picture_path(frame.stamp_ns, info_.place)});
    if (!info_.is_first()) return;
    output.rows["kitti_times"] =
        fmt::format("{:.9f}\n", 1e-9 * static_cast<double>(frame.stamp_ns - kEpoch_ns));
    const std::array<double, 16> T_WC = matrix_of(frame.now.truth.now.T_WC);
    output.rows["kitti_poses"] = numbers(std::span(T_WC).first(12), " ") + "\n";
  }

  std::vector<SequenceDocument> documents() const override {
    if (!info_.is_first()) return {};
    std::string calibration;
    for (std::size_t i = 0; i < info_.rig.size(); ++i) {
      const sim::Lens& lens = info_.rig[i]->optics.lens();
      const double along_x_m = between(*info_.rig[0], *info_.rig[i]).p.x();
      const double base = along_x_m == 0 ? 0 : -lens.fu_px * along_x_m;  // no -0
      const std::array<double, 12> P{lens.fu_px, 0, lens.cu_px, base, 0, lens.fv_px,
                                     lens.cv_px, 0, 0,          0,    1, 0};
      calibration += fmt::format("P{}: {}\n", i, numbers(P, " "));
    }
    return {{"kitti/calib.txt", {{.text = calibration}}},
            {"kitti/times.txt", {{.stream = "kitti_times"}}},
            {"kitti/poses.txt", {{.stream = "kitti_poses"}}}};
  }

 private:
  /// \throws input::Error unless a projection P describes each camera: no distortion, and all
  /// cameras side by side along x with one matrix of intrinsics.
  void require_rectified() const {
    constexpr double kRounding = 1e-9;
    const auto require = [&](bool holds, const char* fault, const char* remedy) {
      if (holds) return;
      throw input::Error(
          info_.scenario.camera.source,
          "{}, and KITTI's calib.txt is of rectified cameras; leave kitti out of --formats, or {}",
          fault, remedy);
    };
    const sim::Lens& lens = info_.calibration.optics.lens();
    const sim::Lens& first = info_.rig[0]->optics.lens();
    const sim::Pose T_0 = between(*info_.rig[0], info_.calibration);
    require(lens.distortion == sim::Lens::Distortion::none, "the camera has a distortion",
            "remove camera.distortion");
    require(T_0.R.isIdentity(kRounding) && T_0.p.tail<2>().norm() < kRounding,
            "the cameras are not parallel and side by side",
            "give them one rotation, and places that differ along their x alone");
    require(lens.fu_px == first.fu_px && lens.fv_px == first.fv_px && lens.cu_px == first.cu_px &&
                lens.cv_px == first.cv_px && lens.width_px == first.width_px &&
                lens.height_px == first.height_px,
            "the cameras have different intrinsics", "give them one focal length, centre and size");
  }
};

}  // namespace

const MakeWriter make_kitti_writer = make_writer<KittiWriter>;

}  // namespace lcs::sequence
