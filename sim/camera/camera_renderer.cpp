#include "sim/camera/camera_renderer.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "sim/camera/gl_context.h"
#include "sim/scene/trial.h"

namespace lcs::sim {
namespace {

constexpr double kNear = 0.05;     // m
constexpr double kLeastFar = 100;  // m
// Standard deviation of the lens's point spread.
constexpr double kLensBlur_px = 0.6;

// Side of a shadow map, in texels; it spans twice the scene's extent for a directional light.
constexpr int kShadowMap = 4096;
// Least difference of the share of light from pixel to pixel at the edge of a shadow.
constexpr double kShadowStep = 0.04;

void prepare(mjModel& m, int width_px, int height_px, bool has_shadows) {
  m.vis.global.offwidth = width_px;
  m.vis.global.offheight = height_px;
  m.vis.quality.offsamples = 0;
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
void check_memory(Model& model, const GeomGroups& groups, int camera, int width_px, int height_px,
                  bool has_shadows) {
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
    CameraRenderer renderer(model, camera, width_px, height_px, groups, has_shadows);
    cv::Mat3b picture;
    cv::Mat1f depth;
    cv::Mat1i geoms;
    renderer.update();
    renderer.render_colour(picture);
    renderer.render_depth_and_geoms(depth, geoms);
  });
  if (trial.fine) return;
  checked = false;
  throw std::runtime_error(
      fmt::format("software GL draws no picture of {}x{} with {} MB of memory ({}); raise ulimit "
                  "-v, or choose a smaller camera size",
                  width_px, height_px, memory.rlim_cur >> 20,
                  trial.crash.empty() ? trial.refused : trial.crash));
}

double sum(const cv::Vec3b& colour) {
  return colour[0] + colour[1] + colour[2];
}

/// The most by which rounding to grey levels changes the share of light of a pixel.
double rounding(const cv::Vec3b& even) {
  return 3 / std::max(sum(even), 1.0);
}

/// The share of its light that each pixel keeps in shadow.
cv::Mat1f shares_of(const cv::Mat3b& even, const cv::Mat3b& shaded) {
  cv::Mat1f share(even.size());
  std::transform(even.begin(), even.end(), shaded.begin(), share.begin(),
                 [](const cv::Vec3b& lit, const cv::Vec3b& dark) {
                   return static_cast<float>(sum(lit) > 0 ? sum(dark) / sum(lit) : 1);
                 });
  return share;
}

void take_speckles_away(const cv::Mat3b& even, const cv::Mat1i& geom, cv::Mat3b& shaded) {
  constexpr int kReach_px = 2;
  const cv::Mat1f share = shares_of(even, shaded);
  cv::Mat1f least, most;  // of the whole window
  const cv::Mat window_of_ones = cv::Mat::ones(2 * kReach_px + 1, 2 * kReach_px + 1, CV_8U);
  cv::erode(share, least, window_of_ones);
  cv::dilate(share, most, window_of_ones);
  const cv::Rect picture({}, geom.size());
  std::vector<float> around;
  for (int y = 0; y < geom.rows; ++y) {
    for (int x = 0; x < geom.cols; ++x) {
      // usually the median cannot differ
      if (geom(y, x) < 0 || most(y, x) - least(y, x) <= rounding(even(y, x))) continue;
      around.clear();
      const cv::Rect window =
          cv::Rect(x - kReach_px, y - kReach_px, 2 * kReach_px + 1, 2 * kReach_px + 1) & picture;
      for (int row = window.y; row < window.br().y; ++row) {
        for (int column = window.x; column < window.br().x; ++column) {
          if (geom(row, column) == geom(y, x)) around.push_back(share(row, column));
        }
      }
      const auto middle = around.begin() + std::ssize(around) / 2;
      std::nth_element(around.begin(), middle, around.end());
      if (std::abs(share(y, x) - *middle) <= rounding(even(y, x))) continue;
      for (int c = 0; c < 3; ++c) {
        shaded(y, x)[c] = cv::saturate_cast<uchar>(*middle * static_cast<float>(even(y, x)[c]));
      }
    }
  }
}

cv::Mat1b shadow_edges(const cv::Mat3b& even, const cv::Mat1i& geom, const cv::Mat3b& shaded) {
  const cv::Mat1f share = shares_of(even, shaded);
  cv::Mat1b edge(geom.size(), uchar{0});
  for (int y = 0; y < geom.rows; ++y) {
    for (int x = 0; x < geom.cols; ++x) {
      const cv::Point here(x, y);
      for (const cv::Point& there : {cv::Point(x + 1, y), cv::Point(x, y + 1)}) {
        if (there.x == geom.cols || there.y == geom.rows) continue;
        if (geom(here) < 0 || geom(here) != geom(there)) continue;
        const double unsure = rounding(even(here)) + rounding(even(there));
        if (std::abs(share(here) - share(there)) > kShadowStep + unsure) {
          edge(here) = edge(there) = 1;
        }
      }
    }
  }
  return edge;
}

}  // namespace

struct CameraRenderer::Impl {
  Model& model;
  int width_px, height_px;
  GlContext gl;
  Drawables drawables;
  mjvScene& scene = drawables.scene();
  mjrContext context;
  std::vector<unsigned char> rgb;
  std::vector<float> z;
  std::optional<Pinhole> view;

