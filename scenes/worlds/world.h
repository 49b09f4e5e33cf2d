/// \file
/// A drawn world, before it is written as a scenario and a scene; and its triangle meshes with
/// normals and texture coordinates, for OBJ files.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <numbers>
#include <opencv2/core.hpp>
#include <set>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "scenes/worlds/draw.h"

namespace lcs::worlds {

inline constexpr double kDegree = std::numbers::pi / 180;

struct Mesh {
  struct Vertex {
    Vector3d position_m, normal;
    Vector2d texture;  ///< a picture spans 0 to 1; y up
  };
  std::vector<Vertex> vertices;
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise from outside
};

/// \name Closed surfaces with their foot at z = 0. A picture spans `side_m` of the surface.
///@{
Mesh box_mesh(const Vector3d& size_m, double side_m);
/// An extruded polygon, counter-clockwise from above; star-shaped about its centroid.
Mesh prism_mesh(const std::vector<Vector2d>& polygon_m, double height_m, double side_m);
/// A profile (radius, height), from the foot up, rotated about z. Radii above 0.
Mesh turned_mesh(const std::vector<Vector2d>& profile_m, double side_m, int around = 16);
/// An ellipsoid centred at z = 0, with bumps of `bumps` times its radius.
Mesh lump_mesh(const Vector3d& radii_m, double bumps, double side_m, Draw& draw);
///@}

/// A leaf, a blade of grass or a stone: a tetrahedron from its foot to its tip.
struct Chip {
  Vector3d foot_m, tip_m;
  double width_m;
};
/// Many chips as one mesh, without texture.
Mesh chips_mesh(const std::vector<Chip>& chips);

/// \return an OBJ file, deterministic for each mesh.
std::string obj_text(const Mesh& mesh);

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
