/// \file
/// Circle expert, second part: edges of like motion become circles, which go on from frame to
/// frame. By default a circle is one group of `MotionGroups`, known again by its edges; the paper's
/// are `PaperCircles`.
#pragma once

#include <span>
#include <vector>

#include "filter/circles/motion_groups.h"
#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/paper/paper_circles.h"
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
  /// An edge of a circle, which is given by its index.
  struct Member {
    Id edge;
    int circle;
  };

  /// How many edges a group has of a circle of the frame before.
  struct Share {
    int edges, circle;
    std::size_t group;
  };

  bool is_line(const std::vector<Edge>& edges, std::span<const int> group) const;
  void match(const std::vector<Edge>& edges, const std::vector<Circle>& circles,
             const std::vector<Member>& before);
  void regroup(std::vector<Edge>& edges, std::vector<Circle>& circles, std::vector<Member>& members,
               const Layers& layers, const MotionField& field);

  CircleParameters parameters_;
  PaperCircles paper_;
  MotionGroups groups_;
  Id next_id_ = 1;
  std::vector<Member> normal_members_, rebel_members_;  // of the last frame, by their edges

  // Of the current frame; kept for their memory.
  std::vector<MotionGroups::Group> found_;
  std::vector<Share> shares_;
  std::vector<int> circle_of_group_, group_of_circle_;
  std::vector<Circle> next_;
};

}  // namespace lcs
