/// \file
/// Prediction of a square from the tangents to its inscribed ellipse ("Square Estimation").
///
/// The paper finds the points L_t where lines from the origin O touch the ellipse, moves them along
/// those lines by d_r, and solves for the ellipse that touches there. With the first case of d_r
/// (the second contradicts it: the split is printed as a ratio of norms against 0), that is the
/// homothety about O by s = (|O L| + dr) / |O L|: L~ = O + s (L - O), R~ = s R. The construction is
/// void where O lies inside the ellipse, and singular where a tangent or its chord is parallel to
/// an axis; the homothety is the answer everywhere.
#pragma once

#include <optional>
#include <utility>

#include "filter/kinematics/camera.h"

namespace lcs::paper {

struct Extent {
  Vec2 location = Vec2::Zero();   ///< L_s, px
  Vec2 half_size = Vec2::Zero();  ///< R_s, px
};

/// The two points where lines through `origin` touch the ellipse; none if it is not outside.
std::optional<std::pair<Vec2, Vec2>> tangent_points(const Extent& ellipse, const Vec2& origin);

/// The paper's construction in closed form; none where it is void or singular.
/// \param travelled_px Delta r: how far L moves away from O (negative: towards it).
std::optional<Extent> predict_by_tangents(const Extent& square, const Vec2& origin,
                                          double travelled_px);

/// The homothety about `origin`. A square whose centre is the origin stays.
Extent predict_by_homothety(const Extent& square, const Vec2& origin, double travelled_px);

}  // namespace lcs::paper
