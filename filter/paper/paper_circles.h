/// \file
/// The paper's circles ("Normal Edge Circling", "Rebel Edge Circling"): each starts from a trusted
/// edge, adds nearby edges of similar direction and velocity, and is matched to the predicted
/// circles by overlap.
#pragma once

#include <span>
#include <vector>

#include "filter/circles/circle_expert.h"
#include "filter/kinematics/motion_field.h"
#include "filter/matching/point_grid.h"
#include "filter/paper/parameters.h"
#include "filter/types/layers.h"

namespace lcs::paper {

class PaperCircles {
 public:
  /// \param ignore circles that reach Tr_m make regions of psi (transition II).
  PaperCircles(const Intrinsics& camera, const PaperCircleParameters& parameters,
               double corner_noise_px, bool ignore)
      : camera_(camera),
        parameters_(parameters),
        corner_noise_px_(corner_noise_px),
        ignore_(ignore) {}

  /// Predicts the circles of the last frame to this one.
  static void predict(BothKinds<Circle>& circles, const MotionField& field);

  /// Groups the edges. Matches, estimates, creates and deletes predicted circles of both kinds.
  void update(const BothKinds<Edge>& edges, std::span<const IgnoreRegion> psi,
              const MotionField& field, CircleExpert::Result& result);

 private:
  /// Mean circle of a group of edges, C_m.
  struct Group {
    Circle mean;
    std::size_t first = 0, count = 0;  // range of its edges in grouped_
  };

  /// An edge from which a group may start.
  struct Seed {
    int trust, age;
    std::size_t index;  // in free_
  };

  /// A candidate match of a predicted circle and a group.
  struct Pair {
    double overlap, distance;
    std::size_t circle, group;
    bool aligned;
  };

  bool alike(const Edge& a, const Edge& b, const MotionField& field) const;
  void group(const std::vector<Edge>& edges, const MotionField& field);
  std::span<const int> members(const Group& group) const {
    return std::span(grouped_).subspan(group.first, group.count);
  }
  void update_kind(const std::vector<Edge>& edges, std::span<const IgnoreRegion> psi,
                   const MotionField& field, std::vector<Circle>& circles,
                   std::vector<int>& of_edges);
  double overlap(const Circle& circle, const Group& group, const std::vector<Edge>& edges) const;
  void estimate_circle(Circle& circle, const Circle& mean, bool aligned) const;

  Intrinsics camera_;
  PaperCircleParameters parameters_;
  double corner_noise_px_;
  bool ignore_;
  Id next_id_ = 1;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  PointGrid grid_;
  std::vector<const Edge*> free_;  // trusted edges; null: already in a group
  std::vector<Vec2> points_;       // of free_
  std::vector<Seed> seeds_;
  std::vector<int> grouped_;
  std::vector<Group> groups_;
  std::vector<Pair> pairs_;
  std::vector<int> circle_of_group_;
  std::vector<char> matched_;  // of each circle
  std::vector<int> kept_;      // index of each circle after deletion, -1: deleted
};

}  // namespace lcs::paper
