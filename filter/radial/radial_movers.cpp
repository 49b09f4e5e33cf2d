#include "filter/radial/radial_movers.h"

#include <algorithm>
#include <limits>

#include "filter/vectors/refill.h"

namespace lcs {

RadialMovers::Result RadialMovers::step(const BothKinds<Edge>& edges,
                                        const CircleExpert::Result& circles,
                                        std::span<const Eigen::Vector2f> corners_px,
                                        std::span<const Reason> reasons, const MotionField& field,
                                        GapView* view) {
  if (!field.ground() || !field.moving() || field.ground()->up_C.head<2>().isZero()) return {};
  const GroundView ground(camera_, field);
  seen_.clear();
  make_room(seen_, edges.normal.size());
  for (const Edge& edge : edges.normal) seen_.emplace_back(edge, ground, field, circle_);

  const RadialFrame frame{edges, circles, seen_, corners_px, reasons, field, ground};
  const Goers::Result& went = goers_.step(frame);
  copy_over(went.odds, odds_);
  copy_over(went.circle, joined_);
  Result result;
  if (view != nullptr) {
    result.came = &comers_.step(frame, *view);
    for (std::size_t i = 0; i < odds_.size(); ++i) {
      if (!(result.came->odds[i] > 0)) continue;
      odds_[i] = result.came->odds[i];
      joined_[i] = -1;
    }
  }
  if (std::ranges::any_of(odds_, [](double odds) { return odds > 0; })) {
    result.moved = &relabel_.step(frame, odds_, joined_, circle_.trust);
  }
  return result;
}

const Relabel::Result& Relabel::step(const RadialFrame& frame, std::span<const double> odds,
                                     std::span<const int> joined, const TrustRanks& trust) {
  const BothKinds<Edge>& edges = frame.edges;
  const CircleExpert::Result& circles = frame.circles;
  // no structured binding: clang before version 16 captures none in a lambda
  BothKinds<Edge>& to = result_.edges;
  CircleExpert::Result& to_circles = result_.circles;
  auto &came = result_.came, &went = result_.went;
  const auto& [normal, rebel] = circles.circles;
  const auto& of_normal = circles.of_edges.normal;

  // A normal circle keeps its kind as long as an edge of it does.
  refill(left_, normal.size());
  refill(moved_, normal.size());
  for (std::size_t i = 0; i < edges.normal.size(); ++i) {
    if (of_normal[i] < 0) continue;
    if (!(odds[i] > 0)) ++left_[of_normal[i]];
    if (odds[i] > 0 && joined[i] < 0) ++moved_[of_normal[i]];
  }
  refill(place_, normal.size(), -1);
  copy_over(rebel, to_circles.circles.rebel);
  to_circles.circles.normal.clear();
  for (std::size_t c = 0; c < normal.size(); ++c) {
    if (left_[c] + moved_[c] == 0) continue;
    auto& kind = left_[c] > 0 ? to_circles.circles.normal : to_circles.circles.rebel;
    place_[c] = static_cast<int>(kind.size());
    kind.push_back(normal[c]);
  }

  to.normal.clear();
  to.rebel.clear();
  to_circles.of_edges.normal.clear();
  to_circles.of_edges.rebel.clear();
  came.clear();
  went.clear();
  std::size_t r = 0;
  const auto add_rebels_before = [&](Id id) {
    for (; r < edges.rebel.size() && edges.rebel[r].id < id; ++r) {
      to.rebel.push_back(edges.rebel[r]);
      to_circles.of_edges.rebel.push_back(circles.of_edges.rebel[r]);
    }
  };
  for (std::size_t i = 0; i < edges.normal.size(); ++i) {
    Edge edge = edges.normal[i];
    const int own = of_normal[i] < 0 ? -1 : place_[of_normal[i]];
    if (!(odds[i] > 0)) {
      to.normal.push_back(edge);
      to_circles.of_edges.normal.push_back(own);
      continue;
    }
    add_rebels_before(edge.id);
    edge.rebel = true;
    edge.origin = edge.location - frame.field.dt_s() * edge.velocity();
    edge.depth_ratio_sigma = std::numeric_limits<double>::infinity();
    edge.trust = trust.of_log_odds(odds[i]);
    if (edge.corner >= 0) {
      (joined[i] >= 0 ? went : came).push_back({edge.corner, static_cast<float>(odds[i])});
    }
    to.rebel.push_back(edge);
    to_circles.of_edges.rebel.push_back(joined[i] >= 0 ? joined[i] : own);
  }
  add_rebels_before(std::numeric_limits<Id>::max());

  // Circles whose members changed.
  const auto renew = [&](std::vector<Circle>& kind, const std::vector<Edge>& of,
                         const std::vector<int>& circle_of_edge) {
    members_.collect(circle_of_edge, kind.size());
    for (std::size_t c = 0; c < kind.size(); ++c) {
      const std::span<const int> members = members_.of(c);
      const bool is_same = kind[c].rebel == of[members.front()].rebel &&
                           kind[c].members == static_cast<int>(members.size());
      if (!is_same) kind[c] = mean_circle(of, members, frame.field, kind[c]);
    }
  };
  renew(to_circles.circles.normal, to.normal, to_circles.of_edges.normal);
  renew(to_circles.circles.rebel, to.rebel, to_circles.of_edges.rebel);
  return result_;
}

}  // namespace lcs
