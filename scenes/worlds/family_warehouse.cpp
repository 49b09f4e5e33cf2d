// A warehouse: an aisle between loaded racks, with crossing passages.
#include <numbers>

#include "scenes/worlds/families.h"

namespace lcs::worlds {

FloorPlan lay_out_warehouse(Kit& kit) {
  Draw& d = kit.draw;
  const double aisle = d.between(1.3, 2.3);  // half width
  const double depth = d.between(0.8, 1.1), bay = d.between(2.2, 2.9), rack = d.between(2.4, 5);
  const int bays = d.whole(3, 6), boards = d.whole(2, 4);
  const double margin = d.between(2.5, 4);
  const Vector2d half(bays * (bay + 0.05) / 2 + margin, aisle + depth + margin);
  const double height = rack + d.between(0.6, 2);
  kit.plainness = d.between(0.05, 0.35);
  kit.world.extent_m = half.norm();
  kit.world.ambient = d.between(0.5, 0.7);
  kit.floor(floor_surface(kit, {Style::concrete, Style::concrete, Style::speckle, Style::worn,
                                Style::fractal}),
            half);
  enclose(kit, half, height);
  // the aisle's markings
  const int line = kit.plain({0.85, 0.75, 0.15});
  for (const double side : {-1.0, 1.0}) {
    kit.decal({0, side * (aisle - 0.12)}, 0, {2 * half.x() - 2, 0.08}, line);
  }
  const int passage = d.whole(0, bays - 1);
  for (const double side : {-1.0, 1.0}) {
    Thing loaded = shelf(kit, {bay, depth, rack}, boards + 1, true);
    for (int i = 0; i < bays; ++i) {
      if (i == passage && bays > 3) continue;
      if (d.chance(0.6)) loaded = shelf(kit, {bay, depth, rack}, boards + 1, true);
      kit.stand(loaded, {-half.x() + margin + (i + 0.5) * (bay + 0.05), side * (aisle + depth / 2)},
                side > 0 ? 0 : std::numbers::pi);
    }
    for (int i = d.whole(0, 2); i > 0; --i) {  // lamps along the ceiling
      const Vector3d size{d.between(1, 2.5), 0.15, 0.06};
      const Part lamp = kit.block({size, {0, 0, height - 0.07}, kit.plain({1, 1, 0.95}, 1, 0.4)});
      kit.fix({{lamp}, {d.between(-0.7, 0.7) * half.x(), side * d.between(0, aisle)}, 0, false});
    }
  }

  FloorPlan layout;
  layout.lane = {.start_m = {-half.x() + 0.8, 0},
                 .length_m = half.x() * 1.2,
                 .half_width_m = 0.4 * aisle,
                 .fastest_mps = 2.5,
                 .highest_camera_m = 1.6,
                 .is_rough = d.chance(0.15)};
  layout.traffic = {.kinds = {"person", "person", "forklift", "cart", "robot", "pallet", "drum",
                              "carton", "load"},
                    .low_m = -half + Vector2d(0.1, 0.1),
                    .high_m = half - Vector2d(0.1, 0.1),
                    .fastest_mps = 3,
                    .farthest_m = half.x() * 1.2};
  layout.furnish = [&kit, &d, half, aisle, height] {
    const Vector2d inner = half - Vector2d(0.3, 0.3);
    scatter(kit,
            {"pallet", "drum", "bollard", "cone", "cart", "ladder", "sack", "person", "bin",
             "forklift", "sign", "barrier"},
            d.whole(6, 14), {-inner.x(), -aisle}, {inner.x(), aisle});
    scatter(kit, {"pallet", "drum", "carton", "panel"}, d.whole(4, 10), -inner, inner);
    for (int i = d.whole(1, 4); i > 0; --i) {
      const Thing board = hanging(kit, height, d.between(2.0, 2.6));
      kit.try_stand({board, {d.between(-0.6, 0.8) * half.x(), d.between(-0.8, 0.8) * aisle}, 0});
    }
    maybe_shadows(kit, {-half.x(), -aisle}, {half.x(), aisle});
  };
  return layout;
}

}  // namespace lcs::worlds
