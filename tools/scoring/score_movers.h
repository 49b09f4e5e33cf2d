/// \file
/// Scores a detector's moving squares and its log odds by the measures of the literature.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "tools/recording/recording.h"
#include "tools/scoring/score_rebels.h"
#include "tools/scoring/scoring.h"

namespace lcs::scoring {

// Measures of tracking, detection and segmentation as the literature defines them. A test compares
// them with TrackEval, pycocotools and DAVIS (tests/scoring/field_measures.sh).

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

struct MoverScore {
  int boxes = 0;                        ///< eligible boxes of objects that move in the frame
  int detected = 0;                     ///< those detected by the rule of event cameras' papers
  std::optional<TrackMeasures> tracks;  ///< absent without such a box
  /// \name Average precision by the detector's log odds; absent without them, or without positives.
  ///@{
  std::optional<double> corner_precision, box_precision;
  ///@}
  /// \name Of each frame with moving pixels; empty unless masks and picture size are known.
  ///@{
  std::vector<double> region_j, boundary_f;
  ///@}
  std::int64_t common_px = 0, all_px = 0;  ///< moving pixels, over these frames
  std::vector<double> latencies_ms;        ///< from an object's first rebel corner to its box
  double still_s = 0;                      ///< time in which no object moves
  int false_tracks = 0;                    ///< squares with other ids that move in it
};

/// Scores a run frame by frame, in order. Keeps the overlaps of boxes, and for each frame two
/// numbers.
class MoverScorer {
 public:
  /// \param picture_px absent: unknown.
  explicit MoverScorer(std::optional<cv::Size> picture_px) : picture_px_(picture_px) {}

  /// \param outcomes of the frame's corners. \param detections up to this frame.
  void add(const recording::FrameRecord& frame, const std::vector<CornerOutcome>& outcomes,
           const ObjectDetections& detections);
  /// \param detections of all frames.
  MoverScore score(const ObjectDetections& detections) const;

 private:
  struct Box {
    double odds;
    bool right;
  };

  void add_boxes(const recording::FrameRecord& frame, const ObjectDetections& detections);
  void add_pixels(const recording::FrameRecord& frame);
  void add_corners(const recording::FrameRecord& frame, const std::vector<CornerOutcome>& outcomes);
  void rank(const recording::FrameRecord& frame, const std::vector<const Square*>& squares,
            const Eigen::MatrixXd& overlap);

  std::optional<cv::Size> picture_px_;
  MoverScore sums_;
  std::set<int> moved_;             ///< objects that moved so far
  std::map<int, double> boxed_ms_;  ///< by object: time from its first rebel corner to its box
  std::map<int, int> objects_;      ///< numbers from 0
  std::map<Id, int> tracks_;
  std::vector<FrameBoxes> frames_;
  std::map<float, Found, std::greater<>> corners_;  ///< by log odds
  std::vector<Box> boxes_;
  std::set<Id> false_tracks_;
  std::int64_t last_ns_ = 0;
  bool has_odds_ = false, are_masks_known_ = true;
};

}  // namespace lcs::scoring
