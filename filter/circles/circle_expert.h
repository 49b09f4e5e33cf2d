/// \file
/// Circle expert, second part: groups edges with similar motion into circles. Each circle is one
/// `MotionGroups` group. It keeps its id while it shares most edges with its previous group.
#pragma once

#include <span>
#include <vector>

#include "filter/circles/circle_parameters.h"
#include "filter/circles/motion_groups.h"
#include "filter/kinematics/motion_field.h"
#include "filter/types/layers.h"

namespace lcs {

/// The mean circle C_m: mean place and motion of the edges; the radius reaches the outermost edge.
/// \param group indices into `edges`; at least one, all of one kind.
/// \param same gives id, trust and age.
Circle mean_circle(const std::vector<Edge>& edges, std::span<const int> group,
                   const MotionField& field, const Circle& same = {});

class CircleExpert {
 public:
  CircleExpert(const Intrinsics& camera, const CircleParameters& parameters,
               const EdgeParameters& edges)
      : parameters_(parameters), groups_(camera, parameters, edges) {}

  struct Result {
    BothKinds<Circle> circles;
    BothKinds<int> of_edges;  ///< index of each edge's circle among its kind, -1: in no circle
  };

  /// Groups the edges of both kinds. Matched circles keep id, trust and age of the last frame.
  /// \return valid until the next call.
  const Result& step(const BothKinds<Edge>& edges, const MotionField& field);

  /// Drops all circles.
  void forget();

 private:
  /// An edge that belonged to a circle in the last frame.
  struct Member {
    Id edge;
    int circle;
  };

  /// Number of edges that a group shares with a circle of the last frame.
  struct Share {
    int edges, circle;
    std::size_t group;
  };

  bool is_line(const std::vector<Edge>& edges, std::span<const int> group) const;
  void match(const std::vector<Edge>& edges, std::size_t circles,
             const std::vector<Member>& before);
  void regroup(const std::vector<Edge>& edges, const MotionField& field,
               std::vector<Circle>& circles, std::vector<int>& of_edges,
               std::vector<Member>& members);

  CircleParameters parameters_;
  MotionGroups groups_;
  Id next_id_ = 1;
  Result result_;
  BothKinds<Member> members_;  // of the last frame, by rising edge id

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<MotionGroups::Group> found_;
  std::vector<Share> shares_;
  std::vector<int> circle_of_group_, group_of_circle_;
  std::vector<Circle> next_;
};

}  // namespace lcs
