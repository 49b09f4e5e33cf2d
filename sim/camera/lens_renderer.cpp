#include "sim/camera/lens_renderer.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "sim/camera/linear_light.h"
#include "sim/truth/truth.h"

namespace lcs::sim {
namespace {

constexpr int kMargin_px = 2;  // of the lattice, for the neighbours of a lens's points
constexpr int kTile_px = 32;
constexpr int kMostSide_px = 1 << 14;  // of Mesa's pictures

/// From pixels to a lattice of a^2 + b^2 points per pixel.
struct Lattice {
  int a, b;

  static Lattice of(int samples) {
    for (const Lattice& lattice : {Lattice{1, 0}, {2, 0}, {2, 1}, {3, 0}}) {
      if (lattice.samples() == samples) return lattice;
    }
    throw std::invalid_argument(
        fmt::format("{} samples of a pixel; 1, 4, 5 or 9 are possible", samples));
  }
  int samples() const { return a * a + b * b; }
  Eigen::Matrix2d from_px() const { return (Eigen::Matrix2d() << a, -b, b, a).finished(); }
  double roll_rad() const { return std::atan2(b, a); }
};

/// The focal length of a pinhole whose pixels are nowhere larger than those of the picture, px.
double scale_px(const Optics& optics) {
  const Lens& lens = optics.lens();
  if (optics.is_pinhole()) return lens.fu_px;
  double most_px = 0;
  for (int y = 0; y < lens.height_px; ++y) {
    for (int x = 0; x < lens.width_px; ++x) {
      const Eigen::Matrix2d J = optics.jacobian_px(optics.ray(x, y));
      most_px = std::max(most_px, Eigen::JacobiSVD<Eigen::Matrix2d>(J).singularValues()[0]);
    }
  }
  return most_px;
}

/// The rays of all places in the picture; those of a border without rays are left out.
Eigen::AlignedBox2d seen_rays(const Optics& optics) {
  const cv::Size size_px = optics.size_px();
  Eigen::AlignedBox2d rays;
  const auto take = [&](double x, double y) {
    const Eigen::Vector2d ray = optics.back_project({x, y}, 1).head<2>();
    if (ray.allFinite()) rays.extend(ray);
  };
  for (int y = 0; y < size_px.height; ++y) {
    for (int x = 0; x < size_px.width; ++x) rays.extend(optics.ray(x, y));
  }
  for (int x = 0; x <= size_px.width; ++x) {
    for (const int y : {0, size_px.height}) take(x - 0.5, y - 0.5);
  }
  for (int y = 0; y <= size_px.height; ++y) {
    for (const int x : {0, size_px.width}) take(x - 0.5, y - 0.5);
  }
  return rays;
}

/// Slope at the middle of three values: the smaller difference to those that are on its surface.
float slope_on_surface(float before, float here, float after) {
  const float a = here - before, b = after - here;
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) ? (std::isnan(b) ? 0 : b) : a;
  return std::abs(a) < std::abs(b) ? a : b;
}

/// What depth and ids are rendered by: a pinhole's own picture.
View truth_view(const Optics& optics, const View& lattice) {
  return optics.is_pinhole() ? View{optics.lens().pinhole(), 0, {}} : lattice;
}

/// The lattice as the pixels of a picture that sees all of a camera's field of view.
/// \throws input::Error if it would be too large.
View lattice_view(const Optics& optics, const Lattice& lattice) {
  const double density = scale_px(optics);
  const double focal = std::sqrt(lattice.samples()) * density;
  const Eigen::Matrix2d to_lattice = density * lattice.from_px();
  const Eigen::AlignedBox2d rays = seen_rays(optics);
  Eigen::AlignedBox2d box;
  for (int corner = 0; corner < 4; ++corner) {
    box.extend(to_lattice * rays.corner(static_cast<Eigen::AlignedBox2d::CornerType>(corner)));
  }
  // the axis is where a pinhole's pixel has a point in its middle, or four round it
  const Eigen::Vector2d first = to_lattice * optics.back_project({0, 0}, 1).head<2>();
  const double shift = lattice.samples() % 2 == 0 ? 0.5 : 0;
  const Eigen::Array2d low = box.min().array() - first.array() - shift;
  const Eigen::Array2d centre = kMargin_px - low.floor() - first.array() - shift;
  const Eigen::Array2i size = (box.max().array() + centre).ceil().cast<int>() + kMargin_px + 1;
  if (size.maxCoeff() > kMostSide_px) {
    throw input::Error(optics.lens().source,
                       "camera.{}: the picture would be made of {} x {} samples (at most {} a "
                       "side); make camera.size smaller{}, or image.samples",
                       optics.is_pinhole() ? "size" : "distortion", size.x(), size.y(),
                       kMostSide_px, optics.is_pinhole() ? "" : ", or the field of view");
  }
  View view{{focal, centre.matrix(), size.x(), size.y()}, lattice.roll_rad(), {}};
  // with a lattice point more on each side, where a cut edge may be out of place by rounding
  view.used = {rays.min().array() - 1 / focal, rays.max().array() + 1 / focal};
  return view;
}

/// From a ray (x, y, 1) to its place in a view.
Eigen::Matrix2d to_view(const View& view) {
  return view.pinhole.focal_px * Eigen::Rotation2Dd(view.roll_rad).toRotationMatrix();
}

/// The pixel of the picture, row by row, in which each pixel of the view lies; -1: in none.
cv::Mat1i pixels_of(const Optics& optics, const View& view) {
  const cv::Size size_px = optics.size_px();
  const Eigen::Matrix2d to_ray = to_view(view).inverse();
  cv::Mat1i pixels(view.pinhole.height_px, view.pinhole.width_px, -1);
  for (int y = 0; y < pixels.rows; ++y) {
    for (int x = 0; x < pixels.cols; ++x) {
      const Eigen::Vector2d ray = to_ray * (Eigen::Vector2d(x, y) - view.pinhole.centre_px);
      if (!view.used->contains(ray)) continue;
      const Eigen::Vector2d px = optics.project(ray.homogeneous());
      if (!px.allFinite()) continue;
      const cv::Point pixel(cvRound(px.x()), cvRound(px.y()));
      if (cv::Rect({}, size_px).contains(pixel)) pixels(y, x) = pixel.y * size_px.width + pixel.x;
    }
  }
  return pixels;
}

/// The place in the view of each pixel's middle.
cv::Mat2f middles_of(const Optics& optics, const View& view) {
  cv::Mat2f middles(optics.size_px());
  for (int y = 0; y < middles.rows; ++y) {
    for (int x = 0; x < middles.cols; ++x) {
      const Eigen::Vector2f place =
          (to_view(view) * optics.ray(x, y) + view.pinhole.centre_px).cast<float>();
      middles(y, x) = {place.x(), place.y()};
    }
  }
  return middles;
}

}  // namespace

