#include "scenes/worlds/families.h"

#include <algorithm>
#include <numbers>

namespace lcs::worlds {

void scatter(Kit& kit, const std::vector<std::string>& kinds, int count, const Vector2d& low_m,
             const Vector2d& high_m) {
  constexpr int kTries = 12;
  constexpr double kGap_m = 0.15;
  for (int i = 0; i < count; ++i) {
    const Thing thing = make_thing(kit, kit.draw.pick(kinds));
    for (int n = 0; n < kTries; ++n) {
      const double x = kit.draw.between(low_m.x(), high_m.x());
      const double y = kit.draw.between(low_m.y(), high_m.y());
      const double heading = kit.draw.between(-std::numbers::pi, std::numbers::pi);
      const TurnedBox box = kit.box_at(thing.parts, {x, y}, heading);
      if (!is_within(box, low_m, high_m)) continue;
      if (kit.try_stand({thing, {x, y}, heading, kGap_m})) break;
    }
  }
}

std::pair<Vector2d, double> at_wall(const Vector2d& half_m, int wall, double along, double off_m) {
  const double x = half_m.x(), y = half_m.y();
  const std::pair<Vector2d, double> of_walls[] = {{{along * x, y - off_m}, 0},
                                                  {{along * x, -y + off_m}, std::numbers::pi},
                                                  {{x - off_m, along * y}, -std::numbers::pi / 2},
                                                  {{-x + off_m, along * y}, std::numbers::pi / 2}};
  return of_walls[wall];
}

void line_walls(Kit& kit, const std::vector<std::string>& kinds, int count,
                const Vector2d& half_m) {
  constexpr int kTries = 8;
  for (int i = 0; i < count; ++i) {
    const Thing thing = make_thing(kit, kit.draw.pick(kinds));
    const double depth = kit.bounds(thing.parts).half_m.y() + 0.06;
    for (int n = 0; n < kTries; ++n) {
      const int wall = kit.draw.whole(0, 3);
      const auto [at, heading] = at_wall(half_m, wall, kit.draw.between(-0.85, 0.85), depth);
      if (kit.try_stand({thing, at, heading})) break;
    }
  }
}

void hang(Kit& kit, int count, const Vector2d& half_m) {
  for (int i = 0; i < count; ++i) {
    const Thing lamp = hanging(kit, kit.ceiling_m, kit.draw.between(1.5, kit.ceiling_m - 0.35));
    const Vector2d share{kit.draw.between(-0.6, 0.6), kit.draw.between(-0.6, 0.6)};
    const double heading = kit.draw.between(0, std::numbers::pi);
    kit.try_stand({lamp, share.cwiseProduct(half_m), heading});
  }
}

int pale(Kit& kit, double low, double high) {
  const double grey = kit.draw.between(low, high);
  return kit.plain({grey, grey * kit.draw.between(0.94, 1), grey * kit.draw.between(0.88, 1)});
}

int wall_surface(Kit& kit) {
  if (kit.draw.chance(0.35)) {
    kit.tag("bare_wall");
    return kit.plain();
  }
  return kit.wide_surface({Style::fractal, Style::bricks, Style::tiles, Style::stripes, Style::worn,
                           Style::concrete, Style::plain, Style::wood, Style::speckle});
}

int floor_surface(Kit& kit, const std::vector<Style>& styles) {
  if (kit.draw.chance(0.15)) return pale(kit, 0.25, 0.8);
  return kit.wide_surface(styles);
}

void enclose(Kit& kit, const Vector2d& half_m, double height_m) {
  const int one = wall_surface(kit);
  const int other = kit.draw.chance(0.3) ? wall_surface(kit) : one;
  const int ceiling =
      kit.draw.chance(0.7) ? pale(kit, 0.6, 0.95) : kit.wide_surface({Style::tiles, Style::wood});
  enclose(kit, half_m, height_m, {other, one, ceiling});
}

void enclose(Kit& kit, const Vector2d& half_m, double height_m, const Shell& materials) {
  const auto& [across_x, across_y, ceiling] = materials;
  const double x = half_m.x(), y = half_m.y();
  // each from right to left as seen from inside, so that its thickness lies outside
  kit.wall({x, -y}, {-x, -y}, height_m, across_y);
  kit.wall({-x, y}, {x, y}, height_m, across_y);
  kit.wall({x, y}, {x, -y}, height_m, across_x);
  kit.wall({-x, -y}, {-x, y}, height_m, across_x);
  kit.ceiling_m = height_m;
  kit.fix({{kit.block({{2 * x, 2 * y, 0.1}, {0, 0, height_m}, ceiling})}, {0, 0}, 0, false});
}

void skirt(Kit& kit, const Vector2d& half_m) {
  const int skirting = kit.plain();
  for (const double side : {-1.0, 1.0}) {
    const Part along = kit.block({{2 * half_m.x(), 0.02, 0.08}, {0, 0, 0}, skirting});
    kit.fix({{along}, {0, side * (half_m.y() - 0.01)}, 0, false});
    const Part across = kit.block({{0.02, 2 * half_m.y(), 0.08}, {0, 0, 0}, skirting});
    kit.fix({{across}, {side * (half_m.x() - 0.01), 0}, 0, false});
  }
}

void maybe_strew(Kit& kit, const Vector2d& low_m, const Vector2d& high_m) {
  Draw& d = kit.draw;
  if (!d.chance(0.7)) return;
  const bool is_grass = d.chance(0.5);
  const double dense_pm2 = d.scaled(0.5, 12), tall_m = d.scaled(0.03, 0.15);
  const double area_m2 = (high_m - low_m).prod();
  constexpr int kShades = 3;
  constexpr double kMost = 2500;
  const int count = static_cast<int>(std::min(kMost, dense_pm2 * area_m2) / kShades);
  for (int shade = 0; shade < kShades; ++shade) {
    std::vector<Chip> chips;
    for (int i = 0; i <= count; ++i) {
      const double x = d.between(low_m.x(), high_m.x()), y = d.between(low_m.y(), high_m.y());
      const double size = tall_m * d.between(0.5, 1.5);
      const double lean_x = d.between(-1, 1), lean_y = d.between(-1, 1);
      const double rise = is_grass ? d.between(0.7, 1.2) : d.between(0.1, 0.5);
      const Vector3d foot(x, y, kit.ground({x, y}));
      const TurnedBox box{{x, y}, {1.5 * size, 1.5 * size}, 0, foot.z(), foot.z() + 2 * size};
      if (least_gap_m(box, kit.kept_free) <= 0) continue;
      chips.push_back({foot, foot + size * Vector3d(lean_x, lean_y, rise),
                       size * (is_grass ? 0.3 : d.between(0.5, 1))});
    }
    if (chips.empty()) return;
    const double light = d.between(0.08, 0.95);
    const Vector3d green(0.75, 1, 0.5), grey(1, 0.9, 0.8);
    const int colour = kit.plain(light * (is_grass ? green : grey));
    kit.fix({{kit.chips(chips, colour)}, {0, 0}, 0, false});
  }
}

void maybe_shadows(Kit& kit, const Vector2d& low_m, const Vector2d& high_m) {
  if (!kit.draw.chance(0.4)) return;
  for (int i = kit.draw.whole(2, 6); i > 0; --i) {
    const double x = kit.draw.between(low_m.x(), high_m.x());
    const double y = kit.draw.between(low_m.y(), high_m.y());
    kit.shadow({x, y});
  }
}

}  // namespace lcs::worlds
