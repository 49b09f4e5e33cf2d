/// \file
/// Predicts a square from the tangents of its inscribed ellipse ("Square Estimation").
///
/// The paper finds the points L_t where lines from the origin O touch the ellipse, moves them along
/// those lines by d_r, and solves for the ellipse that touches there. The second case of d_r
/// contradicts the first: it compares a ratio of norms with 0. The first case is the homothety
/// about O by s = (|O L| + dr) / |O L|: L~ = O + s (L - O), R~ = s R. The construction fails if O
/// is inside the ellipse, or a tangent or chord is parallel to an axis; the homothety never fails.
#pragma once

#include <optional>
#include <utility>

#include "filter/kinematics/camera.h"

namespace lcs::paper {

struct Extent {
  Vec2 location = Vec2::Zero();   ///< L_s, px
  Vec2 half_size = Vec2::Zero();  ///< R_s, px
};

/// The points where lines through `origin` touch the ellipse; absent unless it is outside.
std::optional<std::pair<Vec2, Vec2>> tangent_points(const Extent& ellipse, const Vec2& origin);

/// The paper's construction in closed form; absent where it fails.
/// \param travelled_px Delta r: displacement of L away from O (negative: towards it).
std::optional<Extent> predict_by_tangents(const Extent& square, const Vec2& origin,
                                          double travelled_px);

/// The homothety about `origin`. A square centred on the origin is unchanged.
Extent predict_by_homothety(const Extent& square, const Vec2& origin, double travelled_px);

}  // namespace lcs::paper
