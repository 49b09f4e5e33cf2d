#include "scenes/worlds/kit.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "sim/base/rotation.h"

namespace lcs::worlds {
namespace {

constexpr std::size_t kMostTextures = 16;
// Weathering of a world's surfaces, fitted to recordings (README.md).
constexpr double kLeastWeather_levels = 4, kMostWeather_levels = 55;
constexpr double kPhotographs = 0.4;  // share of surfaces, if pictures are given

/// Rounds to millimetres as in the files, so that equal parts share a mesh.
double rounded(double value) {
  return std::round(value * 1000) / 1000;
}
Vector3d rounded(const Vector3d& v) {
  return {rounded(v.x()), rounded(v.y()), rounded(v.z())};
}

/// Half extent of a box along a direction.
double reach(const TurnedBox& box, const Vector2d& along) {
  const Vector2d ahead = towards(box.heading_rad), left(-ahead.y(), ahead.x());
  return box.half_m.x() * std::abs(along.dot(ahead)) + box.half_m.y() * std::abs(along.dot(left));
}

}  // namespace

Kit::Kit(std::string_view family, std::uint64_t seed, int attempt,
         std::vector<std::string> pictures)
    : draw(seed, fmt::format("world/{}/{}", family, attempt)), pictures_(std::move(pictures)) {
  world.family = family;
  world.seed = seed;
  world.attempt = attempt;
  world.scenario.seed = seed;
  weather_levels = draw.scaled(kLeastWeather_levels, kMostWeather_levels);
}

int Kit::plain(const Vector3d& rgb, double alpha, double emission) {
  world.materials.push_back({.rgb = rgb, .alpha = alpha, .emission = emission, .bold = false});
  return static_cast<int>(world.materials.size()) - 1;
}

int Kit::plain() {
  const double grey = draw.between(0.2, 0.9), most = draw.between(0, tint);
  Vector3d rgb;
  for (int i = 0; i < 3; ++i) rgb[i] = std::clamp(grey + draw.between(-most, most), 0.05, 1.0);
  return plain(rgb);
}

int Kit::surface(const std::vector<Style>& styles) {
  const Style style = draw.pick(styles);
  const bool again = draw.chance(0.3), is_cube = draw.chance(0.4) && info_of(style).is_isotropic;
  const std::vector<int>& same = surfaces_[style];
  if (!same.empty() && (again || world.textures.size() >= kMostTextures)) return draw.pick(same);
  return add_surface(style, false, is_cube);
}

int Kit::wide_surface(const std::vector<Style>& styles) {
  return add_surface(draw.pick(styles), true, false);
}

int Kit::add_surface(Style style, bool is_wide, bool is_cube) {
  const StyleInfo& info = info_of(style);
  if (!info.feature.empty()) tag(info.feature);
  Material material;
  material.side_m = draw.scaled(info.least_m, info.most_m) * (is_wide ? 1.4 : 1);
  material.fits = style == Style::lettering && !is_wide;
  material.cube = is_cube;
  material.bold = style != Style::plain && style != Style::concrete;
  material.texture = static_cast<int>(world.textures.size());
  // a separate random stream, so that the texture does not change the layout
  Draw brush(world.seed,
             fmt::format("texture/{}/{}/{}", world.family, world.attempt, material.texture));
  const int pixels = material.side_m > 1.5 ? 512 : 256;
  const bool from_file = !pictures_.empty() && brush.chance(kPhotographs);
  const std::string name =
      fmt::format("{}_{}", from_file ? "photograph" : info.name, material.texture);
  cv::Mat3b picture =
      from_file ? photograph(pictures_, pixels, brush) : worlds::paint(style, pixels, brush);
  if (!from_file && style != Style::plain) weather(picture, weather_levels, brush);
  if (contrast < 1) fade(picture, contrast);
  world.textures.push_back({name, picture});
  world.materials.push_back(material);
  const int place = static_cast<int>(world.materials.size()) - 1;
  if (!is_wide) surfaces_[style].push_back(place);
  return place;
}

int Kit::paint(const std::vector<Style>& styles) {
  return draw.chance(plainness) ? plain() : surface(styles);
}

int Kit::paint() {
  return paint({Style::plain, Style::fractal, Style::lettering, Style::lettering, Style::wood,
                Style::stripes, Style::tiles, Style::corrugated, Style::worn, Style::speckle,
                Style::grille});
}

double Kit::side_of(int material, double fit_m) const {
  const Material& m = world.materials[static_cast<std::size_t>(material)];
  return m.fits ? fit_m : m.side_m;
}

Part Kit::mesh_part(const std::string& key, const Mesh& mesh, const Vector3d& at_m, int material) {
  const auto [found, is_new] = meshes_by_key_.emplace(key, static_cast<int>(world.meshes.size()));
  if (is_new) world.meshes.push_back(mesh);
  return {
      .shape = Part::Shape::mesh, .position_m = at_m, .material = material, .mesh = found->second};
}

Part Kit::block(const Block& block) {
  const Vector3d size = rounded(block.size_m);
  const Material& m = world.materials[static_cast<std::size_t>(block.material)];
  Part part;
  if (m.texture >= 0 && !m.cube) {
    const double side = side_of(block.material, std::max(size.x(), size.z()));
    part = mesh_part(fmt::format("box {} {} {} {:.4f}", size.x(), size.y(), size.z(), side),
                     box_mesh(size, side), block.foot_m, block.material);
  } else {
    part.size_m = size / 2;
    part.position_m = block.foot_m + Vector3d(0, 0, size.z() / 2);
    part.material = block.material;
  }
  part.rotation = Eigen::AngleAxisd(block.heading_rad, Vector3d::UnitZ());
  return part;
}

Part Kit::post(const Post& post) {
  const Material& m = world.materials[static_cast<std::size_t>(post.material)];
  if (m.texture >= 0 && !m.cube) {
    return turned(
        {{{post.radius_m, 0}, {post.radius_m, post.height_m}}, post.foot_m, post.material});
  }
  return {.shape = Part::Shape::cylinder,
          .size_m = {rounded(post.radius_m), rounded(post.height_m) / 2, 0},
          .position_m = post.foot_m + Vector3d(0, 0, post.height_m / 2),
          .material = post.material};
}

Part Kit::bar(const Bar& bar) const {
  const Vector3d along = bar.to_m - bar.from_m;
  return {.shape = Part::Shape::capsule,
          .size_m = {rounded(bar.radius_m), along.norm() / 2, 0},
          .position_m = (bar.from_m + bar.to_m) / 2,
          .rotation = sim::least_rotation(Vector3d::UnitZ(), along),
          .material = bar.material};
}

Part Kit::ball(const Ball& ball) {
  const Material& m = world.materials[static_cast<std::size_t>(ball.material)];
  if (m.texture >= 0 && !m.cube) return lump({ball.radii_m, 0, ball.middle_m, ball.material});
  return {.shape = Part::Shape::ellipsoid,
          .size_m = rounded(ball.radii_m),
          .position_m = ball.middle_m,
          .material = ball.material};
}

Part Kit::lump(const Lump& lump) {
  const double side = side_of(lump.material, 2 * lump.radii_m.x());
  return mesh_part(fmt::format("lump {}", world.meshes.size()),
                   lump_mesh(rounded(lump.radii_m), lump.bumps, side, draw), lump.middle_m,
                   lump.material);
}

Part Kit::turned(const Turned& turned) {
  const double side = side_of(turned.material, turned.profile_m.back().y());
  std::string key = fmt::format("turned {:.4f}", side);
  for (const Vector2d& p : turned.profile_m) key += fmt::format(" {:.3f} {:.3f}", p.x(), p.y());
  return mesh_part(key, turned_mesh(turned.profile_m, side), turned.foot_m, turned.material);
}

Part Kit::prism(const Prism& prism) {
  const double side = side_of(prism.material, prism.height_m);
  std::string key = fmt::format("prism {:.3f} {:.4f}", prism.height_m, side);
  for (const Vector2d& p : prism.polygon_m) key += fmt::format(" {:.3f} {:.3f}", p.x(), p.y());
  return mesh_part(key, prism_mesh(prism.polygon_m, prism.height_m, side), prism.foot_m,
                   prism.material);
}

Part Kit::slice(const Prism& upright) {
  Part part = prism(upright);
  part.position_m += Vector3d(0, upright.height_m / 2, 0);
  part.rotation = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX());
  return part;
}

