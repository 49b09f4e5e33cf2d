/// \file
/// Triangle meshes with normals and texture coordinates, for OBJ files.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "scenes/worlds/draw.h"

namespace lcs::worlds {

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

}  // namespace lcs::worlds
