// Event pixels against closed forms, on pictures that are computed, not rendered.
#include "sim/events/event_sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

namespace lcs::sim {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr double kBright = 0.5, kDim = 0.1;

/// Without noise, spread and refractory time.
scenario::Events ideal() {
  scenario::Events events;
  events.spread = events.refractory_s = events.leak_hz = events.shot_hz = 0;
  events.dark_lx = 1e-6;
  return events;
}

/// Feeds pictures at k / rate, k = 0, ... `count`. \param light_of gives the light at a time.
template <class LightOf>
std::vector<Event> seen(EventSensor& sensor, cv::Size size, double rate_hz, int count,
                        LightOf&& light_of) {
  std::vector<Event> events;
  cv::Mat1f light(size);
  for (int k = 0; k <= count; ++k) {
    const double t_s = k / rate_hz;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) light(y, x) = static_cast<float>(light_of(x, y, t_s));
    }
    sensor.sample(light, std::llround(1e9 * t_s), events);
  }
  return events;
}

/// The share of a pixel of width 1 that lies beyond an edge: `inside_px` is the distance of the
/// pixel's middle from it, positive if beyond.
double covered(double inside_px) {
  return std::clamp(inside_px + 0.5, 0.0, 1.0);
}

/// A vertical edge moves to the right over a wide picture. Each pixel that it passes has the
/// contrast ln(5) = 1.61, hence 8 crossings of 0.2, and the rate is length x speed x 8.
TEST(Events, AreOfTheRateOfAMovingEdge) {
  const cv::Size size(60, 40);
  const double speed_pxps = 100;
  EventSensor sensor(ideal(), size, 1);
  // 0.4 px between two pictures
  const std::vector<Event> events = seen(sensor, size, 250, 100, [&](int x, int, double t_s) {
    return kDim + (kBright - kDim) * covered(5.5 + speed_pxps * t_s - x);
  });
  const int steps = static_cast<int>(std::log(kBright / kDim) / 0.2);
  ASSERT_EQ(steps, 8);
  // the edge goes from 5.5 to 45.5 in 0.4 s: pixels 6 to 45
  const double rate_hz = static_cast<double>(events.size()) / 0.4;
  EXPECT_NEAR(rate_hz, size.height * speed_pxps * steps, 1e-6);
  for (const Event& event : events) {
    EXPECT_TRUE(event.is_on);
    // while the edge is in the pixel: its light is interpolated over one picture more at most
    const double edge_px = 5.5 + speed_pxps * 1e-9 * static_cast<double>(event.t_ns);
    EXPECT_LE(std::abs(edge_px - event.x), 0.5 + 0.4) << event.x;
  }
}

/// Light that falls and comes back to its level crosses as many levels up as down, also where the
/// last one is a tie.
TEST(Events, AreAsManyUpAsDownWhenLightComesBack) {
  for (const double contrast : {0.1, 0.2, 0.35, 0.4}) {
    scenario::Events parameters = ideal();
    parameters.positive = parameters.negative = contrast;
    EventSensor sensor(parameters, {1, 1}, 1);
    std::map<bool, int> count;
    const double dips = 7;
    for (const Event& event : seen(sensor, {1, 1}, 100, 100, [&](int, int, double t_s) {
           const double share =
               std::abs(std::remainder(dips * t_s, 1.0)) * 2;  // 0 at 0, s / dips ...
           return kBright * std::exp(-3 * (t_s < 1 ? share : 0));
         })) {
      ++count[event.is_on];
    }
    EXPECT_GT(count[false], dips * std::floor(2.5 / contrast));
    EXPECT_EQ(count[true], count[false]) << contrast;
  }
}

