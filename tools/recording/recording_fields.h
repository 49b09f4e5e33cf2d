/// \file
/// The stored fields of a recording by name: one list for both writing and reading.
#pragma once

#include <array>
#include <limits>
#include <type_traits>

#include "filter/types/layers.h"
#include "filter/types/paper_layers.h"
#include "filter/types/reason.h"
#include "sim/truth/truth.h"
#include "tools/recording/recording.h"

namespace lcs::recording {

/// \name Names of enumerators, in the order of their declaration.
///@{
inline constexpr std::array<const char*, 4> kVerdicts{"ignored", "pending", "normal", "rebel"};
inline constexpr std::array<const char*, 4> kLabels{"none", "fixed", "indistinct", "rebel"};
inline constexpr std::array<const char*, 3> kTruths{"all", "nothing_moves", "unknown"};
inline constexpr std::array<const char*, 3> kShapes{"", "circle", "rectangle"};  // Ty begins at 1

inline constexpr auto kReasonWords = [] {
  std::array<const char*, kReasons.size()> words{};
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = kReasons[i].word;
  return words;
}();

template <class Enum>
constexpr const auto& names_of(Enum) {
  if constexpr (std::is_same_v<Enum, Verdict>) return kVerdicts;
  if constexpr (std::is_same_v<Enum, Reason>) return kReasonWords;
  if constexpr (std::is_same_v<Enum, sim::Label>) return kLabels;
  if constexpr (std::is_same_v<Enum, Truth>) return kTruths;
  if constexpr (std::is_same_v<Enum, IgnoreRegion::Shape>) return kShapes;
}
///@}

/// A number that may be non-finite. JSON has finite numbers only; null represents the other value.
template <bool kMayBeInfinite>
struct OrNull {
  double& number;
  static constexpr double kNull = kMayBeInfinite ? std::numeric_limits<double>::infinity()
                                                 : std::numeric_limits<double>::quiet_NaN();
};
using OrInfinite = OrNull<true>;  ///< +inf, for example the depth of the sky
using OrNan = OrNull<false>;      ///< NaN, for example the motion of a point behind the camera

/// A shape (an outline, a mask), which numeric tables omit. Older files lack it.
template <class T>
struct Form {
  T& value;
};
template <class T>
Form(T&) -> Form<T>;  // clang before 17 does not deduce an aggregate's argument by itself

/// A corner with its verdict and the rule that decided it, as in `layers.jsonl`.
struct CornerRow {
  double x = 0;
  double y = 0;
  Verdict verdict = Verdict::pending;
  Reason reason = Reason::unknown;
};

/// The pixels of a square, within a bounding box of pixel edges.
struct MaskRow {
  Id square = 0;
  int left = 0, top = 0, right = 0, bottom = 0;
  sim::PixelRuns mask;
};

/// The valid sightings of a row of alpha.
struct Sightings {
  Chain& chain;
};

void pair(const char* x, const char* y, Vec2& numbers, auto& visit) {
  visit(x, numbers.x());
  visit(y, numbers.y());
}

// Each `fields` calls visit(name, member) for every stored field in file order; the member is a
// reference or one of the wrappers above. The bindings name all members, so that a new member
// missing here fails to compile.

void fields(CornerRow& corner, auto&& visit) {
  auto& [x, y, verdict, reason] = corner;
  visit("x", x);
  visit("y", y);
  visit("verdict", verdict);
  visit("reason", reason);
}

/// A corner's position, in pixels.
void fields(Eigen::Vector2f& place, auto&& visit) {
  visit("x", place.x());
  visit("y", place.y());
}

void fields(Chain& chain, auto&& visit) {
  visit("sightings", Sightings{chain});
  visit("off_field_px", chain.off_field_px);
}

void fields(Edge& edge, auto&& visit) {
  auto& [id, rebel, location, origin, rotated, predicted, speed, depth_ratio, angle, mu, trust, age,
         depth_ratio_sigma, corner, circle] = edge;
  visit("id", id);
  pair("x", "y", location, visit);
  pair("origin_x", "origin_y", origin, visit);
  pair("rotated_x", "rotated_y", rotated, visit);
  pair("predicted_x", "predicted_y", predicted, visit);
  visit("speed", speed);
  visit("depth_ratio", depth_ratio);
  visit("angle", angle);
  visit("mu", mu);
  visit("trust", trust);
  visit("age", age);
  visit("depth_ratio_sigma", OrInfinite{depth_ratio_sigma});
  visit("corner", corner);
  visit("circle", circle);
}

void fields(Circle& circle, auto&& visit) {
  auto& [id, rebel, location, origin, radius, speed, depth_ratio, angle, trust, age, members,
         ignoring] = circle;
  visit("id", id);
  pair("x", "y", location, visit);
  pair("origin_x", "origin_y", origin, visit);
  visit("radius", radius);
  visit("speed", speed);
  visit("depth_ratio", depth_ratio);
  visit("angle", angle);
  visit("trust", trust);
  visit("age", age);
  visit("members", members);
  visit("ignoring", ignoring);
}

void fields(Square& square, auto&& visit) {
  auto& [id, location, half_size, origin, speed, depth_ratio, angle, trust, age, circles,
         rebel_circles, ignoring, outline] = square;
  visit("id", id);
  pair("x", "y", location, visit);
  pair("half_width", "half_height", half_size, visit);
  pair("origin_x", "origin_y", origin, visit);
  visit("speed", speed);
  visit("depth_ratio", depth_ratio);
  visit("angle", angle);
  visit("trust", trust);
  visit("age", age);
  visit("circles", circles);
  visit("rebel_circles", rebel_circles);
  visit("ignoring", ignoring);
  visit("outline", Form{outline});
}

void fields(GapSeen& seen, auto&& visit) {
  auto& [gap, evidence] = seen;
  auto& [circle, place_px, across, columns, rows, inverse_depth_pm] = gap;
  visit("circle", circle);
  pair("x", "y", place_px, visit);
  pair("across_x", "across_y", across, visit);
  visit("columns", columns);
  visit("rows", rows);
  visit("inverse_depth_pm", inverse_depth_pm);
  visit("evidence", evidence);
}

void fields(IgnoreRegion& region, auto&& visit) {
  auto& [shape, location, size] = region;
  visit("shape", shape);
  pair("x", "y", location, visit);
  pair("size_x", "size_y", size, visit);
}

void fields(Collector& collector, auto&& visit) {
  auto& [location, radius, depth_ratio] = collector;
  pair("x", "y", location, visit);
  visit("radius", radius);
  visit("depth_ratio", depth_ratio);
}

void fields(sim::CornerTruth& truth, auto&& visit) {
  auto& [label, radial, outline, object, depth_m, motion_px, static_motion_px] = truth;
  visit("label", label);
  visit("radial", radial);
  visit("outline", outline);
  visit("object", object);
  visit("depth_m", OrInfinite{depth_m});
  visit("motion_x", OrNan{motion_px.x()});
  visit("motion_y", OrNan{motion_px.y()});
  visit("static_motion_x", OrNan{static_motion_px.x()});
  visit("static_motion_y", OrNan{static_motion_px.y()});
}

void fields(sim::ObjectTruth& truth, auto&& visit) {
  auto& [object, left, top, right, bottom, visible_px, visible_fraction, moving, mask] = truth;
  visit("object", object);
  visit("left", left);
  visit("top", top);
  visit("right", right);
  visit("bottom", bottom);
  visit("visible_px", visible_px);
  visit("visible_fraction", visible_fraction);
  visit("moving", moving);
  visit("mask", Form{mask});
}

void fields(MaskRow& row, auto&& visit) {
  auto& [square, left, top, right, bottom, mask] = row;
  visit("square", square);
  visit("left", left);
  visit("top", top);
  visit("right", right);
  visit("bottom", bottom);
  visit("mask", Form{mask});
}

void fields(LabelledBox& box, auto&& visit) {
  auto& [id, left, top, right, bottom, ignored] = box;
  visit("id", id);
  visit("left", left);
  visit("top", top);
  visit("right", right);
  visit("bottom", bottom);
  visit("ignored", ignored);
}

void fields(sim::Object& object, auto&& visit) {
  auto& [id, name] = object;
  visit("id", id);
  visit("name", name);
}

}  // namespace lcs::recording
