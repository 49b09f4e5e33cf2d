/// \file
/// Which rebel edges bear each other out. A single one may be two corners that happen to lie right;
/// several near each other that move alike, over an area and as no static point does, are an
/// object.
#pragma once

#include <span>
#include <vector>

#include "filter/disjoint_sets.h"
#include "filter/layers.h"
#include "filter/parameters.h"
#include "filter/point_grid.h"
#include "filter/reason.h"

namespace lcs {

/// Gives a rebel edge its image velocity, and the origin behind it that its angle is seen from.
void set_velocity(Edge& edge, const Vec2& velocity_pxps, double dt_s);

/// A static residual beyond this says that a rebel's motion cannot be static, px.
inline constexpr double kOffField_px = 1.0;

class RebelGroups {
 public:
  RebelGroups(const ConstellationParameters& parameters, const TrustRanks& trust)
      : parameters_(parameters), trust_(trust) {}

  /// Finds the groups, judges their edges, and smooths their velocities. Edges that do not hold
  /// with their group, and those of groups that move as the static world may, lose trust.
  void judge(std::vector<Edge>& rebels, double dt_s);

  /// Of the edges last judged, by index: whether others bear it out, and why not.
  bool borne_out(std::size_t edge) const { return reasons_[edge] == Reason::rebel_edge; }
  Reason reason(std::size_t edge) const { return reasons_[edge]; }

 private:
  /// Those of an edge's group that lie near it, itself included.
  struct Bearers {
    int near = 0;
    int off = 0;  // of them, that surely do not move as what is static
  };

  void connect(const std::vector<Edge>& rebels, double dt_s);
  void support(std::vector<Edge>& rebels);
  void smooth(std::vector<Edge>& rebels, double dt_s);
  void support_group(const std::vector<Edge>& rebels, std::span<const int> group);
  bool is_in_line(const std::vector<Edge>& rebels, std::span<const int> group);
  void smooth_group(std::vector<Edge>& rebels, std::span<int> group, double dt_s);

  ConstellationParameters parameters_;
  TrustRanks trust_;
  std::vector<Reason> reasons_;  // of each edge; `rebel_edge`: borne out

  // Of the current frame; kept for their memory.
  PointGrid grid_;
  std::vector<Vec2> points_, steps_;  // a frame, px
  std::vector<double> lengths_px_;    // of the steps
  DisjointSets components_;           // of edges near each other and of like velocity
  SetMembers groups_;                 // living edges by component
  std::vector<int> group_of_;         // root of its component, of each edge
  std::vector<char> is_off_;          // surely does not move as what is static, of each edge
  std::vector<Bearers> bearers_;      // of each edge
  std::vector<char> stray_;
  std::vector<Vec2> places_;  // of a group
  std::vector<double> vx_, vy_;
};

}  // namespace lcs
