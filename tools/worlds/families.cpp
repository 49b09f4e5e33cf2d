#include "tools/worlds/families.h"

#include <numbers>

namespace lcs::worlds {

using Eigen::Vector2d;
using Eigen::Vector3d;

void scatter(Kit& kit, const std::vector<std::string>& kinds, int count, const Vector2d& low_m,
             const Vector2d& high_m, double gap_m) {
  constexpr int kTries = 12;
  for (int i = 0; i < count; ++i) {
    const Thing thing = make_thing(kit, kit.draw.pick(kinds));
    for (int n = 0; n < kTries; ++n) {
      const double x = kit.draw.between(low_m.x(), high_m.x());
      const double y = kit.draw.between(low_m.y(), high_m.y());
      const double heading = kit.draw.between(-std::numbers::pi, std::numbers::pi);
      const Box box = kit.box_at(thing.parts, {x, y}, heading);
      bool inside = true;
      for (const double a : {-1.0, 1.0}) {
        for (const double b : {-1.0, 1.0}) {
          const Vector2d corner = point_of(box, a, b, 0).head<2>();
          inside = inside && (corner.array() >= low_m.array()).all() &&
                   (corner.array() <= high_m.array()).all();
        }
      }
      if (inside && kit.try_stand(thing.kind, thing.parts, {x, y}, heading, gap_m)) break;
    }
  }
}

int wall_surface(Kit& kit) {
  if (kit.draw.chance(0.35)) {
    kit.tag("bare_wall");
    return kit.plain();
  }
  const double side = kit.draw.between(1.2, 3);
  return kit.surface({Style::fractal, Style::bricks, Style::tiles, Style::stripes, Style::worn,
                      Style::concrete, Style::plain, Style::wood, Style::speckle},
                     side);
}

int floor_surface(Kit& kit, const std::vector<Style>& styles) {
  if (kit.draw.chance(0.15)) return kit.plain();
  const double side = kit.draw.between(1, 3);
  return kit.surface(styles, side);
}

void enclose(Kit& kit, const Vector2d& half_m, double height_m) {
  const double x = half_m.x(), y = half_m.y();
  const int one = wall_surface(kit);
  const int other = kit.draw.chance(0.3) ? wall_surface(kit) : one;
  // each from right to left as seen from inside, so that its thickness lies outside
  kit.wall({x, -y}, {-x, -y}, height_m, one);
  kit.wall({-x, y}, {x, y}, height_m, one);
  kit.wall({x, y}, {x, -y}, height_m, other);
  kit.wall({-x, -y}, {-x, y}, height_m, other);
  const int ceiling = kit.draw.chance(0.7) ? kit.plain() : kit.surface({Style::tiles, Style::wood}, 1.5);
  kit.fix({kit.block({2 * x, 2 * y, 0.1}, {0, 0, height_m}, ceiling)}, {0, 0}, 0, false);
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
