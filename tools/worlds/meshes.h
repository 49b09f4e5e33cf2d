/// \file
/// Triangle meshes with normals and texture coordinates, as OBJ files have them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "tools/worlds/draw.h"

namespace lcs::worlds {

struct Mesh {
  struct Vertex {
    Eigen::Vector3d position_m, normal;
    Eigen::Vector2d texture;  ///< a picture reaches from 0 to 1; y up
  };
  std::vector<Vertex> vertices;
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise from outside
};

/// \name Closed surfaces that stand on z = 0. A picture spans `side_m` of the surface.
///@{
Mesh box_mesh(const Eigen::Vector3d& size_m, double side_m);
/// A polygon, counter-clockwise from above, drawn up. Star-shaped about its centre of gravity.
Mesh prism_mesh(const std::vector<Eigen::Vector2d>& polygon_m, double height_m, double side_m);
/// A profile (radius, height), from the foot up, turned about z. Radii above 0.
Mesh turned_mesh(const std::vector<Eigen::Vector2d>& profile_m, double side_m, int around = 16);
/// An ellipsoid with bumps of that share of its radius, about z = 0.
Mesh lump_mesh(const Eigen::Vector3d& radii_m, double bumps, double side_m, Draw& draw);
///@}

/// A leaf, a blade of grass, a stone: a tetrahedron from its foot to its tip.
struct Chip {
  Eigen::Vector3d foot_m, tip_m;
  double width_m;
};
/// Many of them as one, without a picture.
Mesh chips_mesh(const std::vector<Chip>& chips);

/// The text of an OBJ file: the same bytes for the same mesh.
std::string obj_text(const Mesh& mesh);

}  // namespace lcs::worlds
