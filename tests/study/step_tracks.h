/// \file
/// The default filter's edges (`filter/edges/edge_expert.h`) without the correction of the told
/// motion (8)-(11), put together from their public parts: prediction, association, log odds,
/// coasting and, if asked for, the votes and the beliefs of neighbours.
#pragma once

#include <utility>
#include <vector>

#include "filter/edges/edge_expert.h"
#include "tests/study/rules.h"

namespace lcs::study {

class StepTracks {
 public:
  StepTracks(const Intrinsics& camera, const EdgeParameters& parameters, const TrustRanks& trust,
             const Rules& rules);

  /// Like `EdgeExpert::step`.
  const EdgeExpert::Result& step(const Chi& chi, const MotionField& field);

  /// Drops all tracks.
  void forget();

 private:
  void take(const Chi& chi);
  void estimate_noise(double dt_s);
  TrackFrame frame_of(const MotionField& field) const;
  void follow(const MotionField& field, const Chi& chi);
  Sightings sightings() const;
  void see(const MotionField& field, const Chi& chi);
  void coast(const MotionField& field);
  void believe(const MotionField& field);
  void decide(const Chi& chi, const MotionField& field);
  void make_edges(const Chi& chi, const MotionField& field);

  Intrinsics camera_;
  EdgeParameters parameters_;
  TrustRanks trust_;
  Rules rules_;
  Id next_id_ = 1;
  double noise2_px2_ = 0, last_noise2_px2_ = 0;
  CornerNoise noise_;
  Neighbourhood around_, nobody_;  // nobody: each corner without neighbours
  Association association_;
  Coupling coupling_;
  std::size_t corners_ = 0;
  std::vector<float> x_px_, y_px_;
  std::vector<int> track_of_, kept_;
  Tracks tracks_, predicted_;
  std::vector<float> shown_, speed_pxps_, angle_, sure_;
  std::vector<Coupling::Node> nodes_;
  std::vector<std::pair<Id, std::size_t>> order_;
  EdgeExpert::Result result_;
};

}  // namespace lcs::study
