/// \file
/// Measures of tracking, detection and segmentation as the literature defines them. A test compares
/// them with TrackEval, pycocotools and DAVIS (tests/scoring/field_measures.sh).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <utility>
#include <vector>

namespace lcs::scoring {

/// Pairs (row, column), one to one, with the greatest sum of `worth`; as many as the shorter side
/// has entries. Hungarian algorithm (Kuhn 1955) with potentials, O(n^2 m).
std::vector<std::pair<int, int>> best_pairs(const Eigen::MatrixXd& worth);

/// The true and the detected boxes of a frame. Objects and tracks have numbers from 0.
struct FrameBoxes {
  std::vector<int> objects, tracks;
  Eigen::MatrixXd overlap;  ///< IoU, objects x tracks
};

struct TrackMeasures {
  /// HOTA, DetA and AssA: means over IoU .05 to .95 (Luiten et al., IJCV 2021).
  double hota = 0, detection = 0, association = 0;
  double mota = 0;           ///< at IoU .5 (Bernardin and Stiefelhagen, 2008)
  int identity_changes = 0;  ///< IDSW of MOTA
  double idf1 = 0;           ///< at IoU .5 (Ristani et al., 2016)
};

/// \param frames with at least one object.
TrackMeasures measure_tracks(std::span<const FrameBoxes> frames);

/// A point of a precision-recall curve: the findings at a threshold or above.
struct Found {
  std::int64_t right = 0, wrong = 0;
};

/// Mean over the recalls 0, .01, ..., 1 of the greatest precision at that recall or above (COCO).
/// \param curve by falling threshold. \param positives all that should be found, at least 1.
double average_precision(std::span<const Found> curve, std::int64_t positives);

/// F of the boundaries of two masks of one size: a boundary pixel is right if the other mask has
/// one within `reach_px` (Perazzi et al., CVPR 2016; DAVIS takes .008 of the picture's diagonal).
double boundary_f(const cv::Mat1b& a, const cv::Mat1b& b, int reach_px);

}  // namespace lcs::scoring
