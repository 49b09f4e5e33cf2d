/// \file
/// The pixels of an event camera, fed with pictures in linear light. Needs no renderer.
///
/// The model is ESIM's (Rebecq, Gehrig, Scaramuzza, "ESIM: an Open Event Camera Simulator",
/// CoRL 2018) with the noise of v2e (Hu, Liu, Delbruck, "v2e: From Video Frames to Realistic DVS
/// Events", CVPRW 2021). With light L in daylights, a pixel sees
///
///     l = ln(L + dark),
///
/// linear in time between two pictures. It keeps a reference level, at first l of the first picture
/// or, with a leak, less a part of C+ drawn at random, as after a long time in constant light:
///
/// * When l is above the reference by the pixel's contrast C+, there is an ON event, and the
///   reference rises by C+. Likewise OFF and C-. A step of light by a factor R thus gives
///   floor(ln R / C+) events.
/// * C+ and C- of a pixel are drawn once: N(mean, spread), at least `kLeastContrast`.
/// * Refractory: a pixel gives no event sooner than this after its last one. The reference still
///   moves, as in ESIM: the events in between are lost.
/// * Leak: the reference falls by leak * C+ a second, so that constant light gives ON events at the
///   rate leak.
/// * Shot noise: events at random times, ON and OFF alike, at the rate shot (1 - 3/4 min(1, L)):
///   v2e's, whose brightest pixel has a quarter of the noise of the dark. They do not move the
///   reference.
///
/// Not modelled: the finite bandwidth of a photoreceptor, which grows with light, and the limited
/// rate at which a sensor is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/base/random.h"
#include "sim/events/event.h"

namespace lcs::sim {

// Chooses the instants at which event pixels see the world, as ESIM does: so many that nothing
// moves by more than a pixel from one picture to the next, in between which light is interpolated.

/// The time from a frame to the next has this many equal cells, at whose ends the world may be
/// drawn; so many drawings are the most.
inline constexpr int kEventCells = 128;
/// Equal parts of that time, for each of which motion is measured; a part has several cells.
inline constexpr std::size_t kEventParts = 16;
inline constexpr double kMostEventShift_px = 1;

struct EventSampling {
  std::vector<std::size_t> cells;  ///< those at whose ends there is a picture; the last is always
  double most_shift_px = 0;        ///< from one picture to the next
};

/// \param parts_px the longest way of a point through the picture in each of `kEventParts`; within
///   a part motion is taken as even.
EventSampling sample_events(const std::vector<double>& parts_px);

class EventSensor {
 public:
  static constexpr float kLeastContrast = 0.01F;

  /// \param seed of contrasts and noise; equal seeds and pictures give equal events.
  EventSensor(const scenario::Events& events, cv::Size size, std::uint64_t seed);

  /// Appends the events after the time of the last picture, up to and including `t_ns`, in the
  /// order of time, and of rows from the left at equal times. The first picture gives none.
  /// \param light in daylights, >= 0; of the sensor's size.
  /// \param t_ns later than the picture before.
  /// \throws std::invalid_argument for another size or time.
  void sample(const cv::Mat1f& light, std::int64_t t_ns, std::vector<Event>& events);

 private:
  /// The reference is `start` + `ons` * `on` - `offs` * `off` - the leak: counts, so that light
  /// that returns to a level crosses as many references up as it has crossed down.
  struct Pixel {
    float start, seen;  ///< first reference; l of the last picture
    float on, off;
    int ons = 0, offs = 0;
    std::int64_t free_ns = 0;  ///< the end of the refractory time

    /// l of the last picture less the reference, after `leaks` events by leak alone.
    double above(double leaks) const {
      return static_cast<double>(seen) - start -
             (ons * static_cast<double>(on) - offs * static_cast<double>(off)) + leaks * on;
    }
  };
  void cross(int x, int y, double before, double after, std::int64_t t_ns,
             std::vector<Event>& events);
  void add_shots(const cv::Mat1f& light, std::int64_t begin_ns, std::int64_t span_ns,
                 std::vector<Event>& events);

  scenario::Events parameters_;
  std::int64_t refractory_ns_;
  RandomStream shots_;
  std::vector<Pixel> pixels_;  ///< row by row
  cv::Size size_;
  cv::Mat1f log_;
  std::int64_t first_ns_ = 0, last_ns_ = 0;  ///< of the pictures
  bool has_seen_ = false;
};

}  // namespace lcs::sim
