// A room: furniture and pictures along its walls, lamps, and things in the middle.
#include <numbers>

#include "scenes/worlds/families.h"

namespace lcs::worlds {

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
  const int skirting = kit.plain();
  for (const double side : {-1.0, 1.0}) {
    kit.fix({{kit.block({{2 * half.x(), 0.02, 0.08}, {0, 0, 0}, skirting})},
             {0, side * (half.y() - 0.01)},
             0,
             false});
    kit.fix({{kit.block({{0.02, 2 * half.y(), 0.08}, {0, 0, 0}, skirting})},
             {side * (half.x() - 0.01), 0},
             0,
             false});
  }

  const auto at_wall = [&kit, half](int wall, double along, double off) {
    switch (wall) {
      case 0:
        return std::pair(Vector2d(along * half.x(), half.y() - off), 0.0);
      case 1:
        return std::pair(Vector2d(along * half.x(), -half.y() + off), std::numbers::pi);
      case 2:
        return std::pair(Vector2d(half.x() - off, along * half.y()), -std::numbers::pi / 2);
      default:
        return std::pair(Vector2d(-half.x() + off, along * half.y()), std::numbers::pi / 2);
    }
  };
  // windows, posters and boards are parts of the walls
  for (int i = d.whole(0, 7); i > 0; --i) {
    const double w = d.between(0.4, 1.4), h = d.between(0.3, 1.1);
    const int face = d.chance(0.3) ? kit.plain({0.75, 0.85, 0.95}, 1, 0.2)
                                   : kit.surface({Style::lettering, Style::fractal, Style::foliage,
                                                  Style::tiles, Style::stripes});
    const int frame = kit.plain();
    const double z = d.between(0.9, height - h - 0.1);
    const int wall = d.whole(0, 3);
    const auto [at, heading] = at_wall(wall, d.between(-0.8, 0.8), 0.01);
    kit.fix({{kit.block({{w, 0.03, h}, {0, 0, z}, frame}),
              kit.block({{w - 0.08, 0.04, h - 0.08}, {0, 0, z + 0.04}, face})},
             at,
             heading,
             false});
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
  layout.furnish = [&kit, &d, half, height, at_wall] {
    for (int i = d.whole(5, 12); i > 0; --i) {
      const Thing thing =
          make_thing(kit, d.pick({"shelf", "shelf", "cupboard", "table", "bin", "plant", "ladder",
                                  "statue", "chair", "pole", "carton"}));
      const double depth = kit.bounds(thing.parts).half_m.y() + 0.06;
      for (int n = 0; n < 8; ++n) {
        const int wall = d.whole(0, 3);
        const auto [at, heading] = at_wall(wall, d.between(-0.85, 0.85), depth);
        if (kit.try_stand({thing, at, heading})) break;
      }
    }
    const Vector2d inner = half - Vector2d(0.3, 0.3);
    scatter(kit,
            {"table", "chair", "carton", "ball", "drum", "plant", "bin", "cart", "sack", "person",
             "pole", "statue", "robot"},
            d.whole(3, 10), -inner, inner);
    for (int i = d.whole(0, 3); i > 0; --i) {
      const Thing lamp = hanging(kit, height, d.between(1.5, height - 0.35));
      kit.try_stand({lamp,
                     {d.between(-0.6, 0.6) * half.x(), d.between(-0.6, 0.6) * half.y()},
                     d.between(0, std::numbers::pi)});
    }
    maybe_shadows(kit, -inner, inner);
  };
  return layout;
}

}  // namespace lcs::worlds
