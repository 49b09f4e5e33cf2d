#include "tests/benchmark/raw_renderer.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "sim/camera/gl_context.h"
#include "sim/camera/lens_renderer.h"
#include "sim/scene/mujoco.h"

namespace lcs::test {
namespace {

constexpr int kDefaultShadowSize = 4096;  // MuJoCo's, texels
constexpr int kSpareGeoms = 64;           // for geoms that the model does not contain

/// Applies all that the project's renderer writes into a model, and then the settings.
void prepare(sim::World& world, const cv::Size& size_px, const RenderSettings& settings) {
  mjModel& m = world.model().m();
  const sim::LensRenderer prepares(world.model(), world.camera_id(),
                                   sim::Pinhole::from_fovy(size_px.width, size_px.height, 1), 1);
  m.vis.quality.offsamples = settings.samples;
  if (settings.shadows) {
    m.vis.quality.shadowsize = kDefaultShadowSize;
    for (int light = 0; light < m.nlight; ++light) m.light_castshadow[light] = 1;
  }
}

}  // namespace

struct RawRenderer::Impl {
  sim::World& world;
  RenderSettings settings;
  mjrRect viewport;
  sim::GlContext gl;
  mjvScene scene;
  mjvOption option;
  mjvPerturb perturb;
  mjvCamera camera;
  mjrContext context;
  std::vector<unsigned char> colour, ids;
  std::vector<float> depth;

  Impl(sim::World& world_, const cv::Size& size_px, const RenderSettings& settings_)
      : world(world_), settings(settings_), viewport{0, 0, size_px.width, size_px.height} {
    prepare(world, size_px, settings);
    mjv_defaultScene(&scene);
    mjr_defaultContext(&context);
    mjv_defaultOption(&option);
    mjv_defaultPerturb(&perturb);
    mjv_defaultCamera(&camera);
    std::fill(std::begin(option.sitegroup), std::end(option.sitegroup), mjtByte{0});
    camera.type = mjCAMERA_FIXED;
    camera.fixedcamid = world.camera_id();
    const mjModel& m = world.model().m();
    mjv_makeScene(&m, &scene, static_cast<int>(m.ngeom) + kSpareGeoms);
    for (const int flag : {mjRND_REFLECTION, mjRND_FOG, mjRND_HAZE}) scene.flags[flag] = 0;
    scene.flags[mjRND_SHADOW] = settings.shadows;
    gl.make_current();
    mjr_makeContext(&m, &context, mjFONTSCALE_100);
    mjr_setBuffer(mjFB_OFFSCREEN, &context);
    const auto pixels = static_cast<std::size_t>(size_px.area());
    colour.resize(3 * pixels);
    ids.resize(3 * pixels);
    depth.resize(pixels);
  }
  ~Impl() {
    mjv_freeScene(&scene);
    gl.make_current();
    mjr_freeContext(&context);
  }

  void draw(unsigned char* rgb, float* z) {
    gl.make_current();
    mjr_setBuffer(mjFB_OFFSCREEN, &context);
    mjr_render(viewport, &scene, &context);
    if (settings.read_back) {
      mjr_readPixels(rgb, z, viewport, &context);
    } else {
      gl.function<void()>("glFinish")();
    }
  }

  /// Depth and ids need no shadows.
  void draw_truth() {
    if (settings.truth == TruthRenders::none) return;
    const bool apart = settings.truth == TruthRenders::apart;
    scene.flags[mjRND_SHADOW] = 0;
    if (apart) draw(nullptr, depth.data());
    scene.flags[mjRND_SEGMENT] = scene.flags[mjRND_IDCOLOR] = 1;
    draw(ids.data(), apart ? nullptr : depth.data());
    scene.flags[mjRND_SEGMENT] = scene.flags[mjRND_IDCOLOR] = 0;
    scene.flags[mjRND_SHADOW] = settings.shadows;
  }
};

RawRenderer::RawRenderer(sim::World& world, const cv::Size& size_px, const RenderSettings& settings)
    : impl_(std::make_unique<Impl>(world, size_px, settings)) {
  const Impl& s = *impl_;
  if (s.context.offSamples != settings.samples ||
      (settings.shadows && s.context.shadowSize != kDefaultShadowSize)) {
    throw std::runtime_error("software GL has no such samples or shadows");
  }
}
RawRenderer::~RawRenderer() = default;

void RawRenderer::render() {
  Impl& s = *impl_;
  mjv_updateScene(&s.world.model().m(), &s.world.model().d(), &s.option, &s.perturb, &s.camera,
                  mjCAT_ALL, &s.scene);
  s.draw(s.colour.data(), nullptr);
  s.draw_truth();
}

cv::Mat3b RawRenderer::picture() const {
  const Impl& s = *impl_;
  cv::Mat3b picture;
  const cv::Mat rgb(s.viewport.height, s.viewport.width, CV_8UC3,
                    const_cast<unsigned char*>(s.colour.data()));
  cv::cvtColor(rgb, picture, cv::COLOR_RGB2BGR);
  cv::flip(picture, picture, 0);  // read-back is bottom row first
  return picture;
}

}  // namespace lcs::test
