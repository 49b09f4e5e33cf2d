/// \file
/// Layers from linked edges, beside the paper's couples of circles: what lies close together at one
/// depth, or moves as one, is one object.
///
/// With furthest-first couples of circles, a layer takes in whatever is at a like depth across half
/// the image; boxes come out too large to be objects, as the paper says itself. Here every normal
/// edge brings the depth of its whole path; neighbours are linked, and linked groups merge best
/// link first (Kruskal) only where their means agree, so that a chain of small steps does not join
/// a near object to a far one. Rebels are linked by their own velocities.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "filter/depth_groups.h"
#include "filter/disjoint_sets.h"
#include "filter/layers.h"
#include "filter/motion_field.h"
#include "filter/parameters.h"
#include "filter/point_grid.h"

namespace lcs {

class LinkLayering {
 public:
  LinkLayering(const Intrinsics& camera, const LinkParameters& parameters);

  /// Mean squares S_m of this frame, valid until the next call.
  const std::vector<Square>& layer(const Layers& layers, const MotionField& field);

 private:
  /// An edge that may be linked.
  struct Node {
    Vec2 location;
    Vec2 velocity_pxps;  // rebels
    double w = 0;        // inverse depth, 1/m (normal edges)
    double sigma = 0;    // of w
    double spacing = 0;  // local, px
    const Edge* edge = nullptr;
  };

  void gather(const std::vector<Edge>& edges, const MotionField& field);
  void measure_spacing();
  void link_by_depth();
  void link_by_velocity(double dt_s);
  void make_squares(DisjointSets& sets, std::size_t least, const MotionField& field);
  void make_square(std::span<const int> group, const MotionField& field);
  double reach(const Node& a, const Node& b) const;
  /// By how much the inverse depths of neighbours may differ.
  double tolerance(const Node& a, const Node& b) const;

  Intrinsics camera_;
  LinkParameters parameters_;

  // Of the current frame; kept for their memory.
  std::vector<Node> nodes_;
  std::vector<Vec2> points_;
  PointGrid grid_;
  DepthGroups by_depth_;
  DisjointSets by_velocity_;
  SetMembers groups_;
  std::vector<std::pair<double, int>> near_;
  std::vector<int> circles_;
  std::vector<double> xs_, ys_;
  std::vector<Square> squares_;
};

}  // namespace lcs
