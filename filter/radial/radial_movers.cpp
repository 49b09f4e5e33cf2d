#include "filter/radial/radial_movers.h"

#include <algorithm>

#include "filter/matching/refill.h"

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

  const Goers::Result& went = goers_.step(edges, seen_, circles, field, ground);
  copy_over(went.odds, odds_);
  copy_over(went.circle, joined_);
  Result result;
  if (view != nullptr) {
    result.came =
        &comers_.step(edges.normal, seen_, circles, corners_px, reasons, field, ground, *view);
    for (std::size_t i = 0; i < odds_.size(); ++i) {
      if (!(result.came->odds[i] > 0)) continue;
      odds_[i] = result.came->odds[i];
      joined_[i] = -1;
    }
  }
  if (std::ranges::any_of(odds_, [](double odds) { return odds > 0; })) {
    result.moved = &relabel_.step(edges, circles, odds_, joined_, field, circle_.trust);
  }
  return result;
}

}  // namespace lcs
