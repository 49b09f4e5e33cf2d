// Halls.
#include <numbers>

#include "scenes/worlds/families.h"

namespace lcs::worlds {

/// A warehouse: an aisle between loaded racks, with crossing passages.
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

/// A garage: a low hall with pillars, bays with cars, and pipes and beams below the ceiling.
FloorPlan lay_out_garage(Kit& kit) {
  Draw& d = kit.draw;
  const double aisle = d.between(2.4, 3.2), bay = d.between(4.6, 5.2);  // half width; depth
  const Vector2d half(d.between(9, 15), aisle + bay);
  const double height = d.between(2.2, 3);
  kit.plainness = d.between(0.2, 0.6);
  kit.world.extent_m = half.norm();
  kit.world.ambient = d.between(0.4, 0.65);
  const int ground = floor_surface(
      kit, {Style::concrete, Style::concrete, Style::speckle, Style::worn, Style::fractal});
  kit.floor(ground, half);
  enclose(kit, half, height);
  if (d.chance(0.4)) {
    const double from = d.between(0.2, 0.6) * half.x();
    kit.ramp(from, half.x() - from, 2 * half.y(), d.between(2, 6) * std::numbers::pi / 180, ground);
  }
  // pillars between the bays, with bands and numbers
  const double pitch = 2 * d.between(2.4, 2.7), thick = d.between(0.3, 0.6);
  const int shaft = wall_surface(kit), band = kit.wide_surface({Style::stripes, Style::worn});
  const bool round = d.chance(0.4);
  const int white = kit.plain({0.88, 0.88, 0.85});
  for (const double side : {-1.0, 1.0}) {
    for (double x = -half.x() + pitch / 2; x < half.x(); x += pitch) {
      Parts pillar;
      if (round) {
        pillar.push_back(kit.post({thick / 2, height, {0, 0, 0}, shaft}));
        pillar.push_back(kit.post({thick / 2 + 0.004, 0.8, {0, 0, 0}, band}));
      } else {
        pillar.push_back(kit.block({{thick, thick, height}, {0, 0, 0}, shaft}));
        pillar.push_back(kit.block({{thick + 0.008, thick + 0.008, 0.8}, {0, 0, 0}, band}));
      }
      if (d.chance(0.6)) {
        const Vector3d plate{thick * 0.7, thick + 0.02, thick * 0.7};
        pillar.push_back(kit.block({plate, {0, 0, 1.4}, kit.surface({Style::lettering})}));
      }
      kit.stand({"pillar", pillar}, {x, side * (aisle + 0.3)}, 0);
      for (const double part : {0.0, 0.5}) {  // bay markings
        if (kit.ground({x + part * pitch, 0}) > 0) continue;
        kit.decal({x + part * pitch, side * (aisle + bay / 2 + 0.2)}, 0, {0.1, bay - 0.6}, white);
      }
    }
    const double y = side * aisle * 0.7, z = height - d.between(0.12, 0.25);
    const double radius = d.between(0.03, 0.08);
    kit.world.setting.push_back(
        kit.bar({{-half.x(), y, z}, {half.x(), y, z}, radius, kit.plain()}));
  }
  for (double x = -half.x() + pitch / 2; x < half.x(); x += pitch) {
    kit.world.setting.push_back(
        kit.block({{0.3, 2 * half.y(), 0.25}, {x, 0, height - 0.25}, shaft}));
    if (d.chance(0.6)) {
      const double y = d.between(-1, 1);
      kit.world.setting.push_back(kit.block(
          {{1.2, 0.12, 0.06}, {x + pitch / 2, y, height - 0.08}, kit.plain({1, 1, 0.95}, 1, 0.5)}));
    }
  }

  FloorPlan layout;
  layout.lane = {.start_m = {-half.x() + 1, 0},
                 .length_m = half.x() * 1.1,
                 .half_width_m = 0.4 * aisle,
                 .fastest_mps = 3,
                 .highest_camera_m = 1.5,
                 .is_rough = d.chance(0.2)};
  layout.traffic = {
      .kinds = {"person", "person", "car", "car", "cart", "robot", "bicycle", "drum", "ball"},
      .low_m = -half + Vector2d(0.1, 0.1),
      .high_m = half - Vector2d(0.1, 0.1),
      .fastest_mps = 5,
      .farthest_m = half.x()};
  layout.furnish = [&kit, &d, half, aisle, bay, pitch, height] {
    for (const double side : {-1.0, 1.0}) {
      for (double x = -half.x() + pitch * 0.75; x < half.x() - 1; x += pitch / 2) {
        if (!d.chance(0.6)) continue;
        const Thing car = make_thing(kit, d.pick({"car", "car", "car", "van"}));
        const double heading = side * (d.chance(0.5) ? 1 : -1) * std::numbers::pi / 2;
        kit.try_stand({car, {x, side * (aisle + bay / 2 + 0.3)}, heading, 0.15});
      }
    }
    const Vector2d inner = half - Vector2d(0.3, 0.3);
    scatter(
        kit,
        {"cone", "bollard", "person", "bin", "sign", "cart", "barrier", "drum", "carton", "pole"},
        d.whole(4, 12), -inner, inner);
    for (int i = d.whole(0, 3); i > 0; --i) {
      const Thing board = hanging(kit, height, height - d.between(0.5, 0.7));
      kit.try_stand({board, {d.between(-0.5, 0.8) * half.x(), d.between(-0.5, 0.5) * aisle}, 0});
    }
    maybe_shadows(kit, {-half.x(), -aisle}, {half.x() / 2, aisle});
  };
  return layout;
}

}  // namespace lcs::worlds
