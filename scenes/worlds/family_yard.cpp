// A yard or park: grass and gravel, uneven ground, trees and bushes, fences, a bank.
#include <numbers>

#include "scenes/worlds/families.h"

namespace lcs::worlds {

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
