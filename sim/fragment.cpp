#include "sim/fragment.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>
#include <vector>

#include "scenarios/scenes.h"
#include "sim/texture.h"

namespace lcs::sim {
namespace {

using scenario::Shape;

const char* file_of(Shape shape) {
  switch (shape) {
    case Shape::box:
      return "actors/box.xml";
    case Shape::cylinder:
      return "actors/cylinder.xml";
    case Shape::pedestrian:
      return "actors/pedestrian.xml";
    case Shape::car:
      return "actors/car.xml";
  }
  throw std::invalid_argument("unknown shape of an actor");
}

std::vector<double> numbers(const xml::Element& e, const char* key) {
  std::vector<double> values;
  std::istringstream text(xml::attribute(e, key));
  for (double value; text >> value;) values.push_back(value);
  return values;
}

void set_numbers(xml::Element& e, const char* key, const std::vector<double>& values) {
  e.SetAttribute(key, fmt::format("{:.17g}", fmt::join(values, " ")).c_str());
}

Eigen::Vector3d natural_size(xml::Element& root) {
  const xml::Element* size = xml::child_named(xml::section(root, "custom"), "numeric", "size");
  const std::vector<double> values = size ? numbers(*size, "data") : std::vector<double>{};
  if (values.size() != 3) {
    throw std::runtime_error(
        "an actor's fragment must state its natural size: "
        "<custom><numeric name=\"size\" data=\"x y z\"/></custom>");
  }
  return {values[0], values[1], values[2]};
}

Eigen::Matrix3d rotation(const xml::Element& geom) {
  const std::vector<double> q = numbers(geom, "quat");
  if (q.size() != 4) return Eigen::Matrix3d::Identity();
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

/// Factors along the axes of a geom whose frame stands at R in the body.
Eigen::Vector3d local_factors(const Eigen::Matrix3d& R, const Eigen::Vector3d& factor) {
  return (factor.asDiagonal() * R).colwise().norm();
}

/// Factor of the radius of what is round about an axis: what lies, as a wheel does, must keep
/// standing on the ground, so it grows with the height; what stands takes the mean of the factors
/// across.
double radius_factor(const Eigen::Vector3d& axis, const Eigen::Vector3d& factor) {
  return std::abs(axis.z()) < std::sqrt(0.5) ? factor.z() : std::sqrt(factor.x() * factor.y());
}

void scale_vector(xml::Element& geom, const char* key, const Eigen::Vector3d& factor) {
  std::vector<double> values = numbers(geom, key);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] *= factor[i % 3];
  if (!values.empty()) set_numbers(geom, key, values);
}

void scale_geom(xml::Element& geom, const Eigen::Vector3d& factor) {
  std::vector<double> size = numbers(geom, "size");
  const std::string type = xml::attribute(geom, "type");
  scale_vector(geom, "pos", factor);

  if (std::vector<double> ends = numbers(geom, "fromto"); ends.size() == 6) {
    const Eigen::Vector3d along =
        Eigen::Vector3d(ends[3] - ends[0], ends[4] - ends[1], ends[5] - ends[2]).normalized();
    scale_vector(geom, "fromto", factor);
    set_numbers(geom, "size", {size.at(0) * radius_factor(along, factor)});
    return;
  }
  if (type == "mesh") return;  // its asset is scaled
  const Eigen::Matrix3d R = rotation(geom);
  const Eigen::Vector3d local = local_factors(R, factor);
  if (type == "box" || type == "ellipsoid") {
    set_numbers(geom, "size",
                {size.at(0) * local.x(), size.at(1) * local.y(), size.at(2) * local.z()});
  } else if (type == "sphere" || type.empty()) {
    const double r = size.at(0);
    geom.SetAttribute("type", "ellipsoid");
    set_numbers(geom, "size", {r * local.x(), r * local.y(), r * local.z()});
  } else {
    set_numbers(geom, "size",
                {size.at(0) * radius_factor(R.col(2), factor), size.at(1) * local.z()});
  }
}

bool is_style(const std::string& texture) {
  const auto& styles = texture_styles();
  return std::find(styles.begin(), styles.end(), texture) != styles.end();
}

/// Gives the texture of the material `paint` the name that says what to fill it with.
void paint_fragment(xml::Element& root, const scenario::Actor& actor) {
  if (actor.texture.empty()) return;
  xml::Element& assets = xml::section(root, "asset");
  xml::Element* material = xml::child_named(assets, "material", "paint");
  const std::string old_name = material ? xml::attribute(*material, "texture") : "";
  xml::Element* texture = xml::child_named(assets, "texture", old_name);
  if (!texture)
    throw std::runtime_error("an actor's fragment needs a material 'paint' with a texture");

  std::string new_name = kPictureTexture;
  if (is_style(actor.texture)) {
    new_name = fmt::format("{}{}:paint", kProceduralPrefix, actor.texture);
  } else if (!std::filesystem::is_regular_file(actor.texture)) {
    throw scenario::Error(
        actor.source,
        fmt::format("texture '{}' is no picture that exists and no style; styles are {}",
                    actor.texture, fmt::join(texture_styles(), ", ")));
  }
  texture->SetAttribute("name", new_name.c_str());
  xml::for_each(assets, [&](xml::Element& e) {
    if (xml::attribute(e, "texture") == old_name) e.SetAttribute("texture", new_name.c_str());
  });
}

}  // namespace

void scale_fragment(xml::Element& root, const Eigen::Vector3d& size_m) {
  const Eigen::Vector3d factor = size_m.cwiseQuotient(natural_size(root));
  if (factor.isApproxToConstant(1)) return;
  xml::for_each(xml::section(root, "asset"), [&](xml::Element& e) {
    if (std::string_view(e.Name()) != "mesh") return;
    if (numbers(e, "scale").size() != 3) set_numbers(e, "scale", {1, 1, 1});
    scale_vector(e, "scale", factor);
  });
  xml::for_each(xml::section(root, "worldbody"), [&](xml::Element& e) {
    if (std::string_view(e.Name()) == "geom") scale_geom(e, factor);
  });
}

bool has_picture(const scenario::Actor& actor) {
  return !actor.texture.empty() && !is_style(actor.texture);
}

xml::Document actor_fragment(const scenario::Actor& actor) {
  xml::Document document = xml::load(scenario::shipped_file(file_of(actor.shape)), actor.source);
  xml::Element& root = *document->RootElement();
  if (actor.size_m) {
    const Eigen::Vector3d& size = *actor.size_m;
    if (actor.shape == Shape::cylinder && size.x() != size.y()) {
      throw scenario::Error(actor.source, "a cylinder is round: give the same length and width");
    }
    scale_fragment(root, size);
  }
  paint_fragment(root, actor);
  xml::prefix_names(root, actor.name + "/");
  return document;
}

}  // namespace lcs::sim
