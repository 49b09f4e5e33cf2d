#include "sim/scene/ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "sim/random.h"
#include "sim/scene/mjcf.h"

namespace lcs::sim {
namespace {

constexpr const char* kName = "rough_ground";
constexpr int kWaves = 24;
constexpr double kLongestOverShortest = 3;
constexpr double kPointsAWave = 8;
constexpr double kMostPoints = 400;  // along either side
constexpr double kHighest = 4;       // standard deviations
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

std::string material_of_floor(xml::Element& worldbody) {
  for (auto* geom = worldbody.FirstChildElement("geom"); geom;
       geom = geom->NextSiblingElement("geom")) {
    if (xml::attribute(*geom, "type") == "plane") return xml::attribute(*geom, "material");
  }
  return "";
}

}  // namespace

void add_ground(xml::Element& scene, const scenario::Ground& ground,
                const Eigen::Vector2d& ego_start_m, const input::Source& source) {
  const Eigen::Vector2d half = ground.size_m / 2;
  xml::Element* field = xml::section(scene, "asset").InsertNewChildElement("hfield");
  xml::set_source(*field, source);
  field->SetAttribute("name", kName);
  field->SetAttribute("nrow", points_along(ground.size_m.y(), ground.wavelength_m));
  field->SetAttribute("ncol", points_along(ground.size_m.x(), ground.wavelength_m));
  mjcf::set_numbers(*field, "size", {half.x(), half.y(), kHighest * ground.roughness_m, kBase_m});

  xml::Element& worldbody = xml::section(scene, "worldbody");
  const std::string material = material_of_floor(worldbody);
  const Eigen::Vector2d centre = ground.centre_m.value_or(ego_start_m);
  xml::Element* geom = worldbody.InsertNewChildElement("geom");
  xml::set_source(*geom, source);
  geom->SetAttribute("name", kName);
  geom->SetAttribute("type", "hfield");
  geom->SetAttribute("hfield", kName);
  mjcf::set_numbers(*geom, "pos", {centre.x(), centre.y(), 0});
  geom->SetAttribute("contype", 1);
  geom->SetAttribute("conaffinity", 1);
  if (!material.empty()) geom->SetAttribute("material", material.c_str());
}

void raise_ground(Model& model, const scenario::Ground& ground, std::uint64_t scenario_seed) {
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
      const double deviations = std::clamp(waves.at(x, y) + kHighest / 2, 0.0, kHighest);
      *height = static_cast<float>(window * deviations / kHighest);
    }
  }
}

std::string less_contact(const scenario::Ground& ground) {
  return fmt::format(
      "the rover touches more of the rough ground at once than there is room for; make "
      "ground.wavelength "
      "({:g} m) longer or ground.roughness ({:g} m) less",
      ground.wavelength_m, ground.roughness_m);
}

}  // namespace lcs::sim
