// Trajectories in the format of TUM's RGB-D benchmark: t x y z qx qy qz qw.
#include "tools/sequence/pose_text.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

class TumWriter : public Writer {
 public:
  using Writer::Writer;

  void write(const FrameView& frame, FrameOutput& output) const override {
    output.rows["tum_camera"] = pose_line(frame.stamp_ns, frame.now.truth.now.T_WC);
    if (!info_.is_first()) return;
    std::string& imu = output.rows["tum_imu"];
    for (const sim::ImuTruth& state : frame.now.imu_truth)
      imu += pose_line(kEpoch_ns + state.t_ns, state.T_WS);
  }
  std::vector<SequenceDocument> documents() const override {
    std::vector<SequenceDocument> all{{"tum/camera.txt", {{.stream = "tum_camera"}}}};
    if (info_.is_first()) all.push_back({"tum/imu.txt", {{.stream = "tum_imu"}}});
    return all;
  }
};

}  // namespace

const MakeWriter make_tum_writer = make_writer<TumWriter>;

}  // namespace lcs::sequence
