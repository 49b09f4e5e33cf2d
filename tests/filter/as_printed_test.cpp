/// The paper's formulas as printed, where the print contains an error. Each test transcribes one
/// formula (the rotation is `RotationModel::as_printed`) and shows its error beside the form that
/// the filter uses. `filter/EQUATIONS.md` lists them row by row.
#include <gtest/gtest.h>

#include <optional>

#include "filter/kinematics/geometry.h"
#include "filter/kinematics/motion_field.h"
#include "filter/paper/paper_squares.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using namespace paper;

using Eigen::Vector3d;
using testing::Random;
using testing::steady_motion;
using testing::vga;

// ---------------------------------------------------------------------------------------- rotation

double angle_between_rays(const Vec2& a, const Vec2& b, double f) {
  const Vector3d u(a.x(), a.y(), f), v(b.x(), b.y(), f);
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

/// A rotation keeps the angles between all rays, whatever the signs of its axes. The printed field
/// changes them at first order about every axis, the field in use only at second order.
TEST(AsPrinted, TheRotationIsNoRotationInAnyConventionOfSigns) {
  const double f = vga().focal_px, step = 1e-4;
  FieldParameters first_order, as_printed;
  first_order.rotation = RotationModel::first_order;
  as_printed.rotation = RotationModel::as_printed;
  for (int axis = 0; axis < 3; ++axis) {
    SCOPED_TRACE(axis);
    const Vector3d w = step * Vector3d::Unit(axis);
    const EgoMotion motion = steady_motion(Vector3d::Zero(), w, 1);
    const MotionField field(vga(), motion, first_order), print(vga(), motion, as_printed);
    Random random(1);
    double printed = 0, used = 0;
    for (int i = 0; i < 100; ++i) {
      const Vec2 a(random.uniform(-320, 320), random.uniform(-240, 240));
      const Vec2 b(random.uniform(-320, 320), random.uniform(-240, 240));
      const double before = angle_between_rays(a, b, f);
      const auto change = [&](const Vec2& a_now, const Vec2& b_now) {
        return std::abs(angle_between_rays(a_now, b_now, f) - before) / step;
      };
      const Vec2 c = vga().centre_px;
      printed = std::max(printed, change(print.rotated(a + c) - c, print.rotated(b + c) - c));
      used = std::max(used, change(field.rotated(a + c) - c, field.rotated(b + c) - c));
    }
    EXPECT_GT(printed, 0.1);  // rad of error per rad of rotation
    EXPECT_LT(used, 10 * step);
  }
}

// --------------------------------------------------------------------------------------------- d_t

Circle disc(const Vec2& at, double radius, double depth_ratio) {
  Circle circle;
  circle.location = at;
  circle.radius = radius;
  circle.depth_ratio = depth_ratio;
  return circle;
}

/// |beta_tl| <= |beta_m|, with beta_tl = asin(R_b / d_ab) and beta_m by the law of cosines: as
/// printed, a couple is parted by circles that do not lie between its two, not by those that do.
TEST(AsPrinted, ThePartingConditionHasItsInequalityTheWrongWayRound) {
  const Circle a = disc({100, 100}, 20, 1), b = disc({300, 100}, 20, 1);
  const auto printed = [&](const Circle& c) {
    const double d_ab = (a.location - b.location).norm(), d_ac = (a.location - c.location).norm(),
                 d_bc = (b.location - c.location).norm();
    const double beta_m = std::acos((d_ab * d_ab + d_ac * d_ac - d_bc * d_bc) / (2 * d_ab * d_ac));
    return std::asin(b.radius / d_ab) <= beta_m;
  };
  const Circle between = disc({200, 102}, 20, 0.3), beside = disc({200, 300}, 20, 0.3);
  EXPECT_FALSE(printed(between));
  EXPECT_TRUE(printed(beside));
  EXPECT_TRUE(parts(between, a, b));
  EXPECT_FALSE(parts(beside, a, b));
}

// ---------------------------------------------------------------------------------------- tangents

struct Tangent {
  Extent square;
  Vec2 origin, touch;
  double to_centre, to_touch, travelled;
};

/// A square, an origin outside its ellipse, and one of the tangent points.
template <typename Condition>
Tangent random_tangent(Random& random, Condition condition) {
  for (;;) {
    Tangent t;
    t.square = {{random.uniform(0, 640), random.uniform(0, 480)},
                {random.uniform(5, 120), random.uniform(5, 120)}};
    t.origin = {random.uniform(-200, 840), random.uniform(-200, 680)};
    const auto points = tangent_points(t.square, t.origin);
    if (!points) continue;
    t.touch = random.uniform(0, 1) < 0.5 ? points->first : points->second;
    t.to_centre = (t.square.location - t.origin).norm();
    t.to_touch = (t.touch - t.origin).norm();
    t.travelled = random.uniform(0.05, 0.3) * t.to_centre;
    const Vec2 c = (t.touch - t.square.location).cwiseAbs();
    const Vec2 o = (t.touch - t.origin).cwiseAbs();
    if (std::min(c.minCoeff(), o.minCoeff()) > 1 && condition(t)) return t;
  }
}
bool any(const Tangent&) {
  return true;
}
bool touches_farther_than_its_centre(const Tangent& t) {
  return t.to_touch > 1.05 * t.to_centre;
}

/// dL_y/dL_x = (O_y - L_ty)/(L_tx - L_sx) as printed; the line from O needs O_x - L_tx below it.
/// That slope and the differential of the ellipse give the printed tangent condition.
TEST(AsPrinted, TheSlopeOfTheTangentLineHasTheWrongDenominator) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Tangent t = random_tangent(random, any);
    const Vec2 c = t.touch - t.square.location, o = t.origin - t.touch;
    const Vec2 r = t.square.half_size;
    const auto off_the_ellipse = [&](double slope) {
      return std::abs(slope * c.y() / (r.y() * r.y()) + c.x() / (r.x() * r.x())) /
             (1 / r.maxCoeff());
    };
    EXPECT_LT(off_the_ellipse(o.y() / o.x()), 1e-9);
    EXPECT_GT(off_the_ellipse(o.y() / c.x()), 1e-6);
    const double condition =
        r.x() * r.x() * o.y() * c.y() + r.y() * r.y() * o.x() * c.x();  // as printed
    EXPECT_NEAR(condition / (r.prod() * r.prod()), 0, 1e-9);
  }
}

