/// \file
/// Edges by two hypotheses: each tracked corner stands or moves by itself, and carries the log odds
/// of the latter. The formulas are in filter/MODEL.md (6) to (20).
#pragma once

#include <vector>

#include "filter/edges/association.h"
#include "filter/edges/coupling.h"
#include "filter/edges/edge_expert.h"
#include "filter/edges/motion_fix.h"
#include "filter/edges/track.h"

namespace lcs {

class HypothesisEdges : public EdgeExpert {
 public:
  HypothesisEdges(const Intrinsics& camera, const CircleParameters& parameters);

  void predict(Layers& layers, const MotionField& field) override;
  void update(Layers& layers, const Chi& chi, const MotionField& field,
              std::vector<Verdict>& verdicts) override;
  void forget() override {
    tracks_.clear();
    predicted_.clear();
    velocity_error_.forget();
    began_anew_ = false;
    noise_sum_px2_ = noise_weight_ = 0;
  }

 private:
  void estimate_noise(double dt_s);
  void predict_tracks(const MotionField& field);
  void find_residuals(const MotionField& field, const Chi& chi, const std::vector<int>& track_of,
                      bool started);
  Track first_seen(const Chi& chi, std::size_t corner);
  bool see(Track& track, const Vec2& x_px, double chance_ppx2, const MotionField& field);
  double first_step(const Track& track, const Vec2& x_px, const DepthBounds& bounds) const;
  double faded(double log_odds, double dt_s) const;
  void coast(const std::vector<IgnoreRegion>& psi, const MotionField& field);
  void couple(const MotionField& field);
  void decide(Layers& layers, const Chi& chi, const MotionField& field,
              std::vector<Verdict>& verdicts);
  Edge edge_of(const Track& track, const MotionField& field) const;

  HypothesisParameters parameters_;
  double noise2_px2_ = 0;                        // of this frame's corners, by the frames before
  double noise_sum_px2_ = 0, noise_weight_ = 0;  // seen in these: its sum, and that of the weights
  Association association_;
  Coupling coupling_;
  VelocityError velocity_error_;
  std::vector<Track> tracks_;     // of the last frame; those of its corners first, by chi
  std::vector<Track> predicted_;  // the same, in this frame
  std::vector<Residual> residuals_;
  std::vector<Coupling::Node> nodes_;
  std::vector<Track*> seen_;  // of each node
};

}  // namespace lcs
