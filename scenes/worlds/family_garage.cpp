// A garage: a low hall with pillars, bays with cars, and pipes and beams below the ceiling.
#include <numbers>

#include "scenes/worlds/families.h"

namespace lcs::worlds {

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
