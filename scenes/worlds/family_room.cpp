// A room: furniture and pictures along its walls, lamps, and things in the middle.
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

}  // namespace lcs::worlds
