/// \file
/// Corners from an event camera: Arc* (Alzugaray and Chli, "Asynchronous Corner Detection and
/// Tracking for Event Cameras in Real Time", RA-L 2018), chains of its corner events, and the
/// surface of active events as a picture for signatures.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace lcs {

/// Decides for each event whether it is on a corner, by the surface of active events (SAE): the
/// time of the last event of each pixel and polarity. Events of one pixel and polarity that follow
/// each other within `kBurst_ns` are one edge, of which only the first enters the SAE and may be a
/// corner.
///
/// On the circles of 16 and of 20 pixels round the event (radius 3 and 4), the arc of the newest
/// events is grown from the newest one, each time to the newer neighbour. It ends where all that
/// follows is older than all of it. A corner moving into its own opening leaves an arc of 3 to 6 of
/// 16 pixels, and 4 to 8 of 20; one moving the other way leaves an arc of all but as many. Both
/// circles must agree.
class ArcStar {
 public:
  static constexpr std::int64_t kBurst_ns = 50'000'000;
  static constexpr int kBorder_px = 4;  ///< events nearer to the border are no corners

  ArcStar(int width_px, int height_px);

  /// \param x,y a pixel of the sensor. \param t_ns not before the time of the last event.
  bool add(int x, int y, std::int64_t t_ns, bool is_on);

  /// The SAE of both polarities at the time of the last event: 128 is a pixel without an event for
  /// `kFade_ns`, 255 one with an ON event at this time, 1 one with an OFF event; linear in time in
  /// between. Of both polarities the later one counts.
  static constexpr std::int64_t kFade_ns = 100'000'000;
  cv::Mat1b picture() const;

 private:
  struct Pixel {
    std::array<std::int64_t, 2> surface_ns;  ///< by polarity
    std::array<std::int64_t, 2> last_ns;     ///< bursts included
  };
  template <std::size_t N>
  bool has_arc(const std::array<std::array<int, 2>, N>& circle, int x, int y, bool is_on, int least,
               int most) const;
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px_) +
           static_cast<std::size_t>(x);
  }

  int width_px_, height_px_;
  std::int64_t now_ns_ = 0;    ///< time of the last event
  std::vector<Pixel> pixels_;  ///< row by row
};

/// The corners of a step, from all events since the step before.
///
/// A corner gives many corner events on its way. Each one within `kReach_px` of the place of a
/// chain continues the nearest such chain, else it begins one. At a step, each chain of at least
/// `kLeastEvents` is one corner, at the mean of its last `kMeanEvents`, unless a chain with a later
/// event is within `kApart_px`: that one is where the corner has gone.
class EventCorners {
 public:
  static constexpr int kReach_px = 3;
  static constexpr float kApart_px = 5;
  static constexpr std::size_t kLeastEvents = 3, kMeanEvents = 4;

  EventCorners(int width_px, int height_px)
      : arc_star_(width_px, height_px), chain_at_(height_px, width_px, kNone) {}

  /// As `ArcStar::add`.
  void add(int x, int y, std::int64_t t_ns, bool is_on);

  /// Ends the step. \return its corners in pixels, row by row.
  std::vector<Eigen::Vector2f> step();

  const ArcStar& arc_star() const { return arc_star_; }

 private:
  static constexpr int kNone = -1;
  struct Chain {
    std::vector<Eigen::Vector2f> events_px;  ///< in order of time
    std::int64_t last_ns = 0;
  };
  int& pixel_of(const Chain& chain);

  ArcStar arc_star_;
  std::vector<Chain> chains_;
  cv::Mat1i chain_at_;  ///< place in `chains_` of the one whose last event is at the pixel
};

}  // namespace lcs
