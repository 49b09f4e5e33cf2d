#include "sim/camera/round_cylinders.h"

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lcs::sim {
namespace {

// Constants of GL/gl.h, which need not be installed.
constexpr unsigned kCompile = 0x1300, kQuadStrip = 8, kTriangleFan = 6;

/// Texture of a geom by the rules of mjr_render: its own, or that of its material; -1: none.
int texture_of(const mjvGeom& geom, const mjrContext& context) {
  if (geom.texid >= 0) return geom.texid;
  return geom.matid < 0 ? -1 : context.mat_texid[mjNTEXROLE * geom.matid + mjTEXROLE_RGB];
}

}  // namespace

void RoundCylinders::compile(const GlContext& gl, int stacks) {
  auto* const begin = gl.function<void(unsigned)>("glBegin");
  auto* const end = gl.function<void()>("glEnd");
  auto* const normal = gl.function<void(float, float, float)>("glNormal3f");
  auto* const texture = gl.function<void(float, float)>("glTexCoord2f");
  auto* const vertex = gl.function<void(float, float, float)>("glVertex3f");
  const auto around = [](int side) {
    const double angle = 2 * std::numbers::pi * (side % kSides) / kSides;
    return Eigen::Vector2d(std::cos(angle), std::sin(angle)).cast<float>().eval();
  };
  list_ = gl.function<unsigned(int)>("glGenLists")(1);
  if (list_ == 0) throw std::runtime_error("software GL has no memory for a shape");
  gl.function<void(unsigned, unsigned)>("glNewList")(list_, kCompile);
  // texture coordinates as MuJoCo's: around the axis and down; on the ends as seen from above
  for (int stack = 0; stack < stacks; ++stack) {
    begin(kQuadStrip);
    for (int side = 0; side <= kSides; ++side) {
      const Eigen::Vector2f at = around(side);
      normal(at.x(), at.y(), 0);
      for (const int level : {stack + 1, stack}) {
        const float up = static_cast<float>(level) / static_cast<float>(stacks);
        texture(static_cast<float>(side) / kSides, 1 - up);
        vertex(at.x(), at.y(), 2 * up - 1);
      }
    }
    end();
  }
  for (const int top : {-1, 1}) {
    const auto z = static_cast<float>(top);
    begin(kTriangleFan);
    normal(0, 0, z);
    texture(0.5F, 0.5F);
    vertex(0, 0, z);
    for (int side = 0; side <= kSides; ++side) {
      const Eigen::Vector2f at = around(top > 0 ? side : kSides - side);
      texture(0.5F + 0.5F * at.x(), 0.5F + 0.5F * at.y());
      vertex(at.x(), at.y(), z);
    }
    end();
  }
  gl.function<void()>("glEndList")();
}

void RoundCylinders::replace(mjvScene& scene, const mjrContext& context) const {
  for (int i = 0; i < scene.ngeom; ++i) {
    mjvGeom& geom = scene.geoms[i];
    if (geom.type != mjGEOM_CYLINDER) continue;
    geom.type = mjGEOM_MESH;
    // mjr_render calls the list `baseMesh + dataid`
    geom.dataid = static_cast<int>(list_) - static_cast<int>(context.baseMesh);
    for (int k = 0; k < 9; ++k) geom.mat[k] *= geom.size[k % 3];
    const int texture = texture_of(geom, context);
    geom.texcoord = texture >= 0 && context.textureType[texture] == mjTEXTURE_2D;
  }
}

}  // namespace lcs::sim
