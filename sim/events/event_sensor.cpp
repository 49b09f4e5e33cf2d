#include "sim/events/event_sensor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace lcs::sim {
namespace {

/// Share of the shot noise of the dark that a pixel has in daylight.
constexpr double kShotsInDaylight = 0.25;

}  // namespace

EventSampling sample_events(const std::vector<double>& parts_px) {
  constexpr std::size_t kCells = kEventCells, kCellsInPart = kCells / kEventParts;
  const auto shift_px = [&](std::size_t cell) {
    return parts_px[cell / kCellsInPart] / kCellsInPart;
  };
  EventSampling sampling;
  double since_px = 0;  // the last picture, up to the end of the cell
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    since_px += shift_px(cell);
    if (cell + 1 < kCells && since_px + shift_px(cell + 1) <= kMostEventShift_px) continue;
    sampling.cells.push_back(cell);
    sampling.most_shift_px = std::max(sampling.most_shift_px, since_px);
    since_px = 0;
  }
  return sampling;
}

EventSensor::EventSensor(const scenario::Events& events, cv::Size size, std::uint64_t seed)
    : parameters_(events),
      refractory_ns_(std::llround(1e9 * events.refractory_s)),
      shots_(seed, "events.shots"),
      size_(size) {
  RandomStream contrasts(seed, "events.contrasts");
  const auto draw = [&](double mean) {
    return std::max(kLeastContrast, static_cast<float>(mean + events.spread * contrasts.normal()));
  };
  RandomStream phases(seed, "events.leak");
  pixels_.reserve(static_cast<std::size_t>(size.area()));
  for (int i = 0; i < size.area(); ++i) {
    const float on = draw(events.positive), off = draw(events.negative);
    const float above = events.leak_hz > 0 ? on * static_cast<float>(phases.uniform()) : 0.F;
    pixels_.push_back({.start = -above, .seen = 0, .on = on, .off = off});
  }
}

void EventSensor::sample(const cv::Mat1f& light, std::int64_t t_ns, std::vector<Event>& events) {
  if (light.size() != size_) throw std::invalid_argument("a picture of another size than events");
  if (has_seen_ && t_ns <= last_ns_) {
    throw std::invalid_argument("a picture that is not later than the one before it");
  }
  const double dark = parameters_.dark_lx / scenario::Image::kDaylight_lx;
  cv::add(light, dark, log_);
  cv::log(log_, log_);
  if (!has_seen_) {
    auto l = log_.begin();
    for (Pixel& pixel : pixels_) {
      pixel.seen = *l++;
      pixel.start += pixel.seen;
    }
    has_seen_ = true;
    first_ns_ = last_ns_ = t_ns;
    return;
  }
  const std::size_t first = events.size();
  const std::int64_t span_ns = t_ns - last_ns_;
  const auto leaks_until = [&](std::int64_t then_ns) {
    return parameters_.leak_hz * 1e-9 * static_cast<double>(then_ns - first_ns_);
  };
  const double leaks_before = leaks_until(last_ns_), leaks_after = leaks_until(t_ns);
  Pixel* pixel = pixels_.data();
  for (int y = 0; y < size_.height; ++y) {
    const float* l = log_[y];
    for (int x = 0; x < size_.width; ++x, ++pixel) {
      const float seen = std::exchange(pixel->seen, l[x]);
      const double after = pixel->above(leaks_after);
      if (after < pixel->on && after > -pixel->off) continue;
      const double rise =
          static_cast<double>(l[x]) - seen + (leaks_after - leaks_before) * pixel->on;
      cross(x, y, after - rise, after, t_ns, events);
    }
  }
  add_shots(light, last_ns_, span_ns, events);
  std::sort(events.begin() + static_cast<std::ptrdiff_t>(first), events.end(),
            [](const Event& a, const Event& b) {
              return std::tie(a.t_ns, a.y, a.x, a.is_on) < std::tie(b.t_ns, b.y, b.x, b.is_on);
            });
  last_ns_ = t_ns;
}

/// The levels that a pixel crosses from the last picture to this one at `t_ns`. \param before,
/// after l less the reference, at both; `after` is beyond the contrast.
void EventSensor::cross(int x, int y, double before, double after, std::int64_t t_ns,
                        std::vector<Event>& events) {
  Pixel& pixel = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
                         static_cast<std::size_t>(x)];
  const bool is_on = after > 0;
  const double contrast = is_on ? pixel.on : -pixel.off;
  const std::int64_t span_ns = t_ns - last_ns_;
  int levels = 0;
  while (is_on ? (levels + 1) * contrast <= after : (levels + 1) * contrast >= after) {
    ++levels;
    const double share = std::clamp((levels * contrast - before) / (after - before), 0.0, 1.0);
    const std::int64_t at_ns =
        last_ns_ + std::max<std::int64_t>(1, std::llround(share * static_cast<double>(span_ns)));
    if (at_ns < pixel.free_ns) continue;
    events.push_back({at_ns, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), is_on});
    pixel.free_ns = at_ns + refractory_ns_;
  }
  (is_on ? pixel.ons : pixel.offs) += levels;
}

/// A Poisson process of all pixels together, at the rate of the dark, of which brighter pixels
/// leave events out.
void EventSensor::add_shots(const cv::Mat1f& light, std::int64_t begin_ns, std::int64_t span_ns,
                            std::vector<Event>& events) {
  const double rate_hz = parameters_.shot_hz * size_.area();
  if (rate_hz == 0) return;
  double after_s = 0;
  const double span_s = 1e-9 * static_cast<double>(span_ns);
  while ((after_s += shots_.exponential() / rate_hz) < span_s) {
    const std::uint64_t drawn = shots_.bits();
    const auto place = static_cast<std::size_t>((drawn >> 32) * pixels_.size() >> 32);
    const auto width = static_cast<std::size_t>(size_.width);
    const auto x = static_cast<std::uint16_t>(place % width);
    const auto y = static_cast<std::uint16_t>(place / width);
    const bool is_on = (drawn & 1) != 0;
    const double share = 1 - (1 - kShotsInDaylight) * std::min(1.F, light(y, x));
    if (shots_.uniform() >= share) continue;
    const std::int64_t t_ns = begin_ns + std::max<std::int64_t>(1, std::llround(1e9 * after_s));
    Pixel& pixel = pixels_[place];
    if (t_ns < pixel.free_ns || t_ns > begin_ns + span_ns) continue;
    events.push_back({t_ns, x, y, is_on});
    pixel.free_ns = t_ns + refractory_ns_;
  }
}

}  // namespace lcs::sim
