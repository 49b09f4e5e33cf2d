/// \file
/// A drawn world, before it is written as a scenario and a scene.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <numbers>
#include <opencv2/core.hpp>
#include <set>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "scenes/worlds/meshes.h"

namespace lcs::worlds {

inline constexpr double kDegree = std::numbers::pi / 180;

struct Texture {
  std::string name;  ///< of its file, without .png
  cv::Mat3b picture;
};

struct Material {
  Vector3d rgb{1, 1, 1};
  double alpha = 1;
  double emission = 0;
  int texture = -1;   ///< -1: none
  double side_m = 1;  ///< spanned by a picture
  bool fits = false;  ///< a picture spans a side of the part, of any size
  bool cube = false;  ///< mapped onto primitives from all sides
  bool bold = true;   ///< has detectable corners
};

/// A geom in its body frame, with MuJoCo's sizes.
struct Part {
  enum class Shape { box, cylinder, capsule, ellipsoid, plane, mesh } shape = Shape::box;
  Vector3d size_m = Vector3d::Zero();
  Vector3d position_m = Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  int material = 0;
  int mesh = -1;
  bool is_solid = false;  ///< has wheel contact
};

/// An object of the scene.
struct Body {
  std::string name;
  Vector3d position_m = Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  std::vector<Part> parts;
};

struct DrawnWorld {
  std::string family;
  std::uint64_t seed = 0;
  int attempt = 0;                 ///< number of rejected worlds of this seed before this one
  std::set<std::string> features;  ///< that occur in it, as "slope"
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Part> setting;
  std::vector<Body> bodies;
  bool has_sky = false;
  Vector3d sky{0.6, 0.7, 0.85};
  double ambient = 0.5;  ///< omnidirectional light
  double diffuse = 0.4;  ///< directional light
  double extent_m = 10;
  /// Complete except for the paths of files.
  scenario::Scenario scenario;
};

}  // namespace lcs::worlds
