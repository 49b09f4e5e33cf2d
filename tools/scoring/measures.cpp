#include "tools/scoring/measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <opencv2/imgproc.hpp>

namespace lcs::scoring {
namespace {

constexpr double kTrackMatch = 0.5;
constexpr double kRounding = std::numeric_limits<double>::epsilon();

/// A matched pair of a frame.
struct Match {
  int object, track;
  double overlap;
};

struct Counts {
  Eigen::VectorXd objects, tracks;  ///< boxes of each
};

Counts count(std::span<const FrameBoxes> frames) {
  int objects = 0, tracks = 0;
  for (const FrameBoxes& frame : frames) {
    for (const int object : frame.objects) objects = std::max(objects, object + 1);
    for (const int track : frame.tracks) tracks = std::max(tracks, track + 1);
  }
  Counts counts{Eigen::VectorXd::Zero(objects), Eigen::VectorXd::Zero(tracks)};
  for (const FrameBoxes& frame : frames) {
    counts.objects(frame.objects).array() += 1;
    counts.tracks(frame.tracks).array() += 1;
  }
  return counts;
}

/// How much the boxes of each object and track overlap over all frames, relative to their number.
Eigen::MatrixXd alignment(std::span<const FrameBoxes> frames, const Counts& counts) {
  Eigen::MatrixXd common = Eigen::MatrixXd::Zero(counts.objects.size(), counts.tracks.size());
  for (const FrameBoxes& frame : frames) {
    const Eigen::ArrayXXd overlap = frame.overlap;
    const Eigen::ArrayXXd all = overlap.rowwise().sum().replicate(1, overlap.cols()) +
                                overlap.colwise().sum().replicate(overlap.rows(), 1) - overlap;
    common(frame.objects, frame.tracks).array() += (all > kRounding).select(overlap / all, 0);
  }
  const Eigen::MatrixXd all = counts.objects.replicate(1, counts.tracks.size()) +
                              counts.tracks.transpose().replicate(counts.objects.size(), 1);
  return common.cwiseQuotient(all - common);
}

void measure_hota(std::span<const FrameBoxes> frames, const Counts& counts,
                  TrackMeasures& measures) {
  const Eigen::MatrixXd aligned = alignment(frames, counts);
  std::vector<Match> matches;
  for (const FrameBoxes& frame : frames) {
    const Eigen::MatrixXd worth = aligned(frame.objects, frame.tracks).cwiseProduct(frame.overlap);
    for (const auto& [i, j] : best_pairs(worth)) {
      matches.push_back({frame.objects[i], frame.tracks[j], frame.overlap(i, j)});
    }
  }
  constexpr int kThresholds = 19;
  const double boxes = counts.objects.sum() + counts.tracks.sum();
  for (int step = 1; step <= kThresholds; ++step) {
    std::map<std::pair<int, int>, int> together;
    int right = 0;
    for (const Match& match : matches) {
      if (match.overlap < 0.05 * step - kRounding) continue;
      ++right;
      ++together[{match.object, match.track}];
    }
    double associated = 0;
    for (const auto& [pair, times] : together) {
      const double all = counts.objects[pair.first] + counts.tracks[pair.second] - times;
      associated += times * (times / all);
    }
    const double detection = right / (boxes - right);
    const double association = associated / std::max(1, right);
    measures.detection += detection;
    measures.association += association;
    measures.hota += std::sqrt(detection * association);
  }
  for (double* sum : {&measures.hota, &measures.detection, &measures.association}) {
    *sum /= kThresholds;  // once, so that right tracks have exactly 1
  }
}

void measure_mota(std::span<const FrameBoxes> frames, const Counts& counts,
                  TrackMeasures& measures) {
  // A pair of the frame before is kept if it still overlaps enough.
  constexpr double kKept = 1000;
  std::map<int, int> before, last;  // the track of each object: in the frame before, ever
  int right = 0;
  for (const FrameBoxes& frame : frames) {
    if (frame.objects.empty() || frame.tracks.empty()) continue;
    Eigen::MatrixXd worth = frame.overlap;
    for (Eigen::Index i = 0; i < worth.rows(); ++i) {
      const auto track = before.find(frame.objects[i]);
      for (Eigen::Index j = 0; j < worth.cols(); ++j) {
        if (worth(i, j) < kTrackMatch - kRounding) {
          worth(i, j) = 0;
        } else if (track != before.end() && track->second == frame.tracks[j]) {
          worth(i, j) += kKept;
        }
      }
    }
    before.clear();
    for (const auto& [i, j] : best_pairs(worth)) {
      if (!(worth(i, j) > 0)) continue;
      ++right;
      const int object = frame.objects[i], track = frame.tracks[j];
      before[object] = track;
      const auto [entry, is_first] = last.try_emplace(object, track);
      measures.identity_changes += entry->second != track;
      entry->second = track;
    }
  }
  const double wrong = counts.tracks.sum() - right;
  measures.mota = (right - wrong - measures.identity_changes) / counts.objects.sum();
}

void measure_idf1(std::span<const FrameBoxes> frames, const Counts& counts,
                  TrackMeasures& measures) {
  Eigen::MatrixXd together = Eigen::MatrixXd::Zero(counts.objects.size(), counts.tracks.size());
  for (const FrameBoxes& frame : frames) {
    together(frame.objects, frame.tracks).array() +=
        (frame.overlap.array() >= kTrackMatch).cast<double>();
  }
  double right = 0;
  for (const auto& [object, track] : best_pairs(together)) right += together(object, track);
  measures.idf1 = 2 * right / (counts.objects.sum() + counts.tracks.sum());
}

/// The pixels with a neighbour to the right, below or both that differs.
cv::Mat1b boundary(const cv::Mat1b& mask) {
  cv::Mat1b wide;
  cv::copyMakeBorder(mask, wide, 0, 1, 0, 1, cv::BORDER_REPLICATE);
  const cv::Rect here(cv::Point(), mask.size());
  const cv::Mat rim = (mask != wide(here + cv::Point(1, 0))) |
                      (mask != wide(here + cv::Point(0, 1))) |
                      (mask != wide(here + cv::Point(1, 1)));
  return rim;
}

/// The share of the pixels of `of` that lie within a disc round one of `to`.
double near_share(const cv::Mat1b& of, const cv::Mat1b& to, const cv::Mat1b& disc) {
  cv::Mat1b reached;
  cv::dilate(to, reached, disc);
  return static_cast<double>(cv::countNonZero(of & reached)) / cv::countNonZero(of);
}

}  // namespace

std::vector<std::pair<int, int>> best_pairs(const Eigen::MatrixXd& worth) {
  if (worth.rows() > worth.cols()) {
    std::vector<std::pair<int, int>> pairs = best_pairs(worth.transpose());
    for (auto& [row, column] : pairs) std::swap(row, column);
    std::ranges::sort(pairs);
    return pairs;
  }
  // Index 0 is a column of no row: each new row starts an alternating path there.
  const int rows = static_cast<int>(worth.rows()), columns = static_cast<int>(worth.cols());
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> row_price(rows + 1, 0), column_price(columns + 1, 0);
  std::vector<int> row_of(columns + 1, 0);
  for (int row = 1; row <= rows; ++row) {
    std::vector<double> least(columns + 1, kFar);
    std::vector<int> from(columns + 1, 0);
    std::vector<char> done(columns + 1, 0);
    row_of[0] = row;
    int column = 0;
    do {
      done[column] = 1;
      const int at = row_of[column];
      double step = kFar;
      int next = 0;
      for (int c = 1; c <= columns; ++c) {
        if (done[c]) continue;
        const double cost = -worth(at - 1, c - 1) - row_price[at] - column_price[c];
        if (cost < least[c]) {
          least[c] = cost;
          from[c] = column;
        }
        if (least[c] < step) {
          step = least[c];
          next = c;
        }
      }
      for (int c = 0; c <= columns; ++c) {
        if (done[c]) {
          row_price[row_of[c]] += step;
          column_price[c] -= step;
        } else {
          least[c] -= step;
        }
      }
      column = next;
    } while (row_of[column] != 0);
    for (; column != 0; column = from[column]) row_of[column] = row_of[from[column]];
  }
  std::vector<std::pair<int, int>> pairs;
  for (int c = 1; c <= columns; ++c) {
    if (row_of[c] != 0) pairs.emplace_back(row_of[c] - 1, c - 1);
  }
  std::ranges::sort(pairs);
  return pairs;
}

TrackMeasures measure_tracks(std::span<const FrameBoxes> frames) {
  const Counts counts = count(frames);
  TrackMeasures measures;
  measure_hota(frames, counts, measures);
  measure_mota(frames, counts, measures);
  measure_idf1(frames, counts, measures);
  return measures;
}

double average_precision(std::span<const Found> curve, std::int64_t positives) {
  constexpr int kRecalls = 101;
  const auto precision = [](const Found& at) {
    const std::int64_t all = at.right + at.wrong;
    return all > 0 ? static_cast<double>(at.right) / static_cast<double>(all) : 0;
  };
  double sum = 0, best = 0;
  std::size_t left = curve.size();
  for (int step = kRecalls - 1; step >= 0; --step) {
    const double recall = step * 0.01;  // rounded as COCO does
    for (; left > 0; --left) {
      const Found& at = curve[left - 1];
      if (static_cast<double>(at.right) / static_cast<double>(positives) < recall) break;
      best = std::max(best, precision(at));
    }
    sum += best;
  }
  return sum / kRecalls;
}

double boundary_f(const cv::Mat1b& a, const cv::Mat1b& b, int reach_px) {
  const cv::Mat1b rim_a = boundary(a), rim_b = boundary(b);
  const bool has_a = cv::countNonZero(rim_a) > 0, has_b = cv::countNonZero(rim_b) > 0;
  if (!has_a || !has_b) return has_a == has_b ? 1 : 0;
  cv::Mat1b disc(2 * reach_px + 1, 2 * reach_px + 1);
  for (int y = -reach_px; y <= reach_px; ++y) {
    for (int x = -reach_px; x <= reach_px; ++x) {
      disc(y + reach_px, x + reach_px) = x * x + y * y <= reach_px * reach_px;
    }
  }
  const double precision = near_share(rim_a, rim_b, disc), recall = near_share(rim_b, rim_a, disc);
  return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0;
}

}  // namespace lcs::scoring