double d_r_case_1(const Tangent& t) {
  return (t.to_centre + t.travelled) * t.to_touch / t.to_centre - t.to_touch;
}
/// With cos(gamma) of the case |O L| <= |O L_t|, before and after the printed simplification.
double d_r_case_2(const Tangent& t) {
  const double cos_gamma = t.to_centre / t.to_touch;
  return (t.to_centre + t.travelled) / cos_gamma - t.to_touch * cos_gamma;
}
double d_r_case_2_simplified(const Tangent& t) {
  return (t.to_centre + t.travelled) * t.to_centre / t.to_touch - t.to_centre;
}

/// R~ as printed without absolute values; empty if an absolute value is needed.
std::optional<Vec2> printed_half_size(const Tangent& t, double d_r) {
  const Vec2 centre =
      t.square.location + t.travelled * (t.square.location - t.origin) / t.to_centre;
  const Vec2 touch = t.touch + d_r * (t.touch - t.origin) / t.to_touch;
  const Vec2 o = t.origin - touch, c = touch - centre;
  const double ry2 = (o.x() * c.y() * c.y() - o.y() * c.x() * c.y()) / o.x();
  const double rx2 = -ry2 * o.x() * c.x() / (o.y() * c.y());
  if (rx2 <= 0 || ry2 <= 0) return std::nullopt;
  return Vec2(std::sqrt(rx2), std::sqrt(ry2));
}

TEST(AsPrinted, TheFirstCaseOfTheTravelledDistanceIsTheHomothetyForEveryEllipse) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Tangent t = random_tangent(random, any);
    const double s = (t.to_centre + t.travelled) / t.to_centre;
    const auto half_size = printed_half_size(t, d_r_case_1(t));
    ASSERT_TRUE(half_size);
    EXPECT_TRUE(half_size->isApprox(s * t.square.half_size, 1e-6));
  }
}

/// The second case contradicts itself (its simplification inverts 1/cos(gamma)), and neither form
/// is the expansion. With |O L_t| as the subtrahend, both cases become one formula.
TEST(AsPrinted, TheSecondCaseOfTheTravelledDistanceIsNotTheHomothety) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Tangent t = random_tangent(random, touches_farther_than_its_centre);
    EXPECT_GT(std::abs(d_r_case_2(t) - d_r_case_2_simplified(t)), 1e-3 * t.to_centre);
    const Vec2 expected = t.square.half_size * (t.to_centre + t.travelled) / t.to_centre;
    for (const double d_r : {d_r_case_2(t), d_r_case_2_simplified(t)}) {
      const auto half_size = printed_half_size(t, d_r);
      EXPECT_FALSE(half_size && half_size->isApprox(expected, 1e-3));
    }
    const double cos_gamma = t.to_centre / t.to_touch;
    EXPECT_NEAR((t.to_centre + t.travelled) / cos_gamma - t.to_touch, d_r_case_1(t), 1e-9);
  }
}

/// L~_ty = L_ty + (d_r^2 / (m_t^2 + 1))^(1/2), L~_tx = L_tx + m_t (L_ty - L~_ty): the root loses
/// the direction, and x has the wrong sign, so the point leaves the line. With m_t (L~_ty - L_ty)
/// and the root's sign leading away from O, it is L_t + d_r (L_t - O) / |L_t - O|.
TEST(AsPrinted, ThePredictedTangentPointLeavesTheTangentLine) {
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const Tangent t = random_tangent(random, any);
    const Vec2 ray = t.touch - t.origin;
    const double m = ray.x() / ray.y(), d_r = d_r_case_1(t);
    const double rise = std::sqrt(d_r * d_r / (m * m + 1));
    const Vec2 printed(t.touch.x() + m * (t.touch.y() - (t.touch.y() + rise)), t.touch.y() + rise);
    const auto off_line = [&](const Vec2& x) {
      return std::abs(cross(ray.normalized(), Vec2(x - t.origin)));
    };
    const Vec2 away = d_r * ray.normalized();
    EXPECT_GT(off_line(printed), 0.01 * std::min(std::abs(away.x()), std::abs(away.y())));
    const double signed_rise = ray.y() > 0 ? rise : -rise;
    const Vec2 corrected = t.touch + Vec2(m * signed_rise, signed_rise);
    EXPECT_LT((corrected - (t.touch + away)).norm(), 1e-9);
  }
}

// ----------------------------------------------------------------------------------------- overlap

/// |min - max| of two disjoint squares is their gap, but the print counts it as an overlap.
TEST(AsPrinted, TheOverlapOfDisjointSquaresIsTheirGap) {
  Square a, b;
  a.location = {50, 50};
  b.location = {150, 140};
  a.half_size = b.half_size = {40, 40};
  const auto side = [](double x, double y) {
    return std::abs(std::min(x + 40, y + 40) - std::max(x - 40, y - 40));
  };
  EXPECT_GT(100 * side(50, 150) * side(50, 140) / (4 * 40 * 40), 3);
  EXPECT_DOUBLE_EQ(overlap_percent(a, b), 0);
}

}  // namespace
}  // namespace lcs
