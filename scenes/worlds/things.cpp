#include "scenes/worlds/families.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <string_view>

namespace lcs::worlds {
namespace {

const std::vector<Style> kPrinted{Style::lettering, Style::lettering, Style::stripes, Style::plain};
const std::vector<Style> kMetal{Style::worn, Style::corrugated, Style::grille, Style::plain,
                                Style::fractal};
const std::vector<Style> kStone{Style::concrete, Style::speckle, Style::fractal, Style::bricks};
const std::vector<Style> kCloth{Style::plain, Style::stripes, Style::fractal, Style::tiles,
                                Style::lettering};
const std::vector<Style> kLeaves{Style::foliage};
const std::vector<Style> kWood{Style::wood};

using Outline = std::vector<Vector2d>;

Parts drum(Kit& k) {
  const double r = k.draw.between(0.15, 0.35), h = r * k.draw.between(2, 3.2);
  const Outline side{{r, 0},       {r, h * .32},        {r * 1.04, h * .34}, {r, h * .36},
                     {r, h * .64}, {r * 1.04, h * .66}, {r, h * .68},        {r, h}};
  return {k.turned({side, {0, 0, 0}, k.paint(kMetal)})};
}

Parts ball(Kit& k) {
  const double r = k.draw.scaled(0.1, 0.5);
  return {k.ball({{r, r, r}, {0, 0, r}, k.paint()})};
}

Parts bollard(Kit& k) {
  const double r = k.draw.between(0.04, 0.12), h = k.draw.between(0.5, 1.1);
  const int m = k.draw.chance(0.5) ? k.plain() : k.surface({Style::stripes, Style::worn});
  return {k.post({r, h, {0, 0, 0}, m}), k.ball({{r, r, r}, {0, 0, h}, k.plain()})};
}

Parts cone(Kit& k) {
  const double h = k.draw.between(0.3, 0.8);
  const int red = k.plain({0.85, 0.3, 0.1}), white = k.plain({0.92, 0.92, 0.9});
  const double r = h * 0.22;
  return {k.block({{3 * r, 3 * r, 0.03}, {0, 0, 0}, k.plain({0.15, 0.15, 0.15})}),
          k.turned({{{r, 0}, {r * .72, h * .35}}, {0, 0, 0.03}, red}),
          k.turned({{{r * .72, 0}, {r * .46, h * .3}}, {0, 0, 0.03 + h * .35}, white}),
          k.turned({{{r * .46, 0}, {r * .12, h * .35}}, {0, 0, 0.03 + h * .65}, red})};
}

/// A rigid walking or standing person with legs apart.
Parts person(Kit& k) {
  const double h = k.draw.between(1.5, 1.9), s = h / 1.75;
  const int coat = k.paint(kCloth), trousers = k.paint(kCloth), skin = k.plain({0.75, 0.58, 0.47});
  const double stride = k.draw.between(0.05, 0.28) * s, wide = k.draw.between(0.85, 1.2);
  const double hand = 0.25 * s * wide, shoulder = 0.2 * s * wide;  // from the middle
  const Outline torso{{0.16 * s * wide, 0},
                      {0.19 * s * wide, 0.12 * s},
                      {0.17 * s * wide, 0.3 * s},
                      {0.22 * s * wide, 0.55 * s},
                      {0.09 * s, 0.68 * s}};
  Parts parts{k.bar({{stride, 0.09 * s, 0.06}, {0, 0.09 * s, 0.85 * s}, 0.075 * s, trousers}),
              k.bar({{-stride, -0.09 * s, 0.06}, {0, -0.09 * s, 0.85 * s}, 0.075 * s, trousers}),
              k.turned({torso, {0, 0, 0.8 * s}, coat}),
              k.bar({{0.12 * s, hand, 0.85 * s}, {0, shoulder, 1.38 * s}, 0.05 * s, coat}),
              k.bar({{-0.12 * s, -hand, 0.85 * s}, {0, -shoulder, 1.38 * s}, 0.05 * s, coat}),
              k.ball({{0.1 * s, 0.085 * s, 0.125 * s}, {0, 0, 1.62 * s}, skin}),
              k.ball({{0.105 * s, 0.09 * s, 0.08 * s}, {-0.015 * s, 0, 1.69 * s}, k.plain()})};
  if (k.draw.chance(0.3)) {  // a carried object
    parts.push_back(k.block({{0.2 * s, 0.32 * s, 0.42 * s}, {-0.28 * s, 0, 0.95 * s}, k.paint()}));
  }
  return parts;
}

/// The corners of a rectangle about the origin.
std::array<Vector2d, 4> corners(double half_x_m, double half_y_m) {
  return corners_of({.half_m = {half_x_m, half_y_m}});
}

Parts on_wheels(Kit& k, Parts parts, double x, double y, double r, double width) {
  const int tyre = k.plain({0.1, 0.1, 0.11});
  for (const Vector2d& at : corners(x, y)) {
    Part wheel = k.post({r, width, {0, 0, 0}, tyre});
    wheel.position_m = {at.x(), at.y(), r};
    wheel.rotation = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX());
    parts.push_back(wheel);
  }
  return parts;
}

Parts cart(Kit& k) {
  const double l = k.draw.between(0.5, 1.3), w = l * k.draw.between(0.5, 0.8);
  const double r = k.draw.between(0.04, 0.1), h = k.draw.between(0.25, 0.9);
  const double back = -l / 2 - 0.1;
  const Parts parts{k.block({{l, w, 0.05}, {0, 0, 2 * r}, k.plain()}),
                    k.block({{l * .92, w * .92, h}, {0, 0, 2 * r + 0.05}, k.paint()}),
                    k.bar({{-l / 2, -w * .4, 2 * r}, {back, -w * .4, 1.0}, 0.015, k.plain()}),
                    k.bar({{-l / 2, w * .4, 2 * r}, {back, w * .4, 1.0}, 0.015, k.plain()}),
                    k.bar({{back, -w * .4, 1.0}, {back, w * .4, 1.0}, 0.015, k.plain()})};
  return on_wheels(k, parts, l * .38, w * .4, r, 0.03);
}

/// An extruded side view; windows are slabs that protrude slightly.
Parts car(Kit& k) {
  const double l = k.draw.between(3.4, 4.6), h = k.draw.between(1.35, 1.65), w = 1.75;
  const double r = 0.31;
  const int body = k.draw.chance(0.75) ? k.plain() : k.paint({Style::worn, Style::lettering});
  const int glass = k.plain({0.1, 0.12, 0.14}), lamp = k.plain({0.9, 0.88, 0.8});
  const double sill = 0.22, bonnet = h * 0.58;
  const Outline lower{{-l / 2, sill},
                      {l / 2, sill},
                      {l / 2, bonnet * .85},
                      {l * .25, bonnet},
                      {-l / 2, bonnet * 1.02}};
  const Outline cabin{{-l * .42, bonnet * .98}, {l * .27, bonnet * .98}, {l * .1, h}, {-l * .3, h}};
  const Outline windows{
      {-l * .37, bonnet * 1.04}, {l * .22, bonnet * 1.04}, {l * .09, h * .96}, {-l * .28, h * .96}};
  Parts parts{k.slice({lower, w, {0, 0, 0}, body}), k.slice({cabin, w * .86, {0, 0, 0}, body}),
              k.slice({windows, w * .865, {0, 0, 0}, glass})};
  for (const double y : {-0.6, 0.6}) {
    parts.push_back(k.block({{0.02, 0.3, 0.12}, {l / 2, y, bonnet * .6}, lamp}));
    parts.push_back(
        k.block({{0.02, 0.25, 0.14}, {-l / 2, y, bonnet * .65}, k.plain({0.6, 0.08, 0.06})}));
  }
  parts.push_back(
      k.block({{0.02, 0.5, 0.11}, {-l / 2 - 0.005, 0, 0.5}, k.surface({Style::lettering})}));
  return on_wheels(k, parts, l * .31, w / 2 - 0.08, r, 0.2);
}

Parts van(Kit& k) {
  const double l = k.draw.between(4.4, 5.8), h = k.draw.between(1.9, 2.6), w = 1.95;
  const int body = k.paint({Style::lettering, Style::plain, Style::worn, Style::corrugated});
  const int glass = k.plain({0.1, 0.12, 0.14});
  const Outline cab{
      {l * .22, 0.3}, {l / 2, 0.3}, {l / 2, h * .5}, {l * .38, h * .92}, {l * .22, h * .92}};
  const Outline window{
      {l * .26, h * .52}, {l * .45, h * .52}, {l * .37, h * .86}, {l * .26, h * .86}};
  const Parts parts{k.block({{l * .72, w, h - 0.3}, {-l * .14, 0, 0.3}, body}),
                    k.slice({cab, w * .96, {0, 0, 0}, k.plain()}),
                    k.slice({window, w * .97, {0, 0, 0}, glass})};
  return on_wheels(k, parts, l * .31, w / 2 - 0.09, 0.34, 0.22);
}

Parts table(Kit& k) {
  const double l = k.draw.between(0.8, 1.8), w = k.draw.between(0.6, 0.9),
               h = k.draw.between(0.65, 0.8);
  const int top = k.paint(kWood), leg = k.plain();
  Parts parts{k.block({{l, w, 0.04}, {0, 0, h}, top})};
  for (const Vector2d& at : corners(l / 2 - 0.05, w / 2 - 0.05)) {
    parts.push_back(k.post({0.022, h, {at.x(), at.y(), 0}, leg}));
  }
  for (int i = k.draw.whole(0, 4); i > 0; --i) {
    const Vector3d at{k.draw.between(-l * .4, l * .4), k.draw.between(-w * .35, w * .35), h + 0.04};
    const double s = k.draw.between(0.06, 0.2);
    if (k.draw.chance(0.6)) {
      const Vector3d size{s, s * 1.4, s * k.draw.between(0.3, 1.6)};
      parts.push_back(k.block({size, at, k.paint(kPrinted), k.draw.between(0, std::numbers::pi)}));
    } else {
      const Outline side{{s * .3, 0}, {s * .5, s * .5}, {s * .25, s}, {s * .3, s * 1.3}};
      parts.push_back(k.turned({side, at, k.paint()}));
    }
  }
  return parts;
}

Parts chair(Kit& k) {
  const int wood = k.paint(kWood), leg = k.plain();
  const double w = k.draw.between(0.4, 0.5), h = k.draw.between(0.42, 0.48);
  Parts parts{k.block({{w, w, 0.04}, {0, 0, h}, wood}),
              k.block({{0.03, w, k.draw.between(0.25, 0.5)}, {-w / 2, 0, h + 0.08}, wood})};
  for (const Vector2d& at : corners(w / 2 - 0.02, w / 2 - 0.02)) {
    parts.push_back(k.post({0.016, at.x() < 0 ? h + 0.3 : h, {at.x(), at.y(), 0}, leg}));
  }
  return parts;
}

Parts cupboard(Kit& k) {
  const Vector3d size{k.draw.between(0.6, 1.4), k.draw.between(0.35, 0.6),
                      k.draw.between(0.7, 2.0)};
  const int face = k.paint({Style::wood, Style::worn, Style::plain, Style::grille});
  const int knob = k.plain();
  Parts parts{k.block({size, {0, 0, 0}, face})};
  const int doors = k.draw.whole(1, 3);
  for (int i = 0; i < doors; ++i) {  // protruding doors, with gaps and knobs
    const double w = size.x() / doors, x = -size.x() / 2 + (i + 0.5) * w;
    parts.push_back(k.block({{w - 0.03, 0.02, size.z() - 0.1}, {x, -size.y() / 2, 0.06}, face}));
    parts.push_back(
        k.ball({{0.02, 0.02, 0.02}, {x + w * .35, -size.y() / 2 - 0.02, size.z() * .5}, knob}));
  }
  return parts;
}

Parts bin(Kit& k) {
  const double r = k.draw.between(0.12, 0.3), h = k.draw.between(0.35, 1.0);
  const int m = k.paint(kMetal);
  const Outline side{{r * .8, 0}, {r, h}, {r * 1.08, h}, {r * 1.08, h * 1.04}, {r * .3, h * 1.15}};
  return {k.turned({side, {0, 0, 0}, m})};
}

Parts plant(Kit& k) {
  const double r = k.draw.between(0.1, 0.25), h = r * 1.6, crown = k.draw.between(0.2, 0.5);
  const int pot = k.paint(kStone);
  const Vector3d radii{crown, crown, crown * k.draw.between(0.8, 1.6)};
  return {k.turned({{{r * .7, 0}, {r, h}}, {0, 0, 0}, pot}),
          k.lump({radii, 0.15, {0, 0, h + crown * .8}, k.surface(kLeaves)})};
}

/// Randomly adds light and dark leaves that stand off a surface.
void add_leaves(Kit& k, Parts& parts, const Vector3d& middle_m, const Vector3d& radii_m) {
  if (!k.draw.chance(0.6)) return;
  const double size = k.draw.scaled(0.03, 0.12);
  const int count = k.draw.whole(60, 250);
  for (const bool is_light : {false, true}) {
    std::vector<Chip> chips;
    for (int i = 0; i < count; ++i) {
      const Vector3d out = Vector3d{k.draw.normal(), k.draw.normal(), k.draw.normal()}.normalized();
      const Vector3d way{k.draw.normal(), k.draw.normal(), k.draw.normal()};
      Vector3d foot = middle_m + k.draw.between(0.85, 1.05) * out.cwiseProduct(radii_m);
      foot.z() = std::max(foot.z(), size);
      chips.push_back({foot, foot + size * k.draw.between(0.5, 1.5) * way.normalized(), size});
    }
    const double light = is_light ? k.draw.between(0.4, 0.95) : k.draw.between(0.03, 0.25);
    parts.push_back(k.chips(chips, k.plain(light * Vector3d(k.draw.between(0.5, 0.95), 1, 0.45))));
  }
}

Parts bush(Kit& k) {
  const int leaves = k.surface(kLeaves);
  const double r = k.draw.between(0.3, 0.9);
  Parts parts;
  for (int i = k.draw.whole(1, 3); i > 0; --i) {
    const double s = r * k.draw.between(0.6, 1);
    const Vector3d radii{s, s, s * k.draw.between(0.7, 1.2)};
    const Vector3d middle{k.draw.between(-r, r) * .5, k.draw.between(-r, r) * .5, s * .6};
    parts.push_back(k.lump({radii, 0.15, middle, leaves}));
    add_leaves(k, parts, middle, radii);
  }
  return parts;
}

Parts tree(Kit& k) {
  const double trunk = k.draw.between(0.06, 0.2), h = k.draw.between(1.8, 3.2);
  const double crown = k.draw.between(0.8, 1.7);
  const Vector3d radii{crown, crown, crown * k.draw.between(0.8, 1.5)};
  const Vector3d middle{0, 0, h + crown * .6};
  const Outline side{{trunk * 1.4, 0}, {trunk, 0.3}, {trunk * .8, h + 0.3}};
  const Vector3d bough_radii{crown * .7, crown * .7, crown * .6};
  const Vector3d bough{crown * .5, crown * .3, h + crown * .2};
  Parts parts{k.turned({side, {0, 0, 0}, k.surface({Style::wood, Style::fractal})}),
              k.lump({radii, 0.12, middle, k.surface(kLeaves)}),
              k.lump({bough_radii, 0.15, bough, k.surface(kLeaves)})};
  add_leaves(k, parts, middle, radii);
  return parts;
}

Parts rock(Kit& k) {
  const double r = k.draw.scaled(0.12, 0.6);
  const Vector3d radii{r, r * k.draw.between(0.6, 1), r * k.draw.between(0.5, 0.9)};
  return {k.lump({radii, 0.12, {0, 0, r * .3}, k.surface(kStone)})};
}

Parts pole(Kit& k) {
  k.tag("thin_pole");
  const double r = k.draw.between(0.012, 0.04), h = k.draw.between(1.4, 3.5);
  const int paint = k.draw.chance(0.6) ? k.plain() : k.surface({Style::stripes});
  return {k.post({r, h, {0, 0, 0}, paint}),
          k.turned({{{0.16, 0}, {0.05, 0.05}}, {0, 0, 0}, k.plain()})};
}

Parts sign(Kit& k) {
  k.tag("thin_pole");
  const double h = k.draw.between(1.3, 2.4), w = k.draw.between(0.35, 0.8);
  return {k.post({0.025, h, {0, 0, 0}, k.plain({0.6, 0.6, 0.62})}),
          k.turned({{{0.14, 0}, {0.05, 0.04}}, {0, 0, 0}, k.plain()}),
          k.block({{0.02, w, w * k.draw.between(0.6, 1.2)},
                   {0.035, 0, h - w * .7},
                   k.surface({Style::lettering})})};
}

Parts lamp_post(Kit& k) {
  k.tag("thin_pole");
  const double h = k.draw.between(2.8, 5);
  const int m = k.plain({0.3, 0.32, 0.33});
  return {k.turned({{{0.1, 0}, {0.07, 0.5}, {0.035, 0.55}, {0.03, h}}, {0, 0, 0}, m}),
          k.bar({{0, 0, h}, {0.7, 0, h + 0.15}, 0.025, m}),
          k.block({{0.4, 0.16, 0.07}, {0.85, 0, h + 0.1}, k.plain({0.8, 0.8, 0.75})})};
}

Parts bench(Kit& k) {
  const double l = k.draw.between(1.1, 1.8);
  const int wood = k.surface(kWood), iron = k.plain({0.2, 0.2, 0.21});
  Parts parts;
  for (const double y : {-0.15, 0.0, 0.15}) {
    parts.push_back(k.block({{l, 0.11, 0.035}, {0, y, 0.43}, wood}));
  }
  for (const double z : {0.6, 0.75}) parts.push_back(k.block({{l, 0.03, 0.1}, {0, 0.24, z}, wood}));
  for (const double x : {-l * .4, l * .4}) {
    parts.push_back(k.block({{0.05, 0.4, 0.43}, {x, 0, 0}, iron}));
    parts.push_back(k.block({{0.05, 0.04, 0.5}, {x, 0.21, 0.4}, iron}));
  }
  return parts;
}

Parts pallet(Kit& k) {
  const int wood = k.surface(kWood);
  Parts parts;
  for (const double y : {-0.35, 0.0, 0.35}) {
    parts.push_back(k.block({{1.2, 0.1, 0.1}, {0, y, 0}, wood}));
  }
  for (const double x : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
    parts.push_back(k.block({{0.14, 0.8, 0.025}, {x, 0, 0.1}, wood}));
  }
  const int load = k.draw.whole(0, 3);
  if (load == 1) {
    parts.push_back(k.block({{1.1, 0.75, k.draw.between(0.4, 1.2)}, {0, 0, 0.125}, k.paint()}));
  } else if (load == 2) {
    const int m = k.paint(kPrinted);
    for (int i = 0; i < 2 * k.draw.whole(1, 3); ++i) {
      parts.push_back(
          k.block({{0.5, 0.72, 0.3}, {i % 2 ? 0.28 : -0.28, 0, 0.125 + 0.302 * (i / 2)}, m}));
    }
  } else if (load == 3) {
    const int m = k.paint({Style::plain, Style::fractal});
    for (int i = 0; i < k.draw.whole(2, 5); ++i) {  // sacks
      parts.push_back(k.lump({{0.5, 0.33, 0.1}, 0.1, {0, 0, 0.2 + 0.17 * i}, m}));
    }
  }
  return parts;
}

Parts ladder(Kit& k) {
  const double h = k.draw.between(1.4, 2.4), lean = 0.25 * h;
  const int m = k.plain();
  Parts parts;
  for (const double y : {-0.2, 0.2}) {
    parts.push_back(k.bar({{-lean / 2, y, 0.02}, {lean / 2, y, h}, 0.02, m}));
    parts.push_back(k.bar({{lean * 1.2, y, 0.02}, {lean / 2, y, h}, 0.016, m}));
  }
  for (double z = 0.25; z < h; z += 0.28) {
    const double x = -lean / 2 + lean * z / h;
    parts.push_back(k.bar({{x, -0.2, z}, {x, 0.2, z}, 0.014, m}));
  }
  return parts;
}

Parts statue(Kit& k) {
  const double s = k.draw.between(0.5, 1);
  const int stone = k.paint(kStone);
  const Outline body{{0.12 * s, 0},
                     {0.18 * s, 0.15 * s},
                     {0.1 * s, 0.4 * s},
                     {0.17 * s, 0.6 * s},
                     {0.06 * s, 0.75 * s}};
  return {k.block({{0.5 * s, 0.5 * s, 0.7 * s}, {0, 0, 0}, k.draw.chance(0.5) ? k.plain() : stone}),
          k.turned({body, {0, 0, 0.7 * s}, stone}),
          k.ball({{0.1 * s, 0.09 * s, 0.13 * s}, {0, 0, 1.55 * s}, stone})};
}

Parts sack(Kit& k) {
  const double r = k.draw.between(0.2, 0.4);
  const int cloth = k.paint({Style::plain, Style::fractal, Style::lettering});
  return {k.lump({{r, r * .7, r * .8}, 0.15, {0, 0, r * .65}, cloth})};
}

Parts panel(Kit& k) {
  const double w = k.draw.between(0.8, 2.2), h = k.draw.between(1.2, 2.2);
  Parts parts{k.block({{0.05, w, h}, {0, 0, 0.12}, k.paint()})};
  for (const double y : {-w * .35, w * .35}) {
    parts.push_back(k.block({{0.5, 0.06, 0.12}, {0, y, 0}, k.plain()}));
  }
  return parts;
}

Parts barrier(Kit& k) {
  const double l = k.draw.between(1, 2);
  const int board = k.surface({Style::stripes}), leg = k.plain();
  return {k.block({{0.04, l, 0.2}, {0, 0, 0.75}, board}),
          k.block({{0.04, l, 0.15}, {0, 0, 0.35}, board}),
          k.block({{0.05, 0.05, 1.0}, {0, -l * .42, 0}, leg}),
          k.block({{0.05, 0.05, 1.0}, {0, l * .42, 0}, leg}),
          k.block({{0.5, 0.06, 0.05}, {0, -l * .42, 0}, leg}),
          k.block({{0.5, 0.06, 0.05}, {0, l * .42, 0}, leg})};
}

/// A low robot with a mast, like another rover.
Parts robot(Kit& k) {
  const double r = k.draw.between(0.18, 0.35), h = k.draw.between(0.15, 0.5);
  const Outline side{{r * .9, 0}, {r, 0.05}, {r, h}, {r * .8, h + 0.06}};
  return {k.turned({side, {0, 0, 0.03}, k.paint(kMetal)}),
          k.post({0.02, k.draw.between(0.2, 0.9), {-r * .4, 0, h}, k.plain()}),
          k.block({{0.1, 0.14, 0.1}, {r * .3, 0, h + 0.09}, k.plain({0.1, 0.1, 0.12})})};
}

/// A truck with mast and fork, sometimes loaded.
Parts forklift(Kit& k) {
  const int body = k.draw.chance(0.5) ? k.plain({0.85, 0.65, 0.1}) : k.paint(kMetal);
  const int iron = k.plain({0.2, 0.2, 0.22});
  Parts parts{k.block({{1.3, 0.95, 0.7}, {-0.2, 0, 0.25}, body}),
              k.block({{0.4, 0.9, 0.5}, {-0.75, 0, 0.45}, body})};
  for (const double y : {-0.4, 0.4}) {
    parts.push_back(k.block({{0.1, 0.08, 1.9}, {0.55, y, 0.08}, iron}));
    parts.push_back(k.bar({{-0.5, y, 0.95}, {-0.4, y, 1.9}, 0.03, iron}));
    parts.push_back(k.bar({{0.4, y, 0.95}, {0.3, y, 1.9}, 0.03, iron}));
    parts.push_back(k.block({{1.0, 0.1, 0.04}, {1.1, y * .6, 0.12}, iron}));
  }
  parts.push_back(k.block({{0.9, 0.9, 0.05}, {-0.05, 0, 1.9}, iron}));
  if (k.draw.chance(0.6)) parts.push_back(k.block({{0.9, 0.9, 0.8}, {1.15, 0, 0.16}, k.paint()}));
  return on_wheels(k, parts, 0.45, 0.42, 0.22, 0.14);
}

Parts bicycle(Kit& k) {
  const int frame = k.plain(), tyre = k.plain({0.12, 0.12, 0.12});
  const auto rim = [](double x, int i) {
    const double a = std::numbers::pi * i / 6;
    return Vector3d(x + 0.32 * std::cos(a), 0, 0.34 + 0.32 * std::sin(a));
  };
  Parts parts;
  for (const double x : {-0.5, 0.5}) {
    for (int i = 0; i < 12; ++i) parts.push_back(k.bar({rim(x, i), rim(x, i + 1), 0.018, tyre}));
  }
  parts.push_back(k.bar({{-0.5, 0, 0.34}, {-0.15, 0, 0.8}, 0.018, frame}));
  parts.push_back(k.bar({{-0.15, 0, 0.8}, {0.35, 0, 0.85}, 0.018, frame}));
  parts.push_back(k.bar({{0.5, 0, 0.34}, {0.33, 0, 0.95}, 0.018, frame}));
  parts.push_back(k.bar({{0.35, 0, 0.85}, {0, 0, 0.35}, 0.018, frame}));
  const int coat = k.paint(kCloth), trousers = k.paint(kCloth);
  parts.push_back(k.bar({{-0.12, 0.1, 0.9}, {0.1, 0.1, 0.4}, 0.065, trousers}));
  parts.push_back(k.bar({{-0.12, -0.1, 0.9}, {-0.05, -0.1, 0.35}, 0.065, trousers}));
  Part torso = k.turned({{{0.16, 0}, {0.2, 0.35}, {0.1, 0.55}}, {-0.15, 0, 0.9}, coat});
  torso.rotation = Eigen::AngleAxisd(0.35, Vector3d::UnitY());
  parts.push_back(torso);
  parts.push_back(k.bar({{0.05, 0.18, 1.35}, {0.33, 0.2, 0.98}, 0.045, coat}));
  parts.push_back(k.bar({{0.05, -0.18, 1.35}, {0.33, -0.2, 0.98}, 0.045, coat}));
  parts.push_back(k.ball({{0.11, 0.09, 0.13}, {0.12, 0, 1.6}, k.plain({0.75, 0.58, 0.47})}));
  return parts;
}

/// A load on a hook: it hangs and may move.
Parts load(Kit& k) {
  const double s = k.draw.between(0.3, 0.8), foot = k.draw.between(0.4, 1.3);
  const double hook = foot + s * .4;
  const double rope = std::min(3.0, k.ceiling_m - hook - 0.02);
  return {k.block({{s, s, s * k.draw.between(0.5, 1)}, {0, 0, foot}, k.paint()}),
          k.post({0.012, rope, {0, 0, hook}, k.plain({0.2, 0.2, 0.2})})};
}

Parts any_carton(Kit& k) {
  const double s = k.draw.scaled(0.2, 0.8);
  return carton(k, {s, s * k.draw.between(0.6, 1), s * k.draw.between(0.5, 1.3)}).parts;
}

template <int kEmptiness_percent>
Parts any_shelf(Kit& k) {
  const Vector3d size{k.draw.between(0.7, 1.8), k.draw.between(0.28, 0.45), k.draw.between(1, 2.1)};
  return shelf(k, size, k.draw.whole(3, 5), false, kEmptiness_percent / 100.0).parts;
}

/// A desk with drawers and a screen; one sits on the side of -y.
Parts desk(Kit& k) {
  const double l = k.draw.between(1.1, 1.8), w = k.draw.between(0.6, 0.8), h = 0.72;
  const int top = k.paint(kWood), frame = k.plain(), dark = k.plain({0.1, 0.1, 0.12});
  const double drawers = l / 2 - 0.24, screen = k.draw.between(-0.3, 0.3) * l;
  Parts parts{k.block({{l, w, 0.03}, {0, 0, h}, top}),
              k.block({{0.4, w - 0.1, h - 0.05}, {drawers, 0, 0.05}, frame}),
              k.block({{0.03, w - 0.1, h}, {-l / 2 + 0.04, 0, 0}, frame}),
              k.block({{0.22, 0.16, 0.02}, {screen, w * .25, h + 0.03}, dark}),
              k.post({0.02, 0.2, {screen, w * .25 + 0.03, h + 0.05}, dark}),
              k.block({{0.54, 0.03, 0.33}, {screen, w * .25, h + 0.13}, dark})};
  for (const double z : {0.08, 0.29, 0.5}) {  // protruding fronts
    parts.push_back(k.block({{0.37, 0.02, 0.19}, {drawers, -w / 2 + 0.05, z}, top}));
  }
  return parts;
}

Parts railing(Kit& k) {
  const double l = k.draw.between(1, 3), h = k.draw.between(0.85, 1.1);
  const double r = k.draw.between(0.008, 0.02);
  const int m = k.plain(), spaces = static_cast<int>(l / k.draw.between(0.12, 0.5)) + 1;
  Parts parts{k.bar({{-l / 2, 0, h}, {l / 2, 0, h}, 0.025, k.plain()}),
              k.bar({{-l / 2, 0, 0.1}, {l / 2, 0, 0.1}, r, m})};
  for (int i = 0; i <= spaces; ++i) {
    const double foot = i % spaces == 0 ? 0 : 0.1;  // only the outer ones reach the floor
    parts.push_back(k.post({r, h - foot, {-l / 2 + l * i / spaces, 0, foot}, m}));
  }
  return parts;
}

/// From the floor to the ceiling.
Parts column(Kit& k) {
  const double w = k.draw.between(0.12, 0.4), h = k.ceiling_m;
  if (k.draw.chance(0.5)) return {k.post({w / 2, h, {0, 0, 0}, k.plain()})};
  return {k.block({{w, w, h}, {0, 0, 0}, k.plain()})};
}

struct ThingKind {
  std::string_view name;
  Parts (*make)(Kit&);
};
constexpr ThingKind kKinds[] = {{"drum", drum},         {"ball", ball},
                                {"bollard", bollard},   {"cone", cone},
                                {"person", person},     {"cart", cart},
                                {"car", car},           {"van", van},
                                {"table", table},       {"chair", chair},
                                {"cupboard", cupboard}, {"bin", bin},
                                {"plant", plant},       {"bush", bush},
                                {"tree", tree},         {"rock", rock},
                                {"pole", pole},         {"sign", sign},
                                {"lamp", lamp_post},    {"bench", bench},
                                {"pallet", pallet},     {"ladder", ladder},
                                {"statue", statue},     {"sack", sack},
                                {"panel", panel},       {"barrier", barrier},
                                {"robot", robot},       {"forklift", forklift},
                                {"bicycle", bicycle},   {"load", load},
                                {"carton", any_carton}, {"shelf", any_shelf<20>},
                                {"desk", desk},         {"railing", railing},
                                {"column", column},     {"bare_shelf", any_shelf<60>}};

}  // namespace

