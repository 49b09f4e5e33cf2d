/// \file
/// Layouts of the families: the parts of a place, the rover's lane, and the traffic; with the
/// movers and things in them.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "scenes/worlds/kit.h"

namespace lcs::worlds {

// ---- The rover of a world: its camera, its sensors, and its path along the layout's free lane

/// The rover's free lane: from `start_m` along x, with length and half width.
struct Lane {
  Vector2d start_m = Vector2d::Zero();
  double length_m = 5;
  double half_width_m = 1;
  double fastest_mps = 1.5;
  double highest_camera_m = 1.6;
  bool is_rough = false;  ///< has wheel contact
};

/// The rover's pose at a time.
struct Stand {
  double t_s = 0;
  Vector2d at_m = Vector2d::Zero();
  double heading_rad = 0;
};

/// The rover's path through its lane, from the commands.
struct RoverPath {
  std::vector<Stand> frames;  ///< one for each frame
  TurnedBox box_of(const scenario::Camera& camera, const Stand& stand) const;
};

/// The path of the commands, with the simulator's smoothing.
RoverPath way_of(const scenario::Scenario& scenario);

/// Draws camera, sensors and commands of the world's scenario.
RoverPath draw_rover(Kit& kit, const Lane& lane);

/// Projects a point into the camera at a stand: x and y in pixels and its depth in metres, which
/// may be negative.
Vector3d seen_at(const scenario::Camera& camera, const Stand& stand, double ground_m,
                 const Vector3d& point_m);
Vector3d camera_at(const scenario::Camera& camera, const Stand& stand, double ground_m);

// ---- The movers of a world, on free and visible paths

/// The movers of a layout, and their area.
struct Traffic {
  std::vector<std::string> kinds;        ///< of things (`make_thing`)
  Vector2d low_m{-5, -5}, high_m{5, 5};  ///< corners of their area
  double fastest_mps = 2;
  double farthest_m = 8;  ///< from the camera, halfway along its path
  int most = 4;
};

struct PlannedMover {
  Thing thing;
  scenario::Trajectory trajectory;
  double start_s = 0;
  double heading_rad = 0;  ///< at rest, before it starts

  TurnedBox box_at(const Kit& kit, double t_s) const;
};

/// Draws movers one by one, each clear of static things, of the rover and of other movers.
/// \return fewer than `count` if no free path was found.
std::vector<PlannedMover> draw_movers(Kit& kit, const RoverPath& way, const Traffic& traffic,
                                      int count);

/// Number of the run's frames in which a mover moves and is visible, by the plan.
int frames_seen(const Kit& kit, const RoverPath& way, const std::vector<PlannedMover>& movers,
                std::size_t which);

/// Adds the movers to scene and scenario, and tags the world's features that they show.
void add_movers(Kit& kit, const RoverPath& way, const std::vector<PlannedMover>& movers);

// ---- Standing, hanging and moving things: each consists of a few parts about its origin

/// A thing with random size and surfaces. \throws std::invalid_argument for an unknown kind.
Thing make_thing(Kit& kit, const std::string& kind);

/// \name Things of a given size.
///@{
Thing carton(Kit& kit, const Vector3d& size_m);
/// Boards between uprights, with goods on them; length along x.
/// \param emptiness share of places without goods.
Thing shelf(Kit& kit, const Vector3d& size_m, int boards, bool is_rack, double emptiness = 0.2);
/// A door in its frame, flush with a wall along x; the room is towards -y.
Parts door(Kit& kit, int leaf, int frame);
/// A picture or window in its frame, against a wall along x.
Parts framed(Kit& kit, const Vector2d& size_m, double foot_m, int face, int frame);
/// A thing that hangs from a ceiling of that height.
Thing hanging(Kit& kit, double ceiling_m, double foot_m);
///@}

// ---- The layouts

/// A returned layout already has its fixed parts; `furnish` adds those that must not block rover
/// and movers, once their paths are known.
struct FloorPlan {
  Lane lane;
  Traffic traffic;
  std::function<void()> furnish;
};

FloorPlan lay_out_room(Kit& kit);
FloorPlan lay_out_corridor(Kit& kit);
FloorPlan lay_out_warehouse(Kit& kit);
FloorPlan lay_out_street(Kit& kit);
FloorPlan lay_out_yard(Kit& kit);
FloorPlan lay_out_garage(Kit& kit);
FloorPlan lay_out_plain(Kit& kit);

/// \name Shared by several layouts.
///@{
/// Places up to `count` things at random free positions of a rectangle.
void scatter(Kit& kit, const std::vector<std::string>& kinds, int count, const Vector2d& low_m,
             const Vector2d& high_m);
/// Places up to `count` things at free positions along the walls at x and y of +-half.
void line_walls(Kit& kit, const std::vector<std::string>& kinds, int count, const Vector2d& half_m);
/// Hangs up to `count` lamps and boards from the ceiling.
void hang(Kit& kit, int count, const Vector2d& half_m);
/// Position and heading of what stands `off_m` from one of those four walls, with its back to it.
/// \param along from -1 to 1.
std::pair<Vector2d, double> at_wall(const Vector2d& half_m, int wall, double along, double off_m);
/// A plain colour or a texture.
int wall_surface(Kit& kit);
int floor_surface(Kit& kit, const std::vector<Style>& styles);
/// Materials of a room's walls, across x and across y, and of its ceiling.
struct Shell {
  int across_x, across_y, ceiling;
};
/// A grey, possibly with a slight tint.
int pale(Kit& kit, double low, double high);
/// Four walls at x and y of +-half, and a ceiling: of random surfaces, or of these.
void enclose(Kit& kit, const Vector2d& half_m, double height_m);
void enclose(Kit& kit, const Vector2d& half_m, double height_m, const Shell& materials);
/// Skirting at the foot of those walls.
void skirt(Kit& kit, const Vector2d& half_m);
/// Randomly adds grass, or leaves and stones, off the paths. Call it in `furnish`.
void maybe_strew(Kit& kit, const Vector2d& low_m, const Vector2d& high_m);
/// Randomly adds shadows on the floor.
void maybe_shadows(Kit& kit, const Vector2d& low_m, const Vector2d& high_m);
///@}

}  // namespace lcs::worlds
