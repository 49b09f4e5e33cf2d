/// \file
/// The three experts of a frame, and what goes from one to the next and from one frame to the next.
///
/// Of the frame before, each expert goes on from what it made itself: Circle from edges and
/// circles, Square from squares. So the experts of different frames can be at work at once
/// (`filter/pipeline.h`), unless regions are ignored: psi, which the Line expert starts from, comes
/// from the circles and squares of the frame before (transitions II and IV).
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

/// What is known of a frame while the experts are at it.
struct Frame {
  bool is_anew = true;               ///< nothing of the frame before is to be used
  EgoMotion motion;                  ///< since then
  std::optional<MotionField> field;  ///< of it
  Chi chi;
  std::vector<Follower> followers;  ///< from the Circle expert to the Square expert
  FrameResult result;
};

class Stages {
 public:
  /// \throws std::invalid_argument for parameters out of range, or a camera that is none.
  Stages(const Intrinsics& camera, const Parameters& parameters);

  /// Whether the Line expert needs the frame before finished.
  bool feeds_back() const { return parameters_.line.ignore; }

  /// Each in turn for a frame; each expert takes frames in their order. `before` may be the frame
  /// itself, which then is carried on in place.
  void line(std::span<const Eigen::Vector2f> corners_px, const EgoMotion& told, const Frame& before,
            Frame& frame);
  void circle(const Frame& before, Frame& frame);
  void square(const Frame& before, Frame& frame);

  /// Of all frames that the Line expert has seen.
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  bool is_turn_unseen(const Frame& frame) const {
    return parameters_.field.unseen_turn && !frame.is_anew && frame.motion.unseen_turn_rad > 0;
  }
  void see_turn(const Frame& before, Frame& frame, std::span<const Vec2> corners_px);
  void predict_circles(const Frame& before, Frame& frame);
  void predict_squares(const Frame& before, Frame& frame);
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
