#include "sim/camera/lens_renderer.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "sim/base/trial.h"
#include "sim/camera/gl_context.h"

namespace lcs::sim {
namespace {

constexpr double kNear = 0.05;     // m
constexpr double kLeastFar = 100;  // m

// Side of a shadow map, in texels; it spans twice the scene's extent for a directional light.
constexpr int kShadowMap = 4096;

// Constants of GL/gl.h and GL/glext.h, which need not be installed.
constexpr unsigned kRenderbuffer = 0x8D41, kRgba16 = 0x805B;
constexpr unsigned kRgba = 0x1908, kUnsignedShort = 0x1403;
constexpr unsigned kFramebuffer = 0x8D40, kComplete = 0x8CD5;
constexpr unsigned kCompile = 0x1300, kQuadStrip = 8, kTriangleFan = 6;
constexpr unsigned kModelview = 0x1700;
constexpr unsigned kFirstClipPlane = 0x3001;  // MuJoCo uses the one before for reflections
constexpr unsigned kClipPlanes = 4;

/// Draws cylinders rounder than MuJoCo does, and with fewer triangles.
///
/// MuJoCo's cylinder has 28 sides, each cut into 16 quads along the axis. The sides leave the
/// outline up to .6 % of the radius inside the circle; the cuts serve lamps near the surface alone,
/// and are most of the time that a scene with many poles takes.
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

/// Texture of a geom by the rules of mjr_render: its own, or that of its material; -1: none.
int texture_of(const mjvGeom& geom, const mjrContext& context) {
  if (geom.texid >= 0) return geom.texid;
  return geom.matid < 0 ? -1 : context.mat_texid[mjNTEXROLE * geom.matid + mjTEXROLE_RGB];
}

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

/// Whether light is even on every flat surface, so that it needs no vertices inside.
bool has_only_directional_lights(const mjModel& m) {
  return std::all_of(m.light_type, m.light_type + m.nlight,
                     [](int type) { return type == mjLIGHT_DIRECTIONAL; });
}

void prepare(mjModel& m, cv::Size buffer_px, bool has_shadows) {
  m.vis.global.offwidth = buffer_px.width;
  m.vis.global.offheight = buffer_px.height;
  m.vis.quality.offsamples = 0;
  if (has_only_directional_lights(m)) m.vis.quality.numquads = 1;
  m.vis.quality.shadowsize = has_shadows ? kShadowMap : 0;
  // MuJoCo's clipping planes are in multiples of the scene's extent
  const double extent = m.stat.extent;
  m.vis.map.znear = static_cast<float>(kNear / extent);
  m.vis.map.zfar = static_cast<float>(std::max(kLeastFar, 4 * extent) / extent);
  // a directional light that moves with the camera is no property of the world
  auto& head = m.vis.headlight;
  for (int c = 0; c < 3; ++c) {
    head.ambient[c] = std::min(1.F, head.ambient[c] + head.diffuse[c] / 2);
    head.diffuse[c] = 0;
    head.specular[c] = 0;
  }
}

/// Mesa crashes when it runs out of memory. \throws std::runtime_error if the memory limit (ulimit
/// -v) is too small to render an image. Checks at the first renderer of the process only.
void check_memory(Model& model, int camera, const View& colour, const View& truth,
                  const GeomGroups& groups, bool has_shadows) {
  static std::atomic<bool> checked = false;
  struct rlimit memory = {};
  if (::getrlimit(RLIMIT_AS, &memory) != 0 || memory.rlim_cur == RLIM_INFINITY ||
      checked.exchange(true)) {
    return;
  }
  constexpr rlim_t kForTheRest = rlim_t{256} << 20;  // memory for all else in a run
  const Trial trial = try_in_child([&] {
    memory.rlim_cur -= std::min(memory.rlim_cur, kForTheRest);
    ::setrlimit(RLIMIT_AS, &memory);
    CameraRenderer renderer(model, camera, colour, truth, groups, has_shadows);
    cv::Mat1f depth;
    cv::Mat1i geoms;
    renderer.update();
    renderer.render_codes();
    renderer.render_depth_and_geoms(depth, geoms);
  });
  if (trial.fine) return;
  checked = false;
  throw std::runtime_error(
      fmt::format("software GL draws no picture of {}x{} with {} MB of memory ({}); raise ulimit "
                  "-v, or choose a smaller camera size",
                  truth.pinhole.width_px, truth.pinhole.height_px, memory.rlim_cur >> 20,
                  trial.crash.empty() ? trial.refused : trial.crash));
}

}  // namespace

struct CameraRenderer::Impl {
  Model& model;
  const View colour, truth;
  const cv::Size buffer_px;
  GlContext gl;
  Drawables drawables;
  mjvScene& scene = drawables.scene();
  mjrContext context;
  RoundCylinders cylinders;
  std::array<mjvGLCamera, 2> eyes;  ///< of the model's camera, after an update
  cv::Mat4w codes;
  cv::Mat4w ids;
  cv::Mat1f z;

