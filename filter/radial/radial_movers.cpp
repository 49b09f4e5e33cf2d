#include "filter/radial/radial_movers.h"

#include "filter/matching/refill.h"

namespace lcs {

const Relabel::Result* RadialMovers::step(const BothKinds<Edge>& edges,
                                          const CircleExpert::Result& circles,
                                          std::span<const Eigen::Vector2f> corners_px,
                                          std::span<const Reason> reasons, const MotionField& field,
                                          GapView* view) {
  came_.gaps.clear();
  came_.inherited.clear();
  if (!field.ground() || !field.moving() || field.ground()->up_C.head<2>().isZero()) return nullptr;
  const GroundView ground(camera_, field);
  seen_.clear();
  make_room(seen_, edges.normal.size());
  for (const Edge& edge : edges.normal) seen_.emplace_back(edge, ground, field, circle_);

  const Goers::Result& went = goers_.step(edges, seen_, circles, field, ground);
  copy_over(went.odds, odds_);
  copy_over(went.circle, joined_);
  if (view != nullptr) {
    const Comers::Result& came =
        comers_.step(edges.normal, seen_, circles, corners_px, reasons, field, ground, *view);
    came_.gaps = came.gaps;
    came_.inherited = came.inherited;
    for (std::size_t i = 0; i < odds_.size(); ++i) {
      if (!(came.odds[i] > 0)) continue;
      odds_[i] = came.odds[i];
      joined_[i] = -1;
    }
  }
  return &relabel_.step(edges, circles, odds_, joined_, field, circle_.trust);
}

}  // namespace lcs