LensRenderer::Sampling LensRenderer::sampling_of(const Optics& optics, int samples) {
  Sampling sampling{lattice_view(optics, Lattice::of(samples)), {}, {}, {}};
  if (!optics.is_pinhole()) sampling.middles = middles_of(optics, sampling.view);
  const cv::Mat1i pixels = pixels_of(optics, sampling.view);
  const cv::Size size_px = optics.size_px();
  std::vector<int> counts(static_cast<std::size_t>(size_px.area()), 0);
  for (const int pixel : pixels) {
    if (pixel >= 0) ++counts[static_cast<std::size_t>(pixel)];
  }
  std::vector<int>& ends = sampling.ends;
  ends.assign(1, 0);
  // a lens's pixel may have no point if there is one to a pixel: it takes the one nearest to its
  // middle
  for (const int count : counts) ends.push_back(ends.back() + std::max(count, 1));
  sampling.points.resize(static_cast<std::size_t>(ends.back()));
  std::vector<int> next(ends.begin(), ends.end() - 1);
  const auto add = [&](std::size_t pixel, int x, int y) {  // rendered bottom row first
    sampling.points[static_cast<std::size_t>(next[pixel]++)] =
        (pixels.rows - 1 - y) * pixels.cols + x;
  };
  for (int y = 0; y < pixels.rows; ++y) {
    for (int x = 0; x < pixels.cols; ++x) {
      if (pixels(y, x) >= 0) add(static_cast<std::size_t>(pixels(y, x)), x, y);
    }
  }
  for (std::size_t pixel = 0; pixel < counts.size(); ++pixel) {
    if (counts[pixel] > 0) continue;
    const cv::Vec2f& middle = sampling.middles(static_cast<int>(pixel) / size_px.width,
                                               static_cast<int>(pixel) % size_px.width);
    add(pixel, cvRound(middle[0]), cvRound(middle[1]));
  }
  return sampling;
}

