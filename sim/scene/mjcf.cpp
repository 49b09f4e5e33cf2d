#include "sim/scene/mjcf.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cctype>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <string_view>

#include "sim/rotation.h"

namespace lcs::sim::mjcf {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using xml::Element;
using xml::is_kind;

/// Value of a `<compiler>` attribute; the last `<compiler>` that has it wins.
std::string compiler(const Element& root, const char* key, const char* otherwise) {
  std::string value = otherwise;
  for (const Element* c = root.FirstChildElement("compiler"); c;
       c = c->NextSiblingElement("compiler")) {
    if (const char* said = c->Attribute(key)) value = said;
  }
  return value;
}

/// The defaults of a class; nullptr if missing.
const Element* class_named(const Element& parent, const std::string& name) {
  for (const Element* d = parent.FirstChildElement("default"); d;
       d = d->NextSiblingElement("default")) {
    if (xml::attribute(*d, "class") == name) return d;
    if (const Element* found = class_named(*d, name)) return found;
  }
  return nullptr;
}

const Element* parent_of(const Element& e) {
  return e.Parent() ? e.Parent()->ToElement() : nullptr;
}

std::string class_of(const Element& e) {
  if (const char* own = e.Attribute("class")) return own;
  for (const Element* about = parent_of(e); about; about = parent_of(*about)) {
    if (const char* given = about->Attribute("childclass")) return given;
  }
  return "";
}

Quaterniond from_euler(const std::vector<double>& angles, const std::string& sequence) {
  Quaterniond q = Quaterniond::Identity();
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = std::tolower(sequence[i]) - 'x';
    const Quaterniond turn(Eigen::AngleAxisd(angles[i], Vector3d::Unit(axis)));
    q = std::islower(sequence[i]) ? q * turn : turn * q;  // intrinsic, or extrinsic for capitals
  }
  return q;
}

Quaterniond from_axes(const std::vector<double>& v) {
  const Vector3d x = Vector3d(v[0], v[1], v[2]).normalized();
  const Vector3d y = Vector3d(v[3], v[4], v[5]);
  const Vector3d z = x.cross(y).normalized();
  Eigen::Matrix3d R;
  R << x, z.cross(x), z;
  return Quaterniond(R);
}

/// Replaces all other rotation attributes by `quat`. Malformed ones stay, so that MuJoCo reports
/// them.
void rotate_by_quat(Element& e, double unit_rad, const std::string& sequence) {
  const auto replace = [&](const char* key, std::size_t count, const auto& quaternion) {
    const std::vector<double> v = numbers(xml::attribute(e, key));
    if (v.size() != count) return;
    const Quaterniond q = quaternion(v);
    if (!q.coeffs().allFinite()) return;
    e.DeleteAttribute(key);
    set_numbers(e, "quat", {q.w(), q.x(), q.y(), q.z()});
  };
  using Values = const std::vector<double>&;
  replace("euler", 3, [&](Values v) {
    return from_euler({v[0] * unit_rad, v[1] * unit_rad, v[2] * unit_rad}, sequence);
  });
  replace("axisangle", 4, [&](Values v) {
    return Quaterniond(Eigen::AngleAxisd(v[3] * unit_rad, Vector3d(v[0], v[1], v[2]).normalized()));
  });
  replace("xyaxes", 6, from_axes);
  replace("zaxis", 3, [](Values v) {
    return least_rotation(Vector3d::UnitZ(), {v[0], v[1], v[2]});
  });
}

void scale_angles(Element& joint, double factor) {
  if (effective(joint, "type") == "slide") return;
  for (const char* key : {"range", "ref", "springref"}) {
    std::vector<double> values = numbers(xml::attribute(joint, key));
    for (double& value : values) value *= factor;
    if (!values.empty()) set_numbers(joint, key, values);
  }
}

/// Joins sections of one kind, as a file and its includes may have several.
void join_sections(Element& root) {
  for (const char* kind : {"asset", "worldbody", "actuator", "sensor", "custom"}) {
    Element* first = root.FirstChildElement(kind);
    while (Element* more = first ? first->NextSiblingElement(kind) : nullptr) {
      while (tinyxml2::XMLNode* child = more->FirstChild()) first->InsertEndChild(child);
      root.DeleteChild(more);
    }
  }
}

/// MuJoCo's built-in defaults, which the target document's defaults might override.
struct Default {
  const char *kind, *key, *value;
};
constexpr Default kDefaults[] = {
    {"geom", "type", "sphere"},     {"geom", "contype", "1"},
    {"geom", "conaffinity", "1"},   {"geom", "condim", "3"},
    {"geom", "group", "0"},         {"geom", "priority", "0"},
    {"geom", "solref", "0.02 1"},   {"geom", "friction", "1 0.005 0.0001"},
    {"geom", "margin", "0"},        {"geom", "gap", "0"},
    {"geom", "density", "1000"},    {"geom", "rgba", "0.5 0.5 0.5 1"},
    {"joint", "type", "hinge"},     {"joint", "damping", "0"},
    {"joint", "stiffness", "0"},    {"joint", "armature", "0"},
    {"joint", "frictionloss", "0"},
};

