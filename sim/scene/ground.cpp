#include "sim/scene/ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/base/random.h"
#include "sim/scene/spec.h"

namespace lcs::sim {
namespace {

constexpr const char* kName = "rough_ground";
constexpr int kWaves = 24;
constexpr double kLongestOverShortest = 3;
constexpr double kPointsAWave = 8;
constexpr double kMostPoints = 400;  // along either side
constexpr double kBase_m = 0.1;      // of solid ground below the lowest point

int points_along(double length_m, double wavelength_m) {
  return static_cast<int>(std::clamp(length_m / wavelength_m * kPointsAWave, 4.0, kMostPoints));
}

/// A sum of plane waves with unit variance.
class Waves {
 public:
  Waves(double wavelength_m, std::uint64_t seed) {
    RandomStream random(seed, "ground");
    for (Wave& wave : waves_) {
      const double length = wavelength_m * std::pow(kLongestOverShortest, random.uniform());
      const double direction = 2 * std::numbers::pi * random.uniform();
      const double number = 2 * std::numbers::pi / length;
      wave = {number * std::cos(direction), number * std::sin(direction),
              2 * std::numbers::pi * random.uniform()};
    }
  }

  double at(double x_m, double y_m) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::cos(wave.kx * x_m + wave.ky * y_m + wave.phase);
    return sum * std::sqrt(2.0 / kWaves);
  }

 private:
  struct Wave {
    double kx, ky, phase;
  };
  std::array<Wave, kWaves> waves_;
};

/// Smooth rise from 0 at the edge to 1 at one wavelength from it.
double rise(double from_edge_m, double wavelength_m) {
  const double t = std::clamp(from_edge_m / wavelength_m, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

std::string material_of_floor(const mjsBody& world) {
  std::string material;
  for_each_in(world, mjOBJ_GEOM, false, [&](mjsElement* e) {
    if (material.empty() && mjs_asGeom(e)->type == mjGEOM_PLANE) {
      material = mjs_getString(mjs_asGeom(e)->material);
    }
  });
  return material;
}

}  // namespace

void add_ground(mjSpec& scene, const scenario::RoughGround& ground,
                const Eigen::Vector2d& ego_start_m, int group) {
  mjsHField& field = *mjs_addHField(&scene);
  mjs_setName(field.element, kName);
  field.nrow = points_along(ground.size_m.y(), ground.wavelength_m);
  field.ncol = points_along(ground.size_m.x(), ground.wavelength_m);
  const std::vector<float> flat(static_cast<std::size_t>(field.nrow * field.ncol));
  mjs_setFloat(field.userdata, flat.data(), static_cast<int>(flat.size()));
  const Eigen::Vector2d half = ground.size_m / 2;
  Eigen::Map<Eigen::Vector4d>(field.size) << half, kHighestGround * ground.roughness_m, kBase_m;

  mjsBody& world = *mjs_findBody(&scene, "world");
  const std::string material = material_of_floor(world);
  const Spec empty(mj_makeSpec());  // none of the scene's defaults
  mjsGeom& geom = *mjs_addGeom(&world, mjs_getSpecDefault(empty.get()));
  mjs_setName(geom.element, kName);
  geom.type = mjGEOM_HFIELD;
  mjs_setString(geom.hfieldname, kName);
  Eigen::Map<Eigen::Vector3d>(geom.pos) << ground.centre_m.value_or(ego_start_m), 0;
  geom.contype = geom.conaffinity = 1;
  geom.group = group;
  mjs_setString(geom.material, material.c_str());
}

void raise_ground(Model& model, const scenario::RoughGround& ground, std::uint64_t scenario_seed) {
  mjModel& m = model.m();
  const int field = model.id(mjOBJ_HFIELD, kName);
  const int rows = m.hfield_nrow[field];
  const int columns = m.hfield_ncol[field];
  const Eigen::Vector2d spacing(ground.size_m.x() / (columns - 1), ground.size_m.y() / (rows - 1));
  const Waves waves(ground.wavelength_m, scenario_seed);
  float* height = m.hfield_data + m.hfield_adr[field];
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column, ++height) {
      const double x = column * spacing.x();
      const double y = row * spacing.y();
      const double edge_x = std::min(x, ground.size_m.x() - x);
      const double edge_y = std::min(y, ground.size_m.y() - y);
      const double window = rise(edge_x, ground.wavelength_m) * rise(edge_y, ground.wavelength_m);
      const double deviations =
          std::clamp(waves.at(x, y) + kHighestGround / 2, 0.0, kHighestGround);
      *height = static_cast<float>(window * deviations / kHighestGround);
    }
  }
}

}  // namespace lcs::sim
