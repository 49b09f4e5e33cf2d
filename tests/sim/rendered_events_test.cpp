// Events of rendered worlds, and the instants at which they are rendered.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "sim/events/event_sensor.h"
#include "sim/observer.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

/// A rover before a white pole on a dark floor under a black sky, with ideal event pixels.
scenario::Scenario pole(double yaw_rate_radps) {
  scenario::Scenario s = test::scenario_in_mjcf(
      test::floor_with("<geom type=\"box\" pos=\"3 0 1\" size=\".1 .1 2\" rgba=\"1 1 1 1\"/>"), 0,
      4);
  s.ego.phases = {{.yaw_rate_radps = yaw_rate_radps}};
  s.camera.width_px = 160;
  s.camera.height_px = 120;
  s.camera.rate_hz = 20;
  s.events.emplace();
  s.events->spread = s.events->refractory_s = s.events->leak_hz = s.events->shot_hz = 0;
  return s;
}

std::vector<Observation> frames_of(const scenario::Scenario& s, int skipped = 0) {
  Simulation simulation(s);
  for (int k = 0; k < skipped; ++k) simulation.skip();
  std::vector<Observation> all;
  while (std::optional<Observation> o = simulation.next()) all.push_back(std::move(*o));
  return all;
}

TEST(RenderedEvents, AreNoneWhereNothingMoves) {
  for (const Observation& o : frames_of(pole(0))) EXPECT_TRUE(o.events.empty()) << o.index;
}

/// The mean place of the events of an edge from dark to bright light, from its true place, px. A
/// pixel sees the logarithm of its share of both sides behind the lens: in it, the first rays of
/// the bright side are most of the step, so that what is bright looks wide.
double place_of_events(double dark, double bright) {
  const double sigma_px = scenario::Image{}.point_spread_px;
  const auto log_at = [&](double inside_px) {
    double light = 0, weights = 0;
    for (int k = -2; k <= 2; ++k) {
      const double weight = std::exp(-k * k / (2 * sigma_px * sigma_px));
      light += weight * (dark + (bright - dark) * std::clamp(inside_px + k + 0.5, 0.0, 1.0));
      weights += weight;
    }
    return std::log(light / weights);
  };
  double sum = 0;
  constexpr double kStep_px = 0.01;
  for (double px = -3; px < 3; px += kStep_px) {
    sum += (px + kStep_px / 2) * (log_at(px + kStep_px) - log_at(px));
  }
  return sum / std::log(bright / dark);
}

/// All events of a turn are where the picture has contrast, in the time since the frame before, and
/// ON and OFF are on the two sides of the pole, by its way through the picture.
TEST(RenderedEvents, FollowTheOutlinesOfAPole) {
  const std::vector<Observation> all = frames_of(pole(0.3));
  EXPECT_TRUE(all.front().events.empty());
  for (std::size_t k = 1; k < all.size(); ++k) {
    const Observation& o = all[k];
    ASSERT_GT(o.events.size(), 100U);
    EXPECT_GT(o.events.front().t_ns, all[k - 1].t_ns);
    EXPECT_LE(o.events.back().t_ns, o.t_ns);
    // the turn to the left moves the picture to the right
    const auto middle_of = [&](bool is_on) {
      double sum = 0;
      int count = 0;
      for (const Event& event : o.events) {
        if (event.is_on != is_on || event.y > 40) continue;  // above the floor's horizon
        sum += event.x;
        ++count;
      }
      EXPECT_GT(count, 20);
      return sum / count;
    };
    const double width_px = 2 * 0.1 / 2.9 * 120 / 2 / std::tan(std::numbers::pi / 6);
    // light of the pole and of the sky, with ESIM's constant
    double pole_light = 0;
    for (int x = 0; x < 160; ++x) {
      pole_light = std::max<double>(pole_light, o.rendered(20, x)[1] + 1e-3);
    }
    const double sky_light = o.rendered(20, 0)[1] + 1e-3;
    EXPECT_NEAR(middle_of(true) - middle_of(false),
                width_px - 2 * place_of_events(sky_light, pole_light), 1);
  }
}

TEST(RenderedEvents, AreTheSameBitsTwiceAndAfterASkip) {
  scenario::Scenario s = pole(0.3);
  s.events = scenario::Events{};
  const std::vector<Observation> all = frames_of(s), again = frames_of(s), later = frames_of(s, 2);
  ASSERT_EQ(later.size(), 2U);
  for (std::size_t k = 0; k < all.size(); ++k) EXPECT_EQ(all[k].events, again[k].events);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(later[k].events, all[k + 2].events);
}

/// With a shutter the windows of frames overlap the times of events.
TEST(RenderedEvents, AreNearlyThoseOfAnInstantShutter) {
  scenario::Scenario s = pole(0.3);
  const std::vector<Observation> instant = frames_of(s);
  s.camera.rolling_shutter_s = 0.02;
  s.camera.exposure_s = 0.01;
  const std::vector<Observation> slow = frames_of(s);
  for (std::size_t k = 1; k < slow.size(); ++k) {
    const auto expected = static_cast<double>(instant[k].events.size());
    // the physics end their steps at other times, and differ in rounding
    EXPECT_NEAR(static_cast<double>(slow[k].events.size()), expected, 0.02 * expected);
    EXPECT_GT(slow[k].events.front().t_ns, slow[k - 1].t_ns);
    EXPECT_LE(slow[k].events.back().t_ns, slow[k].t_ns);
  }
}

TEST(RenderedEvents, WarnOfATurnThatIsTooFastForTheMostInstants) {
  scenario::Scenario s = pole(20);
  s.camera.rate_hz = 5;
  Simulation simulation(s);
  while (simulation.next()) {
  }
  EXPECT_GT(simulation.warnings().of(Warning::coarse_events).count, 0);
  Simulation slow(pole(0.3));
  while (slow.next()) {
  }
  EXPECT_EQ(slow.warnings().of(Warning::coarse_events).count, 0);
}

TEST(EventSampling, KeepsShiftsBelowAPixelWithFewPictures) {
  for (const double px : {0.0, 0.5, 3.0, 20.0}) {
    const EventSampling even = sample_events(std::vector<double>(kEventParts, px / kEventParts));
    EXPECT_LE(even.most_shift_px, kMostEventShift_px);
    // a cell is at most 20 / 128 of a pixel, by which a picture may come early
    EXPECT_LE(static_cast<double>(even.cells.size()), px / (1 - 20.0 / kEventCells) + 1);
    EXPECT_EQ(even.cells.back(), static_cast<std::size_t>(kEventCells - 1));
  }
  // motion in the first part only: the pictures are there, and one at the end
  std::vector<double> start(kEventParts, 0.0);
  start.front() = 4;
  const EventSampling uneven = sample_events(start);
  EXPECT_EQ(std::ranges::count_if(uneven.cells, [](std::size_t cell) { return cell > 8; }), 1);
  EXPECT_LE(uneven.most_shift_px, kMostEventShift_px);
  const EventSampling fast = sample_events(std::vector<double>(kEventParts, 16.0));
  EXPECT_EQ(fast.cells.size(), static_cast<std::size_t>(kEventCells));
  EXPECT_DOUBLE_EQ(fast.most_shift_px, 2);
}

}  // namespace
}  // namespace lcs::sim
