/// \file
/// The fields of everything that a recording stores, by name: one list for writing and for reading.
#pragma once

#include <array>
#include <vector>

#include "filter/ego_motion.h"
#include "filter/layers.h"
#include "sim/truth.h"

namespace lcs::bench {

/// \name Words for enumerators, in the order of their declaration.
///@{
inline constexpr std::array<const char*, 4> kVerdicts{"ignored", "pending", "normal", "rebel"};
inline constexpr std::array<const char*, 4> kLabels{"none", "fixed", "indistinct", "rebel"};
inline constexpr std::array<const char*, 3> kShapes{"", "circle", "rectangle"};  // Ty begins at 1

inline const auto& names_of(Verdict) {
  return kVerdicts;
}
inline const auto& names_of(sim::Label) {
  return kLabels;
}
inline const auto& names_of(IgnoreRegion::Shape) {
  return kShapes;
}
///@}

/// \name Numbers that need not be finite: JSON knows only finite ones, and null stands for the
/// other.
///@{
struct OrInfinite {  ///< +inf, as the depth of the sky
  double& number;
};
struct OrNan {  ///< NaN, as the motion of a point that leaves the camera's front
  double& number;
};
///@}

/// A corner with its verdict, as `layers.jsonl` has them.
struct CornerRow {
  double x = 0;
  double y = 0;
  Verdict verdict = Verdict::pending;
};

/// A row of alpha, with as many sightings as it has.
struct ChainRow {
  std::vector<Vec2> sightings;
  double off_field_px = 0;
};

// Each `fields` calls visit(name, member) with a reference to the member, or one of the above, for
// every stored field, in file order.

template <class Visit>
void fields(CornerRow& corner, Visit&& visit) {
  visit("x", corner.x);
  visit("y", corner.y);
  visit("verdict", corner.verdict);
}

template <class Visit>
void fields(ChainRow& chain, Visit&& visit) {
  visit("sightings", chain.sightings);
  visit("off_field_px", chain.off_field_px);
}

template <class Visit>
void fields(Edge& edge, Visit&& visit) {
  visit("id", edge.id);
  visit("x", edge.location.x());
  visit("y", edge.location.y());
  visit("origin_x", edge.origin.x());
  visit("origin_y", edge.origin.y());
  visit("rotated_x", edge.rotated.x());
  visit("rotated_y", edge.rotated.y());
  visit("predicted_x", edge.predicted.x());
  visit("predicted_y", edge.predicted.y());
  visit("speed", edge.speed);
  visit("depth_ratio", edge.depth_ratio);
  visit("angle", edge.angle);
  visit("mu", edge.mu);
  visit("trust", edge.trust);
  visit("age", edge.age);
  visit("off_field_px", edge.off_field_px);
  visit("corner", edge.corner);
  visit("circle", edge.circle);
}

template <class Visit>
void fields(Circle& circle, Visit&& visit) {
  visit("id", circle.id);
  visit("x", circle.location.x());
  visit("y", circle.location.y());
  visit("origin_x", circle.origin.x());
  visit("origin_y", circle.origin.y());
  visit("radius", circle.radius);
  visit("speed", circle.speed);
  visit("depth_ratio", circle.depth_ratio);
  visit("angle", circle.angle);
  visit("trust", circle.trust);
  visit("age", circle.age);
  visit("members", circle.members);
  visit("ignoring", circle.ignoring);
}

template <class Visit>
void fields(Square& square, Visit&& visit) {
  visit("id", square.id);
  visit("x", square.location.x());
  visit("y", square.location.y());
  visit("half_width", square.half_size.x());
  visit("half_height", square.half_size.y());
  visit("origin_x", square.origin.x());
  visit("origin_y", square.origin.y());
  visit("speed", square.speed);
  visit("depth_ratio", square.depth_ratio);
  visit("angle", square.angle);
  visit("trust", square.trust);
  visit("age", square.age);
  visit("circles", square.circles);
  visit("rebel_circles", square.rebel_circles);
  visit("ignoring", square.ignoring);
}

template <class Visit>
void fields(IgnoreRegion& region, Visit&& visit) {
  visit("shape", region.shape);
  visit("x", region.location.x());
  visit("y", region.location.y());
  visit("size_x", region.size.x());
  visit("size_y", region.size.y());
}

template <class Visit>
void fields(Collector& collector, Visit&& visit) {
  visit("x", collector.location.x());
  visit("y", collector.location.y());
  visit("radius", collector.radius);
  visit("depth_ratio", collector.depth_ratio);
}

template <class Visit>
void fields(sim::CornerTruth& truth, Visit&& visit) {
  visit("label", truth.label);
  visit("radial", truth.radial);
  visit("object", truth.object);
  visit("depth_m", OrInfinite{truth.depth_m});
  visit("motion_x", OrNan{truth.motion_px.x()});
  visit("motion_y", OrNan{truth.motion_px.y()});
  visit("static_motion_x", OrNan{truth.static_motion_px.x()});
  visit("static_motion_y", OrNan{truth.static_motion_px.y()});
}

template <class Visit>
void fields(sim::ObjectTruth& truth, Visit&& visit) {
  visit("object", truth.object);
  visit("left", truth.left);
  visit("top", truth.top);
  visit("right", truth.right);
  visit("bottom", truth.bottom);
  visit("visible_px", truth.visible_px);
  visit("visible_fraction", truth.visible_fraction);
  visit("moving", truth.moving);
}

template <class Visit>
void fields(sim::Object& object, Visit&& visit) {
  visit("id", object.id);
  visit("name", object.name);
}

}  // namespace lcs::bench
