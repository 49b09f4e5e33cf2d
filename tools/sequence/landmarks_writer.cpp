// The truth of every FAST corner, as used by the scores of a run: one row each.
#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "filter/detect/fast.h"
#include "sim/camera/rectifier.h"
#include "tools/recording/recording_fields.h"
#include "tools/recording/recording_io.h"
#include "tools/sequence/replay_settings.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

std::string or_empty(double number) {
  return std::isfinite(number) ? fmt::format("{}", number) : "";
}

std::vector<sim::CornerTruth> labels_of(const SequenceInfo& info, const sim::FrameTruth& truth,
                                        std::span<const Eigen::Vector2f> corners_px) {
  return sim::label_corners(info.calibration.camera, truth, corners_px,
                            info.scenario.truth_min_depth_m, &info.calibration.optics);
}

/// The truth of corners of the picture, with motions in the picture. The labels are found for
/// the same corners in the pinhole's picture.
std::vector<sim::CornerTruth> labels_in_picture(const SequenceInfo& info,
                                                const sim::FrameTruth& truth,
                                                std::span<const Eigen::Vector2f> corners) {
  const sim::Pinhole& camera = info.calibration.camera;
  const sim::Optics& optics = info.calibration.optics;
  if (optics.is_pinhole()) return labels_of(info, truth, corners);
  std::vector<Eigen::Vector2f> straight;
  for (const Eigen::Vector2f& corner : corners) {
    straight.push_back(camera.project(optics.back_project(corner.cast<double>(), 1)).cast<float>());
  }
  std::vector<sim::CornerTruth> labels = labels_of(info, truth, straight);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const auto in_picture = [&](Eigen::Vector2d& motion_px) {
      const Eigen::Vector2d goal_px = straight[i].cast<double>() + motion_px;
      motion_px = optics.project(camera.back_project(goal_px, 1)) - corners[i].cast<double>();
    };
    in_picture(labels[i].motion_px);
    in_picture(labels[i].static_motion_px);
  }
  return labels;
}

}  // namespace

Writer landmarks_writer(const SequenceInfo& info) {
  const FastDetector detector(info.scenario.fast_threshold);
  const sim::Rectifier rectifier(info.calibration.optics.lens(), info.calibration.optics.size_px());
  const auto write = [=](const FrameView& frame, FrameOutput& output) {
    const sim::Observation& o = frame.now;
    cv::Mat1b grey;
    cv::cvtColor(o.image, grey, cv::COLOR_BGR2GRAY);
    const std::vector<Eigen::Vector2f> corners = detector.detect(grey);
    recording::FrameRecord seen;
    seen.index = o.index;
    seen.t_ns = frame.stamp_ns;
    seen.corners_px = corners;
    rectifier.rectify(seen.corners_px);
    seen.corner_truth = labels_of(info, o.truth, seen.corners_px);
    seen.object_truth = rectifier.rectified(o.objects, o.truth.object);
    output.rows["truth"] = recording::seen_line(seen) + '\n';
    const std::vector<sim::CornerTruth> truth = labels_in_picture(info, o.truth, corners);
    std::string& rows = output.rows["landmarks"];
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const sim::CornerTruth& corner = truth[i];
      const std::string_view label =
          recording::names_of(corner.label)[static_cast<int>(corner.label)];
      const bool is_landmark = corner.label != sim::Label::none;
      const auto pair = [&](const Eigen::Vector2d& v) {
        return is_landmark ? or_empty(v.x()) + "," + or_empty(v.y()) : ",";
      };
      rows += fmt::format("{},{},{},{},{},{},{},{},{}\n", o.index, corners[i].x(), corners[i].y(),
                          corner.object, is_landmark ? or_empty(corner.depth_m) : "",
                          pair(corner.motion_px), pair(corner.static_motion_px), label,
                          corner.radial ? 1 : 0);
    }
  };
  return {write,
          {{"landmarks.csv",
            {{.text = "frame,x_px,y_px,object,depth_m,motion_x_px,motion_y_px,static_motion_x_px,"
                      "static_motion_y_px,label,radial\n"},
             {.stream = "landmarks"}}},
           {kTruthFile,
            {{.text = recording::objects_line(info.objects) + '\n'}, {.stream = "truth"}}}}};
}

}  // namespace lcs::sequence
