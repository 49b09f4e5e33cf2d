// A corridor: open and closed doors on both sides, crossing passages, pipes and boards.
#include <algorithm>
#include <numbers>

#include "scenes/worlds/families.h"

namespace lcs::worlds {

FloorPlan lay_out_corridor(Kit& kit) {
  Draw& d = kit.draw;
  const double half_length = d.between(6, 13), half_width = d.between(0.85, 1.7);
  const double height = d.between(2.2, 3), depth = d.between(2.5, 4.5);
  kit.plainness = d.between(0.1, 0.5);
  kit.world.extent_m = half_length;
  kit.world.ambient = d.between(0.5, 0.75);
  kit.floor(floor_surface(kit, {Style::tiles, Style::speckle, Style::wood, Style::concrete,
                                Style::fractal, Style::stripes}),
            {half_length, half_width + depth});
  const int walls = wall_surface(kit), ends = wall_surface(kit), behind = wall_surface(kit);
  const int leaf = kit.draw.chance(0.5) ? kit.plain() : kit.surface({Style::wood, Style::worn});
  const int frame = kit.plain();
  const double x0 = -half_length, x1 = half_length, y1 = half_width + depth;
  const int white = pale(kit, 0.6, 0.95);
  kit.fix({{kit.block({{2 * x1, 2 * y1, 0.1}, {0, 0, height}, white})}, {0, 0}, 0, false});
  kit.wall({x1, y1}, {x1, -y1}, height, ends);
  kit.wall({x0, -y1}, {x0, y1}, height, ends);
  kit.wall({x1, -y1}, {x0, -y1}, height, behind);
  kit.wall({x0, y1}, {x1, y1}, height, behind);

  // passages go through both walls; doors and the spaces between differ from side to side
  std::vector<std::pair<double, double>> passages;
  for (double x = x0 + d.between(3, 5); x < x1 - 3; x += d.between(3.5, 8)) {
    if (d.chance(0.75)) passages.emplace_back(x, x + d.between(1.3, 2.4));
  }
  for (const double side : {-1.0, 1.0}) {
    const double heading = side > 0 ? 0 : std::numbers::pi;
    const auto build = [&](double from, double to, double foot) {
      if (to - from < 0.02) return;
      const double y = side * half_width;
      if (side > 0) kit.wall({from, y}, {to, y}, height - foot, walls, foot);
      if (side < 0) kit.wall({to, y}, {from, y}, height - foot, walls, foot);
    };
    double from = x0;
    for (std::size_t i = 0; i <= passages.size(); ++i) {
      const double to = i < passages.size() ? passages[i].first : x1;
      // doors protrude slightly from the wall
      for (double x = from + d.between(0.8, 2); x < to - 0.8; x += d.between(1.8, 4)) {
        kit.fix({door(kit, leaf, frame), {x, side * (half_width - 0.01)}, heading, false});
      }
      build(from, to, 0);
      if (i == passages.size()) break;
      const double end = passages[i].second, y = side * half_width, far = side * y1;
      build(to, end, d.between(2.05, height));  // a lintel
      kit.wall({to, std::min(y, far)}, {to, std::max(y, far)}, height, behind);
      kit.wall({end, std::max(y, far)}, {end, std::min(y, far)}, height, behind);
      from = end;
    }
    if (d.chance(0.5)) {  // a pipe or cable tray
      const double z = height - d.between(0.12, 0.3), y = side * (half_width - 0.12);
      kit.world.setting.push_back(
          kit.bar({{x0, y, z}, {x1, y, z}, d.between(0.02, 0.07), kit.plain()}));
    }
    for (int i = d.whole(0, 4); i > 0; --i) {  // boards
      const double w = d.between(0.3, 1.2);
      const Vector3d size{w, 0.02, w * d.between(0.6, 1.3)}, foot{0, 0, d.between(1.0, 1.4)};
      const int face = kit.surface({Style::lettering, Style::stripes, Style::fractal});
      const Vector2d at{d.between(x0 + 1, x1 - 1), side * (half_width - 0.02)};
      kit.fix({{kit.block({size, foot, face})}, at, heading, false});
    }
  }
  if (d.chance(0.3)) {
    const double from = d.between(0.2, 0.6) * half_length;
    const double slope = d.between(2, 5) * std::numbers::pi / 180;
    kit.ramp(from, half_length - from, 2 * y1, slope,
             kit.wide_surface({Style::tiles, Style::concrete, Style::worn}));
  }

  FloorPlan layout;
  layout.lane = {.start_m = {x0 + 0.8, 0},
                 .length_m = half_length,
                 .half_width_m = 0.35 * half_width,
                 .fastest_mps = 2,
                 .highest_camera_m = 1.4,
                 .is_rough = d.chance(0.1)};
  layout.traffic = {.kinds = {"person", "person", "person", "cart", "robot", "carton", "ball",
                              "drum", "bin", "ladder"},
                    .low_m = {x0 + 0.1, -y1 + 0.1},
                    .high_m = {x1 - 0.1, y1 - 0.1},
                    .fastest_mps = 2.5,
                    .farthest_m = half_length};
  layout.furnish = [&kit, &d, half_length, half_width, height] {
    for (int i = d.whole(6, 16); i > 0; --i) {
      const Thing thing =
          make_thing(kit, d.pick({"bin", "plant", "bench", "shelf", "chair", "carton", "cart",
                                  "cupboard", "sign", "pole", "person", "sack", "bollard"}));
      const double off = kit.bounds(thing.parts).half_m.y() + 0.06;
      for (int n = 0; n < 8; ++n) {
        const double side = d.sign();
        if (kit.try_stand({thing,
                           {d.between(-0.8, 0.95) * half_length, side * (half_width - off)},
                           side > 0 ? 0 : std::numbers::pi})) {
          break;
        }
      }
    }
    for (int i = d.whole(1, 5); i > 0; --i) {
      const Thing lamp = hanging(kit, height, std::min(height - 0.3, d.between(1.8, 2.3)));
      kit.try_stand({lamp, {d.between(-0.5, 0.9) * half_length, 0}, 0});
    }
    maybe_shadows(kit, {-half_length, -half_width}, {half_length, half_width});
  };
  return layout;
}

}  // namespace lcs::worlds
