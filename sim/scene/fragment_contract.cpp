#include "sim/scene/fragment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "sim/scene/gait.h"

namespace lcs::sim {
namespace {

constexpr double kTolerance = 1e-6;

/// Rejects an element that can move relative to the body `base`, at any depth.
void require_fixed(mjsElement* e, const mjsBody& base, const SpecReader& reader) {
  for (mjsBody* body = mjs_getParent(e); body && body != &base;
       body = mjs_getParent(body->element)) {
    if (!mjs_firstChild(body, mjOBJ_JOINT, 0)) continue;
    reader.refuse(e, "TAG is in a body that moves; move it into 'base'");
  }
}

bool is_velocity_of(const mjsActuator& actuator, std::string_view joint) {
  return actuator.type == mjACTUATOR_VELOCITY && actuator.trntype == mjTRN_JOINT &&
         mjs_getString(actuator.target) == joint;
}

/// Whether a name is a side, or a side and more: "left", "left_front".
bool is_wheel(std::string_view name, std::string_view side) {
  return name == side || (name.starts_with(side) && name[side.size()] == '_');
}

void check_actuator(const mjSpec& spec, mjsElement* e, const SpecReader& reader) {
  const std::string name(name_of(e));
  if (!is_velocity_of(*mjs_asActuator(e), name)) {
    reader.refuse(e, fmt::format("the actuator '{0}' must give the joint '{0}' a velocity; give "
                                 "<velocity name=\"{0}\" joint=\"{0}\" kv=\"...\"/>",
                                 name));
  }
  if (!find(spec, mjOBJ_JOINT, name)) {
    reader.refuse(e, fmt::format("there is no joint called '{}' for TAG; call it so", name));
  }
}

/// \param R rotation of the joint's body in B.
void check_axis(mjsElement* joint, mjtJoint type, const Eigen::Matrix3d& R, const Vector3d& axis,
                const SpecReader& reader) {
  const mjsJoint& is = *mjs_asJoint(joint);
  const Vector3d given = R * Eigen::Map<const Vector3d>(is.axis);
  if (is.type == type && given.normalized().isApprox(axis, kTolerance) &&
      Eigen::Map<const Vector3d>(is.pos).isZero(kTolerance)) {
    return;
  }
  reader.refuse(
      joint,
      fmt::format("TAG moves otherwise than its actuator says; give <joint name=\"{}\" type=\"{}\" "
                  "axis=\"...\"/> with the axis {} of 'base', through the origin of its body",
                  name_of(joint), type == mjJNT_SLIDE ? "slide" : "hinge",
                  fmt::join(axis.data(), axis.data() + 3, " ")));
}

void check_joint(const mjsBody& body, const char* name, mjtJoint type, const Vector3d& axis,
                 const SpecReader& reader) {
  mjsElement* const joint = find(*mjs_getSpec(body.element), mjOBJ_JOINT, name);
  if (!joint || mjs_getParent(joint) != &body) {
    reader.refuse(body.element, fmt::format("TAG has no joint '{}' of its own; give it one", name));
  }
  check_axis(joint, type, Eigen::Matrix3d::Identity(), axis, reader);
}

/// The slides along the world's x and y must precede the hinge, which turns all later joints.
void check_holonomic(const mjsBody& base, const SpecReader& reader) {
  check_joint(base, "x", mjJNT_SLIDE, Vector3d::UnitX(), reader);
  check_joint(base, "y", mjJNT_SLIDE, Vector3d::UnitY(), reader);
  check_joint(base, "yaw", mjJNT_HINGE, Vector3d::UnitZ(), reader);
  std::vector<std::string> order;
  for_each_in(base, mjOBJ_JOINT, false, [&](mjsElement* e) { order.emplace_back(name_of(e)); });
  if (order != std::vector<std::string>{"x", "y", "yaw"}) {
    reader.refuse(base.element, fmt::format("the body 'base' of a holonomic rover has the joints "
                                            "{}; give it x, y and yaw in this order, and no other",
                                            fmt::join(order, ", ")));
  }
}

struct Wheel {
  Vector3d place_m;  ///< in B
  double radius_m;
};

Wheel check_wheel(const mjsBody& base, mjsElement* joint, const SpecReader& reader) {
  mjsBody* const body = mjs_getParent(joint);
  Pose T_BW;
  for (mjsBody* b = body; b && b != &base; b = mjs_getParent(b->element)) {
    T_BW = pose_in_body(b->element) * T_BW;
  }
  check_axis(joint, mjJNT_HINGE, T_BW.R, Vector3d::UnitY(), reader);
  mjsElement* round = mjs_firstChild(body, mjOBJ_GEOM, 0);
  while (round && !is_round(mjs_asGeom(round)->type)) round = mjs_nextChild(body, round, 0);
  if (!round) {
    constexpr const char* kNone =
        "the wheel of '{}' has no sphere, cylinder or ellipsoid; give it one";
    reader.refuse(body->element, fmt::format(kNone, name_of(joint)));
  }
  return {T_BW.p, mjs_asGeom(round)->size[0]};
}

void check_wheeled(const mjSpec& spec, const mjsBody& base, const SpecReader& reader) {
  mjsElement* const free = mjs_firstChild(&base, mjOBJ_JOINT, 0);
  if (!free || name_of(free) != "base" || mjs_asJoint(free)->type != mjJNT_FREE) {
    reader.refuse(free ? free : base.element,
                  "the body 'base' of a rover on wheels must be free, by a joint called like it; "
                  "give <freejoint name=\"base\"/>");
  }
  std::array<Vector3d, 2> middle{Vector3d::Zero(), Vector3d::Zero()};  // left, right
  std::array<int, 2> count{};
  double radius_m = 0;
  mjsElement* last = nullptr;
  for_each(spec, mjOBJ_ACTUATOR, [&](mjsElement* e) {
    const std::size_t side = is_wheel(name_of(e), "left") ? 0 : 1;
    if (side == 1 && !is_wheel(name_of(e), "right")) return;
    last = find(spec, mjOBJ_JOINT, name_of(e));
    const Wheel wheel = check_wheel(base, last, reader);
    if (radius_m == 0) radius_m = wheel.radius_m;
    if (std::abs(wheel.radius_m - radius_m) > kTolerance) {
      reader.refuse(last, fmt::format("the wheel of TAG has a radius of {:g} m, and another one "
                                      "{:g} m; give all driven wheels the same",
                                      wheel.radius_m, radius_m));
    }
    middle[side] += wheel.place_m;
    ++count[side];
  });
  for (const std::size_t side : {0, 1}) middle[side] /= count[side];
  const auto& [left, right] = middle;
  if (left.y() > right.y() && std::abs(left.x()) + std::abs(right.x()) < kTolerance &&
      std::abs(left.y() + right.y()) < kTolerance) {
    return;
  }
  reader.refuse(
      mjs_getParent(last)->element,
      fmt::format("the middles of the left and right wheels are at ({:g}, {:g}) and ({:g}, {:g}) "
                  "m; put them at (0, y) and (0, -y), so that the rover turns about its origin",
                  left.x(), left.y(), right.x(), right.y()));
}

}  // namespace

mjsBody& check_base(const mjSpec& spec, const SpecReader& reader,
                    const std::filesystem::path& file) {
  const mjsBody& world = *mjs_findBody(&spec, "world");
  mjsBody* const base = mjs_findBody(&spec, "base");
  if (!base || mjs_getParent(base->element) != &world) {
    mjsElement* const other = mjs_firstChild(&world, mjOBJ_BODY, 0);
    throw input::Error(other ? reader.source(other) : input::Source{file.string(), 1},
                       "there is no body called 'base'; put all that a rover or an actor is into "
                       "<worldbody><body name=\"base\">, another's robot (MJCF or URDF) by <model> "
                       "and <attach>, as scenes/README.md shows");
  }
  for (const mjtObj type : {mjOBJ_BODY, mjOBJ_GEOM, mjOBJ_SITE}) {
    for_each_in(world, type, false, [&](mjsElement* e) {
      if (e == base->element) return;
      reader.refuse(e,
                    "TAG stands in the worldbody beside the one body 'base' that a rover or an "
                    "actor is; move it into 'base', or take it away");
    });
  }
  const Pose pose = pose_in_body(base->element);
  if (!pose.p.isZero(0) || !pose.R.isIdentity(kTolerance)) {
    reader.refuse(base->element,
                  "the body 'base' has a place or rotation of its own; take it away and move what "
                  "is in it (its origin is on the ground below its middle, x is forward, z up)");
  }
  return *base;
}

Vector3d check_actor(const Fragment& actor, const SpecReader& reader) {
  for_each(*actor.spec, mjOBJ_JOINT, [&](mjsElement* e) {
    reader.refuse(e,
                  "TAG: an actor is one rigid body, which its trajectory moves; take the joint "
                  "away, or give the actor a pose: a keyframe of its file, or zero");
  });
  bool has_geom = false;
  for_each_in(*actor.base, mjOBJ_GEOM, true, [&](mjsElement* e) {
    has_geom = true;
    const mjtGeom type = mjs_asGeom(e)->type;
    if (type != mjGEOM_PLANE && type != mjGEOM_HFIELD) return;
    reader.refuse(e,
                  fmt::format("TAG is a {}, which only the setting can have; use a box or a mesh",
                              type == mjGEOM_PLANE ? "plane" : "height field"));
  });
  if (!has_geom) {
    reader.refuse(actor.base->element,
                  "the body 'base' has no geom, and so nobody sees it; give it one");
  }
  mjsElement* const numeric = find(*actor.spec, mjOBJ_NUMERIC, "size");
  int count = 0;
  const double* values = numeric ? mjs_getDouble(mjs_asNumeric(numeric)->data, &count) : nullptr;
  if (count == 3 && std::all_of(values, values + 3, [](double v) { return v > 0; })) {
    return Eigen::Map<const Vector3d>(values);
  }
  const std::string remedy = fmt::format(
      "an actor's file must state its natural size, which {}; give <custom><numeric name=\"size\" "
      "data=\"LENGTH WIDTH HEIGHT\"/></custom>, in m",
      numeric ? fmt::format("'{}' is not", fmt::join(values, values + count, " "))
              : std::string("this one does not"));
  reader.refuse(numeric ? numeric : actor.base->element, remedy);
}

void check_walker(const mjsBody& base, const SpecReader& reader) {
  const auto child = [&](const mjsBody& parent, const std::string& name) -> const mjsBody& {
    const mjsBody* found = mjs_findChild(&parent, name.c_str());
    if (!found || mjs_getParent(found->element) != &parent) {
      reader.refuse(parent.element, fmt::format("TAG of a walker has no body '{}'; give it one "
                                                "(scenes/README.md, 'Rovers and actors')",
                                                name));
    }
    if (!pose_in_body(found->element).R.isIdentity(kTolerance)) {
      reader.refuse(
          found->element,
          "TAG of a walker is turned when its joints are at zero; give it the axes of 'base'");
    }
    return *found;
  };
  const auto hanging = [&](const mjsBody& parent, const std::string& name) -> const mjsBody& {
    const mjsBody& found = child(parent, name);
    const Vector3d p = pose_in_body(found.element).p;
    if (p.head<2>().isZero(kTolerance) && p.z() < 0) return found;
    reader.refuse(found.element, fmt::format("TAG of a walker is at ({:g}, {:g}, {:g}); put it "
                                             "right below its parent, at (0, 0, z) with z below 0",
                                             p.x(), p.y(), p.z()));
  };
  const mjsBody& trunk = child(base, Gait::kTrunk);
  for (const std::string side : Gait::kSides) {
    hanging(hanging(child(trunk, side + Gait::kLeg[0]), side + Gait::kLeg[1]),
            side + Gait::kLeg[2]);
    hanging(child(trunk, side + Gait::kArm[0]), side + Gait::kArm[1]);
  }
}

void check_rover(const Fragment& rover, const SpecReader& reader) {
  const mjSpec& spec = *rover.spec;
  mjsElement* const imu = find(spec, mjOBJ_SITE, "imu");
  if (!imu) {
    reader.refuse(rover.base->element,
                  "there is no site called 'imu' in 'base'; give <site name=\"imu\" pos=\"...\"/>");
  }
  require_fixed(imu, *rover.base, reader);

  std::string driven;
  mjsElement* first = nullptr;
  int left = 0, right = 0, axes = 0;
  for_each(spec, mjOBJ_ACTUATOR, [&](mjsElement* e) {
    if (!first) first = e;
    const std::string_view name = name_of(e);
    if (!is_driven(name)) return;
    const bool is_left = is_wheel(name, "left"), is_right = is_wheel(name, "right");
    check_actuator(spec, e, reader);
    left += is_left;
    right += is_right;
    axes += !is_left && !is_right;
    driven += (driven.empty() ? "" : ", ") + std::string(name);
  });
  const bool is_holonomic = axes == 3 && left + right == 0;
  if (!is_holonomic && (axes > 0 || left == 0 || right == 0)) {
    const std::string what = fmt::format(
        "of the actuators that say how the rover is driven, it has {}; give it either x, y and yaw "
        "(it follows any command) or left and right (wheels; more of them are called left_front "
        "and the like)",
        driven.empty() ? "none" : driven);
    reader.refuse(first ? first : rover.base->element, what);
  }
  is_holonomic ? check_holonomic(*rover.base, reader) : check_wheeled(spec, *rover.base, reader);
}

bool is_driven(std::string_view actuator) {
  return actuator == "x" || actuator == "y" || actuator == "yaw" || is_wheel(actuator, "left") ||
         is_wheel(actuator, "right");
}

bool is_wheeled(const mjSpec& spec) {
  return find(spec, mjOBJ_ACTUATOR, "x") == nullptr;
}

}  // namespace lcs::sim