Thing carton(Kit& kit, const Vector3d& size_m) {
  return {"carton", {kit.block({size_m, {0, 0, 0}, kit.paint()})}};
}

Thing shelf(Kit& kit, const Vector3d& size_m, int boards, bool is_rack, double emptiness) {
  kit.tag("shelf");
  const int wood = is_rack ? kit.plain({0.85, 0.4, 0.1}) : kit.paint(kWood);
  const int upright = is_rack ? kit.plain({0.15, 0.25, 0.5}) : wood;
  Parts parts;
  const double post = is_rack ? 0.09 : 0.03;
  for (const Vector2d& at : corners(size_m.x() / 2 - post / 2, size_m.y() / 2 - post / 2)) {
    parts.push_back(kit.block({{post, post, size_m.z()}, {at.x(), at.y(), 0}, upright}));
  }
  const double step = (size_m.z() - 0.1) / (boards - 1);
  for (int i = 0; i < boards; ++i) {
    const double z = 0.06 + i * step, thick = is_rack ? 0.1 : 0.025;
    if (!is_rack || i > 0) {
      parts.push_back(kit.block({{size_m.x() - 2 * post, size_m.y(), thick}, {0, 0, z}, wood}));
    }
    if (i + 1 == boards && !is_rack) break;
    const double foot = !is_rack || i > 0 ? z + thick : 0;
    const double room = step - thick - 0.08;
    double x = -size_m.x() / 2 + post + 0.02;
    while (x < size_m.x() / 2 - post - 0.05) {  // a row of goods
      const double w = is_rack ? kit.draw.between(0.4, 1.1) : kit.draw.between(0.04, 0.3);
      if (x + w > size_m.x() / 2 - post) break;
      const double h = room * kit.draw.between(0.4, 1),
                   d = size_m.y() * kit.draw.between(0.6, 0.95);
      const double kind = kit.draw.between(0, 1);
      const Vector3d at(x + w / 2, 0, foot);
      if (kind < emptiness) {
        // nothing
      } else if (kind < 0.85) {
        parts.push_back(kit.block({{w, d, h}, at, kit.paint(kPrinted)}));
      } else {
        const double r = std::min(w, d) / 2;
        parts.push_back(kit.turned({{{r, 0}, {r, h * .7}, {r * .5, h}}, at, kit.paint()}));
      }
      x += w + kit.draw.between(0.01, is_rack ? 0.25 : 0.08);
    }
  }
  return {is_rack ? "rack" : "shelf", parts};
}

