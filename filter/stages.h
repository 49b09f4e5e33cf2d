/// \file
/// The three experts of a frame, and what goes from one to the next and from one frame to the next.
///
/// Of the frame before, each expert goes on from what it made itself: Circle from edges and
/// circles, Square from squares. Only psi, which the Line expert starts from where regions are
/// ignored, comes from the circles and squares of the frame before (transitions II and IV).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "filter/circle.h"
#include "filter/diagnostics.h"
#include "filter/edge_expert.h"
#include "filter/filter.h"
#include "filter/intake.h"
#include "filter/line.h"
#include "filter/motion_field.h"
#include "filter/square.h"
#include "filter/unseen_turn.h"

namespace lcs {

/// What is known of a frame while the experts are at it. One is carried on from frame to frame.
struct Frame {
  bool is_anew = true;               ///< nothing of the frame before is to be used
  EgoMotion motion;                  ///< since then
  std::optional<MotionField> field;  ///< of it
  Chi chi;
  FrameResult result;
};

class Stages {
 public:
  /// \throws std::invalid_argument for parameters out of range, or a camera that is none.
  Stages(const Intrinsics& camera, const Parameters& parameters);

  /// Each in turn for a frame.
  /// \param signatures one for each corner, or none at all.
  /// \param frame the one before, in whose place this one comes.
  void line(std::span<const Eigen::Vector2f> corners_px, std::span<const Signature> signatures,
            const EgoMotion& told, Frame& frame);
  void circle(Frame& frame);
  void square(Frame& frame);

  /// Of all frames that the Line expert has seen.
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  bool is_turn_unseen(const Frame& frame) const {
    return parameters_.field.unseen_turn && !frame.is_anew && frame.motion.unseen_turn_rad > 0;
  }
  /// Whether the Line expert starts from circles and squares.
  bool feeds_back() const { return parameters_.line.ignore; }
  void start_anew(Layers& layers);
  void see_turn(Frame& frame, std::span<const Vec2> corners_px);
  void predict_circles(Frame& frame);
  void predict_squares(Frame& frame);
  void turn_away(std::span<const Eigen::Vector2f> corners_px, Frame& frame);

  Intrinsics camera_;
  Parameters parameters_;
  // Of the Line expert.
  Intake intake_;
  LineExpert line_;
  Diagnostics diagnostics_;
  std::vector<Vec2> finite_;  ///< corners
  // Of the Circle expert, or where regions are ignored of the Line expert.
  UnseenTurn turn_;
  // Of the Circle expert.
  CornerGrouping grouping_;
  std::unique_ptr<EdgeExpert> edges_;
  CircleExpert circles_;
  // Of the Square expert.
  SquareExpert squares_;
};

}  // namespace lcs
