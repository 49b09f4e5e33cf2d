// Shadows against the geometry of rays, and the labels of corners near their edges.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>
#include <utility>
#include <vector>

#include "sim/camera/linear_light.h"
#include "sim/observer.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const Vector3d kLight = Vector3d(0.3, 0.5, -1).normalized();
const Vector3d kHalf_m(0.2, 0.2, 0.3), kBox_m(2.2, -0.1, 0.3);

/// A box on a floor, seen from above and behind.
scenario::Scenario lit(bool has_shadows, const std::string& light = "castshadow=\"true\"") {
  scenario::Scenario s = test::scenario_in_mjcf(
      test::floor_with("<light directional=\"true\" dir=\".3 .5 -1\" diffuse=\".4 .4 .4\" "
                       "ambient=\"0 0 0\" specular=\"0 0 0\" " +
                       light +
                       "/><body name=\"crate\" pos=\"2.2 -.1 .3\"><geom type=\"box\" "
                       "size=\".2 .2 .3\" rgba=\".7 .6 .5 1\"/></body>"),
      0, 3);
  s.camera.mount_position_m = {0, 0, 1.8};
  s.camera.mount_rpy_rad = {0, 35 * test::kDegree, 0};
  s.image.shadows = has_shadows;
  return s;
}

Observation frame_of(const scenario::Scenario& s, int k = 0) {
  Observer observer(s, WrongStart::refused);
  for (int i = 0; i < k; ++i) observer.advance();
  return observer.observe();
}

Vector3d on_floor(const Vector3d& p_W) {
  return p_W - p_W.z() / kLight.z() * kLight;
}

/// The shadow on the floor: the hull of the top's shadow and of the foot; its outline beside the
/// box, from the corner of the foot on the left to that on the right, as the camera sees them.
std::vector<Vector3d> outline() {
  const auto corner = [](double x, double y, double z) {
    return on_floor(kBox_m + kHalf_m.cwiseProduct(Vector3d(x, y, z)));
  };
  return {corner(-1, 1, -1), corner(-1, 1, 1), corner(1, 1, 1), corner(1, -1, 1),
          corner(1, -1, -1)};
}

/// Places along the outline on the floor with the direction out of the shadow, W.
struct Place {
  Vector3d p_W, out_W;
};
std::vector<Place> edge_places() {
  const std::vector<Vector3d> corners = outline();
  Vector3d middle(0, 0, 0);
  for (const Vector3d& corner : corners) middle += corner / static_cast<double>(corners.size());
  std::vector<Place> places;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Vector3d along = corners[i] - corners[i - 1];
    Vector3d out = along.cross(Vector3d::UnitZ()).normalized();
    if (out.dot(corners[i] - middle) < 0) out = -out;
    for (const double share : {0.3, 0.5, 0.7}) {
      places.push_back({corners[i - 1] + share * along, out});
    }
  }
  return places;
}

/// Share of its light that a pixel keeps.
double share(const Observation& o, const Vector2d& px) {
  const cv::Point at(cvRound(px.x()), cvRound(px.y()));
  return to_linear(o.image)(at)[1] / to_linear(test::behind_lens(o.rendered))(at)[1];
}

bool is_on_floor(const Observation& o, const Vector2d& px) {
  return o.truth.object(cvRound(px.y()), cvRound(px.x())) == 0;
}

