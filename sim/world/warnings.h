/// \file
/// Counts of events that hint at a mistake in a scenario, for example a rover that tips over. The
/// figures of such a run are right, but its author seldom intended them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lcs::sim {

enum class Warning : std::uint8_t {
  rover_below_ground,
  rover_tipped,
  rover_collisions,
  actor_collisions,
  objects_below_ground,
  rover_off_command,
  actors_never_moved,
  actors_never_seen,
  actors_in_ground,
  actors_of_other_size,
  translucent_geoms,
  undrawn_parts,
  joints_frozen,
  options_replaced,
  mujoco_warnings,
  joints_loose,
  bodies_named,
  coplanar_faces,
  coarse_shutter,
  coarse_events,
};

struct WarningText {
  const char* word;    ///< as in "warnings.WORD" of metrics.json
  const char* remedy;  ///< printed after the description of the event
};

/// In the order of `Warning`.
inline constexpr std::array<WarningText, 20> kWarnings{{
    {"rover_below_ground", "give the ground contacts (contype), or change its start or its path"},
    {"rover_tipped", "make it slower, or the ground smoother"},
    {"rover_collisions", "change its start or its path, or move the obstacle"},
    {"actor_collisions", "change its trajectory, or move the obstacle"},
    {"objects_below_ground", "give it contacts (contype, conaffinity), or take its joint away"},
    {"rover_off_command", "correct its joints, wheels or actuators, or ask for less"},
    {"actors_never_moved", "change its start or its speed, or the rover's path"},
    {"actors_never_seen", "change its trajectory, its start, or the rover's path"},
    {"actors_in_ground", "raise its geoms: an actor's origin is on the ground below its middle"},
    {"actors_of_other_size", "correct the size in its file (<numeric name=\"size\">) or its geoms"},
    {"translucent_geoms",
     "a pixel has one true surface; give it alpha 1, or 0 for a geom that is not drawn"},
    {"undrawn_parts", "only geoms have a truth; give the body geoms for the parts to be seen"},
    {"joints_frozen", "the joints that a pose holds do not move"},
    {"options_replaced", "bodies may move otherwise than in MuJoCo; give the option that is used"},
    {"mujoco_warnings", "MuJoCo goes on all the same"},
    {"joints_loose", "give ego.pose, a keyframe or zero, if they should stay"},
    {"bodies_named", "give it a name of its own"},
    {"coplanar_faces", "the picture shows now one and now the other; move one by a millimetre"},
    {"coarse_shutter", "rows show steps; shorten the shutter's times, or slow the motion"},
    {"coarse_events", "events come in bursts; raise camera.rate, or slow the motion"},
}};
static_assert(kWarnings.size() == static_cast<std::size_t>(Warning::coarse_events) + 1);

constexpr const WarningText& text_of(Warning warning) {
  return kWarnings[static_cast<std::size_t>(warning)];
}

/// Count of each kind of event, and its first occurrences in words: event, time, place, remedy.
class Warnings {
 public:
  struct Met {
    std::int64_t count = 0;
    std::string first;
    std::vector<std::string> next;  ///< up to `kMostNext` descriptions, without remedies
  };
  static constexpr std::size_t kMostNext = 9;

  void add(Warning warning, const std::string& what) {
    Met& met = of(warning);
    if (met.count++ == 0) {
      met.first = what + ": " + text_of(warning).remedy;
    } else if (met.next.size() < kMostNext) {
      met.next.push_back(what);
    }
  }

  Met& of(Warning warning) { return met_[static_cast<std::size_t>(warning)]; }
  const Met& of(Warning warning) const { return met_[static_cast<std::size_t>(warning)]; }

 private:
  std::array<Met, kWarnings.size()> met_;
};

}  // namespace lcs::sim
