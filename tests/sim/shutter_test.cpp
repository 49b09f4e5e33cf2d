// Rolling shutter and exposure against pictures of single instants, and against closed forms.
#include "sim/base/shutter.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "sim/camera/linear_light.h"
#include "sim/drive.h"
#include "sim/observer.h"
#include "sim/world/path.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTurn_radps = 1;
constexpr double kReadout_s = 0.02, kExposure_s = 0.01;

/// A turning rover before a tall white pole.
scenario::Scenario turning(const std::string& half_width_m = ".1") {
  scenario::Scenario s =
      test::scenario_in_mjcf(test::floor_with("<geom type=\"box\" pos=\"3 0 1\" size=\".1 " +
                                              half_width_m + " 2\" rgba=\"1 1 1 1\"/>"),
                             0, 3);
  s.ego.phases = {{.yaw_rate_radps = kTurn_radps}};
  s.camera.width_px = 160;
  s.camera.height_px = 120;
  return s;
}

/// A carried camera before a textured scene, in a motion of six dimensions.
scenario::Scenario carried() {
  scenario::Scenario s = test::scenario_in("lab", 0, 3);
  s.ego = {};
  s.ego.path = {{0, {0, 0, 0.6}, {0, 0, 0}},
                {0.2, {0.1, 0.02, 0.62}, {0.02, -0.03, 0.2}},
                {0.4, {0.3, 0.05, 0.6}, {-0.02, 0.03, 0.5}},
                {0.6, {0.5, 0.05, 0.6}, {0, 0, 0.6}}};
  s.camera.width_px = 160;
  s.camera.height_px = 120;
  s.camera.rate_hz = 5;
  return s;
}

/// What an instant shutter sees at a time: frame 1 at the rate that puts it there.
Observation seen_at(scenario::Scenario s, double t_s) {
  s.camera.rolling_shutter_s = s.camera.exposure_s = 0;
  s.camera.rate_hz = 1 / t_s;
  Observer observer(s, WrongStart::refused);
  observer.advance();
  return observer.observe();
}

Observation frame_of(const scenario::Scenario& s, int k) {
  Observer observer(s, WrongStart::refused);
  for (int i = 0; i < k; ++i) observer.advance();
  return observer.observe();
}

TEST(Shutter, SharesOfARowAddUpToOneRoundItsTime) {
  scenario::Camera camera;
  camera.height_px = 120;
  camera.rolling_shutter_s = kReadout_s;
  camera.exposure_s = kExposure_s;
  const Shutter shutter(camera);
  for (const int n : {1, 2, 8, 64}) {
    const double cell_s = (kReadout_s + kExposure_s) / n;
    for (int row = 0; row < 120; ++row) {
      double sum = 0, mean_s = 0;
      for (int i = 0; i < n; ++i) {
        const double share = shutter.share(row, i, n);
        const double at_s =
            1e-9 * static_cast<double>(shutter.instants_ns()[Shutter::instant_of(i, n)]);
        EXPECT_NEAR(at_s, -kExposure_s / 2 + (i + 0.5) * cell_s, 1e-9);  // rounded to ns
        sum += share;
        mean_s += share * at_s;
      }
      EXPECT_NEAR(sum, 1, 1e-12);
      // cells that a row covers in part pull the mean by less than half a cell
      EXPECT_NEAR(mean_s, kReadout_s * row / 120, cell_s / 2);
    }
  }
  EXPECT_EQ(Shutter::drawings_for(0), 1);
  EXPECT_EQ(Shutter::drawings_for(1.01 * Shutter::kMostShift_px), 2);
  EXPECT_EQ(Shutter::drawings_for(10 * Shutter::kMostShift_px), 16);
  EXPECT_EQ(Shutter::drawings_for(1000), Shutter::kMostDrawings);
}

