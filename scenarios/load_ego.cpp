#include "scenarios/load_ego.h"

#include <algorithm>
#include <cmath>

#include "scenarios/load_actor.h"
#include "scenarios/quantities.h"
#include "scenarios/scenes.h"

namespace lcs::scenario {
namespace {

void read_motion(Reader& reader, EgoPhase& phase) {
  reader.read("speed", kSpeed, phase.speed_mps);
  reader.read("acceleration", kAcceleration, phase.acceleration_mps2);
  reader.read("direction", kAngle, phase.direction_rad);
  reader.read("yaw_rate", kAngularRate, phase.yaw_rate_radps);
}

/// What a phase has become at `at_s`.
EgoPhase carried_on(const EgoPhase& before, double at_s) {
  EgoPhase phase = before;
  phase.at_s = at_s;
  phase.speed_mps =
      std::max(0.0, before.speed_mps + before.acceleration_mps2 * (at_s - before.at_s));
  return phase;
}

EgoPhase next_phase(Reader reader, const EgoPhase& before) {
  double at_s = before.at_s;
  const Value* at = reader.require("at");
  reader.read("at", kTime, at_s);
  EgoPhase phase = carried_on(before, at_s);
  read_motion(reader, phase);
  reader.finish();
  if (at_s <= before.at_s) {
    throw Error(at->where, reader.path_of("at") + " is '" + at->text +
                               "', not after the phase before (" + number_text(before.at_s) +
                               " s); make the times increase");
  }
  return phase;
}

void read_way(Reader& reader, Ego& ego) {
  for (const char* key :
       {"start", "heading", "speed", "acceleration", "direction", "yaw_rate", "phases"}) {
    reader.at_most_one_of({key, "waypoints"});
  }
  const Value& value = *reader.find("waypoints");
  const std::string path = reader.path_of("waypoints");
  ego.waypoints = read_waypoints(value, path).points;
  ego.start_m = ego.waypoints.front().position_m;
  const auto elsewhere =
      std::find_if(ego.waypoints.begin(), ego.waypoints.end(),
                   [&](const Waypoint& point) { return point.position_m != ego.start_m; });
  if (elsewhere == ego.waypoints.end()) {
    throw Error(value.where, path + " lead nowhere: all are one place; make one of them another, " +
                                 "or give start and heading for a rover that stands");
  }
  const Eigen::Vector2d way = elsewhere->position_m - ego.start_m;
  ego.heading_rad = std::atan2(way.y(), way.x());
}

}  // namespace

Ego read_ego(Reader reader, const std::filesystem::path& folder) {
  Ego ego;
  ego.source = reader.where();
  if (const auto file = own_file(reader, "drive", folder)) {
    ego.drive = Drive::own;
    ego.drive_file = *file;
  } else if (const auto drive = reader.choice("drive", {"holonomic", "wheeled"}, kOwnFile)) {
    ego.drive = static_cast<Drive>(*drive);
  }
  if (reader.find("waypoints")) read_way(reader, ego);
  reader.read("start", kPosition, ego.start_m);
  reader.read("heading", kAngle, ego.heading_rad);
  read_motion(reader, ego.phases.emplace_back());
  if (const Value* phases = reader.find("phases")) {
    const std::string path = reader.path_of("phases");
    for (const Value& phase : as_list(*phases, path)) {
      const std::string index = std::to_string(ego.phases.size() - 1);
      ego.phases.push_back(next_phase({phase, path + "." + index}, ego.phases.back()));
    }
  }
  reader.finish();
  return ego;
}

}  // namespace lcs::scenario