/// Within a pixel l is ln(dim + (bright - dim) s) with the covered share s = v t. Event n is due
/// when l has risen by n C: t = dim (e^(n C) - 1) / ((bright - dim) v). Linear interpolation of l
/// errs by at most h^2 / 8 max |l''| in l, and by that over the slope of l in time.
TEST(Events, AreAtTheTimesAtWhichLightCrossesItsLevels) {
  EventSensor sensor(ideal(), {1, 1}, 1);
  const double speed = 1, rate_hz = 1000;
  const std::vector<Event> events = seen(sensor, {1, 1}, rate_hz, 1000, [&](int, int, double t_s) {
    return kDim + (kBright - kDim) * speed * t_s;
  });
  ASSERT_EQ(events.size(), 8U);
  for (std::size_t n = 1; n <= events.size(); ++n) {
    const double due_s =
        kDim * (std::exp(0.2 * static_cast<double>(n)) - 1) / ((kBright - kDim) * speed);
    const double slope = (kBright - kDim) * speed / kDim;  // the largest of l, at its start
    const double error_s = slope / (8 * rate_hz * rate_hz) + 1e-6 / slope;  // and of floats
    EXPECT_NEAR(1e-9 * static_cast<double>(events[n - 1].t_ns), due_s, 5 * error_s);
  }
}

/// A bright bar of length 2 a and width 2 b turns round its middle by w rad/s. A point of a long
/// side at s from its middle moves by w s across that side, and likewise on an end. Together they
/// sweep 2 w (a^2 + b^2) pixels a second, and each pixel gives 8 events. OFF has a lower contrast,
/// so that the way back from level 8 has 8 levels with a margin.
TEST(Events, AreOfTheRateOfATurningBar) {
  const cv::Size size(120, 120);
  const double half_length_px = 50, half_width_px = 6, w_radps = 1;
  scenario::Events events_of = ideal();
  events_of.negative = 0.19;
  EventSensor sensor(events_of, size, 1);
  const double rate_hz = 125;  // the ends move 0.4 px between two pictures
  const int count = 250;
  const std::vector<Event> events = seen(sensor, size, rate_hz, count, [&](int x, int y, double t) {
    const double dx = x - 59.5, dy = y - 59.5;
    const double c = std::cos(w_radps * t), s = std::sin(w_radps * t);
    const double along = std::abs(c * dx + s * dy), across = std::abs(c * dy - s * dx);
    return kDim +
           (kBright - kDim) * covered(half_length_px - along) * covered(half_width_px - across);
  });
  const double t_s = count / rate_hz;
  const double passed_px =
      w_radps * t_s * (2 * half_length_px * half_length_px + 2 * half_width_px * half_width_px);
  // ON where the bar comes, OFF where it leaves
  const auto on = std::ranges::count(events, true, &Event::is_on);
  EXPECT_NEAR(static_cast<double>(on) / static_cast<double>(events.size()), 0.5, 0.01);
  // Pixels whose corner alone is touched do not reach all 8 levels: those at the first and last
  // angle, and at the corners of the bar.
  EXPECT_NEAR(static_cast<double>(events.size()), 8 * passed_px, 0.03 * 8 * passed_px);
}

/// The contrast of a pixel is the rise of l at its first event.
TEST(Events, HaveContrastsOfTheirMeanAndSpread) {
  scenario::Events events = ideal();
  events.positive = 0.25;
  events.spread = 0.03;
  const cv::Size size(100, 100);
  EventSensor sensor(events, size, 3);
  // l rises by 1 a second
  std::map<std::pair<int, int>, double> first;
  for (const Event& event :
       seen(sensor, size, 100, 60, [](int, int, double t_s) { return kDim * std::exp(t_s); })) {
    first.try_emplace({event.x, event.y}, 1e-9 * static_cast<double>(event.t_ns));
  }
  ASSERT_EQ(first.size(), 10000U);
  double sum = 0, squares = 0;
  for (const auto& [at, contrast] : first) {
    sum += contrast;
    squares += contrast * contrast;
  }
  const double mean = sum / 10000, deviation = std::sqrt(squares / 10000 - mean * mean);
  EXPECT_NEAR(mean, 0.25, 4 * 0.03 / 100);  // four standard errors
  EXPECT_NEAR(deviation, 0.03, 4 * 0.03 / std::sqrt(2e4));
}