LensRenderer::LensRenderer(Model& model, int camera, const Optics& optics, int samples,
                           const GeomGroups& groups, bool has_shadows)
    : size_px_(optics.size_px()),
      sampling_(sampling_of(optics, samples)),
      renderer_(model, camera, sampling_.view, truth_view(optics, sampling_.view), groups,
                has_shadows) {}

void LensRenderer::mean_of_samples(const cv::Mat4w& codes, cv::Mat3f& light) const {
  const float* const light_of = light_of_codes16().data();
  const cv::Vec4w* const all = codes[0];
  light.create(size_px_);
  const auto mean_of_row = [&](int y, const cv::Range& columns) {
    const int* end = sampling_.ends.data() + y * light.cols + columns.start;
    const int* point = sampling_.points.data() + *end;
    for (int x = columns.start; x < columns.end; ++x, ++end) {
      const int count = end[1] - end[0];
      float red = 0, green = 0, blue = 0;
      for (int i = 0; i < count; ++i) {
        const cv::Vec4w& code = all[*point++];
        red += light_of[code[0]];
        green += light_of[code[1]];
        blue += light_of[code[2]];
      }
      const float share = 1 / static_cast<float>(count);
      light(y, x) = {share * blue, share * green, share * red};
    }
  };
  // by tiles, whose part of the turned lattice stays in the processor's cache
  for (int top = 0; top < light.rows; top += kTile_px) {
    for (int left = 0; left < light.cols; left += kTile_px) {
      const cv::Range columns(left, std::min(left + kTile_px, light.cols));
      for (int y = top; y < std::min(top + kTile_px, light.rows); ++y) mean_of_row(y, columns);
    }
  }
}

void LensRenderer::render_light(cv::Mat3f& light) {
  mean_of_samples(renderer_.render_codes(), light);
}

void LensRenderer::render_shaded(const cv::Mat3f& even, const cv::Mat1i& geom, cv::Mat3f& shaded,
                                 cv::Mat1i& edge) {
  mean_of_samples(renderer_.render_codes(true), shaded);
  cv::Mat1b wide;
  constexpr int kSide_px = 2 * kShadowEdge_px + 1;
  cv::dilate(clean_shadows(even, geom, shaded), wide,
             cv::getStructuringElement(cv::MORPH_ELLIPSE, {kSide_px, kSide_px}));
  wide.convertTo(edge, CV_32S);
}

void LensRenderer::render_depth_and_geoms(cv::Mat1f& depth_m, cv::Mat1i& geom) {
  renderer_.render_depth_and_geoms(depth_m, geom);
  if (sampling_.middles.empty()) return;
  const cv::Mat1f view_depth_m = depth_m;
  const cv::Mat1i view_geom = geom;
  depth_m = cv::Mat1f(sampling_.middles.size());
  geom = cv::Mat1i(sampling_.middles.size());
  for (int y = 0; y < geom.rows; ++y) {
    for (int x = 0; x < geom.cols; ++x) {
      const cv::Point2f at = sampling_.middles(y, x);
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
