/// \file
/// What a corner without a motion of its own is taken for: the log odds that it is a rebel's, from
/// what is decided round it and from the little that its own past shows.
///
/// Three to five in ten of a mover's corners are in no earlier frame where its motion puts them.
/// Near them the mover's other corners lie; but so do corners of what is behind it, at its border,
/// and ground that it has just left. A sum of weights parts them better than a share of neighbours.
/// Derivation of the weights (`InheritanceParameters`): filter/EQUATIONS.md, section 10.
#pragma once

#include <cstdint>

#include "filter/camera.h"
#include "filter/parameters.h"

namespace lcs {

/// In which directions round a place there is something, to a sixteenth of a turn.
class Bearings {
 public:
  static constexpr int kSectors = 16;

  /// \param way from the place, of any length but 0.
  void add(const Vec2& way);
  /// The widest angle that holds none, between the middles of the sectors at its sides: 2 pi of
  /// one direction or none, over pi outside of the hull of what was added.
  double widest_gap_rad() const;

 private:
  std::uint32_t taken_ = 0;  // a bit a sector, from x to y
};

/// What is round a corner and inside the radius that is looked at.
struct Surroundings {
  double rebel_px = 0;     ///< to the nearest corner that is called a rebel
  double normal_px = 0;    ///< to that of an established normal edge; the radius: there is none
  int rebels = 0;          ///< corners that are called and move about as that one does
  double gap_rad = 0;      ///< widest angle without any of these
  bool unfounded = false;  ///< the nearest rebel was called as its group stands on nothing
};

/// What is known of the corner itself.
struct OwnPast {
  bool confirms = false;     ///< both earlier frames have one where the nearest rebel's motion does
  bool stands_once = false;  ///< one of them has one where a static point would be
  bool has_normal = false;   ///< a normal edge took it,
  bool has_trusted = false;  ///< and is of the highest trust
};

/// ln(p / (1 - p)) of the chance p that the corner is on a body that moves.
double rebel_log_odds(const InheritanceParameters& weights, const Surroundings& around,
                      const OwnPast& own);

}  // namespace lcs