  Impl(Model& model_, int camera, const View& colour_, const View& truth_, const GeomGroups& groups,
       bool has_shadows)
      : model(model_),
        colour(colour_),
        truth(truth_),
        buffer_px(std::max(colour.pinhole.width_px, truth.pinhole.width_px),
                  std::max(colour.pinhole.height_px, truth.pinhole.height_px)),
        drawables(model, groups, camera) {
    prepare(model.m(), buffer_px, has_shadows);
    mjr_defaultContext(&context);
    try {
      start();
    } catch (...) {
      release();
      throw;
    }
  }
  ~Impl() { release(); }

  void start() {
    std::string problem;
    try {
      call_mujoco([&] {
        mjr_makeContext(&model.m(), &context, mjFONTSCALE_100);
        mjr_setBuffer(mjFB_OFFSCREEN, &context);
      });
    } catch (const MujocoError& e) {
      problem = e.what();
    }
    if (problem.empty()) problem = take_warning();
    const mjrRect buffer = problem.empty() ? mjr_maxViewport(&context) : mjrRect{0, 0, 0, 0};
    if (context.currentBuffer != mjFB_OFFSCREEN || buffer.width < buffer_px.width ||
        buffer.height < buffer_px.height) {
      const bool is_picture = problem.empty() || problem.find("ffscreen") != std::string::npos;
      throw std::runtime_error(
          is_picture ? fmt::format("software GL does not render images of {}x{}, from samples of "
                                   "{}x{} ({}); choose a smaller camera size, or fewer "
                                   "image.samples",
                                   truth.pinhole.width_px, truth.pinhole.height_px,
                                   colour.pinhole.width_px, colour.pinhole.height_px, problem)
                     : fmt::format("software GL does not take the scene ({}); choose fewer or "
                                   "smaller textures and meshes",
                                   problem));
    }
    const int stacks = has_only_directional_lights(model.m()) ? 1 : model.m().vis.quality.numstacks;
    cylinders.compile(gl, stacks);
    refine_codes();
    set_clip_planes();
    const Pinhole& p = truth.pinhole;
    codes.create(colour.pinhole.height_px, colour.pinhole.width_px);
    ids.create(p.height_px, p.width_px);
    z.create(p.height_px, p.width_px);
  }

  /// Gives MuJoCo's colour buffer 16 bits: in the dark, a step of 8 bits is more light than an
  /// event camera's threshold.
  void refine_codes() {
    gl.function<void(unsigned, unsigned)>("glBindRenderbuffer")(kRenderbuffer, context.offColor);
    gl.function<void(unsigned, unsigned, int, int)>("glRenderbufferStorage")(
        kRenderbuffer, kRgba16, buffer_px.width, buffer_px.height);
    if (gl.function<unsigned(unsigned)>("glCheckFramebufferStatus")(kFramebuffer) != kComplete) {
      throw std::runtime_error(fmt::format(
          "GL draws no codes of 16 bits into a picture of {}x{}; choose a smaller camera size, or "
          "another LCS_GL",
          buffer_px.width, buffer_px.height));
    }
  }

  /// Sets planes that cut off what lies beside the used rays of the colour view.
  void set_clip_planes() {
    if (!colour.used) return;
    // the camera's right and top, and the axis backwards, in the axes of the view
    const double c = std::cos(colour.roll_rad), s = std::sin(colour.roll_rad);
    const Eigen::Vector3d right(c, -s, 0), up(s, c, 0), back(0, 0, 1);
    const Eigen::Vector2d low = colour.used->min(), high = colour.used->max();
    const std::array<Eigen::Vector3d, kClipPlanes> inside{
        right + low.x() * back, -right - high.x() * back, low.y() * back - up,
        up - high.y() * back};
    gl.function<void(unsigned)>("glMatrixMode")(kModelview);
    gl.function<void()>("glLoadIdentity")();
    for (unsigned i = 0; i < kClipPlanes; ++i) {
      const Eigen::Vector4d plane(inside[i].x(), inside[i].y(), inside[i].z(), 0);
      gl.function<void(unsigned, const double*)>("glClipPlane")(kFirstClipPlane + i, plane.data());
    }
  }

  void enable_clip_planes(bool is_on) {
    auto* const set = gl.function<void(unsigned)>(is_on ? "glEnable" : "glDisable");
    for (unsigned i = 0; i < kClipPlanes; ++i) set(kFirstClipPlane + i);
  }

  void release() {
    try {
      gl.make_current();
    } catch (const std::runtime_error&) {
      return;  // destroying the GL context also frees these resources
    }
    mjr_freeContext(&context);
  }