TEST(Shadow, LiesWhereRaysOfTheLightHitTheFloor) {
  const scenario::Scenario s = lit(true);
  Observer observer(s, WrongStart::refused);
  const Observation o = observer.observe();
  const Optics& camera = observer.calibration().optics;
  const Pose T_CW = o.truth.now.T_WC.inverse();
  int seen = 0;
  const auto px_of = [&](const Vector3d& p_W) { return camera.project(T_CW * p_W); };
  for (const Place& place : edge_places()) {
    const Vector2d px = px_of(place.p_W);
    const Vector2d out = (px_of(place.p_W + 0.05 * place.out_W) - px).normalized();
    if (!is_on_floor(o, px) || !is_on_floor(o, px - 4 * out)) continue;  // behind the box
    // 5 mm of floor are a texel of the shadow map, and at most 1 px
    EXPECT_LT(share(o, px - 2.5 * out), 0.8) << px.transpose();
    EXPECT_GT(share(o, px + 2.5 * out), 0.98) << px.transpose();
    ++seen;
  }
  EXPECT_GE(seen, 6);
  // the shadow of the corner of the top that is farthest from the foot
  const Vector2d corner = px_of(outline()[2]), inside = px_of((outline()[2] + kBox_m) / 2);
  ASSERT_TRUE(is_on_floor(o, corner));
  const Vector2d in = (inside - corner).normalized();
  EXPECT_LT(share(o, corner + 4 * in), 0.8);
  EXPECT_GT(share(o, corner - 3 * in), 0.98);
}

/// \param s with shadows. Corners along the edge have no label, and all others keep theirs.
void expect_labels(const scenario::Scenario& s) {
  Observer observer(s, WrongStart::refused);
  const Observation o = observer.observe();
  scenario::Scenario without = s;
  without.image.shadows = false;
  const Observation even = frame_of(without);
  const Optics& optics = observer.calibration().optics;
  const Pinhole& camera = observer.calibration().camera;
  const Pose T_CW = o.truth.now.T_WC.inverse();
  const auto label = [&](const Observation& of, const Vector2d& px) {
    const std::vector<Eigen::Vector2f> corner{px.cast<float>()};
    return label_corners(camera, of.truth, corner, 0.5, &optics).at(0).label;
  };
  int near = 0;
  std::vector<Vector2d> edge;  // px of the pinhole, every 2 mm
  const std::vector<Vector3d> corners = outline();
  for (std::size_t i = 1; i < corners.size(); ++i) {
    for (double along = 0; along <= 1; along += 0.004) {
      edge.push_back(
          camera.project(T_CW * (corners[i - 1] + along * (corners[i] - corners[i - 1]))));
    }
  }
  for (const Place& place : edge_places()) {
    const Vector2d px = camera.project(T_CW * place.p_W);
    const Vector2d in_picture = optics.project(T_CW * place.p_W);
    if (!is_on_floor(o, in_picture)) continue;
    for (const Vector2d& off : {Vector2d(0, 0), Vector2d(2, 0), Vector2d(0, -2)}) {
      EXPECT_EQ(label(o, px + off), Label::none) << px.transpose();
      EXPECT_EQ(label(even, px + off), Label::fixed);
      ++near;
    }
  }
  EXPECT_GE(near, 18);
  int far = 0;
  for (int y = 8; y < camera.height_px - 8; y += 7) {
    for (int x = 8; x < camera.width_px - 8; x += 7) {
      const Vector2d px(x, y);
      const bool is_near =
          std::ranges::any_of(edge, [&](const Vector2d& other) { return (other - px).norm() < 7; });
      if (is_near) continue;
      EXPECT_EQ(label(o, px), label(even, px)) << px.transpose();
      ++far;
    }
  }
  EXPECT_GT(far, 1000);
}

TEST(Shadow, TakesTheLabelsOfCornersNearItsEdgeAlone) {
  expect_labels(lit(true));
}

TEST(Shadow, TakesThoseOfADistortedPictureToo) {
  scenario::Scenario s = lit(true);
  s.camera.focal_px = Vector2d(400, 400);
  s.camera.distortion = scenario::Distortion{.equidistant = true, .coefficients = {0, 0, 0, 0}};
  expect_labels(s);
}

