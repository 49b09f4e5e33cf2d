#include "filter/detect/picture_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "filter/detect/fast.h"

namespace lcs {
namespace {

constexpr int kGrid_px = 8;

/// By row modulo `kGrid_px`: mean square of a step between rows minus the mean of the steps before
/// and after it, half levels clipped at `kMostJump`.
using Jumps = std::array<double, kGrid_px>;

Jumps jumps(const cv::Mat1b& grey) {
  constexpr int kMostJump = 48;  // half levels: limits the weight of sharp edges in the scene
  std::array<std::int64_t, kGrid_px> sums{}, counts{};
  for (int y = 2; y + 1 < grey.rows; ++y) {
    const uchar *before = grey[y - 2], *above = grey[y - 1], *row = grey[y], *below = grey[y + 1];
    int sum = 0;  // overflows only in pictures over 900,000 px wide
    for (int x = 0; x < grey.cols; ++x) {
      const int twice = 3 * (row[x] - above[x]) + before[x] - below[x];
      const int jump = std::min(std::abs(twice), kMostJump);
      sum += jump * jump;
    }
    sums[static_cast<std::size_t>(y % kGrid_px)] += sum;
    counts[static_cast<std::size_t>(y % kGrid_px)] += grey.cols;
  }
  Jumps means{};
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (counts[i] > 0)
      means[i] = 0.25 * static_cast<double>(sums[i]) / static_cast<double>(counts[i]);
  }
  return means;
}

/// Mean square jump at block borders, less the largest elsewhere. The grid may start at any row, as
/// the picture may be cropped. Adjacent rows share the border's pixels and are left out.
double excess(const Jumps& jumps) {
  const auto most = static_cast<int>(std::ranges::max_element(jumps) - jumps.begin());
  double other = 0;
  for (int beside = 2; beside <= kGrid_px - 2; ++beside) {
    other = std::max(other, jumps[static_cast<std::size_t>((most + beside) % kGrid_px)]);
  }
  return jumps[static_cast<std::size_t>(most)] - other;
}

/// The highest threshold that gives a corner for every 16x16 pixels.
/// \return 0 if there are fewer already at `least`.
int crowded_up_to(const cv::Mat1b& grey, int least) {
  constexpr std::size_t kPixelsEach = 256;
  std::vector<cv::KeyPoint> corners = FastDetector(least).detect_scored(grey);
  const std::size_t enough = grey.total() / kPixelsEach;
  if (corners.size() <= enough) return 0;
  const auto last = corners.begin() + static_cast<std::ptrdiff_t>(enough);
  // The response is the highest threshold that still detects the corner.
  std::ranges::nth_element(corners, last, std::ranges::greater(), &cv::KeyPoint::response);
  return static_cast<int>(last->response);
}

}  // namespace

std::optional<double> noise_levels(const cv::Mat1b& grey) {
  constexpr int kBlock_px = 16, kQuarter_px = kBlock_px / 2;
  constexpr double kDarkest = 6, kBrightest = 249;  // clipped pixels have no noise
  constexpr std::size_t kFewestBlocks = 8;
  const cv::Matx13f immerkaer(1, -2, 1);  // the kernel in x and in y
  cv::Mat1s residual;
  cv::sepFilter2D(grey, residual, CV_16S, immerkaer, immerkaer);
  residual = cv::abs(residual);
  std::vector<std::pair<double, double>> blocks;  // unevenness, mean residual
  for (int y = 1; y + kBlock_px < grey.rows; y += kBlock_px) {
    for (int x = 1; x + kBlock_px < grey.cols; x += kBlock_px) {
      double least = 255, most = 0;
      for (const int dy : {0, kQuarter_px}) {
        for (const int dx : {0, kQuarter_px}) {
          const cv::Rect quarter(x + dx, y + dy, kQuarter_px, kQuarter_px);
          const double mean = cv::mean(grey(quarter))[0];
          least = std::min(least, mean);
          most = std::max(most, mean);
        }
      }
      if (least < kDarkest || most > kBrightest) continue;
      blocks.emplace_back(most - least,
                          cv::mean(residual(cv::Rect(x, y, kBlock_px, kBlock_px)))[0]);
    }
  }
  if (blocks.size() < kFewestBlocks) return std::nullopt;
  std::ranges::sort(blocks);
  std::vector<double> flat;
  for (std::size_t i = 0; i < std::max(kFewestBlocks, blocks.size() / 10); ++i) {
    flat.push_back(blocks[i].second);
  }
  std::ranges::sort(flat);
  const double median = 0.5 * (flat[(flat.size() - 1) / 2] + flat[flat.size() / 2]);
  // The operator's weights have norm 6; sqrt(pi / 2) converts a mean absolute value to a deviation.
  return std::sqrt(std::numbers::pi / 2) / 6 * median;
}

double compression_levels(const cv::Mat1b& grey) {
  cv::Mat1b columns;
  cv::transpose(grey, columns);
  // A fence may repeat every 8 pixels, but only in one direction.
  return std::sqrt(std::max(0.0, std::min(excess(jumps(grey)), excess(jumps(columns)))));
}

int threshold_of(const cv::Mat1b& grey) {
  constexpr double kLeast = 20, kMost = 254, kDeviations = 8;
  const auto levels = [&](double deviation) {
    return static_cast<int>(std::lround(std::clamp(kDeviations * deviation, kLeast, kMost)));
  };
  constexpr double kMostNoise = 6;  // above it is texture: no block is flat
  const double noise = std::min(noise_levels(grey).value_or(0), kMostNoise);
  const int by_noise = levels(noise);
  const int by_both = levels(std::hypot(noise, compression_levels(grey)));
  return by_both > by_noise ? std::clamp(crowded_up_to(grey, by_noise), by_noise, by_both)
                            : by_noise;
}

}  // namespace lcs
