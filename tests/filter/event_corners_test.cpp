// Arc* and its chains on the events of a square that moves, and their symmetries.
#include "filter/detect/event_corners.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>
#include <vector>

namespace lcs {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

constexpr int kSide_px = 120;
constexpr double kHalf_px = 18;  // of the square

struct Event {
  int x, y;
  std::int64_t t_ns;
  bool is_on;
};

/// A bright square, turned by `angle_rad`, that starts left of the middle and moves by
/// `speed_pxps`.
struct Square {
  double angle_rad;
  Vector2d speed_pxps{100, 37};
  Vector2d along{std::cos(angle_rad), std::sin(angle_rad)};

  Vector2d centre_px(double t_s) const { return Vector2d(45, 52) + speed_pxps * t_s; }
  /// Below 0 inside.
  double outside_px(const Vector2d& px, double t_s) const {
    const Vector2d d = px - centre_px(t_s);
    return std::max(std::abs(along.dot(d)), std::abs(along.x() * d.y() - along.y() * d.x())) -
           kHalf_px;
  }
  std::vector<Vector2d> corners_px(double t_s) const {
    std::vector<Vector2d> corners;
    for (const double turn : {0.25, 0.75, 1.25, 1.75}) {
      const double a = angle_rad + turn * std::numbers::pi;
      corners.push_back(centre_px(t_s) +
                        kHalf_px * std::numbers::sqrt2 * Vector2d(std::cos(a), std::sin(a)));
    }
    return corners;
  }
  double to_corner_px(const Vector2d& px, double t_s) const {
    double nearest_px = 1e9;
    for (const Vector2d& corner : corners_px(t_s)) {
      nearest_px = std::min(nearest_px, (corner - px).norm());
    }
    return nearest_px;
  }

