/// \file
/// The paper's squares: groups of circles ("Geometric Layering", "Mean Square"), matched to the
/// predicted squares by overlap ("Square Estimation").
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/motion_field.h"
#include "filter/paper/parameters.h"
#include "filter/types/layers.h"

namespace lcs::paper {

// Predicts a square from the tangents of its inscribed ellipse ("Square Estimation").
//
// The paper finds the points L_t where lines from the origin O touch the ellipse, moves them along
// those lines by d_r, and solves for the ellipse that touches there. The second case of d_r
// contradicts the first: it compares a ratio of norms with 0. The first case is the homothety
// about O by s = (|O L| + dr) / |O L|: L~ = O + s (L - O), R~ = s R. The construction fails if O
// is inside the ellipse, or a tangent or chord is parallel to an axis; the homothety never fails.

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

/// Whether a circle separates the couple a, b: it is slower (farther away), lies between them and
/// crosses the segment between their centres.
bool parts(const Circle& between, const Circle& a, const Circle& b);

/// Overlap rho_s of two rectangles: common area in % of the smaller one. Symmetric; 0 if disjoint,
/// 100 if one contains the other, 0 if one has no area.
double overlap_percent(const Square& a, const Square& b);

class PaperSquares {
 public:
  /// \param ignore squares that reach Tr_m make regions of psi (transition IV).
  PaperSquares(const Intrinsics& camera, const PaperSquareParameters& parameters, bool ignore)
      : camera_(camera), parameters_(parameters), ignore_(ignore) {}

  /// Predicts the squares of the last frame to this one.
  static void predict(std::vector<Square>& squares, const MotionField& field);

  /// Layers the circles. Matches, estimates, creates and deletes predicted squares.
  void update(const BothKinds<Circle>& circles, std::span<const IgnoreRegion> psi,
              const MotionField& field, std::vector<Square>& squares);

 private:
  /// A candidate match of a predicted and a mean square.
  struct Pair {
    double overlap, distance;
    std::size_t square, mean;
    bool aligned;
  };

  void layer(const BothKinds<Circle>& circles, const MotionField& field);
  bool like_speed(const Circle& a, const Circle& b) const;
  bool couple(const Circle& a, const Circle& b) const;
  int furthest_partner(std::size_t a, double d_t) const;
  void add_minor_circles(std::size_t a, double d_t, const MotionField& field);
  Square mean_square(std::size_t a, const MotionField& field) const;

  Intrinsics camera_;
  PaperSquareParameters parameters_;
  bool ignore_;
  Id next_id_ = 1;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<Circle> circles_;        // C_n and C_r
  std::vector<char> used_;             // of these
  std::vector<std::size_t> partners_;  // C_b of the current couple
  std::vector<Square> means_;          // S_m
  std::vector<Pair> pairs_;
  std::vector<char> matched_, mean_used_;  // squares, means
};

}  // namespace lcs::paper
