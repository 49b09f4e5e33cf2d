#include "sim/scene/fragment.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <vector>

#include "scenarios/scenes.h"
#include "sim/scene/fragment_contract.h"
#include "sim/scene/mjcf.h"
#include "sim/scene/texture.h"

namespace lcs::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using scenario::Shape;

std::vector<double> numbers(const xml::Element& e, const char* key) {
  return mjcf::numbers(mjcf::effective(e, key));
}

/// Scale factors along the axes of a geom with rotation R in the body.
Vector3d local_factors(const Matrix3d& R, const Vector3d& factor) {
  return (factor.asDiagonal() * R).colwise().norm();
}

/// Scale factor of a radius about an axis. A lying cylinder, for example a wheel, must keep its
/// contact with the ground and scales with the height. An upright cylinder scales with the
/// geometric mean of the two horizontal factors.
double radius_factor(const Vector3d& axis, const Vector3d& factor) {
  return std::abs(axis.z()) < std::sqrt(0.5) ? factor.z() : std::sqrt(factor.x() * factor.y());
}

/// Scales a fragment's geoms and their positions along the axes of its body.
class Scaling {
 public:
  Scaling(xml::Element& root, const Vector3d& factor)
      : assets_(xml::section(root, "asset")), factor_(factor) {}

  /// \param R rotation of the body in the fragment.
  void scale_in(xml::Element& body, const Matrix3d& R) {
    for (auto* e = body.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view kind = e->Name();
      if (kind == "geom") scale_geom(*e, R);
      if (kind != "body") continue;
      scale_places(*e, "pos", R);
      scale_in(*e, R * mjcf::rotation(*e));
    }
  }

 private:
  /// Scales one or more positions whose axes have rotation R.
  void scale_places(xml::Element& e, const char* key, const Matrix3d& R) {
    std::vector<double> values = numbers(e, key);
    if (values.empty() || values.size() % 3 != 0) return;  // MuJoCo reports it
    for (std::size_t i = 0; i < values.size(); i += 3) {
      const Eigen::Map<Vector3d> place(values.data() + i);
      const Vector3d scaled = R.transpose() * factor_.cwiseProduct(R * place);
      std::copy_n(scaled.data(), 3, values.data() + i);
    }
    mjcf::set_numbers(e, key, values);
  }

  void scale_geom(xml::Element& geom, const Matrix3d& R_body) {
    const std::vector<double> size = numbers(geom, "size");
    const std::string type = mjcf::effective(geom, "type");
    scale_places(geom, "pos", R_body);
    const Matrix3d R = R_body * mjcf::rotation(geom);
    const Vector3d local = local_factors(R, factor_);
    if (!mjcf::effective(geom, "mesh").empty()) return scale_mesh(geom, local);
    if (std::vector<double> ends = numbers(geom, "fromto"); ends.size() == 6 && !size.empty()) {
      const Vector3d along =
          R_body * Vector3d(ends[3] - ends[0], ends[4] - ends[1], ends[5] - ends[2]).normalized();
      scale_places(geom, "fromto", R_body);
      mjcf::set_numbers(geom, "size", {size[0] * radius_factor(along, factor_)});
      return;
    }
    // MuJoCo reports missing sizes
    if (type == "sphere" && !size.empty()) {
      geom.SetAttribute("type", "ellipsoid");
      mjcf::set_numbers(geom, "size",
                        {size[0] * local.x(), size[0] * local.y(), size[0] * local.z()});
    } else if ((type == "box" || type == "ellipsoid") && size.size() >= 3) {
      mjcf::set_numbers(geom, "size",
                        {size[0] * local.x(), size[1] * local.y(), size[2] * local.z()});
    } else if ((type == "cylinder" || type == "capsule") && size.size() >= 2) {
      mjcf::set_numbers(geom, "size",
                        {size[0] * radius_factor(R.col(2), factor_), size[1] * local.z()});
    }
  }

  /// Scales the geom's mesh asset, or a copy if another geom needs other factors.
  void scale_mesh(xml::Element& geom, const Vector3d& local) {
    const std::string name = mjcf::effective(geom, "mesh");
    xml::Element* asset = xml::child_named(assets_, "mesh", name);
    if (!asset) return;  // MuJoCo reports it
    std::vector<Scaled>& copies = meshes_[name];
    auto found = std::find_if(copies.begin(), copies.end(),
                              [&](const Scaled& s) { return s.local.isApprox(local); });
    if (found == copies.end()) {
      Scaled scaled{name, local, scale_of(*asset)};
      if (!copies.empty()) {
        asset = assets_.InsertEndChild(asset->DeepClone(assets_.GetDocument()))->ToElement();
        scaled.name = fmt::format("{}:{}", name, copies.size());
        scaled.natural = copies.front().natural;
        asset->SetAttribute("name", scaled.name.c_str());
      }
      const Vector3d scale = scaled.natural.cwiseProduct(local);
      mjcf::set_numbers(*asset, "scale", {scale.x(), scale.y(), scale.z()});
      found = copies.insert(copies.end(), scaled);
    }
    geom.SetAttribute("mesh", found->name.c_str());
  }

