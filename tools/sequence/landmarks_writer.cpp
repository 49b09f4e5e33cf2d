// The truth of every FAST corner, as used by the scores of a run: one row each.
#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "filter/detect/fast.h"
#include "tools/recording/recording_fields.h"
#include "tools/recording/recording_io.h"
#include "tools/sequence/replay_settings.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

std::string or_empty(double number) {
  return std::isfinite(number) ? fmt::format("{}", number) : "";
}

class LandmarksWriter : public Writer {
 public:
  explicit LandmarksWriter(const SequenceInfo& info)
      : info_(info), detector_(info.scenario.fast_threshold) {}

  void write(const FrameView& frame, FrameOutput& output) const override {
    const sim::Observation& o = frame.now;
    cv::Mat1b grey;
    cv::cvtColor(o.image, grey, cv::COLOR_BGR2GRAY);
    const std::vector<Eigen::Vector2f> corners = detector_.detect(grey);
    const std::vector<sim::CornerTruth> truth = sim::label_corners(
        info_.calibration.camera, o.truth, corners, info_.scenario.truth_min_depth_m);
    bench::FrameRecord seen;
    seen.index = o.index;
    seen.t_ns = o.t_ns + kEpoch_ns;
    seen.corners_px = corners;
    seen.corner_truth = truth;
    seen.object_truth = o.objects;
    output.rows["truth"] = bench::seen_line(seen) + '\n';
    std::string& rows = output.rows["landmarks"];
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const sim::CornerTruth& corner = truth[i];
      const std::string_view label = bench::names_of(corner.label)[static_cast<int>(corner.label)];
      const bool is_landmark = corner.label != sim::Label::none;
      const auto pair = [&](const Eigen::Vector2d& v) {
        return is_landmark ? or_empty(v.x()) + "," + or_empty(v.y()) : ",";
      };
      rows += fmt::format("{},{},{},{},{},{},{},{},{}\n", o.index, corners[i].x(), corners[i].y(),
                          corner.object, is_landmark ? or_empty(corner.depth_m) : "",
                          pair(corner.motion_px), pair(corner.static_motion_px), label,
                          corner.radial ? 1 : 0);
    }
  }

  std::vector<Document> documents() const override {
    return {
        {"landmarks.csv",
         {{.text = "frame,x_px,y_px,object,depth_m,motion_x_px,motion_y_px,static_motion_x_px,"
                   "static_motion_y_px,label,radial\n"},
          {.stream = "landmarks"}}},
        {kTruthFile, {{.text = bench::objects_line(info_.objects) + '\n'}, {.stream = "truth"}}}};
  }

 private:
  SequenceInfo info_;
  FastDetector detector_;
};

}  // namespace

std::unique_ptr<Writer> make_landmarks_writer(const SequenceInfo& info) {
  return std::make_unique<LandmarksWriter>(info);
}

}  // namespace lcs::sequence
