#include "sim/scene/fragment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/scenes.h"
#include "sim/scene/model.h"
#include "sim/scene/texture.h"

namespace lcs::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
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
  set_pose_in_body(element, pose, local);
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
  for (Element* s = root.FirstChildElement("asset"); s; s = s->NextSiblingElement("asset")) {
    for (Element* e = s->FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) {
      if (xml::attribute(*e, "name") == name) return e;
    }
  }
  return nullptr;
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
    if (!xml::is_kind(body, "body")) return;
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
      part->SetAttribute("ref", 0);
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

/// Makes an actor rigid: its bodies keep the poses of a keyframe, and the joints go with all that
/// refers to them. \return whether there were joints.
bool freeze(Fragment& fragment, const scenario::Actor& actor, const SpecReader& reader) {
  mjSpec& spec = *fragment.spec;
  bool has_joints = false;
  const auto remove_joints = [&](bool only_free) {
    for_each(spec, mjOBJ_JOINT, [&](mjsElement* e) {
      if (only_free && mjs_asJoint(e)->type != mjJNT_FREE) return;
      remove(spec, e);
      has_joints = true;
    });
  };
  remove_joints(true);  // its trajectory moves it
  mjsElement* key = nullptr;
  const bool is_keyframe = !actor.walks() && actor.pose != scenario::kPoseZero;
  if (is_keyframe && !(key = keyframe(spec, actor.pose))) {
    std::vector<std::string> known{scenario::kPoseZero, scenario::kPoseWalking};
    for_each(spec, mjOBJ_KEY, [&](mjsElement* e) { known.emplace_back(name_of(e)); });
    throw input::Error(
        actor.source,
        "actor '{}' has the pose '{}', which is no keyframe of its file; choose one of {}",
        actor.name, actor.pose, fmt::join(known, ", "));
  }
  const std::unique_ptr<mjModel, ModelDeleter> model(
      call_mujoco([&] { return mj_compile(&spec, nullptr); }));
  if (!model) throw reader.refusal(mjs_getError(&spec), &spec);
  const std::unique_ptr<mjData, DataDeleter> data(
      call_mujoco([&] { return mj_makeData(model.get()); }));
  if (!data) throw MujocoError("could not allocate the state of an actor");
  if (key) {
    mj_resetDataKeyframe(model.get(), data.get(),
                         mj_name2id(model.get(), mjOBJ_KEY, std::string(name_of(key)).c_str()));
  }
  call_mujoco([&] { mj_kinematics(model.get(), data.get()); });
  const auto pose = [&](int body) {
    using Rotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    return Pose{Eigen::Map<const Rotation>(data->xmat + 9 * body),
                Eigen::Map<const Vector3d>(data->xpos + 3 * body)};
  };
  std::vector<std::pair<mjsElement*, Pose>> posed;  // first, as an edit takes the ids away
  for_each(spec, mjOBJ_BODY, [&](mjsElement* e) {
    const int body = mjs_getId(e);
    if (body == 0 || mjs_asBody(e) == fragment.base) return;
    posed.emplace_back(e, pose(model->body_parentid[body]).inverse() * pose(body));
  });
  for (const auto& [body, in_parent] : posed) set_pose_in_body(body, in_parent);
  remove_joints(false);
  take_warning();  // of the joints' limits and the like
  return has_joints;
}

}  // namespace

bool has_picture(const scenario::Actor& actor) {
  return !actor.texture.empty() && !is_texture_style(actor.texture);
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
  if (actor.walks()) {
    freeze(fragment, actor, reader);
    check_walker(*fragment.base, reader);
  } else if (!actor.pose.empty()) {
    fragment.is_frozen = freeze(fragment, actor, reader);
  }
  const Vector3d natural_m = check_actor(fragment, reader);
  fragment.size_m = actor.size_m.value_or(natural_m);
  if (actor.shape == Shape::cylinder && fragment.size_m.x() != fragment.size_m.y()) {
    throw input::Error(actor.source, "a cylinder is round: give the same length and width");
  }
  const Vector3d factor = fragment.size_m.cwiseQuotient(natural_m);
  if (!factor.isApproxToConstant(1)) scale_in(*fragment.base, Matrix3d::Identity(), factor);
  take_contacts_away(*fragment.spec);
  for_each(*fragment.spec, mjOBJ_KEY, [&](mjsElement* e) { mjs_delete(fragment.spec.get(), e); });
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
  // the file's cameras are for a viewer; their names may clash with the scenario's camera
  for (const mjtObj type : {mjOBJ_CAMERA, mjOBJ_KEY}) {
    for_each(*spec, type, [&](mjsElement* e) { mjs_delete(spec, e); });
  }
  if (!is_wheeled(*spec)) take_contacts_away(*spec);
  return fragment;
}

}  // namespace lcs::sim
