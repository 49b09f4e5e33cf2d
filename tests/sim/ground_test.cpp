// Bumps on the floor: their statistics, and their effect on wheels and camera.

#include "sim/scene/ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "sim/simulation.h"
#include "sim/world/world.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

scenario::Scenario rough(double roughness_m) {
  auto s = test::scenario_in("lab", 0.4, 12);
  s.ego.drive = scenario::Drive::wheeled;
  s.ego.start_m = {-3, 0};
  s.ground = scenario::RoughGround{.roughness_m = roughness_m,
                                   .wavelength_m = 0.4,
                                   .centre_m = Eigen::Vector2d(-1, 0),
                                   .size_m = {6, 3}};
  return s;
}

/// Heights of the field above the floor, m, row by row.
std::vector<double> heights(World& world) {
  const mjModel& m = world.model().m();
  const int field = world.model().id(mjOBJ_HFIELD, "rough_ground");
  const double top_m = m.hfield_size[4 * field + 2];
  const float* data = m.hfield_data + m.hfield_adr[field];
  std::vector<double> h;
  for (int i = 0; i < m.hfield_nrow[field] * m.hfield_ncol[field]; ++i)
    h.push_back(top_m * data[i]);
  return h;
}

/// Largest angle between the camera's up and the world's over a run, rad.
double greatest_tilt_rad(const scenario::Scenario& s) {
  Simulation simulation(s);
  double greatest = 0;
  while (const auto o = simulation.next()) {
    const Eigen::Vector3d up = -o->truth.now.T_WC.R.col(1);
    greatest = std::max(greatest, std::acos(std::min(1.0, up.z())));
  }
  return greatest;
}

/// The program's own parts take none of the scene's defaults, and are drawn.
TEST(Ground, TakesNoDefaultsOfTheScene) {
  auto s = rough(0.01);
  std::string mjcf = test::floor_with("");
  mjcf.insert(
      mjcf.find("<statistic"),
      "<asset><material name='none' rgba='1 0 0 .2'/></asset><default><geom group='3' "
      "friction='.01' density='7' margin='1' condim='1' "
      "rgba='1 0 0 0' material='none'/><camera fovy='9' projection='orthographic'/></default>");
  mjcf.insert(mjcf.find("type=\"plane\""), "group='0' ");
  s.scene = test::scenario_in_mjcf(mjcf, 0, 1).scene;
  s.camera.groups = {2, 0};
  const World world(s);
  const mjModel& m = world.model().m();
  const int geom = world.model().id(mjOBJ_GEOM, "rough_ground");
  EXPECT_TRUE(world.is_drawn(geom));
  EXPECT_EQ(m.geom_friction[3 * geom], 1);
  EXPECT_EQ(m.geom_margin[geom], 0);
  EXPECT_EQ(m.geom_condim[geom], 3);
  const int camera = world.camera_id();
  EXPECT_EQ(m.cam_projection[camera], mjPROJ_PERSPECTIVE);
  EXPECT_NEAR(m.cam_fovy[camera], s.camera.fovy_rad * 180 / std::numbers::pi, 1e-9);
}

TEST(Ground, HasTheRoughnessAskedForAndIsLevelAtItsEdges) {
  World world(rough(0.01));
  const std::vector<double> h = heights(world);
  const int columns = world.model().m().hfield_ncol[0];
  const int rows = world.model().m().hfield_nrow[0];
  double sum = 0, squares = 0;
  int inner = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double z = h[static_cast<std::size_t>(row * columns + column)];
      const bool edge = row == 0 || column == 0 || row == rows - 1 || column == columns - 1;
      if (edge) {
        EXPECT_EQ(z, 0);
      }
      EXPECT_GE(z, 0);
      EXPECT_LE(z, 0.04);
      // skips the margin of one wavelength, 8 points
      if (row < 8 || column < 8 || row >= rows - 8 || column >= columns - 8) continue;
      ++inner;
      sum += z;
      squares += z * z;
    }
  }
  // about 50 independent bumps: the deviation is known to 10 %, and clipping reduces it by 4 %
  const double mean = sum / inner;
  EXPECT_NEAR(mean, 0.02, 0.004);
  EXPECT_NEAR(std::sqrt(squares / inner - mean * mean), 0.01, 0.002);
}

TEST(Ground, IsTheSeedsOwn) {
  auto s = rough(0.01);
  World a(s), b(s);
  EXPECT_EQ(heights(a), heights(b));
  s.seed = 2;
  World c(s);
  EXPECT_NE(heights(a), heights(c));
}

TEST(Ground, ShakesTheCameraOfARoverOnWheelsMoreTheRougherItIs) {
  const double smooth = greatest_tilt_rad(rough(0.0001));
  const double bumpy = greatest_tilt_rad(rough(0.006));
  EXPECT_LT(smooth, 0.5 * test::kDegree);
  EXPECT_GT(bumpy, 1 * test::kDegree);
  EXPECT_LT(bumpy, 15 * test::kDegree);  // it does not fall over
}

TEST(Ground, DoesNotStopTheRover) {
  Simulation simulation(rough(0.006));
  Eigen::Vector3d first, last;
  while (const auto o = simulation.next()) {
    if (o->index == 0) first = o->truth.now.T_WC.p;
    last = o->truth.now.T_WC.p;
  }
  // over the bumps its way is longer, and its wheels slip: 0.36 of 0.44 m
  EXPECT_GT((last - first).x(), 0.75 * 0.4 * 1.1);
  EXPECT_LT((last - first).x(), 1.05 * 0.4 * 1.1);
}

TEST(Ground, BearsTheRoverHoweverSteepItsBumpsAre) {
  for (const auto& [roughness_m, wavelength_m] : {std::pair(0.05, 0.1), {0.05, 0.4}, {0.01, 0.1}}) {
    auto s = rough(roughness_m);
    s.ground->wavelength_m = wavelength_m;
    EXPECT_EQ(test::physics_error(s, 500'000'000), "nothing was refused") << roughness_m;
  }
}

/// Material of the bumps in a scene with these geoms.
std::string material_of_bumps(const std::string& geoms) {
  auto s = test::scenario_in_mjcf(
      "<mujoco><asset><material name='sand'/><material name='wood'/></asset><worldbody>"
      "<light/>" +
          geoms + "</worldbody></mujoco>",
      0, 1);
  s.ground = rough(0.006).ground;
  World world(s);
  const mjModel& m = world.model().m();
  const int material = m.geom_matid[world.model().id(mjOBJ_GEOM, "rough_ground")];
  return material < 0 ? "" : std::string(world.model().name(mjOBJ_MATERIAL, material));
}

TEST(Ground, IsOfTheMaterialOfTheFloorWhereverThatIsInTheFile) {
  const std::string floor = "<geom type='plane' size='9 9 .1' material='sand'/>";
  const std::string box = "<geom type='box' size='.1 .1 .1' pos='3 3 .1' material='wood'/>";
  EXPECT_EQ(material_of_bumps(floor + box), "sand");
  EXPECT_EQ(material_of_bumps(box + floor), "sand");
  EXPECT_EQ(material_of_bumps(box), "") << "there is no floor";
}

TEST(Ground, IsSettingNotAnObject) {
  World plain(test::scenario_in("lab", 0.4, 1)), bumpy(rough(0.006));
  EXPECT_EQ(plain.objects().size(), bumpy.objects().size());
}

}  // namespace
}  // namespace lcs::sim