Part Kit::chips(const std::vector<Chip>& chips, int material) {
  return mesh_part(fmt::format("chips {}", world.meshes.size()), chips_mesh(chips),
                   Vector3d::Zero(), material);
}

TurnedBox bounds(const DrawnWorld& world, const Parts& parts) {
  TurnedBox box;
  box.foot_m = std::numeric_limits<double>::infinity();
  box.head_m = -box.foot_m;
  const auto add = [&](const Part& part, const Vector3d& p) {
    const Vector3d at = part.rotation * p + part.position_m;
    box.half_m = box.half_m.cwiseMax(at.head<2>().cwiseAbs());
    box.foot_m = std::min(box.foot_m, at.z());
    box.head_m = std::max(box.head_m, at.z());
  };
  for (const Part& part : parts) {
    if (part.shape == Part::Shape::mesh) {
      for (const auto& v : world.meshes[static_cast<std::size_t>(part.mesh)].vertices) {
        add(part, v.position_m);
      }
      continue;
    }
    Vector3d half = part.size_m;
    const double radius = half.x();
    if (part.shape == Part::Shape::cylinder) half = {radius, radius, half.y()};
    if (part.shape == Part::Shape::capsule) half = {radius, radius, half.y() + radius};
    for (int i = 0; i < 8; ++i) {
      add(part, half.cwiseProduct(Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    }
  }
  return box;
}

TurnedBox Kit::box_at(const Parts& parts, const Vector2d& at_m, double heading_rad) const {
  TurnedBox box = bounds(parts);
  box.centre_m = at_m;
  box.heading_rad = heading_rad;
  // the lowest ground under it, so that no part floats
  double height = ground(at_m);
  for (const Vector2d& corner : corners_of(box)) height = std::min(height, ground(corner));
  box.foot_m += height;
  box.head_m += height;
  return box;
}

Eigen::Quaterniond Kit::attitude(const TurnedBox& box) const {
  constexpr double kLong_m = 0.45, kStep_m = 0.05;  // shorter things stand upright on a slope
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(box.heading_rad, Vector3d::UnitZ()));
  if (box.half_m.maxCoeff() < kLong_m) return turn;
  const auto slope = [&](const Vector2d& along) {
    return (ground(box.centre_m + kStep_m * along) - ground(box.centre_m - kStep_m * along)) /
           (2 * kStep_m);
  };
  const Vector3d up(-slope(Vector2d::UnitX()), -slope(Vector2d::UnitY()), 1);
  return sim::least_rotation(Vector3d::UnitZ(), up) * turn;
}

void Kit::stand(const Thing& thing, const Vector2d& at_m, double heading_rad) {
  const auto& [kind, parts] = thing;
  const TurnedBox box = box_at(parts, at_m, heading_rad);
  const Eigen::Quaterniond rotation = attitude(box);
  const bool is_tilted = rotation.toRotationMatrix()(2, 2) < 1 - 1e-9;
  const TurnedBox own = bounds(parts);
  const double height = is_tilted ? ground(at_m) : box.foot_m - own.foot_m;
  world.bodies.push_back(
      {fmt::format("{}_{}", kind, ++names_[kind]), {at_m.x(), at_m.y(), height}, rotation, parts});
  solids.push_back(box);
  constexpr double kNotThin_m = 0.1;
  if (own.half_m.minCoeff() > kNotThin_m && is_bare(parts)) tag("bare_thing");
}

bool Kit::is_bare(const Parts& parts) const {
  return std::ranges::none_of(parts, [&](const Part& part) {
    return world.materials[static_cast<std::size_t>(part.material)].bold;
  });
}

bool Kit::try_stand(const Standing& standing) {
  const auto& [thing, at_m, heading_rad, gap] = standing;
  const TurnedBox box = box_at(thing.parts, at_m, heading_rad);
  if (least_gap_m(box, solids) < gap || least_gap_m(box, kept_free) < gap) return false;
  stand(thing, at_m, heading_rad);
  return true;
}

void Kit::fix(const Fixture& fixture) {
  const auto& [parts, at_m, heading_rad, in_the_way] = fixture;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(heading_rad, Vector3d::UnitZ()));
  const TurnedBox box = box_at(parts, at_m, heading_rad);
  const Vector3d at(at_m.x(), at_m.y(), box.foot_m - bounds(parts).foot_m);
  for (Part part : parts) {
    part.position_m = turn * part.position_m + at;
    part.rotation = turn * part.rotation;
    world.setting.push_back(part);
  }
  if (in_the_way) solids.push_back(box);
}