/// Each row is that of a picture of the instant of its drawing. The path gives the same poses to
/// both but for rounding, which can move single pixels at edges.
TEST(RollingShutter, ShowsInEachRowTheWorldOfItsTime) {
  scenario::Scenario s = carried();
  s.camera.rolling_shutter_s = kReadout_s;
  const Observation rolled = frame_of(s, 1);
  const Shutter shutter(s.camera);
  int differing = 0, changed = 0;
  const Observation global = seen_at(s, 0.2);
  for (const int row : {0, 31, 64, 97, 119}) {
    // the number of drawings is not told: one of them has this row
    int least = s.camera.width_px;
    for (int n = 1; n <= Shutter::kMostDrawings && least > 0; n *= 2) {
      const int i = shutter.drawing_of(row, n);
      const double at_s =
          1e-9 * static_cast<double>(shutter.instants_ns()[Shutter::instant_of(i, n)]);
      EXPECT_NEAR(at_s, kReadout_s * row / 120, kReadout_s / n / 2 + 1e-9);
      const Observation then = seen_at(s, 0.2 + at_s);
      int off = 0;
      for (int x = 0; x < s.camera.width_px; ++x) {
        off += rolled.rendered(row, x) != then.rendered(row, x) ||
               rolled.geom(row, x) != then.geom(row, x) ||
               std::abs(rolled.truth.depth_m(row, x) / then.truth.depth_m(row, x) - 1) > 1e-5;
      }
      least = std::min(least, off);
    }
    differing += least;
    for (int x = 0; x < s.camera.width_px; ++x) {
      changed += rolled.rendered(row, x) != global.rendered(row, x);
    }
  }
  EXPECT_LE(differing, 5 * 160 / 100);
  EXPECT_GT(changed, 200);  // the shutter makes a difference
}

/// The motion of a corner is that of a fixed point: its row in frame k + 1 is the one at whose time
/// the point is there. The path gives the poses, without the simulation.
TEST(RollingShutter, HasTheTruthOfEachRowsTime) {
  scenario::Scenario s = carried();
  s.camera.rolling_shutter_s = kReadout_s;
  const Observation o = frame_of(s, 1);
  const Path path(s.ego);
  const sim::Drive driven = drive(s);
  const Pose T_BC = driven.calibration.T_BC;
  const Pinhole camera = driven.calibration.camera;
  const auto T_WC = [&](double t_s) { return path.at(t_s).T_WB * T_BC; };
  std::vector<Eigen::Vector2f> corners;
  for (int y = 4; y < 116; y += 8) {
    for (int x = 4; x < 156; x += 8) {
      corners.emplace_back(static_cast<float>(x), static_cast<float>(y));
    }
  }
  int compared = 0;
  const auto truth = label_corners(camera, o.truth, corners, 0.3);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (truth[i].label == Label::none || !truth[i].motion_px.allFinite()) continue;
    const Vector2d x = corners[i].cast<double>();
    const Vector2d goal = x + truth[i].motion_px;
    if (goal.y() < 0 || goal.y() > 119) continue;
    const Vector3d p_W =
        T_WC(0.2 + kReadout_s * x.y() / 120) * camera.back_project(x, truth[i].depth_m);
    const Vector2d there = camera.project(T_WC(0.4 + kReadout_s * goal.y() / 120).inverse() * p_W);
    EXPECT_LT((there - goal).norm(), 1e-4);
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

/// The same of a fisheye: OpenCV projects the point for the time of every row, and the picture
/// shows it in the row that it is in at that row's own time.
TEST(RollingShutter, OfAFisheyeHasTheTruthThatOpenCvProjectsRowByRow) {
  scenario::Scenario s = carried();
  s.camera.rolling_shutter_s = kReadout_s;
  s.camera.focal_px = Vector2d(90, 91);
  s.camera.centre_px = Vector2d(79, 61);
  s.camera.distortion =
      scenario::Distortion{.equidistant = true, .coefficients = {-0.02, 0.006, -0.002, 0.0003}};
  const Observation o = frame_of(s, 1);
  const Path path(s.ego);
  const sim::Drive driven = drive(s);
  const Pinhole camera = driven.calibration.camera;
  const cv::Matx33d K(90, 0, 79, 0, 91, 61, 0, 0, 1);
  const cv::Vec4d D(-0.02, 0.006, -0.002, 0.0003);
  const auto T_CW = [&](double t_s) {
    return (path.at(t_s).T_WB * driven.calibration.T_BC).inverse();
  };
  int compared = 0;
  double most_px = 0;
  for (int y = 6; y < 114; y += 9) {
    for (int x = 6; x < 154; x += 9) {
      std::vector<cv::Point2d> ray{cv::Point2d(x, y)};
      cv::fisheye::undistortPoints(ray, ray, K, D);
      const std::vector<Eigen::Vector2f> corner{
          camera.project(Vector3d(ray[0].x, ray[0].y, 1)).cast<float>()};
      const CornerTruth truth =
          label_corners(camera, o.truth, corner, 0.3, &driven.calibration.optics).at(0);
      if (truth.label == Label::none || !truth.motion_px.allFinite()) continue;
      const Vector3d p_W = T_CW(0.2 + kReadout_s * y / 120).inverse() *
                           (truth.depth_m * Vector3d(ray[0].x, ray[0].y, 1));
      const Vector3d goal = camera.back_project(corner[0].cast<double>() + truth.motion_px, 1);
      std::vector<cv::Point2d> told{cv::Point2d(goal.x(), goal.y())};
      cv::fisheye::distortPoints(told, told, K, D);
      cv::Point2d last;
      for (int row = 0; row < 120; ++row) {
        const Vector3d p_C = T_CW(0.4 + kReadout_s * row / 120) * p_W;
        if (p_C.z() < 0.05) break;
        std::vector<cv::Point2d> seen;
        cv::fisheye::projectPoints(std::vector{cv::Point3d(p_C.x(), p_C.y(), p_C.z())}, seen,
                                   cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), K, D);
        // below its own row before, above it now: it is seen between the two
        if (row > 0 && last.y >= row - 1 && seen[0].y < row) {
          const double before = last.y - (row - 1), after = seen[0].y - row;
          const cv::Point2d there = last + before / (before - after) * (seen[0] - last);
          most_px = std::max(most_px, cv::norm(there - told[0]));
          ++compared;
          break;
        }
        last = seen[0];
      }
    }
  }
  EXPECT_GT(compared, 60);
  EXPECT_LT(most_px, 2e-3);  // a straight way between two rows; corners are floats
}

