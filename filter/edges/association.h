/// \file
/// Which corner is a sighting of which track, one to one.
///
/// A pair is weighed by its likelihood ratio against clutter: the density of the track's prediction
/// over the density of corners there, times how much more often signatures that differ so much are
/// of one place than of two. Its neighbours vote, each by the same ratio for the same step: many
/// that agree on a step make a chance match unlikely, while a hit among corners that look alike
/// says little.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "filter/edges/edge_parameters.h"
#include "filter/edges/track.h"
#include "filter/line/line.h"
#include "filter/matching/point_grid.h"

namespace lcs {

class Association {
 public:
  explicit Association(const EdgeParameters& parameters);

  /// \param predicted tracks, in this frame's pixels.
  /// \return for each corner of chi the track that it is a sighting of, -1: of none.
  const std::vector<int>& match(const Chi& chi, std::span<const Track> predicted, double noise2_px2,
                                double dt_s);

  /// Of the last match: tracks within `neighbour_reach` of a corner, and itself.
  int crowd(std::size_t corner) const { return crowd_[corner]; }
  /// Of the last match: how densely pairs that are none but look as good lie about a corner that
  /// has a track, by the tracks there and its signature; 0 without signatures.
  double chance_ppx2(std::size_t corner) const { return chance_ppx2_[corner]; }
  /// px: how far a corner may be from where the rotation alone puts it.
  double reach_px(double dt_s) const;
  /// px^2: of the circle about it.
  double reach_area_px2(double dt_s) const;

 private:
  /// A corner may be a sighting of a track. The likeliest first.
  struct Pair {
    double weight;  // ln of the ratio of all but the neighbours
    int track;
    float likeness;  // ln of the ratio that signatures give
    bool operator<(const Pair& other) const {
      return weight > other.weight || (weight == other.weight && track < other.track);
    }
  };

  /// A neighbour that is asked, and what it counts.
  struct Voice {
    std::size_t corner;
    double weight;
  };

  /// A normal density times a share; 0 if not set.
  struct Share {
    Vec2 place_px = Vec2::Zero();
    Eigen::Matrix2d precision = Eigen::Matrix2d::Zero();
    double ln_most = -std::numeric_limits<double>::infinity();

    void set(const Vec2& at_px, const Eigen::Matrix2d& covariance, double share);
    double ln(const Vec2& x_px) const {
      const Vec2 off = x_px - place_px;
      return ln_most - 0.5 * off.dot(precision * off);
    }
  };

  /// Where a frame may show a track.
  struct Expected {
    Vec2 track_px;
    Share still, moving;
    double anywhere_ppx2, ln_anywhere;
  };

  void expect(std::span<const Track> predicted, double noise2_px2, double dt_s);
  void find_pairs(const Chi& chi, std::span<const Track> predicted, double dt_s);
  void offer(const Pair& pair);
  double clutter_ppx2(std::size_t corner) const;
  double asked(std::size_t pair, double noise2_px2, double least) const;

  EdgeParameters parameters_;
  std::array<double, 257> likeness_;  // by the number of bits that differ

  // Of the current frame; kept for their memory.
  PointGrid tracks_, corners_;
  std::vector<Vec2> places_;
  std::vector<Signature> signatures_;             // of the tracks
  std::vector<Expected> expected_;                // of the tracks
  std::vector<Pair> pairs_;                       // by corner
  std::vector<std::size_t> first_;                // of each corner's
  Eigen::ArrayXf step_x_, step_y_, likeness_of_;  // of the pairs, to be looked through at once
  std::vector<int> crowd_;                        // of each corner
  std::vector<double> ln_clutter_;                // of the density of tracks, of each corner
  std::vector<double> ln_likest_;                 // of its pairs, over that
  std::vector<Neighbour> near_;
  std::vector<Voice> voices_;  // nearest first
  struct Match {
    double weight;
    int corner, track;
    double signature;
  };
  std::vector<Match> matches_;
  std::vector<char> taken_;
  std::vector<int> track_of_;
  std::vector<double> chance_ppx2_;  // of each corner
};

}  // namespace lcs
