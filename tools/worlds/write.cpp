// A world as files: a scene in MJCF with its textures and meshes, and a scenario in YAML.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <filesystem>

#include "tools/files/output_file.h"
#include "tools/sequence/png.h"
#include "tools/worlds/meshes.h"
#include "tools/worlds/sheet.h"
#include "tools/worlds/worlds.h"

namespace lcs::worlds {
namespace {

using Eigen::Vector3d;

/// With decimals enough for a tenth of a millimetre, and none to spare.
std::string number(double value) {
  std::string text = fmt::format("{:.4f}", value);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

template <class... Numbers>
std::string numbers(Numbers... values) {
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

std::string geom_text(const Part& part) {
  // In the order of Part::Shape.
  constexpr std::array<const char*, 6> kShapes{"box",       "cylinder", "capsule",
                                               "ellipsoid", "plane",    "mesh"};
  const bool is_round = part.shape == Part::Shape::cylinder || part.shape == Part::Shape::capsule;
  const std::string size =
      is_round ? numbers(part.size_m.x(), part.size_m.y()) : numbers(part.size_m);
  const std::string shape =
      fmt::format("type=\"{}\" {}", kShapes[static_cast<std::size_t>(part.shape)],
                  part.shape == Part::Shape::mesh ? fmt::format("mesh=\"mesh_{}\"", part.mesh)
                                                  : fmt::format("size=\"{}\"", size));
  const std::string place =
      part.position_m.isZero() ? "" : fmt::format(" pos=\"{}\"", numbers(part.position_m));
  return fmt::format("<geom {}{}{}{} material=\"material_{}\"/>\n",
                     part.is_solid ? "class=\"solid\" " : "", shape, place,
                     rotation_text(part.rotation), part.material);
}

std::string scene_text(const World& world) {
  std::string text = fmt::format("<mujoco model=\"{}\">\n", name_of(world));
  text += fmt::format("  <custom>\n    <text name=\"{}\" data=\"{} {}\"/>\n  </custom>\n",
                      scenario::kOriginText, world.family, world.seed);
  text += "  <compiler meshdir=\"meshes\" texturedir=\"textures\"/>\n";
  text += fmt::format("  <statistic extent=\"{}\" center=\"0 0 1\"/>\n", number(world.extent_m));
  // round primitives with as many faces as the meshes have: the renderer's time goes with them
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
    text += fmt::format("    <material name=\"material_{}\" rgba=\"{} {}\"", i, numbers(m.rgb),
                        number(m.alpha));
    if (m.emission > 0) text += fmt::format(" emission=\"{}\"", number(m.emission));
    if (m.texture >= 0) {
      text +=
          fmt::format(" texture=\"{}\"", world.textures[static_cast<std::size_t>(m.texture)].name);
      if (!m.cube) {
        text += fmt::format(" texrepeat=\"{0} {0}\" texuniform=\"true\"", number(1 / m.side_m));
      }
    }
    text += "/>\n";
  }
  for (std::size_t i = 0; i < world.meshes.size(); ++i) {
    text += fmt::format("    <mesh name=\"mesh_{0}\" file=\"mesh_{0}.obj\"/>\n", i);
  }
  text += "  </asset>\n  <worldbody>\n";
  for (const char* direction : {".5 .3 -1", ".3 -.6 -.5"}) {
    const bool first = direction[0] == '.' && direction[1] == '5';
    text += fmt::format(
        "    <light directional=\"true\" dir=\"{0}\" diffuse=\"{1} {1} {1}\" ambient=\"0 0 0\" "
        "specular=\"0 0 0\" castshadow=\"false\"/>\n",
        direction, number(world.diffuse * (first ? 1 : 0.5)));
  }
  for (const Part& part : world.setting) text += "    " + geom_text(part);
  for (const Body& body : world.bodies) {
    text += fmt::format("    <body name=\"{}\" pos=\"{}\"{}>\n", body.name,
                        numbers(body.position_m), rotation_text(body.rotation));
    for (const Part& part : body.parts) text += "      " + geom_text(part);
    text += "    </body>\n";
  }
  return text + "  </worldbody>\n</mujoco>\n";
}

std::string angle(double rad) {
  return number(rad / kDegree) + " deg";
}
std::string place(const Eigen::Vector2d& at_m) {
  return fmt::format("[{} m, {} m]", number(at_m.x()), number(at_m.y()));
}

std::string trajectory_text(const scenario::Trajectory& trajectory) {
  if (const auto* circle = std::get_if<scenario::Circular>(&trajectory)) {
    return fmt::format(
        "      circle: {{centre: {}, radius: {} m, start_angle: {} rad, speed: {} m/s}}\n",
        place(circle->centre_m), number(circle->radius_m), number(circle->start_angle_rad),
        number(circle->speed_mps));
  }
  std::string text = "      waypoints:\n";
  for (const scenario::Waypoint& point : std::get<scenario::Waypoints>(trajectory).points) {
    text += fmt::format("        - [{} s, {} m, {} m]\n", number(point.at_s),
                        number(point.position_m.x()), number(point.position_m.y()));
  }
  return text;
}

std::string motion_text(const scenario::EgoPhase& phase, std::string_view indent) {
  std::string text = fmt::format("{}speed: {} m/s\n", indent, number(phase.speed_mps));
  const auto add = [&](const char* key, double value, const std::string& written) {
    if (value != 0) text += fmt::format("{}{}: {}\n", indent, key, written);
  };
  add("acceleration", phase.acceleration_mps2, number(phase.acceleration_mps2) + " m/s^2");
  add("direction", phase.direction_rad, angle(phase.direction_rad));
  add("yaw_rate", phase.yaw_rate_radps, number(phase.yaw_rate_radps / kDegree) + " deg/s");
  return text;
}

std::string scenario_text(const World& world) {
  const scenario::Scenario& s = world.scenario;
  std::string text = fmt::format(
      "# Written by `lcs world {0} --seed {1}`.\norigin:\n  family: {0}\n  seed: {1}\n  again: "
      "{2}\n"
      "  features: [{3}]\n",
      world.family, world.seed, world.attempt, fmt::join(world.features, ", "));
  text += fmt::format("purpose: {}\ngroups: [{}]\nscene: scene.xml\nseed: {}\nframes: {}\n",
                      s.purpose, fmt::join(s.groups, ", "), s.seed, s.frames);
  text += "ego:\n";
  if (s.ego.drive == scenario::Drive::wheeled) text += "  drive: wheeled\n";
  text +=
      fmt::format("  start: {}\n  heading: {}\n", place(s.ego.start_m), angle(s.ego.heading_rad));
  text += motion_text(s.ego.phases.front(), "  ");
  if (s.ego.phases.size() > 1) text += "  phases:\n";
  for (std::size_t i = 1; i < s.ego.phases.size(); ++i) {
    const scenario::EgoPhase& phase = s.ego.phases[i];
    // each key is said, as what is not said goes on as it was
    text += fmt::format(
        "    - {{at: {} s, speed: {} m/s, acceleration: {} m/s^2, direction: {}, yaw_rate: {} "
        "deg/s}}\n",
        number(phase.at_s), number(phase.speed_mps), number(phase.acceleration_mps2),
        angle(phase.direction_rad), number(phase.yaw_rate_radps / kDegree));
  }
  const scenario::Camera& c = s.camera;
  text += fmt::format(
      "camera:\n  size: [{}, {}]\n  fovy: {}\n  rate: {} Hz\n  position: [{} m, 0 m, {} m]\n"
      "  rotation: [0 deg, {}, 0 deg]\n",
      c.width_px, c.height_px, angle(c.fovy_rad), number(c.rate_hz), number(c.mount_position_m.x()),
      number(c.mount_position_m.z()), angle(c.mount_rpy_rad.y()));
  if (c.told.height_error_m != 0 || c.told.pitch_error_rad != 0) {
    text += fmt::format("  told: {{height_error: {} m, pitch_error: {}}}\n",
                        number(c.told.height_error_m), angle(c.told.pitch_error_rad));
  }
  const scenario::Image& image = s.image;
  text += "image:\n";
  if (image.blur_px > 0) text += fmt::format("  blur: {}\n", number(image.blur_px));
  text += fmt::format("  exposure: {} ms\n  gain: {}\n  noise: {{full_well: {}, read: {}}}\n",
                      number(1e3 * image.exposure_s), number(image.gain),
                      number(image.noise->full_well_e), number(image.noise->read_e));
  if (image.jpeg_quality) text += fmt::format("  jpeg: {}\n", *image.jpeg_quality);
  text += fmt::format("imu: {{preset: {}}}\n", s.imu.preset);
  if (s.odometry.enabled) text += "odometry: {}\n";
  if (s.ground) {
    text += fmt::format(
        "ground: {{roughness: {} m, wavelength: {} m, centre: {}, size: [{} m, {} m]}}\n",
        number(s.ground->roughness_m), number(s.ground->wavelength_m), place(*s.ground->centre_m),
        number(s.ground->size_m.x()), number(s.ground->size_m.y()));
  }
  if (!s.actors.empty()) text += "actors:\n";
  for (const scenario::Actor& actor : s.actors) {
    text += fmt::format("  {}:\n    body: {}\n", actor.name, *actor.body);
    if (actor.start.at_s > 0)
      text += fmt::format("    start: {{time: {} s}}\n", number(actor.start.at_s));
    text += "    trajectory:\n" + trajectory_text(actor.trajectory);
  }
  return text;
}

}  // namespace

bench::ResultNames world_files() {
  return {"scene.xml", "*.yaml", "textures/*.png", "meshes/*.obj", kPlanFile, kSheetFile};
}

void write_world(const World& world, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "textures");
  std::filesystem::create_directories(folder / "meshes");
  for (const Texture& texture : world.textures) {
    bench::write_file(folder / "textures" / (texture.name + ".png"),
                      sequence::encode_png(texture.picture, sequence::PngFilter::up));
  }
  for (std::size_t i = 0; i < world.meshes.size(); ++i) {
    bench::write_file(folder / "meshes" / fmt::format("mesh_{}.obj", i), obj_text(world.meshes[i]));
  }
  bench::write_file(folder / kPlanFile, sequence::encode_png(plan(world), sequence::PngFilter::up));
  bench::write_file(folder / "scene.xml", scene_text(world));
  bench::write_file(folder / (name_of(world) + ".yaml"), scenario_text(world));
}

}  // namespace lcs::worlds
