#include "filter/detect/gap_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace lcs {
namespace {

constexpr double kBlur_px = 1;
constexpr std::size_t kPictures = 6;  // that are kept
constexpr double kParallax_px = 2;  // between ground and body, from which a picture is early enough
constexpr double kSigma_levels = 6;    // standard deviation of a warped picture's error
constexpr double kMost = 4;            // log likelihood that a pixel can lose
constexpr double kContour_levels = 4;  // least gradient of a contour, grey levels a pixel
constexpr double kRow = 2;             // log likelihood ratio that a row can reach
constexpr double kBare = 3;            // and that of a row without contours

/// Bilinear; negative outside of the picture.
double sample(const cv::Mat1b& picture, const Vec2& x) {
  if (!(x.x() >= 0 && x.y() >= 0 && x.x() < picture.cols - 1 && x.y() < picture.rows - 1)) {
    return -1;
  }
  const int c = static_cast<int>(x.x()), r = static_cast<int>(x.y());
  const double u = x.x() - c, v = x.y() - r;
  const std::uint8_t *upper = picture[r] + c, *lower = picture[r + 1] + c;
  return (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
}

}  // namespace

void GapPicture::show(const cv::Mat1b& grey) {
  if (grey.cols != camera_.width_px || grey.rows != camera_.height_px) {
    throw std::invalid_argument("the picture has " + std::to_string(grey.cols) + " x " +
                                std::to_string(grey.rows) + " pixels, the camera " +
                                std::to_string(camera_.width_px) + " x " +
                                std::to_string(camera_.height_px));
  }
  shown_ = grey;
}

void GapPicture::begin(const EgoMotion& motion) {
  ground_ = motion.ground;
  if (!(motion.dt_s > 0)) {
    earlier_.clear();
  } else if (!now_.empty()) {
    if (earlier_.size() == kPictures) earlier_.pop_back();
    earlier_.insert(earlier_.begin(), {now_, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()});
    const Eigen::Matrix3d R = motion.R_cur_prev.transpose();
    for (Earlier& earlier : earlier_) {
      earlier.R = earlier.R * R;
      earlier.t_m += earlier.R * (motion.v_C_mps * motion.dt_s);
    }
  }
  now_ = cv::Mat1b();  // the earlier one is kept
  if (shown_.empty()) return earlier_.clear();
  cv::GaussianBlur(shown_, now_, {}, kBlur_px);
  shown_ = cv::Mat1b();
}

/// Place in the earlier picture of a point that is now at x_px. Far outside if it was behind.
Vec2 GapPicture::before(const Earlier& earlier, const Vec2& x_px, double inverse_depth_pm) const {
  const Vec2 h = (x_px - camera_.centre_px) / camera_.focal_px;
  const Eigen::Vector3d X = earlier.R * h.homogeneous() + inverse_depth_pm * earlier.t_m;
  if (!(X.z() > 1e-3)) return Vec2::Constant(-1e6);
  return camera_.centre_px + camera_.focal_px * X.hnormalized();
}

std::optional<double> GapPicture::evidence(const Gap& gap) {
  if (earlier_.empty() || !ground_) return std::nullopt;
  const auto ground_pm = [&](const Vec2& x) {
    const Vec2 h = (x - camera_.centre_px) / camera_.focal_px;
    return std::max(0.0, -ground_->up_C.dot(h.homogeneous()) / ground_->height_m);
  };
  const Vec2 middle = gap.at(gap.columns / 2, gap.rows / 2);
  const auto parallax_px = [&](const Earlier& earlier) {
    return (before(earlier, middle, gap.inverse_depth_pm) -
            before(earlier, middle, ground_pm(middle)))
        .norm();
  };
  auto early = std::ranges::find_if(
      earlier_, [&](const Earlier& earlier) { return parallax_px(earlier) > kParallax_px; });
  if (early == earlier_.end()) --early;

  double sum = 0;
  int rows = 0;
  for (int row = 0; row < gap.rows; ++row) {
    double ratio = 0;
    bool is_bare = true;
    int pixels = 0;
    for (int column = 0; column < gap.columns; ++column) {
      const Vec2 x = gap.at(column, row);
      const double now = sample(now_, x);
      const double as_body = sample(early->blurred, before(*early, x, gap.inverse_depth_pm));
      const double as_ground = sample(early->blurred, before(*early, x, ground_pm(x)));
      if (now < 0 || as_body < 0 || as_ground < 0) continue;
      ++pixels;
      const auto loss = [&](double seen) {
        const double off = (now - seen) / kSigma_levels;
        return std::min(0.5 * off * off, kMost);
      };
      ratio += loss(as_body) - loss(as_ground);
      if (!is_bare) continue;
      const double right = sample(now_, x + Vec2::UnitX()), left = sample(now_, x - Vec2::UnitX());
      const double below = sample(now_, x + Vec2::UnitY()), above = sample(now_, x - Vec2::UnitY());
      if (std::min({right, left, below, above}) < 0) continue;
      is_bare = std::hypot(right - left, below - above) < 2 * kContour_levels;
    }
    if (pixels == 0) continue;
    ++rows;
    sum += std::clamp(ratio, -kRow, kRow) + (is_bare ? kBare : 0);
  }
  if (rows < 3) return std::nullopt;
  return sum / rows;
}

}  // namespace lcs
