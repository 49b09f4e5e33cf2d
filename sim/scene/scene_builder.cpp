#include "sim/scene/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <utility>

#include "scenarios/input/spelling.h"
#include "sim/base/rotation.h"
#include "sim/scene/fragment.h"
#include "sim/scene/ground.h"
#include "sim/scene/model.h"
#include "sim/scene/texture.h"

namespace lcs::sim {
namespace {

using scenario::Actor;
using scenario::Scenario;

mjsBody& world_of(const mjSpec& spec) {
  return *mjs_findBody(&spec, "world");
}

std::vector<std::string> body_names(const mjSpec& scene) {
  std::vector<std::string> names;
  for_each_in(world_of(scene), mjOBJ_BODY, false, [&](mjsElement* e) {
    if (!name_of(e).empty()) names.emplace_back(name_of(e));
  });
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

/// Makes a body of the scene kinematic: the simulation sets its pose. What refers to its joints
/// goes with them. A body stays if its actor moves joints in it.
void make_mocap(mjSpec& scene, const Actor& actor) {
  if (!actor.texture.empty() || actor.size_m || !actor.pose.empty()) {
    throw input::Error(actor.source,
                       "actor '{}' moves a body of the scene, which has its size, pose and texture "
                       "already; remove these keys",
                       actor.name);
  }
  if (!actor.joints.empty()) return;
  mjsBody& body = *mjs_findBody(&scene, actor.body->c_str());
  for_each_in(body, mjOBJ_JOINT, false, [&](mjsElement* e) { remove(scene, e); });
  body.mocap = 1;
}

/// Adds a fragment to the scene. \return its body `base`.
mjsBody& attach(mjSpec& scene, const Fragment& fragment, const std::string& prefix) {
  mjsFrame* const frame = mjs_addFrame(&world_of(scene), nullptr);
  mjsElement* const added = call_mujoco(
      [&] { return mjs_attach(frame->element, fragment.base->element, prefix.c_str(), ""); });
  if (!added) throw MujocoError(mjs_getError(&scene));
  return *mjs_asBody(added);
}

/// \throws input::Error if the trajectory of an added actor lacks its position.
void check_placed(const Actor& actor) {
  const auto* line = std::get_if<scenario::Line>(&actor.trajectory);
  const auto* still = std::get_if<scenario::Still>(&actor.trajectory);
  if ((line && !line->from_m) || (still && !still->position_m)) {
    throw input::Error(actor.source, "actor '{}' is added to the scene: say where ({})", actor.name,
                       line ? "line: from" : "still: position");
  }
}

void add_actor(mjSpec& scene, const Actor& actor, ComposedScene& composed) {
  check_placed(actor);
  const Fragment fragment = actor_fragment(actor, composed.reader);
  const std::string prefix = actor.name + "/";
  composed.actor_sizes_m.emplace_back(fragment.size_m);
  if (fragment.is_frozen) {
    composed.frozen.push_back(
        fmt::format("actor '{}' keeps the pose '{}'", actor.name, actor.pose));
  }
  mjsBody& body = attach(scene, fragment, prefix);
  mjs_setName(body.element, actor.name.c_str());  // the object's name
  body.mocap = 1;
  if (!actor.texture.empty() && !is_texture_style(actor.texture)) {
    composed.pictures.push_back({prefix + kPictureTexture, actor.texture, actor.source});
  }
}

void add_actors(mjSpec& scene, const Scenario& scenario, ComposedScene& composed) {
  const std::vector<std::string> bodies = body_names(scene);
  std::set<std::string> taken;
  for (const Actor& actor : scenario.actors) {
    const std::string object = actor.body.value_or(actor.name);
    const bool is_body = std::ranges::find(bodies, actor.name) != bodies.end();
    const bool is_there = std::ranges::find(bodies, object) != bodies.end();
    if (actor.body && !is_there) fail_no_body(actor, bodies);
    if (is_body && object != actor.name) {
      throw input::Error(actor.source,
                         "actor '{}' is called like another body of the scene; choose another name",
                         actor.name);
    }
    if (is_body && !actor.body) {
      throw input::Error(actor.source,
                         "actor '{}' is called like a body of the scene; choose another name, or "
                         "move that body (body: {})",
                         actor.name, actor.name);
    }
    if (!taken.insert(object).second) {
      throw input::Error(actor.source, "'{}' is moved by two actors; keep one of them", object);
    }
    if (actor.body) {
      make_mocap(scene, actor);
      composed.actor_sizes_m.emplace_back();
    } else {
      add_actor(scene, actor, composed);
    }
    composed.actor_bodies.push_back(object);
  }
}

/// Whether a joint is the only one of a body and of all in it, and free: a thing that moves by the
/// physics.
bool is_of_loose_thing(const mjsJoint& joint) {
  const mjsBody& body = *mjs_getParent(joint.element);
  int count = 0;
  for_each_in(body, mjOBJ_JOINT, true, [&](mjsElement*) { ++count; });
  return joint.type == mjJNT_FREE && count == 1;
}

/// Takes the scene's keyframes away, whose states lack the rover's joints, after the use of one.
void pose_scene(mjSpec& scene, const Scenario& scenario, ComposedScene& composed) {
  std::set<mjsElement*> led;  // joints in bodies of which an actor moves some
  for (const Actor& actor : scenario.actors) {
    mjsBody* body = actor.joints.empty() ? nullptr : mjs_findBody(&scene, actor.body->c_str());
    if (body) for_each_in(*body, mjOBJ_JOINT, true, [&](mjsElement* e) { led.insert(e); });
  }
  const auto goes = [&](mjsElement* joint) {
    return !is_of_loose_thing(*mjs_asJoint(joint)) && !led.contains(joint);
  };
  if (!scenario.pose.empty() &&
      freeze(scene, scenario.pose, goes, "the scene has", scenario.scene_source)) {
    composed.frozen.push_back(fmt::format("the scene keeps the pose '{}'", scenario.pose));
  }
  for_each(scene, mjOBJ_KEY, [&](mjsElement* e) { mjs_delete(&scene, e); });
}

/// Names the bodies of the worldbody that move and have no name by their place, from 1 on.
void name_bodies(mjSpec& scene, ComposedScene& composed) {
  int place = 0;
  for_each_in(world_of(scene), mjOBJ_BODY, false, [&](mjsElement* e) {
    ++place;
    if (!name_of(e).empty() || !mjs_firstChild(mjs_asBody(e), mjOBJ_JOINT, 1)) return;
    std::string name = fmt::format("body[{}]", place);
    while (find(scene, mjOBJ_BODY, name)) name += "'";
    composed.named.emplace_back(input::Error(composed.reader.source(e),
                                             "a body that moves has no name, and is called '{}'",
                                             name)
                                    .what());
    mjs_setName(e, name.c_str());
  });
}

/// Axes of a MuJoCo camera (x right, y up, looking along -z) in B, from roll, pitch and yaw.
Eigen::Matrix3d mujoco_camera_axes(const Eigen::Vector3d& rpy) {
  Eigen::Matrix3d forward;
  forward << -Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitX();
  return rotation_of_rpy(rpy) * forward;
}

void add_camera(mjsBody& base, const scenario::Camera& camera) {
  const Eigen::Matrix3d R = mujoco_camera_axes(camera.mount_rpy_rad);
  mjsCamera& added = *mjs_addCamera(&base, nullptr);
  mjs_setName(added.element, kCamera);
  Eigen::Map<Eigen::Vector3d>(added.pos) = camera.mount_position_m;
  added.alt.type = mjORIENTATION_XYAXES;
  Eigen::Map<Eigen::Matrix<double, 3, 2>>(added.alt.xyaxes) = R.leftCols<2>();
  added.fovy = camera.fovy_rad * 180 / std::numbers::pi;
}

}  // namespace

ComposedScene compose(const Scenario& scenario) {
  ComposedScene composed;
  composed.spec =
      composed.reader.read(scenario.scene, scenario.scene_source, SpecReader::Part::scene);
  mjSpec& scene = *composed.spec;
  mjs_setDeepCopy(&scene, 1);  // so that a fragment ends with its file
  try {
    pose_scene(scene, scenario, composed);
    name_bodies(scene, composed);
    add_actors(scene, scenario, composed);
    if (scenario.ground) {
      const std::vector<int>& drawn = scenario.camera.groups;
      add_ground(scene, *scenario.ground, scenario.ego.start_m, drawn.empty() ? 0 : drawn.front());
    }
    const Fragment rover = rover_fragment(scenario.ego, composed.reader);
    // a rover that is made for an implicit integrator may be unstable with Euler's
    int& integrator = scene.option.integrator;
    if (integrator == mjINT_EULER) integrator = rover.spec->option.integrator;
    add_camera(attach(scene, rover, kEgoPrefix), scenario.camera);
    if (rover.is_frozen) {
      composed.frozen.push_back(fmt::format("the rover keeps the pose '{}'", scenario.ego.pose));
    }
    composed.loose_joints = rover.loose_joints;
  } catch (const MujocoError& e) {
    throw composed.reader.refusal(e.what(), &scene);
  }
  composed.reader.note_warnings(&scene);
  return composed;
}

}  // namespace lcs::sim
