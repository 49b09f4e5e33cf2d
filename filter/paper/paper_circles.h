/// \file
/// The paper's circles: each starts from a trusted edge and takes those near it of like direction
/// and velocity, and is matched to the predicted ones by overlap ("Normal Edge Circling", "Rebel
/// Edge Circling").
#pragma once

#include <span>
#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/matching/point_grid.h"
#include "filter/parameters.h"

namespace lcs {

class PaperCircles {
 public:
  PaperCircles(const Intrinsics& camera, const CircleParameters& parameters);

  /// Groups the edges of one kind, and matches, estimates, makes and deletes its circles.
  void update(std::vector<Edge>& edges, std::vector<Circle>& circles, const Layers& layers,
              const MotionField& field);

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
  void group(const std::vector<Edge>& edges, const MotionField& field);
  std::span<const int> members(const Group& group) const {
    return std::span(grouped_).subspan(group.first, group.count);
  }
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
  std::vector<int> grouped_;
  std::vector<Group> groups_;
  std::vector<Pair> pairs_;
  std::vector<int> circle_of_group_;
  std::vector<char> matched_;  // circles
  std::vector<int> kept_;      // index of each circle after deletion, -1: deleted
};

}  // namespace lcs
