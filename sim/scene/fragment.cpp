#include "sim/scene/fragment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <utility>

#include "scenarios/scenes.h"
#include "sim/scene/model.h"
#include "sim/scene/texture.h"

namespace lcs::sim {
namespace {

using Eigen::Matrix3d;
using scenario::Shape;
using xml::Element;

/// Scale factor of a radius about an axis. A lying cylinder, for example a wheel, must keep its
/// contact with the ground and scales with the height. An upright cylinder scales with the
/// geometric mean of the two horizontal factors.
double radius_factor(const Vector3d& axis, const Vector3d& factor) {
  return std::abs(axis.z()) < std::sqrt(0.5) ? factor.z() : std::sqrt(factor.x() * factor.y());
}

/// \param R_body rotation of its body in the fragment.
void scale_geom(mjsElement* element, const Matrix3d& R_body, const Vector3d& factor) {
  mjsGeom& geom = *mjs_asGeom(element);
  const auto scaled = [&](const Vector3d& place) -> Vector3d {
    return R_body.transpose() * factor.cwiseProduct(R_body * place);
  };
  if (!std::isnan(geom.fromto[0])) {
    Eigen::Map<Vector3d> from(geom.fromto), to(geom.fromto + 3);
    geom.size[0] *= radius_factor(R_body * (to - from).normalized(), factor);
    from = scaled(from);
    to = scaled(to);
    return;
  }
  Pose pose = pose_in_body(element);
  const Matrix3d R = R_body * pose.R;
  Vector3d local = (factor.asDiagonal() * R).colwise().norm();  // along the geom's axes
  if (geom.type == mjGEOM_CYLINDER || geom.type == mjGEOM_CAPSULE) {
    local.head<2>().setConstant(radius_factor(R.col(2), factor));
  } else if (geom.type == mjGEOM_SPHERE) {
    geom.type = mjGEOM_ELLIPSOID;
    geom.size[1] = geom.size[2] = geom.size[0];
  }
  pose.p = scaled(pose.p);
  const bool is_mesh = geom.type == mjGEOM_MESH;  // of any shape, and scaled along `base`'s axes
  set_pose_in_body(element, pose, is_mesh ? factor : local,
                   is_mesh ? Matrix3d(R_body.transpose()) : pose.R);
}

/// Scales geoms and the positions of bodies along the axes of the fragment.
void scale_in(const mjsBody& body, const Matrix3d& R, const Vector3d& factor) {
  for_each_in(body, mjOBJ_GEOM, false, [&](mjsElement* e) { scale_geom(e, R, factor); });
  for_each_in(body, mjOBJ_BODY, false, [&](mjsElement* e) {
    Pose pose = pose_in_body(e);
    const Matrix3d R_child = R * pose.R;
    pose.p = R.transpose() * factor.cwiseProduct(R * pose.p);
    set_pose_in_body(e, pose);
    scale_in(*mjs_asBody(e), R_child, factor);
  });
}

Element* asset_named(Element& root, const char* kind, const std::string& name) {
  Element* found = nullptr;
  xml::for_each(root, [&](Element& e) {
    if (e.Name() == std::string_view(kind) && xml::attribute(e, "name") == name) found = &e;
  });
  return found;
}

/// Renames the texture of the material `paint` to the name that selects its content. Other
/// materials keep their textures.
void paint(Element& root, const scenario::Actor& actor) {
  if (actor.texture.empty()) return;
  Element* const material = asset_named(root, "material", "paint");
  const std::string old_name = material ? xml::attribute(*material, "texture") : "";
  Element* texture = old_name.empty() ? nullptr : asset_named(root, "texture", old_name);
  if (!texture) {
    throw input::Error(
        xml::source_of(material ? *material : root),
        "actor '{}' has the texture '{}', and its file no material 'paint' with a texture to put "
        "it on; give it <texture name=\"paint\" type=\"cube\" builtin=\"flat\" width=\"256\" "
        "height=\"1536\"/><material name=\"paint\" texture=\"paint\"/>, or the actor no texture",
        actor.name, actor.texture);
  }
  std::string new_name = kPictureTexture;
  if (is_texture_style(actor.texture)) {
    new_name = fmt::format("{}{}:paint", kProceduralPrefix, actor.texture);
  } else if (!std::filesystem::is_regular_file(actor.texture)) {
    throw input::Error(actor.source,
                       "texture '{}' is no picture that exists and no style; styles are {}",
                       actor.texture, fmt::join(texture_styles(), ", "));
  }
  bool is_shared = false;
  xml::for_each(root, [&](const Element& e) {
    is_shared |= &e != material && xml::attribute(e, "texture") == old_name;
  });
  if (is_shared) {
    tinyxml2::XMLNode* copy = texture->DeepClone(root.GetDocument());
    texture = texture->Parent()->InsertEndChild(copy)->ToElement();
  }
  texture->SetAttribute("name", new_name.c_str());
  material->SetAttribute("texture", new_name.c_str());
}

/// Actors and holonomic rovers follow their commands exactly and have no contacts.
void take_contacts_away(const mjSpec& spec) {
  for_each(spec, mjOBJ_GEOM,
           [](mjsElement* e) { mjs_asGeom(e)->contype = mjs_asGeom(e)->conaffinity = 0; });
}

/// A keyframe has the pose of a body with a free joint. Three slides and a ball have the same
/// numbers in it, also in a body inside another, where MuJoCo allows no free joint.
void split_free_joints(Element& root) {
  xml::for_each(root, [&](Element& body) {
    if (body.Name() != std::string_view("body")) return;
    Element* joint = body.FirstChildElement("freejoint");
    Element* const first = body.FirstChildElement("joint");
    if (!joint && first && xml::attribute(*first, "type") == "free") joint = first;
    if (!joint) return;
    for (const char* key : {"pos", "quat", "axisangle", "xyaxes", "zaxis", "euler"}) {
      body.DeleteAttribute(key);
    }
    tinyxml2::XMLNode* last = joint;
    for (const char* axis : {"1 0 0", "0 1 0", "0 0 1", ""}) {
      Element* part = root.GetDocument()->NewElement("joint");
      part->SetAttribute("type", *axis ? "slide" : "ball");
      if (*axis) part->SetAttribute("axis", axis);
      // none of the file's defaults, of which some are wrong for a ball
      for (const auto& [key, value] : {std::pair("limited", "false"),
                                       {"range", "0 0"},
                                       {"actuatorfrclimited", "false"},
                                       {"springdamper", "0 0"},
                                       {"pos", "0 0 0"},
                                       {"ref", "0"}}) {
        part->SetAttribute(key, value);
      }
      last = body.InsertAfterChild(last, part);
    }
    body.DeleteChild(joint);
  });
}

/// The keyframe of a name, also where <attach> gave it a prefix; nullptr without one.
mjsElement* keyframe(const mjSpec& spec, const std::string& name) {
  mjsElement* found = nullptr;
  for_each(spec, mjOBJ_KEY, [&](mjsElement* e) {
    const std::string_view is = name_of(e);
    const std::size_t prefix = is.size() - std::min(name.size(), is.size());
    const bool is_word = prefix == 0 || !std::isalnum(static_cast<unsigned char>(is[prefix - 1]));
    if (!found && is.ends_with(name) && is_word) found = e;
  });
  return found;
}

/// The joints of a rover that a pose holds: those with a motor that does not drive, and all in the
/// bodies that they move, as fingers. Without contacts all but the drive's; wheels, casters and
/// springs on contacts stay loose.
std::set<mjsElement*> loose_joints(const mjSpec& spec) {
  std::set<mjsElement*> loose;
  if (!is_wheeled(spec)) for_each(spec, mjOBJ_JOINT, [&](mjsElement* e) { loose.insert(e); });
  for_each(spec, mjOBJ_ACTUATOR, [&](mjsElement* e) {
    mjsElement* const joint = find(spec, mjOBJ_JOINT, mjs_getString(mjs_asActuator(e)->target));
    if (!joint || is_driven(name_of(e))) return;
    for_each_in(*mjs_getParent(joint), mjOBJ_JOINT, true, [&](mjsElement* j) { loose.insert(j); });
  });
  std::erase_if(loose, [](mjsElement* joint) { return is_driven(name_of(joint)); });
  return loose;
}

}  // namespace

bool freeze(mjSpec& spec, const std::string& pose, const std::function<bool(mjsElement*)>& goes,
            const std::string& who, const input::Source& where, const mjsBody* base) {
  mjsElement* key = nullptr;
  if (pose != scenario::kPoseZero && !(key = keyframe(spec, pose))) {
    std::vector<std::string> known{scenario::kPoseZero};
    for_each(spec, mjOBJ_KEY, [&](mjsElement* e) { known.emplace_back(name_of(e)); });
    throw input::Error(where,
                       "{} the pose '{}', which is no keyframe of its file; choose one of {}", who,
                       pose, fmt::join(known, ", "));
  }
  Model model(spec);
  if (key) {
    mj_resetDataKeyframe(&model.m(), &model.d(), model.id(mjOBJ_KEY, std::string(name_of(key))));
  }
  call_mujoco([&] { mj_kinematics(&model.m(), &model.d()); });
  std::vector<std::pair<mjsElement*, Pose>> posed;  // first, as an edit takes the ids away
  std::vector<mjsElement*> joints;
  for_each(spec, mjOBJ_BODY, [&](mjsElement* e) {
    mjsElement* const first = mjs_firstChild(mjs_asBody(e), mjOBJ_JOINT, 0);
    const int body = mjs_getId(e);
    if (!first || mjs_asBody(e) == base) return;
    for_each_in(*mjs_asBody(e), mjOBJ_JOINT, false, [&](mjsElement* joint) {
      if (goes(joint)) joints.push_back(joint);
    });
    if (!goes(first) && mjs_asJoint(first)->type != mjJNT_FREE) return;
    const Pose T_WP = model.body_pose(model.m().body_parentid[body]);
    posed.emplace_back(e, T_WP.inverse() * model.body_pose(body));
  });
  for (const auto& [body, in_parent] : posed) set_pose_in_body(body, in_parent);
  for (mjsElement* joint : joints) remove(spec, joint);
  take_warning();  // of the joints' limits and the like
  return !joints.empty();
}

Fragment actor_fragment(const scenario::Actor& actor, SpecReader& reader) {
  Fragment fragment;
  const std::filesystem::path file = scenario::actor_file(actor);
  const bool has_keyframe =
      !actor.pose.empty() && actor.pose != scenario::kPoseZero && !actor.walks();
  fragment.spec = reader.read(file, actor.source, SpecReader::Part::fragment,
                              [&](Element& root, bool is_model) {
                                if (!is_model) paint(root, actor);
                                if (has_keyframe) split_free_joints(root);
                              });
  fragment.base = &check_base(*fragment.spec, reader, file);
  mjSpec& spec = *fragment.spec;
  if (actor.walks() || !actor.pose.empty()) {
    bool is_free = false;
    for_each(spec, mjOBJ_JOINT, [&](mjsElement* e) {  // its trajectory moves it
      if (mjs_asJoint(e)->type != mjJNT_FREE) return;
      remove(spec, e);
      is_free = true;
    });
    const std::string pose = actor.walks() ? scenario::kPoseZero : actor.pose;
    const bool had_joints = freeze(
        spec, pose, [](mjsElement*) { return true; }, fmt::format("actor '{}' has", actor.name),
        actor.source);
    fragment.is_frozen = !actor.walks() && (is_free || had_joints);
  }
  if (actor.walks()) check_walker(*fragment.base, reader);
  const Vector3d natural_m = check_actor(fragment, reader);
  fragment.size_m = actor.size_m.value_or(natural_m);
  if (actor.shape == Shape::cylinder && fragment.size_m.x() != fragment.size_m.y()) {
    throw input::Error(actor.source, "a cylinder is round: give the same length and width");
  }
  const Vector3d factor = fragment.size_m.cwiseQuotient(natural_m);
  if (!factor.isApproxToConstant(1)) scale_in(*fragment.base, Matrix3d::Identity(), factor);
  take_contacts_away(spec);
  for_each(spec, mjOBJ_KEY, [&](mjsElement* e) { mjs_delete(&spec, e); });
  return fragment;
}

Fragment rover_fragment(const scenario::Ego& ego, SpecReader& reader) {
  Fragment fragment;
  const std::filesystem::path file = scenario::rover_file(ego);
  fragment.spec = reader.read(file, ego.source, SpecReader::Part::fragment);
  mjSpec* spec = fragment.spec.get();
  fragment.base = &check_base(*spec, reader, file);
  if (ego.is_carried()) return fragment;
  check_rover(fragment, reader);
  const std::set<mjsElement*> loose = loose_joints(*spec);
  if (!ego.pose.empty()) {
    fragment.is_frozen = freeze(
        *spec, ego.pose, [&](mjsElement* joint) { return loose.contains(joint); }, "the rover has",
        ego.source, fragment.base);
  } else {
    for_each(*spec, mjOBJ_JOINT, [&](mjsElement* e) {
      if (loose.contains(e)) fragment.loose_joints.emplace_back(name_of(e));
    });
  }
  // the file's cameras are for a viewer; their names may clash with the scenario's camera
  for (const mjtObj type : {mjOBJ_CAMERA, mjOBJ_KEY}) {
    for_each(*spec, type, [&](mjsElement* e) { mjs_delete(spec, e); });
  }
  if (!is_wheeled(*spec)) take_contacts_away(*spec);
  return fragment;
}

}  // namespace lcs::sim
