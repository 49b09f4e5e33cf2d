#include "scenes/worlds/worlds.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <ranges>
#include <stdexcept>

#include "scenarios/keys.h"
#include "scenes/worlds/families.h"

namespace lcs::worlds {
namespace {

constexpr int kMostAttempts = 200;
constexpr int kStillSeen = 12;  // least frames of a visible mover after furnishing
constexpr double kNear_m = 0.8;

struct Family {
  const char* name;
  FloorPlan (*lay_out)(Kit&);
  std::uint64_t static_one_in = 4;
  const char* noun = name;
};
constexpr Family kFamilies[] = {{"room", lay_out_room},
                                {"corridor", lay_out_corridor},
                                {"warehouse", lay_out_warehouse},
                                {"street", lay_out_street},
                                {"yard", lay_out_yard},
                                {"garage", lay_out_garage},
                                {"plain", lay_out_plain, 3, "plain room"}};

const Family& family_of(const std::string& name) {
  for (const Family& family : kFamilies) {
    if (family.name == name) return family;
  }
  throw std::invalid_argument(fmt::format("there is no family of worlds '{}'; there are {}", name,
                                          fmt::join(families(), ", ")));
}

/// Marks the paths of rover and movers as kept free, at every quarter of a frame.
void keep_ways_free(Kit& kit, const RoverPath& way, const std::vector<PlannedMover>& movers) {
  const scenario::Camera& camera = kit.world.scenario.camera;
  constexpr double kRoom_m = 0.1, kLeastStep_m = 0.05;
  const auto keep = [&](TurnedBox box) {
    box.half_m += Vector2d(kRoom_m, kRoom_m);
    kit.kept_free.push_back(box);
  };
  for (const Stand& stand : way.frames) keep(way.box_of(camera, stand));
  for (const PlannedMover& mover : movers) {
    Vector2d last(1e9, 0);
    for (std::size_t k = 0; k + 1 < way.frames.size(); ++k) {
      for (const double share : {0.0, 0.25, 0.5, 0.75}) {
        const double t = way.frames[k].t_s + share * (way.frames[k + 1].t_s - way.frames[k].t_s);
        const TurnedBox box = mover.box_at(kit, t);
        if ((box.centre_m - last).norm() < kLeastStep_m) continue;
        last = box.centre_m;
        keep(box);
      }
    }
  }
}

/// Places a small thing close to the camera's path or beside it, if there is room.
void put_near(Kit& kit, const RoverPath& way) {
  const scenario::Camera& camera = kit.world.scenario.camera;
  for (int i = 0; i < 40; ++i) {
    const Thing thing = make_thing(
        kit, kit.draw.pick({"carton", "ball", "bollard", "bin", "drum", "pole", "chair"}));
    const Stand& stand = kit.draw.pick(way.frames);
    const double bearing = stand.heading_rad + kit.draw.between(-0.7, 0.7);
    const Vector2d eye = camera_at(camera, stand, 0).head<2>();
    const double away = kit.draw.between(0.35, 0.65) + kit.bounds(thing.parts).half_m.x();
    const double heading = kit.draw.between(0, 3);
    if (kit.try_stand({thing, eye + away * towards(bearing), heading, 0.01})) return;
  }
}

/// Whether a static thing is visible within `kNear_m` of the camera.
bool shows_near(const Kit& kit, const RoverPath& way) {
  const scenario::Camera& camera = kit.world.scenario.camera;
  for (const Stand& stand : way.frames) {
    const double level = kit.ground(stand.at_m);
    const Vector3d eye = camera_at(camera, stand, level);
    for (const TurnedBox& box : kit.solids) {
      if ((box.centre_m - eye.head<2>()).norm() > kNear_m + box.half_m.norm()) continue;
      for (const double x : {-0.9, 0.0, 0.9}) {
        for (const double y : {-0.9, 0.0, 0.9}) {
          for (const double z : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
            const Vector3d point = point_of(box, x, y, z);
            const Vector3d seen = seen_at(camera, stand, level, point);
            if ((point - eye).norm() < kNear_m && seen.z() > 0.05 && seen.x() >= 0 &&
                seen.y() >= 0 && seen.x() < camera.width_px && seen.y() < camera.height_px) {
              return true;
            }
          }
        }
      }
    }
  }
  return false;
}

bool is_way_free(const Kit& kit, const RoverPath& way) {
  return std::ranges::all_of(way.frames, [&](const Stand& stand) {
    return least_gap_m(way.box_of(kit.world.scenario.camera, stand), kit.solids) > 0.05;
  });
}

/// Tries to build a world. \return whether it succeeded.
bool attempt(Kit& kit, const Family& family, bool with_movers) {
  const FloorPlan layout = family.lay_out(kit);
  const RoverPath way = draw_rover(kit, layout.lane);
  if (!is_way_free(kit, way)) return false;
  std::vector<PlannedMover> movers;
  if (with_movers) {
    movers = draw_movers(kit, way, layout.traffic, kit.draw.whole(1, layout.traffic.most));
    if (movers.empty()) return false;
  }
  keep_ways_free(kit, way, movers);
  if (kit.draw.chance(0.4)) put_near(kit, way);
  layout.furnish();
  if (!with_movers || kit.draw.chance(0.5)) {  // things that move in other worlds are static here
    scatter(kit, layout.traffic.kinds, kit.draw.whole(1, 3), layout.traffic.low_m,
            layout.traffic.high_m);
  }
  for (std::size_t i = 0; i < movers.size(); ++i) {
    if (frames_seen(kit, way, movers, i) < kStillSeen) return false;
  }
  add_movers(kit, way, movers);
  if (shows_near(kit, way)) kit.tag("near");
  return true;
}

void name_scenario(DrawnWorld& world, const Choice& choice) {
  scenario::Scenario& s = world.scenario;
  s.name = name_of(world);
  s.purpose = fmt::format("a {} drawn from seed {}{}", family_of(world.family).noun, world.seed,
                          s.actors.empty() ? ", where nothing moves" : "");
  s.groups = {"world", choice.family};
  if (s.actors.empty()) s.groups.emplace_back("static");
}

// The texts of a world: an MJCF scene and a YAML scenario.

/// Formats with the decimals for a tenth of a millimetre, without trailing zeros.
std::string number(double value) {
  std::string text = fmt::format("{:.4f}", value);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string numbers(auto... values) {
  const std::array<std::string, sizeof...(values)> texts{number(values)...};
  return fmt::format("{}", fmt::join(texts, " "));
}

std::string numbers(const Vector3d& v) {
  return numbers(v.x(), v.y(), v.z());
}

std::string rotation_text(const Eigen::Quaterniond& q) {
  if (std::abs(q.w()) > 1 - 1e-12) return "";
  return fmt::format(" quat=\"{:.6f} {:.6f} {:.6f} {:.6f}\"", q.w(), q.x(), q.y(), q.z());
}

std::string geom_text(const DrawnWorld& world, const Part& part) {
  using enum Part::Shape;
  constexpr std::array kTypes{"box", "cylinder", "capsule", "ellipsoid", "plane", "mesh"};
  const bool is_round = part.shape == cylinder || part.shape == capsule;
  const std::string size =
      is_round ? numbers(part.size_m.x(), part.size_m.y()) : numbers(part.size_m);
  const std::string form = part.shape == mesh ? fmt::format("mesh=\"mesh_{}\"", part.mesh)
                                              : fmt::format("size=\"{}\"", size);
  const std::string place =
      part.position_m.isZero() ? "" : fmt::format(" pos=\"{}\"", numbers(part.position_m));
  const Material& material = world.materials[static_cast<std::size_t>(part.material)];
  const bool is_tiled = part.shape != mesh && material.texture >= 0 && !material.cube;
  return fmt::format("<geom {}type=\"{}\" {}{}{} material=\"{}_{}\"/>\n",
                     part.is_solid ? "class=\"solid\" " : "",
                     kTypes[static_cast<std::size_t>(part.shape)], form, place,
                     rotation_text(part.rotation), is_tiled ? "tiled" : "material", part.material);
}

}  // namespace

const std::vector<std::string>& families() {
  constexpr auto kNames = kFamilies | std::views::transform(&Family::name);
  static const std::vector<std::string> names(kNames.begin(), kNames.end());
  return names;
}

const std::vector<Split>& splits() {
  static const std::vector<Split> all{
      {"train", 1, 999'999, "to learn from: parameters are chosen here"},
      {"validate", 1'000'000, 1'999'999, "to see whether what was learnt holds elsewhere"},
      {"test", 2'000'000, 2'999'999, "to state figures: nothing is chosen by it"}};
  return all;
}

const Split& split(std::string_view name) {
  for (const Split& s : splits()) {
    if (s.name == name) return s;
  }
  throw std::invalid_argument(
      fmt::format("there is no split '{}'; give train, validate or test", name));
}

std::vector<Choice> choose(std::string_view split_name, int count, const std::string& family) {
  const Split& from = split(split_name);
  std::vector<std::string> names = families();
  if (!family.empty()) names = {family_of(family).name};
  std::vector<Choice> choices;
  for (int i = 0; i < count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    choices.push_back({names[n % names.size()], from.first_seed + n / names.size()});
  }
  return choices;
}

bool is_static(const Choice& choice) {
  const Family& family = family_of(choice.family);
  const auto place = static_cast<std::uint64_t>(&family - kFamilies);
  return (choice.seed + place) % family.static_one_in == family.static_one_in - 1;
}

DrawnWorld draw_world(const Choice& choice, const std::vector<std::string>& pictures) {
  const Family& family = family_of(choice.family);
  for (int n = 0; n < kMostAttempts; ++n) {
    Kit kit(choice.family, choice.seed, n, pictures);
    if (!attempt(kit, family, !is_static(choice))) continue;
    name_scenario(kit.world, choice);
    return std::move(kit.world);
  }
  throw std::runtime_error(fmt::format("no {} could be drawn from seed {}; take another seed",
                                       family.noun, choice.seed));
}

std::string name_of(const DrawnWorld& world) {
  return fmt::format("{}_{}", world.family, world.seed);
}

std::optional<scenario::Origin> origin_named(std::string_view name) {
  const std::size_t line = name.find('_');
  scenario::Origin origin;
  origin.family = name.substr(0, line);
  if (line == name.npos || std::ranges::find(families(), origin.family) == families().end()) {
    return std::nullopt;
  }
  name.remove_prefix(line + 1);
  const auto error = std::from_chars(name.data(), name.data() + name.size(), origin.seed).ec;
  return error == std::errc() ? std::optional(origin) : std::nullopt;
}

std::string scene_text(const DrawnWorld& world) {
  std::string text = fmt::format("<mujoco model=\"{}\">\n", name_of(world));
  text += fmt::format("  <custom>\n    <text name=\"{}\" data=\"{} {}\"/>\n  </custom>\n",
                      scenario::kOriginText, world.family, world.seed);
  text += "  <compiler meshdir=\"meshes\" texturedir=\"textures\"/>\n";
  text += fmt::format("  <statistic extent=\"{}\" center=\"0 0 1\"/>\n", number(world.extent_m));
  // few faces on round primitives, as on the meshes, because they cost rendering time
  text += fmt::format(
      "  <visual>\n    <headlight ambient=\"{0} {0} {0}\" diffuse=\"0 0 0\" specular=\"0 0 0\"/>\n"
      "    <quality numslices=\"16\" numstacks=\"8\"/>\n  </visual>\n",
      number(world.ambient));
  text +=
      "  <default>\n    <geom contype=\"0\" conaffinity=\"0\"/>\n    <material specular=\"0\" "
      "shininess=\"0\" reflectance=\"0\"/>\n    <default class=\"solid\">\n      <geom "
      "contype=\"1\" conaffinity=\"1\"/>\n    </default>\n  </default>\n";
  text += "  <asset>\n";
  if (world.has_sky) {
    const Vector3d haze = (world.sky + Vector3d(1, 1, 1)) / 2;
    text += fmt::format(
        "    <texture name=\"sky\" type=\"skybox\" builtin=\"gradient\" rgb1=\"{}\" rgb2=\"{}\" "
        "width=\"64\" height=\"384\"/>\n",
        numbers(world.sky), numbers(haze));
  }
  for (const Material& material : world.materials) {
    if (material.texture < 0) continue;
    const Texture& texture = world.textures[static_cast<std::size_t>(material.texture)];
    text += fmt::format("    <texture name=\"{0}\" type=\"{1}\" file=\"{0}.png\"/>\n", texture.name,
                        material.cube ? "cube" : "2d");
  }
  for (std::size_t i = 0; i < world.materials.size(); ++i) {
    const Material& m = world.materials[i];
    std::string look = fmt::format(" rgba=\"{} {}\"", numbers(m.rgb), number(m.alpha));
    if (m.emission > 0) look += fmt::format(" emission=\"{}\"", number(m.emission));
    if (m.texture >= 0) {
      look +=
          fmt::format(" texture=\"{}\"", world.textures[static_cast<std::size_t>(m.texture)].name);
    }
    text += fmt::format("    <material name=\"material_{}\"{}/>\n", i, look);
    if (m.texture < 0 || m.cube) continue;
    // primitives repeat a picture by their size, meshes by their own texture coordinates
    text += fmt::format(
        "    <material name=\"tiled_{0}\"{1} texrepeat=\"{2} {2}\" texuniform=\"true\"/>\n", i,
        look, number(1 / m.side_m));
  }
  for (std::size_t i = 0; i < world.meshes.size(); ++i) {
    text += fmt::format("    <mesh name=\"mesh_{0}\" file=\"mesh_{0}.obj\"/>\n", i);
  }
  text += "  </asset>\n  <worldbody>\n";
  for (const auto& [direction, share] :
       {std::pair(".5 .3 -1", 1.0), std::pair(".3 -.6 -.5", 0.5)}) {
    text += fmt::format(
        "    <light directional=\"true\" dir=\"{0}\" diffuse=\"{1} {1} {1}\" ambient=\"0 0 0\" "
        "specular=\"0 0 0\" castshadow=\"false\"/>\n",
        direction, number(world.diffuse * share));
  }
  for (const Part& part : world.setting) text += "    " + geom_text(world, part);
  for (const Body& body : world.bodies) {
    text += fmt::format("    <body name=\"{}\" pos=\"{}\"{}>\n", body.name,
                        numbers(body.position_m), rotation_text(body.rotation));
    for (const Part& part : body.parts) text += "      " + geom_text(world, part);
    text += "    </body>\n";
  }
  return text + "  </worldbody>\n</mujoco>\n";
}

std::string scenario_text(const DrawnWorld& world) {
  scenario::Scenario s = world.scenario;
  s.scene = "scene.xml";
  scenario::Origin& origin = s.origin.emplace();
  origin.family = world.family;
  origin.seed = world.seed;
  origin.again = static_cast<std::uint64_t>(world.attempt);
  origin.features = {world.features.begin(), world.features.end()};
  return fmt::format("# Written by `lcs world {} --seed {}`.\n{}\n", world.family, world.seed,
                     input::yaml_text(scenario::document_of(s)));
}

}  // namespace lcs::worlds
