/// \file
/// Layers from linked edges, beside the paper's couples of circles: what lies close together at one
/// depth, or moves as one, is one object.
///
/// With furthest-first couples of circles, a layer takes in whatever is at a like depth across half
/// the image; boxes come out too large to be objects, as the paper says itself. Here every normal
/// edge brings the depth of its whole path. Neighbours are linked by one distance, across, upwards
/// and in depth, in units of their own depth: bodies are taller than the gaps between them are
/// wide. Linked groups merge best link first (Kruskal) only where their means agree, so that a
/// chain of small steps does not join a near object to a far one. What is too large for an object,
/// or too high up, is the setting. Rebels are linked by their own velocities.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/matching/disjoint_sets.h"
#include "filter/matching/point_grid.h"
#include "filter/parameters.h"
#include "filter/squares/convex_hull.h"
#include "filter/squares/depth_groups.h"

namespace lcs {

class LinkLayering {
 public:
  LinkLayering(const Intrinsics& camera, const LinkParameters& parameters);

  /// Mean squares S_m of this frame, valid until the next call.
  /// \param followers of rebel edges, which belong to their squares.
  const std::vector<Square>& layer(const Layers& layers, const MotionField& field,
                                   std::span<const Follower> followers = {});

 private:
  /// An edge that may be linked.
  struct Node {
    Vec2 velocity_pxps = Vec2::Zero();  // rebels
    const Edge* edge = nullptr;
  };
  /// What follows a node.
  struct Companion {
    int node;
    Vec2 location;
  };
  /// Of a normal edge. Apart from the rest, for they are compared in great numbers.
  struct Depth {
    double w = 0;      // inverse depth, 1/m
    double sigma = 0;  // of w
  };

  void gather(const std::vector<Edge>& edges, double upward, const MotionField& field);
  void take_in(std::span<const Follower> followers);
  void link_by_depth();
  void link_by_velocity(double dt_s);
  void make_squares(DisjointSets& sets, std::size_t least, const MotionField& field);
  void make_square(std::span<const int> group, const MotionField& field);
  /// px: how far neighbours at an inverse depth may be seen apart.
  double reach(double w) const;
  /// The square of how far apart two are, by where they are seen and by their depths; 1 where it is
  /// too far for a link.
  double distance2(const Depth& a, const Depth& b, double apart2_px2) const;
  /// Whether it reaches higher above the ground, where that is known, than any object.
  bool reaches_too_high(std::span<const int> group, double w, const MotionField& field) const;

  Intrinsics camera_;
  LinkParameters parameters_;

  // Of the current frame; kept for their memory.
  std::vector<Node> nodes_;
  std::vector<Depth> depths_;          // of nodes, where these are normal
  std::vector<Vec2> points_;           // of nodes, as `UprightMetric` has them
  std::vector<Companion> companions_;  // in the order of their nodes
  ConvexHull hull_;
  PointGrid grid_;
  DepthGroups by_depth_;
  DisjointSets by_velocity_;
  SetMembers groups_;
  std::vector<int> circles_;
  std::vector<Square> squares_;
};

}  // namespace lcs
