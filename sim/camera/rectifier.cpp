#include "sim/camera/rectifier.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace lcs::sim {
namespace {

constexpr double kLeastCovered = 0.1;
/// Largest round-trip error: beyond its edge a distortion polynomial folds back and is ambiguous.
constexpr double kAstray_px = 0.1;

}  // namespace

Rectifier::Rectifier(const Lens& lens, cv::Size size_px)
    : is_equidistant_(lens.distortion == Lens::Distortion::equidistant),
      from_(lens.fu_px, 0, lens.cu_px, 0, lens.fv_px, lens.cv_px, 0, 0, 1),
      coefficients_(lens.coefficients, true),
      xi_(lens.xi),
      alpha_(lens.alpha),
      camera_(lens.pinhole()) {
  camera_.width_px = size_px.width;
  camera_.height_px = size_px.height;
  to_ = cv::Matx33d(camera_.focal_px, 0, lens.cu_px, 0, camera_.focal_px, lens.cv_px, 0, 0, 1);
  if (lens.is_pinhole()) return;
  if (is_spherical()) {
    map_by_points();
  } else if (is_equidistant_) {
    cv::fisheye::initUndistortRectifyMap(from_, coefficients_, cv::Matx33d::eye(), to_, size_px,
                                         CV_32FC1, map_x_, map_y_);
  } else {
    cv::initUndistortRectifyMap(from_, coefficients_, cv::Matx33d::eye(), to_, size_px, CV_32FC1,
                                map_x_, map_y_);
  }
  if (!(covered() >= kLeastCovered)) {
    throw input::Error(lens.source,
                       "by its intrinsics and distortion the lens sees less than a tenth of its "
                       "own picture; correct them");
  }
}

/// The point at depth 1 of the inner pinhole, behind one sphere or two, for a ray.
Eigen::Vector3d Rectifier::onto_sphere(const Eigen::Vector3d& ray) const {
  const double z = xi_ * ray.norm() + ray.z();
  const double second = std::sqrt(ray.head<2>().squaredNorm() + z * z);
  const double depth = alpha_ * second + (1 - alpha_) * z;
  return {ray.x() / depth, ray.y() / depth, 1};
}

/// The ray of a point at depth 1 of the inner pinhole; NaN if it has none.
Eigen::Vector3d Rectifier::from_sphere(double x, double y) const {
  const double r2 = x * x + y * y;
  const double z =
      (1 - alpha_ * alpha_ * r2) / (alpha_ * std::sqrt(1 - (2 * alpha_ - 1) * r2) + 1 - alpha_);
  const double scale = (z * xi_ + std::sqrt(z * z + (1 - xi_ * xi_) * r2)) / (z * z + r2);
  return {scale * x, scale * y, scale * z - xi_};
}

void Rectifier::map_by_points() {
  const cv::Size size_px(camera_.width_px, camera_.height_px);
  std::vector<cv::Point2f> pixels;
  for (int y = 0; y < size_px.height; ++y) {
    for (int x = 0; x < size_px.width; ++x) {
      pixels.emplace_back(static_cast<float>(x), static_cast<float>(y));
    }
  }
  const std::vector<cv::Point2f> places = bent(pixels);
  const cv::Mat maps(size_px, CV_32FC2, const_cast<cv::Point2f*>(places.data()));
  cv::extractChannel(maps, map_x_, 0);
  cv::extractChannel(maps, map_y_, 1);
}

/// Share of the pinhole's pixels that lie within the original picture.
double Rectifier::covered() const {
  const cv::Mat inside =
      (map_x_ >= 0) & (map_y_ >= 0) & (map_x_ <= map_x_.cols - 1) & (map_y_ <= map_x_.rows - 1);
  return cv::countNonZero(inside) / static_cast<double>(map_x_.total());
}

std::vector<cv::Point2f> Rectifier::straight(const std::vector<cv::Point2f>& bent) const {
  std::vector<cv::Point2f> points;
  if (is_equidistant_) {
    cv::fisheye::undistortPoints(bent, points, from_, coefficients_, cv::Matx33d::eye(), to_);
  } else {
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-9);
    const cv::Matx33d inner = is_spherical() ? cv::Matx33d::eye() : to_;
    cv::undistortPoints(bent, points, from_, coefficients_, cv::noArray(), inner, until);
    if (!is_spherical()) return points;
    for (cv::Point2f& point : points) {
      const Eigen::Vector3d ray = from_sphere(point.x, point.y);
      const Eigen::Vector2d px = camera_.project(ray / ray.z());
      constexpr float kOutside = -1;
      point = ray.z() > 0 ? cv::Point2f(static_cast<float>(px.x()), static_cast<float>(px.y()))
                          : cv::Point2f(kOutside, kOutside);
    }
  }
  return points;
}