void Kit::wall(const Vector2d& from_m, const Vector2d& to_m, double height_m, int material,
               double foot_m, double thickness_m) {
  const Vector2d along = to_m - from_m;
  const double heading = std::atan2(along.y(), along.x());
  const Vector2d middle =
      (from_m + to_m) / 2 + Vector2d(-along.y(), along.x()).normalized() * (thickness_m / 2);
  const Part part = block({{along.norm(), thickness_m, height_m}, {0, 0, foot_m}, material});
  fix({{part}, middle, heading});
}

void Kit::floor(int material, const Vector2d& half_m) {
  world.setting.push_back({.shape = Part::Shape::plane,
                           .size_m = {half_m.x(), half_m.y(), 0.1},
                           .material = material,
                           .is_solid = true});
}

void Kit::ramp(double from_x_m, double length_m, double width_m, double slope_rad, int material) {
  tag("slope");
  const double rise = std::tan(slope_rad);
  // a wedge, so that its texture lies on the slope as on the floor
  Part part = slice({{{0, -0.2}, {length_m, -0.2}, {length_m, length_m * rise}, {0, 0}},
                     width_m,
                     {from_x_m, 0, 0},
                     material});
  part.is_solid = true;
  world.setting.push_back(part);
  ground = [before = ground, from_x_m, rise](const Vector2d& at) {
    return std::max(before(at), rise * (at.x() - from_x_m));
  };
}

