#include "tests/benchmark/stream.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "filter/detect/describe.h"
#include "filter/detect/fast.h"
#include "scenarios/load.h"
#include "sim/simulation.h"
#include "tools/bench/detector.h"
#include "tools/bench/ego_motion_feed.h"

namespace lcs::test {
namespace {

cv::Mat1b grey_of(const cv::Mat3b& image) {
  cv::Mat1b grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

/// A window of the size of the camera's picture, filled with copies of `tile`.
template <typename Pixel>
cv::Mat_<Pixel> tiled(const cv::Mat_<Pixel>& tile, const Intrinsics& camera) {
  cv::Mat_<Pixel> window(camera.height_px, camera.width_px);
  for (int v = 0; v < window.rows; v += tile.rows) {
    for (int u = 0; u < window.cols; u += tile.cols) {
      const cv::Size size(std::min(tile.cols, window.cols - u),
                          std::min(tile.rows, window.rows - v));
      tile(cv::Rect({0, 0}, size)).copyTo(window(cv::Rect({u, v}, size)));
    }
  }
  return window;
}

}  // namespace

Footage::Footage(const std::string& scenario_file) : scenario(scenario::load(scenario_file)) {
  sim::Simulation simulation(scenario);
  camera = bench::intrinsics(simulation.calibration().camera);
  bench::EgoMotionFeed feed(scenario, simulation.calibration());
  const FastDetector detector(scenario.fast_threshold);
  double corners = 0;
  while (const auto observation = simulation.next()) {
    images.push_back(observation->image.clone());
    motions.push_back(feed.next(*observation).told);
    corners += static_cast<double>(detector.detect(grey_of(images.back())).size());
  }
  corners_per_px =
      corners / static_cast<double>(images.size()) / (camera.width_px * camera.height_px);
}

Stream::Stream(const Footage& footage, int corners) : footage_(&footage), camera_(footage.camera) {
  const double area_px2 = corners / footage.corners_per_px;
  const double aspect = static_cast<double>(footage.camera.width_px) / footage.camera.height_px;
  camera_.width_px = static_cast<int>(std::lround(std::sqrt(area_px2 * aspect)));
  camera_.height_px = static_cast<int>(std::lround(area_px2 / camera_.width_px));
  camera_.centre_px = {0.5 * (camera_.width_px - 1), 0.5 * (camera_.height_px - 1)};
  const FastDetector detector(footage.scenario.fast_threshold);
  for (std::size_t k = 0; k < footage.images.size(); ++k) {
    const cv::Mat1b picture = grey(k);
    corners_px_.push_back(detector.detect(picture));
    signatures_.push_back(describe(picture, corners_px_.back()));
  }
}

double Stream::mean_corners() const {
  double sum = 0;
  for (const auto& corners : corners_px_) sum += static_cast<double>(corners.size());
  return sum / static_cast<double>(corners_px_.size());
}

cv::Mat3b Stream::image(std::size_t frame) const {
  return tiled(footage_->images[frame], camera_);
}

cv::Mat1b Stream::grey(std::size_t frame) const {
  return tiled(grey_of(footage_->images[frame]), camera_);
}

}  // namespace lcs::test