/// The axis of a vertical pole at azimuth 0 is, at the time t, at tan(yaw(t)) f to the right.
TEST(RollingShutter, SlantsAPoleBeforeATurningRover) {
  scenario::Scenario s = turning();
  s.camera.mount_position_m = {0, 0, 0.45};  // on the axis of the turn
  s.camera.rolling_shutter_s = kReadout_s;
  const Observation o = frame_of(s, 1);
  const double f = drive(s).calibration.camera.focal_px;
  const int pole = o.geom(20, 91);
  for (int y = 0; y < 70; y += 7) {
    double sum = 0, count = 0;
    for (int x = 0; x < 160; ++x) {
      if (o.geom(y, x) != pole) continue;
      sum += x;
      count += 1;
    }
    ASSERT_GT(count, 5);
    const double yaw = kTurn_radps * (0.1 + kReadout_s * y / 120);
    // to a pixel: 0.5 by the pixels of the pole, 0.25 by the drawing's time, 0.2 by its perspective
    EXPECT_NEAR(sum / count - 79.5, f * std::tan(yaw), 1) << y;
  }
}

/// The mean of the drawings, in linear light, made here from pictures of single instants.
TEST(Exposure, IsTheMeanOfPicturesDuringIt) {
  scenario::Scenario s = carried();
  s.image.noise.reset();
  s.camera.exposure_s = kExposure_s;
  const Observation smeared = frame_of(s, 1);
  const Observation middle = seen_at(s, 0.2);
  double best = 1e9, sharp = 0;
  constexpr double kAlike = 0.02;  // grey levels: rounding of poses at edges, and of grey levels
  for (int n = 1; n <= 16 && best >= kAlike; n *= 2) {
    cv::Mat3f sum(120, 160, cv::Vec3f(0, 0, 0));
    for (int i = 0; i < n; ++i) {
      const double at_s = kExposure_s * ((i + 0.5) / n - 0.5);
      cv::scaleAdd(seen_at(s, 0.2 + at_s).rendered, 1.0 / n, sum, sum);
    }
    best = std::min(best,
                    cv::norm(test::behind_lens(sum), smeared.image, cv::NORM_L1) / (3 * 120 * 160));
  }
  sharp =
      cv::norm(test::behind_lens(middle.rendered), smeared.image, cv::NORM_L1) / (3 * 120 * 160);
  EXPECT_LT(best, kAlike);
  EXPECT_GT(sharp, 10 * best);
  // the truth is that of the middle
  EXPECT_EQ(cv::norm(middle.rendered, smeared.rendered, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(middle.geom, smeared.geom, cv::NORM_INF), 0);
}

/// An edge that crosses v px during the exposure becomes a ramp of v px, whatever its grey levels.
TEST(Exposure, MakesARampOfAnEdgeAsLongAsItsWay) {
  scenario::Scenario s = turning(".5");
  s.camera.mount_position_m = {0, 0, 0.45};
  s.image.noise.reset();
  s.camera.exposure_s = 0.06;
  const Observation o = frame_of(s, 1);
  const double f = drive(s).calibration.camera.focal_px;
  // the left edge of the pole, at its nearer face 2.9 m ahead and 0.5 m to the left of azimuth 0
  const auto edge_px = [&](double t_s) {
    return f * std::tan(kTurn_radps * t_s - std::atan2(0.5, 2.9));
  };
  const double way_px = edge_px(0.13) - edge_px(0.07);
  ASSERT_GT(way_px, 4);
  const int row = 30, column = static_cast<int>(std::lround(79.5 + edge_px(0.1)));
  const cv::Mat3f light = to_linear(o.image);
  const double dark = light(row, column - 8)[1], bright = light(row, column + 6)[1];
  double slopes = 0, first = 0, second = 0;  // sum and moments of the slope
  for (int x = column - 8; x < column + 6; ++x) {
    const double slope = (light(row, x + 1)[1] - light(row, x)[1]) / (bright - dark);
    slopes += slope;
    first += slope * (x + 0.5);
    second += slope * (x + 0.5) * (x + 0.5);
  }
  first /= slopes;
  const double variance = second / slopes - first * first;
  // a ramp of width w has the variance w^2 / 12; the lens adds 0.6^2 and the pixels 1 / 12
  EXPECT_NEAR(std::sqrt(12 * (variance - 0.36 - 1.0 / 12)), way_px, 0.1 * way_px);
  EXPECT_NEAR(first, 79.5 + edge_px(0.1), 0.5);
}

/// Nothing moves: every drawing is the same.
TEST(Shutter, ChangesNoPictureOfAWorldAtRest) {
  scenario::Scenario s = test::scenario_in("lab", 0, 1);
  s.camera.width_px = 160;
  s.camera.height_px = 120;
  const Observation instant = frame_of(s, 0);
  s.camera.rolling_shutter_s = 0.03;
  s.camera.exposure_s = 0.02;
  const Observation timed = frame_of(s, 0);
  EXPECT_EQ(cv::norm(instant.image, timed.image, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(instant.geom, timed.geom, cv::NORM_INF), 0);
}

/// Skipped frames leave those after them as they are, and a run repeats its bits.
TEST(Shutter, IsTheSameAfterSkippedFrames) {
  scenario::Scenario s = turning();
  s.camera.rolling_shutter_s = kReadout_s;
  s.camera.exposure_s = kExposure_s;
  Observer all(s, WrongStart::refused);
  all.observe();
  all.observe();
  const Observation third = all.observe(), skipped = frame_of(s, 2);
  EXPECT_EQ(cv::norm(third.image, skipped.image, cv::NORM_INF), 0);
  EXPECT_EQ(third.truth.next.T_WC.R, skipped.truth.next.T_WC.R);
  const sim::Drive driven = drive(s);
  ASSERT_EQ(driven.frames[2].imu.size(), third.imu.size());
  for (std::size_t i = 0; i < third.imu.size(); ++i) {
    EXPECT_EQ(driven.frames[2].imu[i].gyro_radps, third.imu[i].gyro_radps);
    EXPECT_EQ(third.imu[i].t_ns, skipped.imu[i].t_ns);
  }
  EXPECT_GT(third.imu.front().t_ns, 100'000'000);
  EXPECT_EQ(third.imu.back().t_ns, 200'000'000);
}

TEST(TimeOffset, OfTheToldTimesMovesTheReadingsOfAFrame) {
  scenario::Scenario s = turning();
  s.camera.told.time_offset_error_s = 0.012;
  const std::vector<Observation> later = drive(s).frames;
  EXPECT_EQ(later[1].imu.back().t_ns, 110'000'000);
  EXPECT_EQ(later[2].imu.front().t_ns, 115'000'000);
  s.camera.told.time_offset_error_s = -0.012;
  const std::vector<Observation> earlier = drive(s).frames;
  EXPECT_TRUE(earlier[0].imu.empty());
  EXPECT_EQ(earlier[1].imu.back().t_ns, 85'000'000);
  EXPECT_EQ(earlier[1].t_ns, 100'000'000);
}

TEST(Vignetting, LeavesTheMiddleAndDarkensTheCornersByItsShare) {
  scenario::Scenario s = test::scenario_in("lab", 0, 1);
  s.image.noise.reset();
  const cv::Mat3f even = to_linear(frame_of(s, 0).image);
  s.image.vignetting = 0.5;
  const cv::Mat3f dark = to_linear(frame_of(s, 0).image);
  const auto share = [&](int x, int y) { return dark(y, x)[1] / even(y, x)[1]; };
  EXPECT_NEAR(share(320, 240), 1, 0.02);  // grey levels of 8 bits
  EXPECT_NEAR(share(0, 479), 0.5, 0.03);
  EXPECT_NEAR(share(639, 240), 1 - 0.5 * 0.64, 0.03);  // 0.8 of the way to the corner
}

}  // namespace
}  // namespace lcs::sim