  Impl(Model& model_, const GeomGroups& groups, int camera, int width_px_, int height_px_,
       bool has_shadows)
      : model(model_),
        width_px(width_px_),
        height_px(height_px_),
        drawables(model, groups, camera) {
    prepare(model.m(), width_px, height_px, has_shadows);
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
    if (context.currentBuffer != mjFB_OFFSCREEN || buffer.width < width_px ||
        buffer.height < height_px) {
      const bool is_picture = problem.empty() || problem.find("ffscreen") != std::string::npos;
      throw std::runtime_error(is_picture
                                   ? fmt::format("software GL does not render images of {}x{} "
                                                 "({}); choose a smaller camera size",
                                                 width_px, height_px, problem)
                                   : fmt::format("software GL does not take the scene ({}); choose "
                                                 "fewer or smaller textures and meshes",
                                                 problem));
    }
    rgb.resize(std::size_t(width_px) * height_px * 3);
    z.resize(std::size_t(width_px) * height_px);
  }

  void release() {
    try {
      gl.make_current();
    } catch (const std::runtime_error&) {
      return;  // destroying the GL context also frees these resources
    }
    mjr_freeContext(&context);
  }

  mjrRect viewport() const { return {0, 0, width_px, height_px}; }

  void render(float* depth) {
    gl.make_current();
    call_mujoco([&] {
      mjr_setBuffer(mjFB_OFFSCREEN, &context);
      mjr_render(viewport(), &scene, &context);
      mjr_readPixels(rgb.data(), depth, viewport(), &context);
    });
  }

  // Read-back is bottom row first.
  std::size_t row(int y) const { return std::size_t(height_px - 1 - y) * width_px; }

  /// \param colour id colour by `mjRND_IDCOLOR`: index in the scene, from 1.
  int geom_of(int colour) const {
    const int index = colour - 1;
    return index < 0 || index >= scene.ngeom ? -1 : scene.geoms[index].objid;
  }
};

CameraRenderer::CameraRenderer(Model& model, int camera, int width_px, int height_px,
                               const GeomGroups& groups, bool has_shadows) {
  check_memory(model, groups, camera, width_px, height_px, has_shadows);
  impl_ = std::make_unique<Impl>(model, groups, camera, width_px, height_px, has_shadows);
}

CameraRenderer::~CameraRenderer() = default;

void CameraRenderer::set_view(const Pinhole& view) {
  impl_->view = view;
}

void CameraRenderer::update() {
  Impl& s = *impl_;
  s.drawables.update(s.model);
  if (!s.view) return;
  const Pinhole& view = *s.view;
  for (mjvGLCamera& camera : s.scene.camera) {
    const double per_px = camera.frustum_near / view.focal_px;
    const Eigen::Vector2d to_edge = view.centre_px.array() + 0.5;
    camera.frustum_center = static_cast<float>(per_px * (view.width_px / 2.0 - to_edge.x()));
    camera.frustum_top = static_cast<float>(per_px * to_edge.y());
    camera.frustum_bottom = static_cast<float>(per_px * (to_edge.y() - view.height_px));
  }
}

void CameraRenderer::render_colour(cv::Mat3b& bgr) {
  Impl& s = *impl_;
  s.render(nullptr);
  bgr.create(s.height_px, s.width_px);
  for (int y = 0; y < s.height_px; ++y) {
    const unsigned char* from = s.rgb.data() + 3 * s.row(y);
    cv::Vec3b* to = bgr[y];
    for (int x = 0; x < s.width_px; ++x, from += 3) to[x] = {from[2], from[1], from[0]};
  }
}

void CameraRenderer::render_shaded(const cv::Mat3b& even, const cv::Mat1i& geom, cv::Mat3b& bgr,
                                   cv::Mat1b& edge) {
  impl_->scene.flags[mjRND_SHADOW] = 1;
  render_colour(bgr);
  impl_->scene.flags[mjRND_SHADOW] = 0;
  take_speckles_away(even, geom, bgr);
  edge = shadow_edges(even, geom, bgr);
}

void CameraRenderer::blur(const cv::Mat3b& sharp, cv::Mat3b& picture) {
  cv::GaussianBlur(sharp, picture, {}, kLensBlur_px);
}

void CameraRenderer::render_depth_and_geoms(cv::Mat1f& depth_m, cv::Mat1i& geom) {
  Impl& s = *impl_;
  s.scene.flags[mjRND_SEGMENT] = 1;
  s.scene.flags[mjRND_IDCOLOR] = 1;
  s.render(s.z.data());
  s.scene.flags[mjRND_SEGMENT] = 0;
  s.scene.flags[mjRND_IDCOLOR] = 0;

  depth_m.create(s.height_px, s.width_px);
  geom.create(s.height_px, s.width_px);
  const float n = s.scene.camera[0].frustum_near;
  const float f = s.scene.camera[0].frustum_far;
  for (int y = 0; y < s.height_px; ++y) {
    const unsigned char* id = s.rgb.data() + 3 * s.row(y);
    const float* z = s.z.data() + s.row(y);
    float* depth = depth_m[y];
    int* to = geom[y];
    // neighbouring pixels mostly show the same geom
    int colour = 0, shown = s.geom_of(colour);
    for (int x = 0; x < s.width_px; ++x, id += 3) {
      const int next = id[0] | id[1] << 8 | id[2] << 16;
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