TEST(Shadow, IsNotThereUnlessAskedForAndLeavesTheTruthAlone) {
  const Observation off = frame_of(lit(false)), on = frame_of(lit(true));
  EXPECT_TRUE(off.truth.shadow_edge.empty());
  EXPECT_EQ(cv::norm(off.image, test::behind_lens(off.rendered), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(off.image, on.image, cv::NORM_INF), 20);
  EXPECT_EQ(cv::norm(off.rendered, on.rendered, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(off.truth.depth_m, on.truth.depth_m, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(off.truth.object, on.truth.object, cv::NORM_INF), 0);
}

TEST(Shadow, OfAWorldAtRestIsTheSameThroughAnyShutter) {
  const Observation instant = frame_of(lit(true));
  for (const auto& [readout_s, exposure_s] : {std::pair{0.02, 0.0}, {0.0, 0.01}, {0.02, 0.01}}) {
    scenario::Scenario s = lit(true);
    s.camera.rolling_shutter_s = readout_s;
    s.camera.exposure_s = exposure_s;
    const Observation timed = frame_of(s);
    EXPECT_EQ(cv::norm(instant.image, timed.image, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(instant.rendered, timed.rendered, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(instant.truth.shadow_edge, timed.truth.shadow_edge, cv::NORM_INF), 0);
  }
}

/// In each row of a rolling shutter the edge is that of the row's time: brute force by the actor's
/// place then.
TEST(Shadow, OfAMoverIsThatOfTheTimeOfEachRow) {
  scenario::Scenario s = lit(true);
  scenario::Actor actor =
      test::line_actor("crate", scenario::Shape::box, {2.2, -0.6}, 90 * test::kDegree, 2);
  actor.body = "crate";
  s.actors = {actor};
  s.camera.rolling_shutter_s = 0.05;
  Observer observer(s, WrongStart::refused);
  observer.advance();
  const Observation o = observer.observe();
  const Pinhole& camera = observer.calibration().camera;
  const Pose T_CW = o.truth.now.T_WC.inverse();
  int seen = 0;
  for (const double along : {0.2, 0.35, 0.5, 0.65, 0.8}) {
    // the edge of the top that leads, at the time of the row in which it is seen
    Vector2d px(0, 0);
    for (int i = 0; i < 20; ++i) {
      const double t_s = 0.1 + 0.05 * px.y() / camera.height_px;
      const Vector3d moved(0, -0.6 + 2 * t_s - kBox_m.y(), 0);
      const std::vector<Vector3d> corners = outline();
      px = camera.project(T_CW * (corners[1] + along * (corners[2] - corners[1]) + moved));
    }
    if (!is_on_floor(o, px)) continue;
    const auto at_edge = [&](double dx) {
      return o.truth.shadow_edge(cvRound(px.y()), cvRound(px.x() + dx)) != 0;
    };
    EXPECT_TRUE(at_edge(0)) << px.transpose();
    EXPECT_FALSE(at_edge(-9));  // the shadow moves by 11 px during 0.05 s
    EXPECT_FALSE(at_edge(9));
    ++seen;
  }
  EXPECT_GE(seen, 3);
}

TEST(Shadow, OfALightThatIsToCastNoneIsRefused) {
  scenario::Scenario s = lit(true, "castshadow=\"false\"");
  const std::string message = test::scenario_error([&] { Observer(s, WrongStart::refused); });
  EXPECT_NE(message.find("image.shadows"), std::string::npos) << message;
  EXPECT_NE(message.find("castshadow"), std::string::npos) << message;
}

/// The outline of a shadow passes pixels of the floor, which is even without it.
TEST(Shadow, IsSeenByEventPixels) {
  const auto events_of = [](bool has_shadows) {
    scenario::Scenario s = lit(has_shadows);
    s.ego.phases = {{.yaw_rate_radps = 0.3}};
    s.events.emplace();
    s.events->spread = s.events->refractory_s = s.events->leak_hz = s.events->shot_hz = 0;
    return frame_of(s, 2).events;
  };
  const std::vector<Event> even = events_of(false), shaded = events_of(true);
  std::set<std::pair<int, int>> without;
  for (const Event& event : even) without.emplace(event.x, event.y);
  const auto added = std::ranges::count_if(shaded, [&](const Event& event) {
    return !without.contains({event.x, event.y});
  });
  EXPECT_GT(added, 100);
}

}  // namespace
}  // namespace lcs::sim