/// Both kinds of noise are Poisson-like in number: within four standard deviations.
TEST(Events, OfConstantLightAreLeakAndShots) {
  const cv::Size size(50, 50);
  scenario::Events leaking = ideal();
  leaking.leak_hz = 2;
  EventSensor leak(leaking, size, 1);
  const auto constant = [](int, int, double) { return kDim; };
  const std::vector<Event> leaks = seen(leak, size, 10, 50, constant);
  // each pixel has 10 in 5 s, one less or more by its phase
  EXPECT_NEAR(static_cast<double>(leaks.size()), 2500 * 2 * 5, 4 * 50);
  EXPECT_TRUE(std::ranges::all_of(leaks, &Event::is_on));

  scenario::Events noisy = ideal();
  noisy.shot_hz = 5;
  for (const double light : {0.0, 0.4, 1.0, 2.0}) {
    EventSensor shot(noisy, size, 1);
    const std::vector<Event> shots =
        seen(shot, size, 10, 50, [&](int, int, double) { return light; });
    const double expected = 2500 * 5 * 5 * (1 - 0.75 * std::min(1.0, light));
    EXPECT_NEAR(static_cast<double>(shots.size()), expected, 4 * std::sqrt(expected)) << light;
    const auto on = static_cast<double>(std::ranges::count(shots, true, &Event::is_on));
    EXPECT_NEAR(on, expected / 2, 4 * std::sqrt(expected) / 2);
  }
}

TEST(Events, KeepTheRefractoryTimeInEveryPixel) {
  scenario::Events events = ideal();
  events.refractory_s = 0.02;
  events.shot_hz = 20;
  const cv::Size size(30, 30);
  EventSensor sensor(events, size, 1);
  // flickers by a factor of 16 at 5 Hz: without the bound 27 levels in 0.1 s
  const std::vector<Event> all = seen(sensor, size, 100, 100, [](int, int, double t_s) {
    return 0.1 * std::pow(4, std::sin(10 * std::numbers::pi * t_s));
  });
  std::map<std::pair<int, int>, std::int64_t> last;
  for (const Event& event : all) {
    const auto [at, is_first] = last.try_emplace({event.x, event.y}, event.t_ns);
    if (!is_first) {
      ASSERT_GE(event.t_ns - at->second, kSecond_ns / 50);
    }
    at->second = event.t_ns;
  }
  EXPECT_LE(all.size(), 900U * 51);
  EXPECT_GE(all.size(), 900U * 30);  // and it is reached for most of the time
}

TEST(Events, AreTheSameBitsForASeedAndInOrder) {
  scenario::Events events;
  events.shot_hz = 50;
  const cv::Size size(40, 30);
  const auto run = [&](std::uint64_t seed) {
    EventSensor sensor(events, size, seed);
    return seen(sensor, size, 50, 25, [](int x, int y, double t_s) {
      return 0.3 + 0.2 * std::sin(0.5 * x + 0.3 * y + 20 * t_s);
    });
  };
  const std::vector<Event> all = run(7);
  EXPECT_EQ(all, run(7));
  EXPECT_NE(all, run(8));
  EXPECT_TRUE(std::ranges::is_sorted(all, [](const Event& a, const Event& b) {
    return std::tie(a.t_ns, a.y, a.x) < std::tie(b.t_ns, b.y, b.x);
  }));
  EXPECT_GT(all.front().t_ns, 0);
  EXPECT_LE(all.back().t_ns, kSecond_ns / 2);
}

TEST(Events, RefusePicturesOfAnotherSizeOrOutOfOrder) {
  EventSensor sensor(ideal(), {4, 3}, 1);
  std::vector<Event> events;
  sensor.sample(cv::Mat1f(3, 4, 0.5F), 10, events);
  EXPECT_THROW(sensor.sample(cv::Mat1f(3, 4, 0.5F), 10, events), std::invalid_argument);
  EXPECT_THROW(sensor.sample(cv::Mat1f(4, 3, 0.5F), 20, events), std::invalid_argument);
}

}  // namespace
}  // namespace lcs::sim
