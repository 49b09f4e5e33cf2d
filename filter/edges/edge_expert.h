/// \file
/// Circle expert, first part: edges. Each track is a static point or moves by itself; its edge
/// holds the log odds of moving (filter/MODEL.md).
#pragma once

#include <cstdint>
#include <vector>

#include "filter/edges/association.h"
#include "filter/edges/coupling.h"
#include "filter/edges/edge_parameters.h"
#include "filter/edges/motion_fix.h"
#include "filter/edges/track.h"
#include "filter/kinematics/motion_field.h"
#include "filter/line/line.h"
#include "filter/types/frame_result.h"
#include "filter/types/trust.h"

namespace lcs {

/// The motion that a frame's edges are made with.
enum class UsedMotion : std::uint8_t {
  told,
  held,  ///< the last frame's motion goes on: the corners contradict the told motion
  none,  ///< the corners contradict the told motion, and all tracks were dropped
};

class EdgeExpert {
 public:
  /// \param trust ranks of an edge's trust, which measures the certainty of its kind.
  EdgeExpert(const Intrinsics& camera, const EdgeParameters& parameters, const TrustRanks& trust);

  struct Result {
    BothKinds<Edge> edges;          ///< by rising id
    std::vector<Verdict> verdicts;  ///< of each corner of chi
    std::vector<Reason> reasons;    ///< of each corner of chi
    UsedMotion motion = UsedMotion::told;
  };

  /// Predicts the tracks of the frame before, assigns the corners to them, and updates their
  /// beliefs.
  /// \param told the motion field of the given ego-motion since the frame before.
  /// \param held the motion field of the last frame's motion, over the same time; null: unknown.
  /// \return valid until the next call.
  const Result& step(const Chi& chi, const MotionField& told, const MotionField* held = nullptr);

  /// Drops all tracks.
  void forget();

 private:
  void estimate_noise(double dt_s);
  void predict_tracks(const MotionField& field);
  void correct_predictions(const MotionField& field);
  const std::vector<int>& follow(const MotionField& field, const Chi& chi);
  bool is_held(const MotionField& held, const Chi& chi, const std::vector<int>& track_of) const;
  bool is_first_wrong(const MotionField& told, const MotionField& first, const Chi& chi,
                      const std::vector<int>& track_of) const;
  void find_residuals(const MotionField& field, const Chi& chi, const std::vector<int>& track_of,
                      bool started);
  void correct_residuals(const Chi& chi, const std::vector<int>& track_of, bool started);
  bool has_residual(int track, bool started) const;
  Track first_seen(const Chi& chi, std::size_t corner);
  bool update(Track& track, const Vec2& x_px, double chance_ppx2, const MotionField& field);
  double first_step(const Track& track, const Vec2& x_px, const DepthBounds& bounds,
                    double noise2_px2) const;
  double faded(double log_odds, double dt_s) const;
  void coast(const MotionField& field);
  double shown(const Track& track, const MotionField& field) const;
  void couple(const MotionField& field);
  bool do_all_move() const;
  void decide(const Chi& chi, const MotionField& field);
  Edge edge_of(const Track& track, const MotionField& field) const;

  Intrinsics camera_;
  EdgeParameters parameters_;
  TrustRanks trust_;
  Id next_id_ = 1;
  double noise2_px2_ = 0;       // of this frame's corners, from earlier frames
  double last_noise2_px2_ = 0;  // of the last frame's corners, likewise
  CornerNoise noise_;           // of the corners of all frames so far, faded
  Neighbourhood around_;        // of this frame's corners
  Association association_;
  Coupling coupling_;
  MotionFinder motion_finder_;
  VelocityError velocity_error_;
  std::vector<Track> tracks_;     // of the last frame; tracks with a corner first, by chi
  std::vector<Track> predicted_;  // the same, predicted to this frame
  std::vector<Residual> residuals_;
  std::vector<Coupling::Node> nodes_;
  std::vector<Track*> seen_;  // of each node
  /// Depths were confirmed by a motion that they were not made with.
  bool is_confirmed_ = false;
  Result result_;
};

}  // namespace lcs
