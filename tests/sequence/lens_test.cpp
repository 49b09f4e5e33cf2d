// The truth of distorted pictures against OpenCV's projections.
#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <sstream>

#include "scenarios/load.h"
#include "sim/simulation.h"
#include "tools/sequence/self_check.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// OpenCV's ray and image of a point through a lens.
class ByOpenCv {
 public:
  explicit ByOpenCv(const sim::Lens& lens)
      : is_fisheye_(lens.distortion == sim::Lens::Distortion::equidistant),
        K_(lens.fu_px, 0, lens.cu_px, 0, lens.fv_px, lens.cv_px, 0, 0, 1),
        coefficients_(lens.coefficients) {}

  Vector3d ray(const Vector2d& px) const {
    const std::vector<cv::Point2d> from{{px.x(), px.y()}};
    std::vector<cv::Point2d> to;
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12);
    if (is_fisheye_) {
      cv::fisheye::undistortPoints(from, to, K_, coefficients_, cv::noArray(), cv::noArray(),
                                   until);
    } else {
      cv::undistortPoints(from, to, K_, coefficients_, cv::noArray(), cv::noArray(), until);
    }
    return {to[0].x, to[0].y, 1};
  }
  Vector2d project(const Vector3d& x_C) const {
    const std::vector<cv::Point3d> from{{x_C.x(), x_C.y(), x_C.z()}};
    std::vector<cv::Point2d> to;
    const cv::Vec3d zero(0, 0, 0);
    if (is_fisheye_) {
      cv::fisheye::projectPoints(from, to, zero, zero, K_, coefficients_);
    } else {
      cv::projectPoints(from, zero, zero, K_, coefficients_, to);
    }
    return {to[0].x, to[0].y};
  }

 private:
  bool is_fisheye_;
  cv::Matx33d K_;
  std::vector<double> coefficients_;
};

struct Case {
  std::string name, file;
  std::vector<std::string> sets;
};

class Lens : public testing::TestWithParam<Case> {
 protected:
  Lens()
      : scenario_(scenario::load(std::filesystem::path(LCS_SCENARIOS_DIR) / GetParam().file,
                                 {.sets = GetParam().sets, .seed = {}})),
        simulation_(scenario_) {
    for (int i = 0; i < 12; ++i) simulation_.skip();
    now_ = simulation_.next().value();
    next_ = simulation_.next().value();
    flow_ = true_flow(optics(), now_.truth, now_.geom, {next_.truth.depth_m, next_.geom});
  }
  const sim::Optics& optics() const { return simulation_.calibration().optics; }

  /// A point of frame k at frame k+1, in C, by its object, or as if it were fixed (0).
  Vector3d moved(const Vector3d& p_C, int object) const {
    const auto id = static_cast<std::size_t>(object);
    const sim::FrameTruth& t = now_.truth;
    return t.next.T_WC.inverse() *
           (t.next.T_WO[id] * (t.now.T_WO[id].inverse() * (t.now.T_WC * p_C)));
  }

  scenario::Scenario scenario_;
  sim::Simulation simulation_;
  sim::Observation now_, next_;
  TrueFlow flow_;
};

INSTANTIATE_TEST_SUITE_P(
    Cameras, Lens,
    testing::Values(Case{"RadialTangential",
                         "crossing.yaml",
                         {"camera.focal=[420, 410]", "camera.centre=[330, 225]",
                          "camera.distortion=[-0.28, 0.07, 0.0002, 0.00002, 0]"}},
                    Case{
                        "Pincushion",
                        "crossing.yaml",
                        {"camera.focal=500", "camera.distortion=[0.1, 0.02, 0.001, -0.002, 0.01]"}},
                    Case{"FisheyeThatFlies", "examples/flying.yaml", {"camera.rolling_shutter=0"}},
                    Case{"EurocThatWalks", "examples/walking.yaml", {}}),
    [](const auto& test) { return test.param.name; });

TEST_P(Lens, HasTheFlowOfThePointsOfItsDepth) {
  const ByOpenCv opencv(optics().lens());
  int compared = 0, moving = 0;
  for (int y = 3; y < now_.truth.depth_m.rows; y += 7) {
    for (int x = 2; x < now_.truth.depth_m.cols; x += 5) {
      const int object = now_.truth.object(y, x);
      const cv::Vec2f& flow = flow_.full_px(y, x);
      if (object < 0 || flow_.seen(y, x) == 0) continue;
      const Vector3d p_C = now_.truth.depth_m(y, x) * opencv.ray({x, y});
      const Vector2d goal = opencv.project(moved(p_C, object));
      const Vector2d motion = goal - Vector2d(x, y);
      EXPECT_LT((motion - Vector2d(flow[0], flow[1])).norm(), 0.01) << x << ", " << y;
      ++compared;
      moving += sim::moved(now_.truth.now.T_WO[static_cast<std::size_t>(object)],
                           now_.truth.next.T_WO[static_cast<std::size_t>(object)]);
    }
  }
  EXPECT_GT(compared, 2000);
  EXPECT_GT(moving, 20);
}

/// These throw where depth, picture and masks contradict the flow.
TEST_P(Lens, HasATruthThatAgreesWithItsPictures) {
  const Agreement by_depth = check_flow(optics(), now_, next_, flow_.full_px, flow_.seen);
  EXPECT_GT(by_depth.compared, 2000);
  EXPECT_LT(by_depth.worst, 0.05);
  EXPECT_GT(check_picture(now_, next_, flow_).compared, 100);
  const cv::Mat1w mask = object_mask(now_.truth);
  EXPECT_GT(check_outlines(now_, mask).compared, 0);
  check_masks(now_.index, mask, now_.objects, static_cast<int>(simulation_.objects().size()));
}

TEST_P(Lens, HasTheMotionsOfItsCorners) {
  const std::vector<const sim::Calibration*> rig{&simulation_.calibration()};
  const SequenceInfo info{scenario_, simulation_.calibration(), simulation_.objects(),
                          simulation_.origin(), rig};
  FrameOutput output;
  format("landmarks").make(info).write({now_, 0, object_mask(now_.truth), nullptr}, output);
  const ByOpenCv opencv(optics().lens());
  std::istringstream rows(output.rows.at("landmarks"));
  int compared = 0, beside_centre = 0;
  for (std::string row; std::getline(rows, row);) {
    std::istringstream fields(row);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(fields, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 11u);
    if (cells[9] == "none" || cells[5].empty()) continue;
    const Vector2d px(std::stod(cells[1]), std::stod(cells[2]));
    const Vector3d p_C = std::stod(cells[4]) * opencv.ray(px);
    const Vector2d motion(std::stod(cells[5]), std::stod(cells[6]));
    const Vector2d static_motion(std::stod(cells[7]), std::stod(cells[8]));
    EXPECT_LT((opencv.project(moved(p_C, std::stoi(cells[3]))) - px - motion).norm(), 0.01) << row;
    EXPECT_LT((opencv.project(moved(p_C, 0)) - px - static_motion).norm(), 0.01) << row;
    ++compared;
    beside_centre += (px - Vector2d(optics().lens().cu_px, optics().lens().cv_px)).norm() > 150;
  }
  EXPECT_GT(compared, 50);
  EXPECT_GT(beside_centre, 10);
}

}  // namespace
}  // namespace lcs::sequence