/// Moves a document's global defaults into a class, and assigns the class to all its elements.
void give_class(Element& root) {
  Element* all = root.GetDocument()->NewElement("default");
  xml::set_source(*all, xml::source_of(root));
  std::string name = "main";
  while (Element* section = root.FirstChildElement("default")) {
    if (const char* own = section->Attribute("class")) name = own;
    while (Element* e = section->FirstChildElement()) {
      Element* same = is_kind(*e, "default") ? nullptr : all->FirstChildElement(e->Name());
      if (!same) {
        all->InsertEndChild(e);
        continue;
      }
      for (const auto* a = e->FirstAttribute(); a; a = a->Next()) {
        same->SetAttribute(a->Name(), a->Value());
      }
      section->DeleteChild(e);
    }
    root.DeleteChild(section);
  }
  for (const auto& [kind, key, value] : kDefaults) {
    Element& e = xml::section(*all, kind);
    if (!e.Attribute(key)) e.SetAttribute(key, value);
  }
  all->SetAttribute("class", name.c_str());
  Element* defaults = root.InsertNewChildElement("default");
  xml::set_source(*defaults, xml::source_of(root));
  defaults->InsertEndChild(all);

  const auto put = [&](Element& e, const char* key) {
    if (!e.Attribute(key)) e.SetAttribute(key, name.c_str());
  };
  for (Element* s = root.FirstChildElement(); s; s = s->NextSiblingElement()) {
    for (Element* e = s->FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (is_kind(*s, "worldbody")) put(*e, is_kind(*e, "body") ? "childclass" : "class");
      if (is_kind(*s, "actuator") || is_kind(*e, "material") || is_kind(*e, "mesh")) {
        put(*e, "class");
      }
    }
  }
}

}  // namespace

std::vector<double> numbers(const std::string& text) {
  std::vector<double> values;
  std::istringstream stream(text);
  for (double value; stream >> value;) values.push_back(value);
  return values;
}

void set_numbers(Element& e, const char* key, const std::vector<double>& values) {
  std::string text;  // not by fmt::join, which causes a warning of GCC 13 within fmt 9
  for (const double value : values) {
    text += fmt::format("{}{:.17g}", text.empty() ? "" : " ", value);
  }
  e.SetAttribute(key, text.c_str());
}

std::string effective(const Element& e, const char* key) {
  if (const char* own = e.Attribute(key)) return own;
  const Element* root = e.GetDocument()->RootElement();
  const Element* defaults = class_named(*root, class_of(e));
  for (; defaults && is_kind(*defaults, "default"); defaults = parent_of(*defaults)) {
    std::string value;
    for (const Element* d = defaults->FirstChildElement(e.Name()); d;
         d = d->NextSiblingElement(e.Name())) {
      if (const char* given = d->Attribute(key)) value = given;
    }
    if (!value.empty()) return value;
  }
  return "";
}

Eigen::Matrix3d rotation(const Element& e) {
  const std::vector<double> q = numbers(effective(e, "quat"));
  if (q.size() != 4) return Eigen::Matrix3d::Identity();
  return Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

void make_standalone(Element& root, const Element& into) {
  constexpr double kDegree = std::numbers::pi / 180;
  const auto unit_rad = [](const Element& document) {
    return compiler(document, "angle", "degree") == "radian" ? 1 : kDegree;
  };
  std::string sequence = compiler(root, "eulerseq", "xyz");
  if (sequence.size() != 3 || sequence.find_first_not_of("xyzXYZ") != std::string::npos) {
    sequence = "xyz";
  }
  join_sections(root);
  give_class(root);
  const double factor = unit_rad(root) / unit_rad(into);
  for (Element* s = root.FirstChildElement(); s; s = s->NextSiblingElement()) {
    xml::for_each(*s, [&](Element& e) {
      if (is_kind(*s, "worldbody") || is_kind(*s, "default")) {
        rotate_by_quat(e, unit_rad(root), sequence);
        if (is_kind(e, "joint") && factor != 1) scale_angles(e, factor);
      }
      if (is_kind(*s, "asset") && !e.Attribute("name") && e.Attribute("file")) {
        const std::filesystem::path file = e.Attribute("file");
        e.SetAttribute("name", file.stem().c_str());
      }
    });
  }
}

}  // namespace lcs::sim::mjcf
