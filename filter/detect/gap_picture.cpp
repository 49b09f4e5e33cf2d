#include "filter/detect/gap_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>

namespace lcs {
namespace {

constexpr double kBlur_px = 1;
constexpr std::size_t kPictures = 6;  // that are kept
constexpr double kParallax_px = 2;  // between ground and body, from which a picture is early enough
constexpr double kSigma_levels = 6;    // standard deviation of a warped picture's error
constexpr double kMost = 4;            // log likelihood that a pixel can lose
constexpr double kContour_levels = 4;  // least gradient of a contour, grey levels a pixel
constexpr double kRow = 2;             // log likelihood ratio that a row can reach
constexpr double kBare = 3;            // log likelihood ratio added for a row without contours

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

/// The row of an earlier picture that a row of this picture would come from, if all points on it
/// had one inverse depth.
class EarlierRow {
 public:
  EarlierRow(const GapPicture::Earlier& earlier, const Intrinsics& camera, const Vec2& first_px,
             const Vec2& across, double inverse_depth_pm)
      : camera_(camera),
        first_(earlier.R * ((first_px - camera.centre_px) / camera.focal_px).homogeneous() +
               inverse_depth_pm * earlier.t_m),
        step_(earlier.R.leftCols<2>() * across / camera.focal_px) {}

  /// Place of a column, px. Far outside if it was behind.
  Vec2 at(int column) const {
    const Eigen::Vector3d X = first_ + column * step_;
    if (!(X.z() > 1e-3)) return Vec2::Constant(-1e6);
    return camera_.centre_px + camera_.focal_px * X.hnormalized();
  }

 private:
  const Intrinsics& camera_;
  Eigen::Vector3d first_, step_;
};

/// Whether the gradient at the pixel of a place is steep enough for a contour; false at the border.
bool has_contour(const cv::Mat1b& picture, const Vec2& x) {
  const int c = static_cast<int>(x.x() + 0.5), r = static_cast<int>(x.y() + 0.5);
  if (c < 1 || r < 1 || c + 1 >= picture.cols || r + 1 >= picture.rows) return false;
  const double across = picture(r, c + 1) - picture(r, c - 1);
  const double down = picture(r + 1, c) - picture(r - 1, c);
  return std::hypot(across, down) >= 2 * kContour_levels;
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
  const cv::Mat1b shown = std::exchange(shown_, cv::Mat1b());
  if (shown.empty() || !ground_) return earlier_.clear();
  cv::GaussianBlur(shown, now_, {}, kBlur_px);
}

std::optional<double> GapPicture::evidence(const Gap& gap) {
  if (earlier_.empty()) return std::nullopt;
  // A row lies along the horizon: the ground's inverse depth is the same all along it.
  const auto ground_pm = [&](int row) {
    const Vec2 h = (gap.at(0, row) - camera_.centre_px) / camera_.focal_px;
    return std::max(0.0, ground_->inverse_depth_pm(h));
  };
  const auto row_of = [&](const Earlier& earlier, int row, double inverse_depth_pm) {
    return EarlierRow(earlier, camera_, gap.at(0, row), gap.across, inverse_depth_pm);
  };
  const auto is_early = [&](const Earlier& earlier) {
    const int row = gap.rows / 2, column = gap.columns / 2;
    const Vec2 as_body = row_of(earlier, row, gap.inverse_depth_pm).at(column);
    return (row_of(earlier, row, ground_pm(row)).at(column) - as_body).norm() > kParallax_px;
  };
  auto early = std::ranges::find_if(earlier_, is_early);
  if (early == earlier_.end()) --early;

  double sum = 0;
  int rows = 0;
  for (int row = 0; row < gap.rows; ++row) {
    const EarlierRow body = row_of(*early, row, gap.inverse_depth_pm);
    const EarlierRow ground = row_of(*early, row, ground_pm(row));
    double ratio = 0;
    bool is_bare = true;
    int pixels = 0;
    for (int column = 0; column < gap.columns; ++column) {
      const Vec2 x = gap.at(column, row);
      const double now = sample(now_, x);
      const double as_body = sample(early->blurred, body.at(column));
      const double as_ground = sample(early->blurred, ground.at(column));
      if (now < 0 || as_body < 0 || as_ground < 0) continue;
      ++pixels;
      const auto loss = [&](double seen) {
        const double off = (now - seen) / kSigma_levels;
        return std::min(0.5 * off * off, kMost);
      };
      ratio += loss(as_body) - loss(as_ground);
      is_bare = is_bare && !has_contour(now_, x);
    }
    if (pixels == 0) continue;
    ++rows;
    sum += std::clamp(ratio, -kRow, kRow) + (is_bare ? kBare : 0);
  }
  if (rows < 3) return std::nullopt;
  return sum / rows;
}

}  // namespace lcs
