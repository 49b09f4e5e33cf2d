/// \file
/// The parts of a model that the camera sees: the geoms of the chosen groups, each opaque.
///
/// True depth, masks and motion are of geoms. MuJoCo also draws parts without such truth: rays of
/// range finders, tendons, skins, flexes, sites and other aids. None of these is drawn here. A geom
/// with an alpha between 0 and 1 would show a second surface in the same pixel; it is drawn opaque,
/// unless that surface is right behind it and as fixed as it is (a stain, a painted shadow).
/// Highlights (`specular`) move over a surface with the camera; they are not drawn.
#pragma once

#include <array>
#include <set>
#include <utility>
#include <vector>

#include "sim/scene/model.h"

namespace lcs::sim {

/// Whether the geoms of each of MuJoCo's groups are drawn.
using GeomGroups = std::array<bool, mjNGROUP>;
/// The groups that MuJoCo draws by default.
inline constexpr GeomGroups kUsualGroups{true, true, true};

/// MuJoCo's abstract scene of a model. Needs no GL.
class Drawables {
 public:
  /// \param model after a forward pass. \param camera of the model.
  Drawables(Model& model, const GeomGroups& groups, int camera);
  ~Drawables();
  Drawables(const Drawables&) = delete;
  Drawables& operator=(const Drawables&) = delete;

  /// Takes the poses of the model's last forward pass, and places directional lights so that all
  /// within the scene's extent can cast shadows.
  void update(Model& model);
  mjvScene& scene() { return scene_; }

  /// The alpha of a geom, as its file has it; 0 for a geom that is not drawn.
  float alpha(int geom) const { return alpha_[static_cast<std::size_t>(geom)]; }
  /// Whether a geom keeps its alpha.
  bool is_stain(int geom) const { return stains_.contains(geom); }

 private:
  void collect(Model& model);

  std::vector<float> alpha_;
  std::set<int> stains_;
  mjvScene scene_;
  mjvOption option_;
  mjvPerturb perturb_;
  mjvCamera camera_;
};

/// The parts of the model that MuJoCo draws by default as surfaces of their own, and that are not
/// drawn here, because they have no truth: kind and id of skins, tendons, flexes and sites that are
/// larger than a mark.
std::vector<std::pair<mjtObj, int>> undrawn_parts(const Model& model);

}  // namespace lcs::sim
