// Places below the sky.
#include <numbers>

#include "scenes/worlds/families.h"

namespace lcs::worlds {

/// A street: facades, pavements with kerbs, parked cars, lamps and trees; it may rise ahead.
FloorPlan lay_out_street(Kit& kit) {
  Draw& d = kit.draw;
  const double road = d.between(3, 4.5), pavement = d.between(1.5, 3);  // half width; one side
  const double back = -8, front = d.between(25, 45);
  kit.plainness = d.between(0.1, 0.45);
  kit.world.has_sky = true;
  const double cloud = d.between(0.55, 0.9);
  kit.world.sky = {cloud * d.between(0.75, 1), cloud * d.between(0.85, 1), cloud};
  kit.world.extent_m = front;
  kit.world.ambient = d.between(0.45, 0.65);
  kit.world.diffuse = d.between(0.35, 0.5);
  const int asphalt = floor_surface(
      kit, {Style::speckle, Style::speckle, Style::concrete, Style::fractal, Style::bricks});
  kit.floor(asphalt, {front + 15, road + pavement + 6});
  const double kerb = d.between(0.06, 0.14);
  const int slabs =
      kit.wide_surface({Style::tiles, Style::concrete, Style::speckle, Style::bricks});
  kit.ground = [road, pavement, kerb](const Vector2d& at) {
    return std::abs(at.y()) >= road && std::abs(at.y()) <= road + pavement ? kerb : 0.0;
  };
  double flat = front;
  if (d.chance(0.4)) {
    flat = d.between(5, 14);
    kit.ramp(flat, front - flat + 15, 2 * (road + pavement + 2),
             d.between(2, 7) * std::numbers::pi / 180, asphalt);
  }
  for (const double side : {-1.0, 1.0}) {
    kit.world.setting.push_back(kit.block({{front - back, pavement, kerb},
                                           {(front + back) / 2, side * (road + pavement / 2), 0},
                                           slabs}));
    // facades, a wall or a hedge
    double x = back;
    while (x < front) {
      const double w = d.between(5, 11);
      const double y = side * (road + pavement);
      const double kind = d.between(0, 1);
      if (kind < 0.7) {
        const double h = d.between(4, 10), deep = d.between(0.3, 0.9);
        const int face = d.chance(0.1) ? wall_surface(kit)
                                       : kit.surface({Style::facade, Style::facade, Style::bricks});
        const Part house = kit.block({{w, 3, h + 1}, {0, 0, -0.5}, face});
        kit.fix({{house}, {x + w / 2, y + side * (1.5 + deep * d.between(0, 1))}, 0});
        if (d.chance(0.7)) {  // a door, and a sign above it
          const Part leaf = kit.block({{1, 0.08, 2.1}, {0, 0, kerb}, kit.plain()});
          kit.fix({{leaf}, {x + w * d.between(0.3, 0.7), y + side * 0.03}, 0, false});
          if (d.chance(0.5)) {
            kit.tag("hanging");
            const int words = kit.surface({Style::lettering});
            const Part sign = kit.block({{0.05, 0.7, 0.5}, {0, 0, 2.4}, words});
            kit.fix({{sign}, {x + w * d.between(0.2, 0.8), y - side * 0.4}, 0, false});
          }
        }
      } else if (kind < 0.85) {
        const Vector3d size{w, 0.3, d.between(1, 2.2)};
        kit.fix(
            {{kit.block({size, {0, 0, 0}, wall_surface(kit)})}, {x + w / 2, y + side * 0.2}, 0});
      } else {
        const Vector3d size{w, 0.8, d.between(0.9, 1.8)};
        const Part hedge = kit.block({size, {0, 0, 0}, kit.surface({Style::foliage})});
        kit.fix({{hedge}, {x + w / 2, y + side * 0.5}, 0});
      }
      x += w + (d.chance(0.2) ? d.between(1, 3) : 0);
    }
    const Vector2d behind(0, side * (road + pavement + 4)), ahead(front, 0);  // of the gaps
    const double height = d.between(3, 8);
    kit.wall(behind - side * ahead, behind + side * ahead, height, kit.plain());
  }
  if (d.chance(0.7)) {  // the centre line
    const int white = kit.plain({0.85, 0.85, 0.83});
    for (double x = back; x < std::min(flat, front) - 1; x += 3) {
      kit.decal({x, 0}, 0, {1.2, 0.12}, white);
    }
  }

  FloorPlan layout;
  const bool on_wheels = d.chance(0.3);
  layout.lane = {.start_m = {-1, d.between(-0.5, 0.5) * road},
                 .length_m = on_wheels ? 16 : std::min(flat, front - 6),
                 .half_width_m = 0.45 * road,
                 .fastest_mps = on_wheels ? 2.5 : 8,
                 .highest_camera_m = 1.6,
                 .is_rough = on_wheels};
  layout.traffic = {.kinds = {"car", "car", "van", "person", "person", "bicycle", "bicycle", "cart",
                              "ball", "robot"},
                    .low_m = {back, -road - pavement + 0.1},
                    .high_m = {front, road + pavement - 0.1},
                    .fastest_mps = 9,
                    .farthest_m = 18};
  layout.furnish = [&kit, &d, road, pavement, back, front] {
    maybe_strew(kit, {0, -road - pavement}, {front / 2, road + pavement});
    for (const double side : {-1.0, 1.0}) {
      for (int i = d.whole(2, 6); i > 0; --i) {  // parked along the kerb
        const Thing car = make_thing(kit, d.pick({"car", "car", "car", "van"}));
        const Vector2d at{d.between(back, front), side * (road - 1.05)};
        kit.try_stand({car, at, d.chance(0.5) ? 0 : std::numbers::pi, 0.4});
      }
      const double y0 = side * (road + 0.1), y1 = side * (road + pavement - 0.1);
      scatter(kit,
              {"lamp", "tree", "sign", "bin", "bench", "bollard", "person", "pole", "bush", "panel",
               "bicycle"},
              d.whole(8, 16), {back, std::min(y0, y1)}, {front * 0.8, std::max(y0, y1)});
    }
    scatter(kit, {"cone", "barrier", "bollard", "sack", "ball", "carton"}, d.whole(0, 6),
            {1, -road}, {front / 2, road});
    maybe_shadows(kit, {0, -road}, {front / 3, road});
  };
  return layout;
}

/// A yard or park: grass and gravel, uneven ground, trees and bushes, fences, a bank.
FloorPlan lay_out_yard(Kit& kit) {
  Draw& d = kit.draw;
  const Vector2d half{d.between(9, 15), d.between(6, 10)};
  kit.plainness = d.between(0.05, 0.4);
  kit.world.has_sky = true;
  const double cloud = d.between(0.6, 0.95);
  kit.world.sky = {cloud * d.between(0.7, 1), cloud * d.between(0.85, 1), cloud};
  kit.world.extent_m = half.norm();
  kit.world.ambient = d.between(0.45, 0.65);
  kit.world.diffuse = d.between(0.35, 0.5);
  const int grass = floor_surface(
      kit, {Style::foliage, Style::speckle, Style::fractal, Style::concrete, Style::fractal});
  kit.floor(grass, half + Vector2d(12, 12));
  const bool is_rough = d.chance(0.7);
  double flat = half.x();
  if (d.chance(0.5)) {
    flat = d.between(2, 0.7 * half.x());
    kit.ramp(flat, half.x() + 14 - flat, 2 * half.y() + 24,
             d.between(3, 9) * std::numbers::pi / 180, grass);
  }
  FloorPlan layout;
  layout.lane = {.start_m = {-half.x() + 1.5, d.between(-0.2, 0.2) * half.y()},
                 .length_m = std::min(9.0, flat + half.x() - 2),
                 .half_width_m = 1.5,
                 .fastest_mps = 1.4,
                 .highest_camera_m = 1.2,
                 .is_rough = is_rough};
  if (is_rough) {
    scenario::RoughGround bumps;
    bumps.roughness_m = std::round(1e4 * d.scaled(0.003, 0.015)) / 1e4;
    bumps.wavelength_m = std::round(100 * d.between(0.8, 1.5)) / 100;
    bumps.centre_m = {0, 0};
    bumps.size_m = {std::round(2 * half.x() - 2), std::round(2 * half.y() - 2)};
    if (flat < half.x()) {  // level again before the bank
      bumps.centre_m = {std::round((flat - half.x()) * 50) / 100, 0};
      bumps.size_m.x() = std::round((flat + half.x()) * 100) / 100;
    }
    kit.world.scenario.ground = bumps;
    kit.tag("uneven_ground");
  }
  // its border: a fence of posts and rails, a hedge, a wall, or the side of a house
  for (int i = 0; i < 4; ++i) {
    const bool across = i < 2;
    const double length = 2 * (across ? half.x() : half.y());
    const double side = i % 2 == 0 ? 1 : -1;
    const Vector2d at = across ? Vector2d(0, side * half.y()) : Vector2d(side * half.x(), 0);
    const double turn = across ? 0 : std::numbers::pi / 2;
    const double kind = d.between(0, 1);
    if (kind < 0.35) {
      kit.tag("thin_pole");
      Parts fence;
      const int wood = kit.paint({Style::wood});
      const double h = d.between(0.8, 1.5), step = d.between(0.9, 1.8);
      for (double x = -length / 2; x <= length / 2; x += step) {
        fence.push_back(kit.block({{0.07, 0.07, h}, {x, 0, 0}, wood}));
      }
      for (const double z : {0.3 * h, 0.6 * h, 0.9 * h}) {
        fence.push_back(kit.block({{length, 0.03, 0.06}, {0, 0, z}, wood}));
      }
      kit.fix({fence, at, turn});
    } else if (kind < 0.6) {
      const Vector3d size{length, d.between(0.5, 1), d.between(0.8, 2.2)};
      const Part hedge = kit.block({size, {0, 0, 0}, kit.wide_surface({Style::foliage})});
      kit.fix({{hedge}, at, turn});
    } else if (kind < 0.85) {
      const Vector3d size{length, 0.3, d.between(1, 3) + 1};
      kit.fix({{kit.block({size, {0, 0, -0.5}, wall_surface(kit)})}, at, turn});
    } else {
      const Vector3d size{length, 0.6, d.between(4, 8)};
      const int face = kit.wide_surface({Style::facade, Style::bricks});
      kit.fix({{kit.block({size, {0, 0, -0.3}, face})}, at, turn});
    }
  }
  layout.traffic = {.kinds = {"person", "person", "bicycle", "ball", "cart", "robot", "sack",
                              "drum", "bush", "panel"},
                    .low_m = -half + Vector2d(0.5, 0.5),
                    .high_m = half - Vector2d(0.5, 0.5),
                    .fastest_mps = 4,
                    .farthest_m = 10};
  layout.furnish = [&kit, &d, half] {
    maybe_strew(kit, {-half.x(), -5}, {4, 5});
    const Vector2d inner = half - Vector2d(0.6, 0.6);
    scatter(kit,
            {"tree", "tree", "bush", "bush", "rock", "rock", "bench", "lamp", "sign", "bin", "pole",
             "plant", "person", "statue", "drum", "pallet", "cart"},
            d.whole(16, 34), -inner, inner);
    if (!kit.world.scenario.ground) maybe_shadows(kit, -inner, inner);
  };
  return layout;
}

}  // namespace lcs::worlds
