/// \file
/// Circle expert, second part: edges of like motion become circles, which are matched to the
/// predicted ones ("Normal Edge Circling", "Rebel Edge Circling").
#pragma once

#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/matching/point_grid.h"
#include "filter/parameters.h"

namespace lcs {

class CircleExpert {
 public:
  CircleExpert(const Intrinsics& camera, const CircleParameters& parameters);

  /// Moves the circles to where this frame should show them.
  void predict(Layers& layers, const MotionField& field) const;

  /// The regions and collectors of this frame, from the predicted circles: those that reached Tr_m
  /// are ignored, the trusted others collect.
  void feed_back(const Layers& layers, std::vector<IgnoreRegion>& psi,
                 std::vector<Collector>& lambda) const;

  /// Groups the edges and matches, estimates, makes and deletes circles of both kinds.
  void update(Layers& layers, const MotionField& field);

  /// Transition II: normal circles that reached Tr_m will be ignored in the next frame, and their
  /// trust falls, so that they are looked at again after it. Rebels are never ignored.
  void update_ignorance(Layers& layers) const;

 private:
  /// Mean circle of a group of edges, C_m.
  struct Group {
    Circle mean;
    std::size_t first = 0, count = 0;  // of its edges in grouped_
  };

  /// An edge that a group may start from.
  struct Seed {
    int trust, age;
    std::size_t index;  // of free_
  };

  /// A predicted circle and a group that may be it.
  struct Pair {
    double overlap, distance;
    std::size_t circle, group;
    bool aligned;
  };

  bool alike(const Edge& a, const Edge& b, const MotionField& field) const;
  bool is_line(std::size_t first) const;
  void group(const std::vector<Edge>& edges, const MotionField& field);
  Group mean_circle(const std::vector<Edge>& edges, std::size_t first, std::size_t count,
                    const MotionField& field) const;
  void match(std::vector<Edge>& edges, std::vector<Circle>& circles, const Layers& layers,
             const MotionField& field);
  double overlap(const Circle& circle, const Group& group, const std::vector<Edge>& edges) const;
  void estimate_circle(Circle& circle, const Circle& mean, bool aligned) const;

  Intrinsics camera_;
  CircleParameters parameters_;
  Id next_id_ = 1;

  // Of the current frame; kept for their memory.
  PointGrid grid_;
  std::vector<const Edge*> free_;  // trusted, null: in a group
  std::vector<Vec2> points_;       // of them
  std::vector<Seed> seeds_;
  std::vector<std::size_t> grouped_;
  std::vector<Group> groups_;
  std::vector<Pair> pairs_;
  std::vector<int> circle_of_group_;
  std::vector<char> matched_;  // circles
  std::vector<int> kept_;      // index of each circle after deletion, -1: deleted
};

}  // namespace lcs