  static Vector3d scale_of(const xml::Element& mesh) {
    const std::vector<double> scale = numbers(mesh, "scale");
    return scale.size() == 3 ? Vector3d(scale[0], scale[1], scale[2]) : Vector3d::Ones();
  }

  struct Scaled {
    std::string name;  ///< of the mesh asset
    Vector3d local;    ///< scale factors along the axes of its geoms
    Vector3d natural;  ///< scale in the fragment's file
  };

  xml::Element& assets_;
  Vector3d factor_;
  std::map<std::string, std::vector<Scaled>> meshes_;  ///< by the mesh name in the file
};

/// Renames the texture of the material `paint` to the name that selects its content. Other
/// materials keep their textures.
void paint_fragment(xml::Element& root, const scenario::Actor& actor) {
  if (actor.texture.empty()) return;
  xml::Element& assets = xml::section(root, "asset");
  xml::Element* paint = xml::child_named(assets, "material", "paint");
  const std::string old_name = paint ? mjcf::effective(*paint, "texture") : "";
  xml::Element* texture = xml::child_named(assets, "texture", old_name);
  if (!texture || old_name.empty()) {
    throw input::Error(
        xml::source_of(paint ? *paint : root),
        fmt::format("actor '{}' has the texture '{}', and its file no material 'paint' with a "
                    "texture to put it on; give it <texture name=\"paint\" type=\"cube\" "
                    "builtin=\"flat\" width=\"256\" height=\"1536\"/><material name=\"paint\" "
                    "texture=\"paint\"/>, or the actor no texture",
                    actor.name, actor.texture));
  }
  std::string new_name = kPictureTexture;
  if (is_texture_style(actor.texture)) {
    new_name = fmt::format("{}{}:paint", kProceduralPrefix, actor.texture);
  } else if (!std::filesystem::is_regular_file(actor.texture)) {
    throw input::Error(
        actor.source,
        fmt::format("texture '{}' is no picture that exists and no style; styles are {}",
                    actor.texture, fmt::join(texture_styles(), ", ")));
  }
  bool is_shared = false;
  xml::for_each(assets, [&](const xml::Element& e) {
    is_shared |= &e != paint && mjcf::effective(e, "texture") == old_name;
  });
  if (is_shared) {
    texture = assets.InsertEndChild(texture->DeepClone(assets.GetDocument()))->ToElement();
  }
  texture->SetAttribute("name", new_name.c_str());
  paint->SetAttribute("texture", new_name.c_str());
}

/// Actors and holonomic rovers follow their commands exactly and have no contacts.
void take_contacts_away(xml::Element& root) {
  xml::for_each(xml::section(root, "worldbody"), [](xml::Element& e) {
    if (!xml::is_kind(e, "geom")) return;
    e.SetAttribute("contype", "0");
    e.SetAttribute("conaffinity", "0");
  });
}

}  // namespace

Vector3d natural_size(xml::Element& root, const std::string& prefix) {
  const xml::Element* size =
      xml::child_named(xml::section(root, "custom"), "numeric", prefix + "size");
  const std::vector<double> values = numbers(*size, "data");
  return {values.at(0), values.at(1), values.at(2)};
}

bool has_picture(const scenario::Actor& actor) {
  return !actor.texture.empty() && !is_texture_style(actor.texture);
}

xml::Document actor_fragment(const scenario::Actor& actor, const xml::Element& scene) {
  xml::Document document = xml::load(scenario::actor_file(actor), actor.source);
  xml::Element& root = *document->RootElement();
  mjcf::make_standalone(root, scene);
  check_actor(root);
  if (actor.size_m) {
    const Vector3d& size = *actor.size_m;
    if (actor.shape == Shape::cylinder && size.x() != size.y()) {
      throw input::Error(actor.source, "a cylinder is round: give the same length and width");
    }
    const Vector3d factor = size.cwiseQuotient(natural_size(root, ""));
    xml::Element& base = *xml::child_named(xml::section(root, "worldbody"), "body", "base");
    if (!factor.isApproxToConstant(1)) Scaling(root, factor).scale_in(base, Matrix3d::Identity());
  }
  paint_fragment(root, actor);
  take_contacts_away(root);
  xml::prefix_names(root, actor.name + "/");
  return document;
}

xml::Document rover_fragment(const scenario::Ego& ego, const xml::Element& scene) {
  xml::Document document = xml::load(scenario::rover_file(ego), ego.source);
  xml::Element& root = *document->RootElement();
  mjcf::make_standalone(root, scene);
  check_rover(root);
  // the file's cameras are for a viewer; their names may clash with the scenario's camera
  xml::remove_all(root, "camera");
  if (!is_wheeled(root)) take_contacts_away(root);
  xml::prefix_names(root, kEgoPrefix);
  return document;
}

}  // namespace lcs::sim
