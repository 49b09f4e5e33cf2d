// Rooms.
#include "scenes/worlds/families.h"

namespace lcs::worlds {
namespace {

struct Place {
  bool is_corridor;
  std::vector<std::string> at_walls, inside;
};
const std::vector<Place> kPlaces{
    {false,
     {"bare_shelf", "cupboard", "table", "chair", "bin", "carton", "column", "railing"},
     {"table", "table", "chair", "carton", "drum", "ball", "person", "column", "railing"}},
    {false,
     {"desk", "desk", "bare_shelf", "cupboard", "bin", "carton", "chair"},
     {"desk", "desk", "table", "chair", "chair", "bin", "panel", "column", "person"}},
    {true,
     {"railing", "railing", "column", "cupboard", "chair", "bin", "carton", "bare_shelf"},
     {"carton", "bollard", "drum", "column", "person", "cart"}}};

/// Doors, switches, sockets and pictures, none over another: of `doors` the share.
void dress_walls(Kit& kit, const Vector2d& half_m, double doors) {
  Draw& d = kit.draw;
  const int leaf = kit.plain(), frame = kit.plain(), plate = kit.plain({0.95, 0.95, 0.9});
  for (int wall = 0; wall < 4; ++wall) {
    const double half = wall < 2 ? half_m.x() : half_m.y();
    for (double along = -half + d.between(0.7, 1.6); along < half - 0.7;
         along += d.between(1.3, 2.5)) {
      const auto [at, heading] = at_wall(half_m, wall, along / half, 0.01);
      const bool is_door = d.chance(doors);
      const double height = is_door ? 1.1 : 0.3;  // of a switch, or a socket
      kit.fix({{kit.block({{0.08, 0.03, 0.08}, {0.65, 0, height}, plate})}, at, heading, false});
      if (is_door) {
        kit.fix({door(kit, leaf, frame), at, heading});
      } else if (d.chance(0.5)) {
        const Vector2d size{d.between(0.3, 0.8), d.between(0.3, 0.7)};
        const double foot = d.between(1.0, 1.4);
        kit.fix({framed(kit, size, foot, kit.paint({Style::plain, Style::fractal}), kit.plain()),
                 at, heading, false});
      }
    }
  }
}

}  // namespace

/// A room: furniture and pictures along its walls, lamps, and things in the middle.
FloorPlan lay_out_room(Kit& kit) {
  Draw& d = kit.draw;
  const Vector2d half{d.between(2.6, 5.5), d.between(2.2, 4)};
  const double height = d.between(2.3, 3.4);
  kit.plainness = d.between(0.05, 0.5);
  kit.world.extent_m = half.norm();
  kit.world.ambient = d.between(0.5, 0.75);
  kit.floor(floor_surface(kit, {Style::wood, Style::tiles, Style::speckle, Style::fractal,
                                Style::concrete, Style::worn}),
            half);
  enclose(kit, half, height);
  skirt(kit, half);
  // windows, posters and boards are parts of the walls
  for (int i = d.whole(0, 7); i > 0; --i) {
    const double w = d.between(0.4, 1.4), h = d.between(0.3, 1.1);
    const int face = d.chance(0.3) ? kit.plain({0.75, 0.85, 0.95}, 1, 0.2)
                                   : kit.surface({Style::lettering, Style::fractal, Style::foliage,
                                                  Style::tiles, Style::stripes});
    const int frame = kit.plain();
    const double z = d.between(0.9, height - h - 0.1);
    const int wall = d.whole(0, 3);
    const auto [at, heading] = at_wall(half, wall, d.between(-0.8, 0.8), 0.01);
    kit.fix({framed(kit, {w, h}, z, face, frame), at, heading, false});
  }

  FloorPlan layout;
  layout.lane = {.start_m = {-half.x() + 0.9, 0},
                 .length_m = 2 * half.x() - 2,
                 .half_width_m = half.y() * 0.45,
                 .fastest_mps = 1.0,
                 .highest_camera_m = 1.4,
                 .is_rough = d.chance(0.1)};
  layout.traffic = {.kinds = {"person", "person", "cart", "robot", "ball", "carton", "drum",
                              "chair", "sack", "panel", "load", "cupboard"},
                    .low_m = -half + Vector2d(0.1, 0.1),
                    .high_m = half - Vector2d(0.1, 0.1),
                    .fastest_mps = 2.5,
                    .farthest_m = 1.4 * half.x()};
  layout.furnish = [&kit, &d, half] {
    line_walls(kit,
               {"shelf", "shelf", "cupboard", "table", "bin", "plant", "ladder", "statue", "chair",
                "pole", "carton"},
               d.whole(5, 12), half);
    const Vector2d inner = half - Vector2d(0.3, 0.3);
    scatter(kit,
            {"table", "chair", "carton", "ball", "drum", "plant", "bin", "cart", "sack", "person",
             "pole", "statue", "robot"},
            d.whole(3, 10), -inner, inner);
    hang(kit, d.whole(0, 3), half);
    maybe_shadows(kit, -inner, inner);
  };
  return layout;
}

/// Rooms with few and poor corners: painted walls, skirting, doors, plain furniture, faint joints.
FloorPlan lay_out_plain(Kit& kit) {
  Draw& d = kit.draw;
  const Place& place = d.pick(kPlaces);
  const bool is_corridor = place.is_corridor;
  const double length = is_corridor ? d.between(5, 9) : d.between(3, 6);
  const Vector2d half{length, is_corridor ? d.between(1.1, 1.8) : d.between(2.5, 4.2)};
  const double height = d.between(2.3, 3.2);
  kit.world.extent_m = half.norm();
  kit.world.ambient = d.between(0.65, 0.85);
  kit.tint = 0.12;
  kit.weather_levels = d.scaled(1, 5);
  kit.contrast = d.between(0.15, 0.45);  // of joints
  kit.floor(
      floor_surface(kit, {Style::wood, Style::wood, Style::tiles, Style::tiles, Style::plain}),
      half);
  kit.tag("bare_wall");
  const int walls = d.chance(0.5) ? pale(kit, 0.5, 0.9) : kit.wide_surface({Style::plain});
  enclose(kit, half, height, {walls, walls, pale(kit, 0.6, 0.95)});
  skirt(kit, half);
  kit.plainness = 0.8;
  dress_walls(kit, half, is_corridor ? 0.5 : 0.4);

  kit.plainness = d.between(0.5, 0.85);  // a mover needs a few corners
  kit.contrast = d.between(0.2, 0.5);
  FloorPlan layout;
  layout.lane = {.start_m = {-half.x() + 0.9, 0},
                 .length_m = 2 * half.x() - 2,
                 .half_width_m = half.y() * (is_corridor ? 0.35 : 0.45),
                 .fastest_mps = is_corridor ? 2.0 : 1.0,
                 .highest_camera_m = 1.4,
                 .is_rough = d.chance(0.1)};
  layout.traffic = {.kinds = {"person", "person", "cart", "robot", "ball", "carton", "chair",
                              "drum", "panel", "cupboard", "bin"},
                    .low_m = -half + Vector2d(0.1, 0.1),
                    .high_m = half - Vector2d(0.1, 0.1),
                    .fastest_mps = 2.5,
                    .farthest_m = 1.4 * half.x()};
  layout.furnish = [&kit, &d, &place, half] {
    kit.plainness = d.between(0.75, 0.95);
    // large pictures have more corners of the same things
    const int fewer = kit.world.scenario.camera.width_px / 250;
    line_walls(kit, place.at_walls, d.whole(10, 15) - fewer, half);
    const Vector2d inner = half - Vector2d(0.3, 0.3);
    scatter(kit, place.inside, d.whole(6, 10) - fewer, -inner, inner);
    hang(kit, d.whole(0, 2), half);
    maybe_shadows(kit, -inner, inner);
  };
  return layout;
}

}  // namespace lcs::worlds
