/// \file
/// Assigns corners to tracks, one to one.
///
/// A corner that surely continues a track, by the track's prediction and signature, is compared
/// only with the tracks that are predicted close to it; any other corner with all tracks within
/// reach.
///
/// A pair's weight is its likelihood ratio against clutter: density of the track's prediction over
/// density of tracks there, times the likelihood ratio of the signatures. Neighbouring corners vote
/// with the same ratio for the same step. Many votes for one step make a chance
/// match unlikely. A vote from corners that look alike counts little.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "filter/edges/edge_parameters.h"
#include "filter/edges/neighbourhood.h"
#include "filter/edges/tracks.h"
#include "filter/line/line.h"
#include "filter/matching/point_grid.h"
#include "filter/vectors/vectors.h"

namespace lcs {

class Association {
 public:
  explicit Association(const EdgeParameters& parameters);

  /// \param around the corners' neighbours, which vote.
  /// \param predicted tracks, predicted to this frame, in its pixels; sets where they are expected.
  /// \return the index of each corner's track, -1: none; padded.
  const std::vector<int>& match(const Chi& chi, const Neighbourhood& around, Tracks& predicted,
                                const TrackFrame& frame);

  /// In the last match: 1 + the number of tracks within `neighbour_reach` of each corner; padded.
  const float* crowd() const { return crowd_.data(); }
  /// In the last match: density of wrong pairs that look as good as each corner's own pair, 1/px^2,
  /// from the tracks there and its signature; 0 without signatures; padded.
  const float* chance_ppx2() const { return chance_ppx2_.data(); }

 private:
  /// A candidate pair of a corner and a track. Sorted by falling weight.
  struct Pair {
    double weight;  // ln of the likelihood ratio, without votes
    int track;
    float likeness;  // ln of the signatures' likelihood ratio
    bool operator<(const Pair& other) const {
      return weight > other.weight || (weight == other.weight && track < other.track);
    }
  };

  /// The heaviest pair of a corner.
  struct Match {
    double weight;
    int corner, track;
    double signature;
  };

  /// Tracks that are looked for within the same distance.
  struct Sought {
    PointGrid grid;
    std::vector<Vec2> places;
    std::vector<int> tracks;  // of the places
    // In the order of the grid:
    std::vector<int> track_at;
    std::vector<Signature> signatures;

    void clear();
    void build(const Tracks& predicted, double cell_px);
  };

  bool find_pairs(std::size_t corner, const Vec2& x_px, const Signature* signature,
                  const Tracks& predicted, const Sought& sought, double reach_px);
  void seek(const Tracks& predicted);
  void find_pairs(const Chi& chi, const Tracks& predicted);
  void offer(std::size_t corner, const Pair& pair);
  double clutter_ppx2(std::size_t corner) const;
  Match best_pair(std::size_t corner, std::span<const Neighbour> others, const PairColumns& pairs);

  EdgeParameters parameters_;
  std::array<double, 257> likeness_;  // ln of the ratio, by the number of differing bits
  int most_bits_ = -1;                // with a likeness of at least 0

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  Sought followed_;                         // tracks with three sightings, near their predictions
  Sought all_;                              // all tracks, about their rotated places
  PointGrid::Found near_;                   // to a corner
  double close_px_ = 0, reach_px_ = 0;      // where followed tracks and all are looked for
  std::vector<Alike> alike_;                // of these, to its signature
  std::vector<int> which_;                  // the tracks of these
  std::vector<float> ln_density_, ln_off_;  // `TrackLoops::densities` of these
  std::size_t most_pairs_ = 0;              // that are kept of each corner
  std::vector<Pair> pairs_;                 // so many places for each corner
  std::vector<std::uint32_t> counts_;       // of the pairs of each corner
  std::vector<float> step_x_, step_y_, likeness_of_;  // of the pairs
  std::vector<float> crowd_;                          // of each corner
  std::vector<float> ln_clutter_;                     // of the density of tracks at each corner
  // The voices of a corner, nearest first: its neighbours, with weights and ln_clutter.
  std::vector<int> voices_;
  std::vector<float> voice_weights_, voice_clutter_;
  std::vector<Match> matches_;
  std::vector<char> taken_;
  std::vector<int> track_of_;
  std::vector<float> chance_ppx2_;  // of each corner
};

}  // namespace lcs
