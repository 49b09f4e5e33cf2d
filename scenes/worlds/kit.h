/// \file
/// Tools for building layouts: surfaces, parts, placed things, and the plan view that keeps them
/// apart.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/worlds/draw.h"
#include "scenes/worlds/textures.h"
#include "scenes/worlds/world.h"

namespace lcs::worlds {

// ---- Geometry of the plan view: overlaps, gaps and occlusions

/// An upright box, rotated by its heading.
struct TurnedBox {
  Vector2d centre_m = Vector2d::Zero();
  Vector2d half_m = Vector2d::Zero();  ///< along its heading, and across
  double heading_rad = 0;
  double foot_m = 0, head_m = 0;  ///< heights of its bottom and top
};

/// Horizontal distance of two boxes: at most the true one, and below 0 for an overlap. Infinite
/// for boxes one above the other.
double gap_m(const TurnedBox& a, const TurnedBox& b);

/// Whether the line segment intersects the box.
bool is_between(const TurnedBox& box, const Vector3d& from_m, const Vector3d& to_m);

/// The point at these fractions, from -1 to 1, of a box's half sizes.
Vector3d point_of(const TurnedBox& box, double ahead, double left, double up);

/// The corners of a box, seen from above.
std::array<Vector2d, 4> corners_of(const TurnedBox& box);
/// Whether all of a box lies, seen from above, between these corners.
bool is_within(const TurnedBox& box, const Vector2d& low_m, const Vector2d& high_m);

/// Least gap to any of the boxes; infinite without boxes.
double least_gap_m(const TurnedBox& box, const std::vector<TurnedBox>& others);

inline Vector2d towards(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}
inline Vector2d turned(const Vector2d& v, double by_rad) {
  const Vector2d d = towards(by_rad);
  return {d.x() * v.x() - d.y() * v.y(), d.y() * v.x() + d.x() * v.y()};
}

// ---- The kit

using Parts = std::vector<Part>;

struct Thing {
  std::string kind;
  Parts parts;
};

/// The bounding box of some parts of a world, symmetric about their origin.
TurnedBox bounds(const DrawnWorld& world, const Parts& parts);

class Kit {
 public:
  /// \param pictures files used for some of the surfaces; may be empty.
  Kit(std::string_view family, std::uint64_t seed, int attempt, std::vector<std::string> pictures);

  Draw draw;
  DrawnWorld world;
  std::vector<TurnedBox> solids;     ///< all standing and hanging things
  std::vector<TurnedBox> kept_free;  ///< paths of the rover and the movers
  /// Height of the ground.
  std::function<double(const Vector2d&)> ground = [](const auto&) { return 0.0; };
  double ceiling_m = 100;     ///< its height; large without a ceiling
  double plainness = 0;       ///< share of things without texture
  double tint = 0.25;         ///< of random plain colours, at most
  double contrast = 1;        ///< of textures; below 1 they fade towards their mean colour
  double weather_levels = 0;  ///< of textures; standard deviation

  void tag(std::string_view feature) { world.features.emplace(feature); }

  /// \name Materials, by index into `world.materials`.
  ///@{
  int plain(const Vector3d& rgb, double alpha = 1, double emission = 0);
  int plain();  ///< of a random colour
  /// A surface of one of the styles. At the limit of pictures per world it reuses one.
  int surface(const std::vector<Style>& styles);
  /// A tiled surface for floors and walls, always with its own picture.
  int wide_surface(const std::vector<Style>& styles);
  /// For a thing: a surface or, with probability `plainness`, a plain colour.
  int paint(const std::vector<Style>& styles);
  int paint();  ///< of any style
  ///@}

  /// \name Parts. Each takes one braced list, so that its random values are drawn in the order
  /// written with any compiler.
  ///@{
  struct Block {
    Vector3d size_m, foot_m;  ///< `foot_m` is the centre of the foot
    int material = 0;
    double heading_rad = 0;
  };
  Part block(const Block& block);
  struct Post {
    double radius_m, height_m;
    Vector3d foot_m;
    int material = 0;
  };
  Part post(const Post& post);
  struct Bar {
    Vector3d from_m, to_m;
    double radius_m;
    int material = 0;
  };
  Part bar(const Bar& bar) const;
  struct Ball {
    Vector3d radii_m, middle_m;
    int material = 0;
  };
  Part ball(const Ball& ball);
  struct Lump {
    Vector3d radii_m;
    double bumps;
    Vector3d middle_m;
    int material = 0;
  };
  Part lump(const Lump& lump);
  struct Turned {
    std::vector<Vector2d> profile_m;
    Vector3d foot_m;
    int material = 0;
  };
  Part turned(const Turned& turned);
  struct Prism {
    std::vector<Vector2d> polygon_m;
    double height_m;
    Vector3d foot_m;
    int material = 0;
  };
  Part prism(const Prism& prism);
  /// A prism with an upright polygon (along x and z), whose height is its width along y.
  Part slice(const Prism& prism);
  Part chips(const std::vector<Chip>& chips, int material);
  ///@}

  TurnedBox bounds(const Parts& parts) const { return worlds::bounds(world, parts); }
  /// The bounding box of parts that are placed as a body.
  TurnedBox box_at(const Parts& parts, const Vector2d& at_m, double heading_rad) const;
  /// The attitude of a box placed there: upright or, if it is long, along the ground's slope.
  Eigen::Quaterniond attitude(const TurnedBox& box) const;

  /// Whether it has no texture with corners.
  bool is_bare(const Parts& parts) const;

  /// Places an object, even where it overlaps others; its new name begins with its kind.
  void stand(const Thing& thing, const Vector2d& at_m, double heading_rad);
  struct Standing {
    Thing thing;
    Vector2d at_m;
    double heading_rad;
    double gap_m = 0.05;
  };
  /// Places an object unless another one is within `gap_m`. \return whether it was placed.
  bool try_stand(const Standing& standing);
  struct Fixture {
    Parts parts;
    Vector2d at_m;
    double heading_rad;
    bool in_the_way = true;
  };
  /// Places a part of the static scene, even where it overlaps others.
  void fix(const Fixture& fixture);
  /// A wall of the static scene between two points, on the left of the line.
  void wall(const Vector2d& from_m, const Vector2d& to_m, double height_m, int material,
            double foot_m = 0, double thickness_m = 0.1);
  /// A level floor with wheel contact, of these half sizes.
  void floor(int material, const Vector2d& half_m);
  /// Ground that rises from x = `from_x_m` on, with width `width_m` about y = 0.
  void ramp(double from_x_m, double length_m, double width_m, double slope_rad, int material);
  /// A dark patch on the floor, like the shadow of an absent object.
  void shadow(const Vector2d& at_m);
  /// A flat mark on the floor.
  void decal(const Vector2d& at_m, double heading_rad, const Vector2d& size_m, int material);

 private:
  Part mesh_part(const std::string& key, const Mesh& mesh, const Vector3d& at_m, int material);
  double side_of(int material, double fit_m) const;
  int add_surface(Style style, bool is_wide, bool is_cube);

  std::vector<std::string> pictures_;
  std::map<std::string, int> meshes_by_key_;
  std::map<Style, std::vector<int>> surfaces_;
  std::map<std::string, int> names_;
  int decals_ = 0;
};

}  // namespace lcs::worlds
