/// \file
/// Draws cylinders rounder than MuJoCo does, and with fewer triangles.
///
/// MuJoCo's cylinder has 28 sides, each cut into 16 quads along the axis. The sides leave the
/// outline up to .6 % of the radius inside the circle; the cuts serve lamps near the surface alone,
/// and are most of the time that a scene with many poles takes.
#pragma once

#include "sim/camera/gl_context.h"
#include "sim/scene/mujoco.h"

namespace lcs::sim {

class RoundCylinders {
 public:
  static constexpr int kSides = 64;  ///< outline at most .12 % of the radius inside the circle

  /// Compiles the shape in the current context. \param stacks cuts along the axis: 1 where all
  /// lights are directional, as light is then even along it.
  void compile(const GlContext& gl, int stacks);

  /// Lets a scene's cylinders be drawn by this shape: as meshes, scaled by their orientation.
  /// \param context of the scene, whose lists of meshes give the numbers.
  void replace(mjvScene& scene, const mjrContext& context) const;

 private:
  unsigned list_ = 0;  ///< of GL; the context frees it
};

}  // namespace lcs::sim