Parts door(Kit& kit, int leaf, int frame) {
  Parts parts{
      kit.block({{0.06, 0.12, 2.1}, {-0.48, 0, 0}, frame}),
      kit.block({{0.06, 0.12, 2.1}, {0.48, 0, 0}, frame}),
      kit.block({{1.02, 0.12, 0.07}, {0, 0, 2.1}, frame}),
      kit.block({{0.9, 0.04, 2.08}, {0, 0, 0.01}, leaf}),
      kit.bar({{0.36, -0.06, 1.02}, {0.26, -0.06, 1.02}, 0.012, kit.plain({0.7, 0.7, 0.7})})};
  if (kit.draw.chance(0.6)) {
    parts.push_back(
        kit.block({{0.22, 0.02, 0.12}, {0, -0.03, 1.55}, kit.surface({Style::lettering})}));
  }
  return parts;
}

Parts framed(Kit& kit, const Vector2d& size_m, double foot_m, int face, int frame) {
  const double w = size_m.x(), h = size_m.y();
  return {kit.block({{w, 0.03, h}, {0, 0, foot_m}, frame}),
          kit.block({{w - 0.08, 0.04, h - 0.08}, {0, 0, foot_m + 0.04}, face})};
}

Thing hanging(Kit& kit, double ceiling_m, double foot_m) {
  kit.tag("hanging");
  const int cord = kit.plain({0.15, 0.15, 0.15});
  const double w = kit.draw.between(0.25, 0.9),
               h = std::min(kit.draw.between(0.15, 0.5), ceiling_m - foot_m - 0.05);
  Parts parts;
  if (kit.draw.chance(0.5)) {  // a board
    parts.push_back(
        kit.block({{0.03, w, h}, {0, 0, foot_m}, kit.paint({Style::lettering, Style::stripes})}));
    for (const double y : {-w * .4, w * .4}) {
      parts.push_back(kit.post({0.008, ceiling_m - foot_m - h, {0, y, foot_m + h}, cord}));
    }
  } else {  // a lamp
    const int shade = kit.paint({Style::plain, Style::stripes, Style::fractal});
    parts.push_back(kit.turned({{{w / 2, 0}, {w / 3, h * .5}, {0.03, h}}, {0, 0, foot_m}, shade}));
    parts.push_back(kit.post({0.008, ceiling_m - foot_m - h, {0, 0, foot_m + h}, cord}));
  }
  return {"hanging", parts};
}

Thing make_thing(Kit& kit, const std::string& kind) {
  const auto* const found = std::ranges::find(kKinds, kind, &ThingKind::name);
  if (found == std::end(kKinds)) throw std::invalid_argument("no thing is called '" + kind + "'");
  return {kind, found->make(kit)};
}

}  // namespace lcs::worlds