/// Original positions of pinhole positions.
std::vector<cv::Point2f> Rectifier::bent(const std::vector<cv::Point2f>& straight) const {
  std::vector<cv::Point2f> points;
  if (is_equidistant_) {
    std::vector<cv::Point2f> rays;
    cv::undistortPoints(straight, rays, to_, cv::noArray());
    cv::fisheye::distortPoints(rays, points, from_, coefficients_);
    return points;
  }
  std::vector<cv::Point3f> rays;
  for (const cv::Point2f& px : straight) {
    Eigen::Vector3d ray = camera_.back_project({px.x, px.y}, 1);
    if (is_spherical()) ray = onto_sphere(ray);
    rays.emplace_back(static_cast<float>(ray.x()), static_cast<float>(ray.y()), 1.0F);
  }
  cv::projectPoints(rays, cv::Vec3d::zeros(), cv::Vec3d::zeros(), from_, coefficients_, points);
  return points;
}

void Rectifier::rectify(std::vector<Eigen::Vector2f>& corners_px) const {
  if (is_pinhole() || corners_px.empty()) return;
  std::vector<cv::Point2f> taken;
  for (const Eigen::Vector2f& corner : corners_px) taken.emplace_back(corner.x(), corner.y());
  const std::vector<cv::Point2f> places = straight(taken), back = bent(places);
  corners_px.clear();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const cv::Point2f& px = places[i];
    const bool is_seen = px.x >= 0 && px.y >= 0 &&
                         px.x <= static_cast<float>(camera_.width_px - 1) &&
                         px.y <= static_cast<float>(camera_.height_px - 1);
    const bool is_one_ray = cv::norm(back[i] - taken[i]) < kAstray_px;  // false for NaN
    if (is_seen && is_one_ray) corners_px.emplace_back(px.x, px.y);
  }
}

void Rectifier::rectify(double& left, double& top, double& right, double& bottom) const {
  if (is_pinhole()) return;
  constexpr double kEdge = 0.5;  // distance of a pixel edge from its centre
  std::vector<cv::Point2f> outline;
  for (const double x : {left, 0.5 * (left + right), right}) {
    for (const double y : {top, 0.5 * (top + bottom), bottom}) {
      outline.emplace_back(static_cast<float>(x - kEdge), static_cast<float>(y - kEdge));
    }
  }
  const std::vector<cv::Point2f> places = straight(outline);
  const auto [x_least, x_most] =
      std::minmax_element(places.begin(), places.end(), [](auto& a, auto& b) { return a.x < b.x; });
  const auto [y_least, y_most] =
      std::minmax_element(places.begin(), places.end(), [](auto& a, auto& b) { return a.y < b.y; });
  left = x_least->x + kEdge;
  right = x_most->x + kEdge;
  top = y_least->y + kEdge;
  bottom = y_most->y + kEdge;
}

void Rectifier::remap(cv::Mat& picture, int interpolation, int border, double beyond) const {
  if (is_pinhole()) return;
  cv::Mat straight;
  cv::remap(picture, straight, map_x_, map_y_, interpolation, border, beyond);
  picture = straight;
}

void Rectifier::rectify(cv::Mat& picture) const {
  remap(picture, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
}

void Rectifier::rectify(cv::Mat1i& ids) const {
  if (!ids.empty()) remap(ids, cv::INTER_NEAREST, cv::BORDER_CONSTANT, -1);
}

void Rectifier::rectify(cv::Mat1f& depth_m) const {
  remap(depth_m, cv::INTER_NEAREST, cv::BORDER_CONSTANT, std::numeric_limits<float>::infinity());
}

std::vector<ObjectTruth> Rectifier::rectified(const std::vector<ObjectTruth>& objects,
                                              const cv::Mat1i& ids) const {
  if (is_pinhole() || objects.empty()) return objects;
  cv::Mat1i straight = ids;
  rectify(straight);
  const std::vector<ObjectTruth> boxes = modal_boxes(straight, objects.back().object);
  std::vector<ObjectTruth> all;
  for (const ObjectTruth& object : objects) {
    ObjectTruth box = boxes[static_cast<std::size_t>(object.object - 1)];
    if (box.visible_px == 0) continue;
    box.visible_fraction = object.visible_fraction;
    box.moving = object.moving;
    all.push_back(std::move(box));
  }
  return all;
}

}  // namespace lcs::sim
