// The texts of a world: an MJCF scene and a YAML scenario.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "scenarios/keys.h"
#include "scenes/worlds/worlds.h"

namespace lcs::worlds {
namespace {

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
