#include "sim/scene/fragment_contract.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "sim/scene/mjcf.h"

namespace lcs::sim {
namespace {

using Eigen::Vector3d;
using xml::Element;
using xml::is_kind;

constexpr double kTolerance = 1e-6;

[[noreturn]] void refuse(const Element& at, const std::string& what) {
  throw input::Error(xml::source_of(at), what);
}

Vector3d vector(const Element& e, const char* key, const Vector3d& otherwise) {
  const std::vector<double> v = mjcf::numbers(mjcf::effective(e, key));
  return v.size() == 3 ? Vector3d(v[0], v[1], v[2]) : otherwise;
}

/// The first descendant of that kind and name; nullptr if missing.
Element* find(Element& root, std::string_view kind, const std::string& name) {
  Element* found = nullptr;
  xml::for_each(root, [&](Element& e) {
    if (!found && is_kind(e, kind) && xml::attribute(e, "name") == name) found = &e;
  });
  return found;
}

void check_sections(Element& root) {
  constexpr std::array kTaken{"default", "asset", "worldbody", "actuator", "sensor"};
  constexpr std::array kLeftOut{"compiler", "option",    "size",    "visual",
                                "custom",   "statistic", "keyframe"};
  const auto is_in = [](const auto& kinds, const Element& e) {
    return std::any_of(kinds.begin(), kinds.end(), [&](auto kind) { return is_kind(e, kind); });
  };
  for (Element* s = root.FirstChildElement(); s; s = s->NextSiblingElement()) {
    if (is_in(kTaken, *s) || is_in(kLeftOut, *s)) continue;
    refuse(*s, fmt::format("<{}> is nothing that a rover or an actor can have; take it away (they "
                           "have {})",
                           s->Name(), fmt::join(kTaken, ", ")));
  }
}

/// Finds the body `base`. Removes lights and cameras beside it, and rejects all other elements.
Element& check_base(Element& root) {
  Element* worldbody = root.FirstChildElement("worldbody");
  Element* base = worldbody ? xml::child_named(*worldbody, "body", "base") : nullptr;
  if (!base) {
    refuse(worldbody ? *worldbody : root,
           "there is no body called 'base'; put all that a rover or an actor is into "
           "<worldbody><body name=\"base\">");
  }
  for (Element *e = worldbody->FirstChildElement(), *next = nullptr; e; e = next) {
    next = e->NextSiblingElement();
    if (e == base) continue;
    if (is_kind(*e, "light") || is_kind(*e, "camera")) {
      worldbody->DeleteChild(e);
    } else {
      refuse(*e, fmt::format("{} stands in the worldbody beside the one body 'base' that a rover "
                             "or an actor is; move it into 'base', or take it away",
                             xml::tag(*e)));
    }
  }
  if (!vector(*base, "pos", Vector3d::Zero()).isZero(0) ||
      !mjcf::rotation(*base).isIdentity(kTolerance)) {
    refuse(*base,
           "the body 'base' has a place or rotation of its own; take it away and move what is in "
           "it (its origin is on the ground below its middle, x is forward, z up)");
  }
  return *base;
}

void check_size(Element& root) {
  const Element* size = xml::child_named(xml::section(root, "custom"), "numeric", "size");
  const std::vector<double> values =
      size ? mjcf::numbers(xml::attribute(*size, "data")) : std::vector<double>{};
  if (values.size() == 3 &&
      std::all_of(values.begin(), values.end(), [](double v) { return v > 0 && std::isfinite(v); }))
    return;
  refuse(size ? *size : root,
         fmt::format("an actor's file must state its natural size, which {}; give <custom><numeric "
                     "name=\"size\" data=\"LENGTH WIDTH HEIGHT\"/></custom>, in m",
                     size ? fmt::format("'{}' is not", xml::attribute(*size, "data"))
                          : std::string("this one does not")));
}

/// \param where "in 'base'", or the required parent body, for the message.
Element& require(Element& in, const char* kind, const char* name, const std::string& where,
                 const std::string& remedy) {
  if (Element* found = find(in, kind, name)) return *found;
  refuse(in, fmt::format("there is no {} called '{}' {}; give {}", kind, name, where, remedy));
}

/// Rejects an element that can move relative to the body `base`, at any depth.
void require_fixed(const Element& e, const Element& base) {
  for (const auto* body = e.Parent()->ToElement(); body && body != &base;
       body = body->Parent()->ToElement()) {
    if (!body->FirstChildElement("joint") && !body->FirstChildElement("freejoint")) continue;
    refuse(e, fmt::format("{} is in a body that moves; move it into 'base'", xml::tag(e)));
  }
}

void check_sensor(Element& root, const char* kind) {
  const std::string remedy = fmt::format("<sensor><{0} name=\"{0}\" site=\"imu\"/></sensor>", kind);
  const Element& sensor = require(root, kind, kind, "among the sensors", remedy);
  if (xml::attribute(sensor, "site") != "imu") {
    refuse(sensor, fmt::format("{} is not at the site 'imu'; give {}", xml::tag(sensor), remedy));
  }
}

void check_actuator(Element& root, const Element& actuator) {
  const std::string name = xml::attribute(actuator, "name");
  const std::string remedy = fmt::format("<velocity name=\"{0}\" joint=\"{0}\" kv=\"...\"/>", name);
  if (!is_kind(actuator, "velocity") || xml::attribute(actuator, "joint") != name) {
    refuse(actuator, fmt::format("the actuator '{}' must give the joint '{}' a velocity; give {}",
                                 name, name, remedy));
  }
  if (!find(root, "joint", name)) {
    refuse(actuator, fmt::format("there is no joint called '{}' for {}; call it so", name,
                                 xml::tag(actuator)));
  }
}

void check_joint(Element& body, const char* name, const char* type, const Vector3d& axis) {
  const std::string remedy = fmt::format("<joint name=\"{}\" type=\"{}\" axis=\"{}\"/>", name, type,
                                         fmt::join(axis.data(), axis.data() + 3, " "));
  Element* joint = xml::child_named(body, "joint", name);
  if (!joint) {
    refuse(body, fmt::format("{} has no joint '{}' of its own; give it {}", xml::tag(body), name,
                             remedy));
  }
  const Vector3d given = mjcf::rotation(body) * vector(*joint, "axis", Vector3d::UnitZ());
  if (mjcf::effective(*joint, "type") != type || !given.normalized().isApprox(axis, kTolerance)) {
    refuse(*joint, fmt::format("{} moves otherwise than its actuator says; give {}",
                               xml::tag(*joint), remedy));
  }
}

/// The slides along the world's x and y must precede the hinge, which turns all later joints.
void check_holonomic(Element& base) {
  check_joint(base, "x", "slide", Vector3d::UnitX());
  check_joint(base, "y", "slide", Vector3d::UnitY());
  check_joint(base, "yaw", "hinge", Vector3d::UnitZ());
  std::vector<std::string> order;
  for (const char* kind : {"joint", "freejoint"}) {
    for (Element* e = base.FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) {
      order.push_back(xml::attribute(*e, "name"));
    }
  }
  if (order != std::vector<std::string>{"x", "y", "yaw"}) {
    refuse(base, fmt::format("the body 'base' of a holonomic rover has the joints {}; give it x, y "
                             "and yaw in this order, and no other",
                             fmt::join(order, ", ")));
  }
}

Vector3d check_wheel(Element& base, const char* joint, const std::string& name) {
  Element* wheel = xml::child_named(base, "body", name);
  if (!wheel) {
    refuse(base, fmt::format("there is no body called '{}' in 'base'; give the wheel one, with the "
                             "joint '{}' and a geom whose first size is its radius",
                             name, joint));
  }
  check_joint(*wheel, joint, "hinge", Vector3d::UnitY());
  const Element* geom = wheel->FirstChildElement("geom");
  const std::string type = geom ? mjcf::effective(*geom, "type") : "";
  if (type != "sphere" && type != "cylinder" && type != "ellipsoid") {
    refuse(geom ? *geom : *wheel,
           fmt::format("the first geom of '{}' tells its radius, and {}; give it a sphere, "
                       "cylinder or ellipsoid first",
                       name, geom ? "is a " + type : "it has none"));
  }
  return vector(*wheel, "pos", Vector3d::Zero());
}

void check_wheeled(Element& base) {
  Element* joint = base.FirstChildElement("freejoint");
  if (!joint) joint = xml::child_named(base, "joint", "base");
  if (!joint || xml::attribute(*joint, "name") != "base" ||
      (is_kind(*joint, "joint") && mjcf::effective(*joint, "type") != "free")) {
    refuse(joint ? *joint : base,
           "the body 'base' of a rover on wheels must be free, by a joint called like it; give "
           "<freejoint name=\"base\"/>");
  }
  const Vector3d left = check_wheel(base, "left", "left_wheel");
  const Vector3d right = check_wheel(base, "right", "right_wheel");
  if (left.y() > right.y() && std::abs(left.x()) + std::abs(right.x()) < kTolerance &&
      std::abs(left.y() + right.y()) < kTolerance) {
    return;
  }
  refuse(*xml::child_named(base, "body", "left_wheel"),
         fmt::format("the wheels stand at ({:g}, {:g}) and ({:g}, {:g}) m; put the left one at (0, "
                     "y) and the right one at (0, -y), so that the rover turns about its origin",
                     left.x(), left.y(), right.x(), right.y()));
}

}  // namespace

void check_actor(Element& root) {
  check_sections(root);
  Element& base = check_base(root);
  bool has_geom = false;
  xml::for_each(base, [&](Element& e) {
    if (is_kind(e, "joint") || is_kind(e, "freejoint")) {
      refuse(e, fmt::format("{}: an actor is one rigid body, which its trajectory moves; take the "
                            "joint away",
                            xml::tag(e)));
    }
    if (!is_kind(e, "geom")) return;
    has_geom = true;
    const std::string type = mjcf::effective(e, "type");
    if (type == "plane" || type == "hfield") {
      refuse(e, fmt::format("{} is a {}, which only the setting can have; use a box or a mesh",
                            xml::tag(e), type));
    }
  });
  if (!has_geom) refuse(base, "the body 'base' has no geom, and so nobody sees it; give it one");
  check_size(root);
}

void check_rover(Element& root) {
  check_sections(root);
  Element& base = check_base(root);
  require_fixed(require(base, "site", "imu", "in 'base'", "<site name=\"imu\" pos=\"...\"/>"),
                base);
  check_sensor(root, "accelerometer");
  check_sensor(root, "gyro");

  std::vector<std::string> driven;
  const Element* actuators = root.FirstChildElement("actuator");
  for (const auto* e = actuators ? actuators->FirstChildElement() : nullptr; e;
       e = e->NextSiblingElement()) {
    const std::string name = xml::attribute(*e, "name");
    for (const std::string_view known : {"x", "y", "yaw", "left", "right"}) {
      if (name != known) continue;
      check_actuator(root, *e);
      driven.push_back(name);
    }
  }
  std::sort(driven.begin(), driven.end());
  const bool is_holonomic = driven == std::vector<std::string>{"x", "y", "yaw"};
  if (!is_holonomic && driven != std::vector<std::string>{"left", "right"}) {
    refuse(actuators ? *actuators : root,
           fmt::format("of the actuators that say how the rover is driven, it has {}; give it "
                       "either x, y and yaw (it follows any command) or left and right (two "
                       "wheels)",
                       driven.empty() ? "none" : fmt::format("{}", fmt::join(driven, ", "))));
  }
  is_holonomic ? check_holonomic(base) : check_wheeled(base);
}

bool is_wheeled(Element& root) {
  return xml::child_named(xml::section(root, "actuator"), "velocity", "left") != nullptr;
}

}  // namespace lcs::sim
