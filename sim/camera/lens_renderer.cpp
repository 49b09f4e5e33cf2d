#include "sim/camera/lens_renderer.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "sim/truth/truth.h"

namespace lcs::sim {
namespace {

constexpr int kSamples = 2;    // along each axis of a pixel
constexpr int kMargin_px = 2;  // of the view, for interpolation
constexpr int kMostSide_px = 8192;

cv::Vec2f vec2f(const Eigen::Vector2d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y())};
}

/// A pinhole that sees every ray of the optics. \param rays of samples in its pixels
Pinhole view_of(const Optics& optics, const cv::Mat2d& rays) {
  const Lens& lens = optics.lens();
  if (optics.is_pinhole()) {
    return {lens.fu_px, {lens.cu_px, lens.cv_px}, lens.width_px, lens.height_px};
  }
  double scale_px = 0;
  for (int y = 0; y < lens.height_px; ++y) {
    for (int x = 0; x < lens.width_px; ++x) {
      const Eigen::Matrix2d J = optics.jacobian_px(optics.ray(x, y));
      scale_px = std::max(scale_px, Eigen::JacobiSVD<Eigen::Matrix2d>(J).singularValues()[0]);
    }
  }
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  for (const cv::Vec2d& ray : rays) {
    low = low.min(Eigen::Array2d(ray[0], ray[1]));
    high = high.max(Eigen::Array2d(ray[0], ray[1]));
  }
  const double focal_px = LensRenderer::kDensity * scale_px;
  const Eigen::Array2d size_px = (focal_px * (high - low)).ceil() + 2 * kMargin_px + 1;
  if (!(size_px.maxCoeff() <= kMostSide_px)) {
    throw input::Error(
        lens.source,
        "camera.distortion: the picture would be resampled from one of {:.0f} x {:.0f} pixels (at "
        "most {} a side); make camera.size smaller, or the field of view",
        size_px.x(), size_px.y(), kMostSide_px);
  }
  return {focal_px, (kMargin_px - focal_px * low).matrix(), static_cast<int>(size_px.x()),
          static_cast<int>(size_px.y())};
}

/// The rays of kSamples x kSamples places in each pixel. \throws input::Error as `Optics`
cv::Mat2d sample_rays(const Optics& optics) {
  cv::Mat2d rays;
  if (optics.is_pinhole()) return rays;
  rays.create(optics.size_px() * kSamples);
  for (int y = 0; y < rays.rows; ++y) {
    for (int x = 0; x < rays.cols; ++x) {
      const Eigen::Vector2d px((x + 0.5) / kSamples - 0.5, (y + 0.5) / kSamples - 0.5);
      const Eigen::Vector3d ray = optics.back_project(px, 1);
      // beside the outermost pixels there may be no ray
      rays(y, x) = ray.allFinite() ? cv::Vec2d(ray.x(), ray.y()) : [&] {
        const Eigen::Vector2d own = optics.ray(x / kSamples, y / kSamples);
        return cv::Vec2d(own.x(), own.y());
      }();
    }
  }
  return rays;
}

/// Slope at the middle of three values: the smaller difference to those that are on its surface.
float slope_on_surface(float before, float here, float after) {
  const float a = here - before, b = after - here;
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) ? (std::isnan(b) ? 0 : b) : a;
  return std::abs(a) < std::abs(b) ? a : b;
}

}  // namespace

LensRenderer::LensRenderer(Model& model, int camera, const Optics& optics, const GeomGroups& groups,
                           bool has_shadows)
    : LensRenderer(model, camera, optics, groups, has_shadows, sample_rays(optics)) {}

