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

/// By row modulo `kGrid_px`: the mean square of how far the step from the row above is from the
/// steps beside it.
using Jumps = std::array<double, kGrid_px>;

Jumps jumps(const cv::Mat1b& grey) {
  constexpr int kMostJump = 48;  // half levels: a sharp edge of the scene should not outweigh all
  std::array<std::int64_t, kGrid_px> sums{}, counts{};
  for (int y = 2; y + 1 < grey.rows; ++y) {
    const uchar *before = grey[y - 2], *above = grey[y - 1], *row = grey[y], *below = grey[y + 1];
    int sum = 0;  // a picture would have to be over 900,000 px wide
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

/// Of the rows where blocks meet over the largest of others. Any row may be theirs, as a picture
/// may be cut out of a larger one; the rows beside share its pixels.
double excess(const Jumps& jumps) {
  const auto most = static_cast<int>(std::max_element(jumps.begin(), jumps.end()) - jumps.begin());
  double other = 0;
  for (int beside = 2; beside <= kGrid_px - 2; ++beside) {
    other = std::max(other, jumps[static_cast<std::size_t>((most + beside) % kGrid_px)]);
  }
  return jumps[static_cast<std::size_t>(most)] - other;
}

/// The highest threshold at which there still is a corner for every 16x16 pixels.
/// \return less than `least` where there are fewer at `least` already.
int crowded_up_to(const cv::Mat1b& grey, int least) {
  constexpr std::size_t kPixelsEach = 256;
  std::vector<cv::KeyPoint> corners = FastDetector(least).detect_scored(grey);
  const std::size_t enough = grey.total() / kPixelsEach;
  if (corners.size() <= enough) return 0;
  const auto last = corners.begin() + static_cast<std::ptrdiff_t>(enough);
  std::nth_element(corners.begin(), last, corners.end(), [](const auto& a, const auto& b) {
    return a.response > b.response;  // the highest threshold at which it still is a corner
  });
  return static_cast<int>(last->response);
}

}  // namespace

std::optional<double> noise_levels(const cv::Mat1b& grey) {
  constexpr int kBlock_px = 16, kQuarter_px = kBlock_px / 2;
  constexpr double kDarkest = 6, kBrightest = 249;  // what is clipped has lost its noise
  constexpr std::size_t kFewestBlocks = 8;
  const cv::Matx13f immerkaer(1, -2, 1);  // both ways
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
  std::sort(blocks.begin(), blocks.end());
  std::vector<double> flat;
  for (std::size_t i = 0; i < std::max(kFewestBlocks, blocks.size() / 10); ++i) {
    flat.push_back(blocks[i].second);
  }
  std::sort(flat.begin(), flat.end());
  const double median = 0.5 * (flat[(flat.size() - 1) / 2] + flat[flat.size() / 2]);
  // The operator's weights have a norm of 6; sqrt(pi / 2) takes a mean size to a deviation.
  return std::sqrt(std::numbers::pi / 2) / 6 * median;
}

double compression_levels(const cv::Mat1b& grey) {
  cv::Mat1b columns;
  cv::transpose(grey, columns);
  // A fence may repeat itself every 8 pixels, but not both ways.
  return std::sqrt(std::max(0.0, std::min(excess(jumps(grey)), excess(jumps(columns)))));
}

int threshold_of(const cv::Mat1b& grey) {
  constexpr double kLeast = 20, kMost = 254, kDeviations = 8;
  const auto levels = [&](double deviation) {
    return static_cast<int>(std::lround(std::clamp(kDeviations * deviation, kLeast, kMost)));
  };
  constexpr double kMostNoise = 6;  // more is texture: there is no flat place to tell it by
  const double noise = std::min(noise_levels(grey).value_or(0), kMostNoise);
  const int by_noise = levels(noise);
  const int by_both = levels(std::hypot(noise, compression_levels(grey)));
  return by_both > by_noise ? std::clamp(crowded_up_to(grey, by_noise), by_noise, by_both)
                            : by_noise;
}

}  // namespace lcs