void Kit::decal(const Vector2d& at_m, double heading_rad, const Vector2d& size_m, int material) {
  // slightly different heights avoid z-fighting
  const double lift = 0.003 + 0.0005 * (decals_++ % 8);
  const Part part = block({{size_m.x(), size_m.y(), 0.001}, {0, 0, lift}, material});
  fix({{part}, at_m, heading_rad, false});
}

void Kit::shadow(const Vector2d& at_m) {
  const Vector2d size{draw.scaled(0.4, 2.5), draw.scaled(0.3, 1.2)};
  const double heading = draw.between(0, std::numbers::pi);
  const double darkness = draw.between(0.3, 0.65);
  std::vector<Vector2d> outline;
  const int corners = draw.chance(0.5) ? 4 : draw.whole(6, 14);
  const double phase = draw.between(0, 1);
  for (int i = 0; i < corners; ++i) {
    const double a = 2 * std::numbers::pi * (i + phase) / corners;
    outline.push_back(towards(a).cwiseProduct(size) * draw.between(0.8, 1.0));
  }
  const double lift = 0.003 + 0.0005 * (decals_++ % 8);
  // it is level, and would reach into a slope
  const bool is_level = std::ranges::all_of(outline, [&](const Vector2d& p) {
    return std::abs(ground(at_m + Eigen::Rotation2Dd(heading) * p) - ground(at_m)) < lift;
  });
  if (!is_level) return;
  tag("painted_shadow");
  const Part part = prism({outline, 0.001, {0, 0, lift}, plain({0.02, 0.02, 0.03}, darkness)});
  fix({{part}, at_m, heading, false});
}

double gap_m(const TurnedBox& a, const TurnedBox& b) {
  if (a.foot_m >= b.head_m || b.foot_m >= a.head_m) return std::numeric_limits<double>::infinity();
  const Vector2d between = b.centre_m - a.centre_m;
  double gap = -std::numeric_limits<double>::infinity();
  const auto try_axis = [&](const Vector2d& axis) {
    gap = std::max(gap, std::abs(between.dot(axis)) - reach(a, axis) - reach(b, axis));
  };
  for (const TurnedBox* box : {&a, &b}) {
    const Vector2d ahead = towards(box->heading_rad);
    try_axis(ahead);
    try_axis({-ahead.y(), ahead.x()});
  }
  return gap;
}

bool is_between(const TurnedBox& box, const Vector3d& from_m, const Vector3d& to_m) {
  const auto in_box = [&](const Vector3d& p) {
    const Vector2d flat = turned(p.head<2>() - box.centre_m, -box.heading_rad);
    return Vector3d(flat.x(), flat.y(), p.z());
  };
  const Vector3d from = in_box(from_m), way = in_box(to_m) - from;
  const Vector3d low(-box.half_m.x(), -box.half_m.y(), box.foot_m);
  const Vector3d high(box.half_m.x(), box.half_m.y(), box.head_m);
  double first = 0, last = 1;
  for (int i = 0; i < 3; ++i) {
    if (way[i] == 0) {
      if (from[i] < low[i] || from[i] > high[i]) return false;
      continue;
    }
    const double a = (low[i] - from[i]) / way[i], b = (high[i] - from[i]) / way[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first < last;
}

Vector3d point_of(const TurnedBox& box, double ahead, double left, double up) {
  const Vector2d flat =
      box.centre_m + turned({ahead * box.half_m.x(), left * box.half_m.y()}, box.heading_rad);
  return {flat.x(), flat.y(), (box.foot_m + box.head_m) / 2 + up * (box.head_m - box.foot_m) / 2};
}

std::array<Vector2d, 4> corners_of(const TurnedBox& box) {
  std::array<Vector2d, 4> corners;
  auto corner = corners.begin();
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) *corner++ = point_of(box, x, y, 0).head<2>();
  }
  return corners;
}

bool is_within(const TurnedBox& box, const Vector2d& low_m, const Vector2d& high_m) {
  return std::ranges::all_of(corners_of(box), [&](const Vector2d& corner) {
    return (corner.array() >= low_m.array()).all() && (corner.array() <= high_m.array()).all();
  });
}

double least_gap_m(const TurnedBox& box, const std::vector<TurnedBox>& others) {
  double least = std::numeric_limits<double>::infinity();
  for (const TurnedBox& other : others) least = std::min(least, gap_m(box, other));
  return least;
}

}  // namespace lcs::worlds