  /// Lets the scene be seen by a view.
  void aim(const View& view) {
    const Pinhole& p = view.pinhole;
    const double c = std::cos(view.roll_rad), s = std::sin(view.roll_rad);
    for (std::size_t i = 0; i < eyes.size(); ++i) {
      mjvGLCamera& eye = scene.camera[i] = eyes[i];
      const Eigen::Map<const Eigen::Vector3f> up(eyes[i].up), forward(eyes[i].forward);
      const Eigen::Vector3d right = forward.cross(up).cast<double>();
      Eigen::Map<Eigen::Vector3f>(eye.up) = (c * up.cast<double>() - s * right).cast<float>();
      const double per_px = eye.frustum_near / p.focal_px;
      const Eigen::Vector2d to_edge = p.centre_px.array() + 0.5;
      eye.frustum_center = static_cast<float>(per_px * (p.width_px / 2.0 - to_edge.x()));
      eye.frustum_width = static_cast<float>(per_px * p.width_px / 2.0);
      eye.frustum_top = static_cast<float>(per_px * to_edge.y());
      eye.frustum_bottom = static_cast<float>(per_px * (to_edge.y() - p.height_px));
    }
  }

  /// \return the part of the buffer that shows the view.
  mjrRect render(const View& view) {
    aim(view);
    const mjrRect part{0, 0, view.pinhole.width_px, view.pinhole.height_px};
    gl.make_current();
    call_mujoco([&] {
      mjr_setBuffer(mjFB_OFFSCREEN, &context);
      mjr_render(part, &scene, &context);
    });
    return part;
  }

  /// By GL, not by mjr_readPixels, which converts to 8 bits.
  void read(const mjrRect& part, cv::Mat4w& to) const {
    gl.function<void(int, int, int, int, unsigned, unsigned, void*)>("glReadPixels")(
        part.left, part.bottom, part.width, part.height, kRgba, kUnsignedShort, to.data);
  }

  /// \param id_colour by `mjRND_IDCOLOR`: index in the scene, from 1.
  int geom_of(int id_colour) const {
    const int index = id_colour - 1;
    return index < 0 || index >= scene.ngeom ? -1 : scene.geoms[index].objid;
  }
};

CameraRenderer::CameraRenderer(Model& model, int camera, const View& colour, const View& truth,
                               const GeomGroups& groups, bool has_shadows) {
  check_memory(model, camera, colour, truth, groups, has_shadows);
  impl_ = std::make_unique<Impl>(model, camera, colour, truth, groups, has_shadows);
}

CameraRenderer::~CameraRenderer() = default;

void CameraRenderer::update() {
  Impl& s = *impl_;
  s.drawables.update(s.model);
  s.cylinders.replace(s.scene, s.context);
  std::copy_n(s.scene.camera, s.eyes.size(), s.eyes.begin());
}

const cv::Mat4w& CameraRenderer::render_codes(bool has_shadows) {
  Impl& s = *impl_;
  s.gl.make_current();
  // the planes would cut the shadow maps, too
  const bool is_clipped = s.colour.used && !has_shadows;
  if (is_clipped) s.enable_clip_planes(true);
  s.scene.flags[mjRND_SHADOW] = has_shadows;
  const mjrRect part = s.render(s.colour);
  s.scene.flags[mjRND_SHADOW] = 0;
  if (is_clipped) s.enable_clip_planes(false);
  s.read(part, s.codes);
  return s.codes;
}

void CameraRenderer::render_depth_and_geoms(cv::Mat1f& depth_m, cv::Mat1i& geom) {
  Impl& s = *impl_;
  s.scene.flags[mjRND_SEGMENT] = 1;
  s.scene.flags[mjRND_IDCOLOR] = 1;
  const mjrRect part = s.render(s.truth);
  call_mujoco([&] { mjr_readPixels(nullptr, s.z[0], part, &s.context); });
  s.read(part, s.ids);
  s.scene.flags[mjRND_SEGMENT] = 0;
  s.scene.flags[mjRND_IDCOLOR] = 0;

  depth_m.create(part.height, part.width);
  geom.create(part.height, part.width);
  const float n = s.scene.camera[0].frustum_near;
  const float f = s.scene.camera[0].frustum_far;
  for (int y = 0; y < part.height; ++y) {
    const int read = part.height - 1 - y;  // read-back is bottom row first
    const cv::Vec4w* id = s.ids[read];
    const float* z = s.z[read];
    float* depth = depth_m[y];
    int* to = geom[y];
    // neighbouring pixels mostly show the same geom
    int colour = 0, shown = s.geom_of(colour);
    for (int x = 0; x < part.width; ++x) {
      // a byte of an id is in both bytes of its code
      const int next = (id[x][0] & 255) | (id[x][1] & 255) << 8 | (id[x][2] & 255) << 16;
      if (next != colour) shown = s.geom_of(colour = next);
      to[x] = shown;
      depth[x] = to[x] < 0 ? std::numeric_limits<float>::infinity() : n * f / (f - z[x] * (f - n));
    }
  }
}

std::string CameraRenderer::gl_renderer() const {
  return impl_->gl.renderer();
}

double CameraRenderer::near_m() const {
  return impl_->scene.camera[0].frustum_near;
}

}  // namespace lcs::sim
