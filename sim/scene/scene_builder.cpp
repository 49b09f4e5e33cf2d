#include "sim/scene/scene_builder.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include "sim/scene/fragment.h"
#include "sim/scene/ground.h"
#include "sim/scene/limits.h"
#include "sim/scene/mjcf.h"
#include "sim/scene/texture.h"
#include "tools/input/spelling.h"

namespace lcs::sim {
namespace {

using scenario::Actor;
using scenario::Scenario;

std::vector<std::string> body_names(xml::Element& worldbody) {
  std::vector<std::string> names;
  for (auto* e = worldbody.FirstChildElement("body"); e; e = e->NextSiblingElement("body")) {
    if (const std::string name = xml::attribute(*e, "name"); !name.empty()) names.push_back(name);
  }
  return names;
}

[[noreturn]] void fail_no_body(const Actor& actor, std::vector<std::string> names) {
  constexpr std::size_t kMentioned = 3;
  names = input::nearest_first(*actor.body, std::move(names));
  names.resize(std::min(names.size(), kMentioned));
  throw input::Error(
      actor.source,
      names.empty()
          ? fmt::format("actor '{}' moves body '{}', but the scene has no named body below its "
                        "worldbody; give the actor a shape instead",
                        actor.name, *actor.body)
          : fmt::format("actor '{}' moves body '{}', which the scene lacks; the nearest are {}",
                        actor.name, *actor.body, fmt::join(names, ", ")));
}

/// Makes a body of the scene kinematic: the simulation sets its pose.
void make_mocap(xml::Element& worldbody, const Actor& actor) {
  xml::Element* body = xml::child_named(worldbody, "body", *actor.body);
  if (!actor.texture.empty() || actor.size_m) {
    throw input::Error(actor.source,
                       fmt::format("actor '{}' moves a body of the scene, which has its size and "
                                   "texture already; remove these keys",
                                   actor.name));
  }
  for (const char* kind : {"joint", "freejoint"}) {
    while (xml::Element* joint = body->FirstChildElement(kind)) body->DeleteChild(joint);
  }
  body->SetAttribute("mocap", "true");
}

/// Adds the sections of a fragment that a scene needs. Its custom size, options and visual settings
/// are for a viewer only.
void merge_fragment(xml::Element& scene, const xml::Element& fragment) {
  constexpr std::array<const char*, 5> kParts = {"default", "asset", "worldbody", "actuator",
                                                 "sensor"};
  for (const char* kind : kParts) {
    for (const auto* part = fragment.FirstChildElement(kind); part;
         part = part->NextSiblingElement(kind)) {
      xml::append_children(xml::section(scene, kind), *part);
    }
  }
}

/// \throws input::Error if the trajectory of an added actor lacks its position.
void check_placed(const Actor& actor) {
  const auto* line = std::get_if<scenario::Line>(&actor.trajectory);
  const auto* still = std::get_if<scenario::Still>(&actor.trajectory);
  if ((line && !line->from_m) || (still && !still->position_m)) {
    throw input::Error(actor.source,
                       fmt::format("actor '{}' is added to the scene: say where ({})", actor.name,
                                   line ? "line: from" : "still: position"));
  }
}

xml::Element& base_of(tinyxml2::XMLDocument& fragment, const std::string& prefix) {
  xml::Element& worldbody = xml::section(*fragment.RootElement(), "worldbody");
  return *xml::child_named(worldbody, "body", prefix + "base");
}

void add_actor(xml::Element& scene, const Actor& actor, ComposedScene& composed) {
  check_placed(actor);
  const xml::Document fragment = actor_fragment(actor, scene);
  const std::string prefix = actor.name + "/";
  composed.actor_sizes_m.emplace_back(
      actor.size_m.value_or(natural_size(*fragment->RootElement(), prefix)));
  xml::Element& body = base_of(*fragment, prefix);
  // the object's name is the actor's name
  body.SetAttribute("name", actor.name.c_str());
  body.SetAttribute("mocap", "true");
  merge_fragment(scene, *fragment->RootElement());
  if (has_picture(actor)) {
    composed.pictures.push_back({prefix + kPictureTexture, actor.texture, actor.source});
  }
}

void add_actors(xml::Element& scene, const Scenario& scenario, ComposedScene& composed) {
  xml::Element& worldbody = xml::section(scene, "worldbody");
  const std::vector<std::string> bodies = body_names(worldbody);
  std::set<std::string> taken;
  for (const Actor& actor : scenario.actors) {
    const std::string object = actor.body.value_or(actor.name);
    const bool is_body = std::find(bodies.begin(), bodies.end(), actor.name) != bodies.end();
    const bool is_there = std::find(bodies.begin(), bodies.end(), object) != bodies.end();
    if (actor.body && !is_there) fail_no_body(actor, bodies);
    if (is_body && object != actor.name) {
      throw input::Error(actor.source, fmt::format("actor '{}' is called like another body of the "
                                                   "scene; choose another name",
                                                   actor.name));
    }
    if (is_body && !actor.body) {
      throw input::Error(actor.source,
                         fmt::format("actor '{}' is called like a body of the scene; choose "
                                     "another name, or move that body (body: {})",
                                     actor.name, actor.name));
    }
    if (!taken.insert(object).second) {
      throw input::Error(actor.source,
                         fmt::format("'{}' is moved by two actors; keep one of them", object));
    }
    if (actor.body) {
      make_mocap(worldbody, actor);
      composed.actor_sizes_m.emplace_back();
    } else {
      add_actor(scene, actor, composed);
    }
    composed.actor_bodies.push_back(object);
  }
}

/// Axes of a MuJoCo camera (x right, y up, looking along -z) in B, from roll, pitch and yaw.
Eigen::Matrix3d mujoco_camera_axes(const Eigen::Vector3d& rpy) {
  Eigen::Matrix3d forward;
  forward.col(0) = -Eigen::Vector3d::UnitY();
  forward.col(1) = Eigen::Vector3d::UnitZ();
  forward.col(2) = -Eigen::Vector3d::UnitX();
  return (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
             .toRotationMatrix() *
         forward;
}

void add_camera(xml::Element& base, const scenario::Camera& camera) {
  const Eigen::Matrix3d R = mujoco_camera_axes(camera.mount_rpy_rad);
  const Eigen::Vector3d& p = camera.mount_position_m;
  xml::Element* e = base.InsertNewChildElement("camera");
  e->SetAttribute("name", kCamera);
  mjcf::set_numbers(*e, "pos", {p.x(), p.y(), p.z()});
  mjcf::set_numbers(*e, "xyaxes", {R(0, 0), R(1, 0), R(2, 0), R(0, 1), R(1, 1), R(2, 1)});
  mjcf::set_numbers(*e, "fovy", {camera.fovy_rad * 180 / std::numbers::pi});
}

void add_ego(xml::Element& scene, const Scenario& scenario) {
  const xml::Document fragment = rover_fragment(scenario.ego, scene);
  add_camera(base_of(*fragment, kEgoPrefix), scenario.camera);
  merge_fragment(scene, *fragment->RootElement());
}

/// Rejects procedural textures whose style is unknown, before loading.
void check_styles(xml::Element& scene) {
  for (auto* assets = scene.FirstChildElement("asset"); assets;
       assets = assets->NextSiblingElement("asset")) {
    for (auto* e = assets->FirstChildElement("texture"); e; e = e->NextSiblingElement("texture")) {
      const std::filesystem::path file = xml::attribute(*e, "file");
      const char* name = e->Attribute("name");
      const std::string called = name ? name : file.stem().string();
      const std::string style(procedural_style(called));
      if (style.empty() || is_texture_style(style)) continue;
      throw input::Error(xml::source_of(*e),
                         fmt::format("no texture style is called '{}'; there are {}", style,
                                     fmt::join(texture_styles(), ", ")));
    }
  }
}

/// Removes compiler settings that change bodies and names, the rover's mass, or the search path of
/// files. Also removes keyframes, whose states lack the rover's joints.
void set_compiler(xml::Element& scene) {
  for (auto* c = scene.FirstChildElement("compiler"); c; c = c->NextSiblingElement("compiler")) {
    for (const char* key : {"fusestatic", "discardvisual", "inertiafromgeom", "settotalmass",
                            "boundmass", "boundinertia", "strippath"}) {
      c->DeleteAttribute(key);
    }
  }
  while (xml::Element* keys = scene.FirstChildElement("keyframe")) scene.DeleteChild(keys);
}

}  // namespace

ComposedScene compose(const Scenario& scenario) {
  ComposedScene composed;
  const xml::Document document = xml::load(scenario.scene, scenario.scene_source);
  xml::Element& scene = *document->RootElement();
  set_compiler(scene);
  add_actors(scene, scenario, composed);
  if (scenario.ground) {
    add_ground(scene, *scenario.ground, scenario.ego.start_m, {scenario.file.string(), 0});
  }
  add_ego(scene, scenario);
  check_limits(scene);
  check_styles(scene);
  composed.mjcf = xml::Printed(*document);
  return composed;
}

}  // namespace lcs::sim
