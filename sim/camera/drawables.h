/// \file
/// The parts of a model that the camera sees: the geoms of the chosen groups, each opaque.
///
/// Depth, masks and motion are those of geoms. MuJoCo also draws parts without such truth: rays of
/// range finders, tendons, skins, flexes, sites and other aids. None of these is drawn here. A geom
/// with an alpha between 0 and 1 would show a second surface in the same pixel; it is drawn opaque.
/// Highlights (`specular`) move over a surface with the camera; they are not drawn.
#pragma once

#include <array>
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
  /// \param camera of the model.
  Drawables(const Model& model, const GeomGroups& groups, int camera);
  ~Drawables();
  Drawables(const Drawables&) = delete;
  Drawables& operator=(const Drawables&) = delete;

  /// Takes the poses of the model's last forward pass.
  void update(Model& model);
  mjvScene& scene() { return scene_; }

  /// The alpha of each geom of the model, as its file has it; 0 for a geom that is not drawn.
  static std::vector<float> alpha(Model& model, const GeomGroups& groups, int camera);

 private:
  void collect(Model& model);

  mjvScene scene_;
  mjvOption option_;
  mjvPerturb perturb_;
  mjvCamera camera_;
};

/// The parts of the model that MuJoCo draws by default as surfaces of their own, and that are not
/// drawn here, because they have no truth: kind and id of skins and tendons.
std::vector<std::pair<mjtObj, int>> undrawn_parts(const Model& model);

}  // namespace lcs::sim