  /// One event for each pixel that the outline passes within 0.3 s, in order of time.
  std::vector<Event> events() const {
    constexpr int kSteps = 600;
    constexpr double kStep_s = 5e-4;
    std::vector<Event> events;
    for (int y = 0; y < kSide_px; ++y) {
      for (int x = 0; x < kSide_px; ++x) {
        double before = outside_px(Vector2d(x, y), 0);
        for (int i = 1; i <= kSteps; ++i) {
          const double now = outside_px(Vector2d(x, y), i * kStep_s);
          if ((now < 0) != (before < 0)) {
            const double t_s = (i - 1 + before / (before - now)) * kStep_s;
            events.push_back({x, y, std::llround(1e9 * t_s), now < 0});
          }
          before = now;
        }
      }
    }
    std::ranges::sort(events, {}, [](const Event& e) { return std::tuple(e.t_ns, e.y, e.x); });
    return events;
  }
};

using Map = std::function<Event(Event)>;

std::vector<bool> verdicts(const std::vector<Event>& events, const Map& map) {
  ArcStar arc_star(kSide_px, kSide_px);
  std::vector<bool> all;
  for (const Event& event : events) {
    const Event e = map(event);
    all.push_back(arc_star.add(e.x, e.y, e.t_ns, e.is_on));
  }
  return all;
}

TEST(ArcStar, FindsTheCornersOfAMovingSquareAndNotItsSides) {
  for (const double angle_rad : {0.0, 0.3, 0.7}) {
    const Square square{angle_rad};
    const std::vector<Event> events = square.events();
    const std::vector<bool> is_corner = verdicts(events, [](Event e) { return e; });
    int corners = 0, near = 0, of_sides = 0, sides = 0;
    std::vector<int> found(4, 0);
    for (std::size_t i = 0; i < events.size(); ++i) {
      const double t_s = 1e-9 * static_cast<double>(events[i].t_ns);
      if (t_s < 0.1) continue;  // the surface is filled first
      const Vector2d px(events[i].x, events[i].y);
      const double away_px = square.to_corner_px(px, t_s);
      sides += away_px > 5;
      if (!is_corner[i]) continue;
      ++corners;
      near += away_px <= 3;
      of_sides += away_px > 5;
      for (std::size_t c = 0; c < 4; ++c) found[c] += (square.corners_px(t_s)[c] - px).norm() <= 3;
    }
    EXPECT_GT(near, 0.8 * corners) << angle_rad << ": " << near << " of " << corners;
    EXPECT_LT(of_sides, 0.01 * sides) << angle_rad;
    // the trailing corner leaves the opening of its own arc, too
    EXPECT_GE(std::ranges::count_if(found, [](int n) { return n > 5; }), 3) << angle_rad;
  }
}

TEST(ArcStar, SaysTheSameOfTurnedMirroredShiftedAndInvertedEvents) {
  const std::vector<Event> events = Square{0.3}.events();
  const std::vector<bool> said = verdicts(events, [](Event e) { return e; });
  ASSERT_GT(std::ranges::count(said, true), 20);
  const auto same = [&](const Map& map) { EXPECT_EQ(verdicts(events, map), said); };
  same([](Event e) { return Event{kSide_px - 1 - e.y, e.x, e.t_ns, e.is_on}; });
  same([](Event e) { return Event{kSide_px - 1 - e.x, kSide_px - 1 - e.y, e.t_ns, e.is_on}; });
  same([](Event e) { return Event{e.y, e.x, e.t_ns, e.is_on}; });
  same([](Event e) { return Event{e.x - 5, e.y + 3, e.t_ns + 1'000'000'000, e.is_on}; });
  same([](Event e) { return Event{e.x, e.y, e.t_ns, !e.is_on}; });
}

TEST(ArcStar, TakesOnlyTheFirstEventOfABurst) {
  const std::vector<Event> events = Square{0.3}.events();
  ArcStar once(kSide_px, kSide_px), often(kSide_px, kSide_px);
  for (const Event& e : events) {
    const bool is_corner = once.add(e.x, e.y, e.t_ns, e.is_on);
    EXPECT_EQ(often.add(e.x, e.y, e.t_ns, e.is_on), is_corner);
    EXPECT_FALSE(often.add(e.x, e.y, e.t_ns, e.is_on));
  }
  EXPECT_EQ(cv::countNonZero(once.picture() != often.picture()), 0);
}

TEST(ArcStar, ShowsTheAgeOfTheLastEventOfEachPixel) {
  ArcStar arc_star(20, 20);
  arc_star.add(3, 4, 1'000'000'000, true);
  arc_star.add(5, 6, 1'050'000'000, false);
  const cv::Mat1b now = arc_star.picture();
  EXPECT_EQ(now(4, 3), 128 + 63);
  EXPECT_EQ(now(6, 5), 1);
  EXPECT_EQ(now(0, 0), 128);
  arc_star.add(7, 8, 1'100'000'000, false);
  EXPECT_EQ(arc_star.picture()(4, 3), 128);
}

TEST(EventCorners, AreOnePlaceForEachCornerAtTheTimeOfTheStep) {
  const Square square{0.3};
  EventCorners corners(kSide_px, kSide_px);
  constexpr std::int64_t kStep_ns = 30'000'000;  // 3 px
  std::int64_t until_ns = kStep_ns;
  int seen = 0, far = 0;
  for (const Event& e : square.events()) {
    while (e.t_ns > until_ns) {
      const double t_s = 1e-9 * static_cast<double>(until_ns);
      const std::vector<Vector2f> found = corners.step();
      EXPECT_LE(found.size(), 8U);
      if (until_ns > 100'000'000) {
        for (const Vector2f& px : found) {
          ++seen;
          far += square.to_corner_px(px.cast<double>(), t_s) > 3.5;
        }
      }
      until_ns += kStep_ns;
    }
    corners.add(e.x, e.y, e.t_ns, e.is_on);
  }
  EXPECT_GE(seen, 12);
  EXPECT_LE(far, seen / 10);
  corners.step();
  EXPECT_TRUE(corners.step().empty());
}

}  // namespace
}  // namespace lcs