LensRenderer::LensRenderer(Model& model, int camera, const Optics& optics, const GeomGroups& groups,
                           bool has_shadows, const cv::Mat2d& rays)
    : optics_(optics),
      view_(view_of(optics, rays)),
      renderer_(model, camera, view_.width_px, view_.height_px, groups, has_shadows) {
  const Pinhole centred = Pinhole::from_fovy(view_.width_px, view_.height_px,
                                             2 * std::atan(view_.height_px / 2.0 / view_.focal_px));
  if (!optics.is_pinhole() || view_.centre_px != centred.centre_px) renderer_.set_view(view_);
  if (optics.is_pinhole()) return;
  const auto place = [&](const Eigen::Vector2d& ray) {
    return vec2f(view_.project({ray.x(), ray.y(), 1}));
  };
  samples_.create(rays.size());
  std::transform(rays.begin(), rays.end(), samples_.begin(), [&](const cv::Vec2d& ray) {
    return place({ray[0], ray[1]});
  });
  centres_.create(optics.size_px());
  for (int y = 0; y < centres_.rows; ++y) {
    for (int x = 0; x < centres_.cols; ++x) centres_(y, x) = place(optics.ray(x, y));
  }
}

void LensRenderer::render_colour(cv::Mat3b& bgr) {
  renderer_.render_colour(bgr);
  resample(bgr);
}

void LensRenderer::render_shaded(cv::Mat3b& bgr, cv::Mat1i& edge) {
  cv::Mat3b even;
  cv::Mat1f depth_m;
  cv::Mat1i geom;
  cv::Mat1b sharp, wide;
  renderer_.render_colour(even);
  renderer_.render_depth_and_geoms(depth_m, geom);
  renderer_.render_shaded(even, geom, bgr, sharp);
  resample(bgr);
  if (!centres_.empty()) {
    // the view has two pixels and more for each one of the lens: none is left out between two
    const cv::Mat1b in_view = sharp;
    sharp = cv::Mat1b(bgr.size(), uchar{0});
    for (int y = 0; y < in_view.rows; ++y) {
      for (int x = 0; x < in_view.cols; ++x) {
        if (!in_view(y, x)) continue;
        const Eigen::Vector2d px = optics_.project(view_.back_project(Eigen::Vector2d(x, y), 1));
        if (!px.allFinite()) continue;
        const cv::Point there(cvRound(px.x()), cvRound(px.y()));
        if (cv::Rect({}, sharp.size()).contains(there)) sharp(there) = 1;
      }
    }
  }
  constexpr int kSide_px = 2 * kShadowEdge_px + 1;
  cv::dilate(sharp, wide, cv::getStructuringElement(cv::MORPH_ELLIPSE, {kSide_px, kSide_px}));
  wide.convertTo(edge, CV_32S);
}

void LensRenderer::resample(cv::Mat3b& bgr) const {
  if (samples_.empty()) return;
  cv::Mat3b samples;
  cv::remap(bgr, samples, samples_, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::resize(samples, bgr, centres_.size(), 0, 0, cv::INTER_AREA);
}

void LensRenderer::render_depth_and_geoms(cv::Mat1f& depth_m, cv::Mat1i& geom) {
  renderer_.render_depth_and_geoms(depth_m, geom);
  if (centres_.empty()) return;
  const cv::Mat1f view_depth_m = depth_m;
  const cv::Mat1i view_geom = geom;
  depth_m = cv::Mat1f(centres_.size());
  geom = cv::Mat1i(centres_.size());
  for (int y = 0; y < geom.rows; ++y) {
    for (int x = 0; x < geom.cols; ++x) {
      const cv::Point2f at = centres_(y, x);
      const cv::Point nearest(cvRound(at.x), cvRound(at.y));
      const int id = geom(y, x) = view_geom(nearest);
      depth_m(y, x) = view_depth_m(nearest);
      if (id < 0) continue;
      // inverse depth, which is linear in a pinhole's picture of a plane
      const float w = 1 / depth_m(y, x);
      const auto beside = [&](const cv::Point& step) {
        const cv::Point there = nearest + step;
        return view_geom(there) == id ? 1 / view_depth_m(there)
                                      : std::numeric_limits<float>::quiet_NaN();
      };
      const cv::Point right(1, 0), down(0, 1);
      const cv::Point2f off = at - cv::Point2f(nearest);
      const float change = off.x * slope_on_surface(beside(-right), w, beside(right)) +
                           off.y * slope_on_surface(beside(-down), w, beside(down));
      depth_m(y, x) = 1 / std::clamp(w + change, w / 2, w * 2);
    }
  }
}

}  // namespace lcs::sim
