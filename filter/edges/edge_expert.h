/// \file
/// Circle expert, first part: edges. Each track is a static point or moves by itself; its edge
/// holds the log odds of moving (filter/MODEL.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "filter/edges/association.h"
#include "filter/edges/corner_noise.h"
#include "filter/edges/coupling.h"
#include "filter/edges/edge_parameters.h"
#include "filter/edges/motion_fix.h"
#include "filter/edges/tracks.h"
#include "filter/kinematics/motion_field.h"
#include "filter/line/line.h"
#include "filter/types/frame_result.h"
#include "filter/types/trust.h"

namespace lcs {

struct Explanation;

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
    BothKinds<Edge> edges;            ///< by rising id
    std::vector<Verdict> verdicts;    ///< of each corner of chi
    std::vector<Reason> reasons;      ///< of each corner of chi
    std::span<const float> log_odds;  ///< of each corner of chi: that it moves by itself
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

  /// \param corner of the last frame's chi. The corners in the result are of chi, too.
  Explanation explain(std::size_t corner) const;

 private:
  void take(const Chi& chi);
  void estimate_noise(double dt_s);
  TrackFrame frame_of(const MotionField& field) const;
  void predict(const MotionField& field, const TrackFrame& frame, Tracks& predicted) const;
  void follow(const MotionField& told, const Chi& chi);
  Sightings sightings() const;
  bool is_held(const MotionField& held);
  bool is_first_wrong(const MotionField& told, const MotionField& first);
  MotionField corrected(const MotionField& field, bool started);
  void see(const MotionField& field, const Chi& chi);
  void coast(const MotionField& field);
  void couple(const MotionField& field);
  bool do_all_move() const;
  void decide(const Chi& chi, const MotionField& field);
  void make_edges(const Chi& chi, const MotionField& field);

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
  VelocityError velocity_error_;
  std::size_t corners_ = 0;               // of this frame
  std::vector<float> x_px_, y_px_;        // of these; padded
  std::vector<int> track_of_;             // of these, -1: none; padded
  Tracks tracks_;                         // of the last frame; tracks with a corner first, by chi
  Tracks predicted_, other_;              // the same, predicted to this frame
  std::vector<int> asked_;                // corners whose tracks may correct the motion
  Columns<float, kMissColumns> misses_;  // of these
  std::vector<int> kept_;                 // whether a corner's track was continued
  std::vector<float> off2_px2_, shown_;
  std::vector<Coupling::Node> nodes_;
  std::vector<float> speed_pxps_, angle_, sure_;   // of the tracks
  std::vector<std::pair<Id, std::size_t>> order_;  // of the tracks with a motion
  /// Depths were confirmed by a motion that they were not made with.
  bool is_confirmed_ = false;
  Result result_;
};

}  // namespace lcs
