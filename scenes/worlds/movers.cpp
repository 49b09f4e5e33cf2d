#include "scenes/worlds/families.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/world/actor.h"

namespace lcs::worlds {
namespace {

constexpr double kRoverGap_m = 0.12, kGap_m = 0.08;
constexpr int kTries = 120;
constexpr int kLeastSeen = 14;  // frames; the promise is ten by the truth
constexpr double kLeastHeight_px = 14;

double to_cm(double value) {
  return std::round(value * 100) / 100;
}
Vector2d to_cm(const Vector2d& v) {
  return {to_cm(v.x()), to_cm(v.y())};
}

enum class Path { across, slanting, coming, going, pacing, overtaking, shuttle, circle };

/// A frame and a visible point that a path leads through.
struct Meeting {
  std::size_t frame = 0;
  Vector2d at_m = Vector2d::Zero();
  double distance_m = 0;
};

class Planner {
 public:
  Planner(Kit& kit, const RoverPath& way, const Traffic& traffic)
      : kit_(kit), d_(kit.draw), s_(kit.world.scenario), way_(way), traffic_(traffic) {
    fovx_ =
        2 * std::atan(std::tan(s_.camera.fovy_rad / 2) * s_.camera.width_px / s_.camera.height_px);
    focal_px_ = s_.camera.height_px / 2.0 / std::tan(s_.camera.fovy_rad / 2);
  }

  /// Plans one candidate; the caller checks that it is free and visible.
  bool plan(PlannedMover& mover) {
    const TurnedBox box = kit_.bounds(mover.thing.parts);
    const double radius = box.half_m.norm();
    const Meeting meeting = meet(radius);
    const Stand& rover = way_.frames[meeting.frame];
    Path path = d_.pick({Path::across, Path::across, Path::across, Path::slanting, Path::slanting,
                         Path::coming, Path::going, Path::pacing, Path::overtaking, Path::shuttle,
                         Path::circle});
    const double fastest = std::min(traffic_.fastest_mps, speed_in_view(meeting.distance_m));
    double speed = d_.scaled(std::min(0.15, fastest), fastest);
    if (d_.chance(0.15)) {  // close to the largest speed; back and forth to stay in view
      path = Path::shuttle;
      speed = fastest * d_.between(0.7, 1);
    }
    double heading = rover.heading_rad;
    if (path == Path::circle) return plan_circle(mover, meeting, box, speed);
    if (path == Path::across || path == Path::shuttle) {
      heading += d_.either(std::numbers::pi / 2 - 0.25, std::numbers::pi / 2 + 0.25);
    } else if (path == Path::slanting) {
      heading += d_.chance(0.5) ? d_.either(0.4, 1.2) : d_.either(1.9, 2.7);
    } else if (path == Path::coming) {
      heading += std::numbers::pi + d_.between(-0.25, 0.25);
    } else if (path == Path::going) {
      heading += d_.between(-0.25, 0.25);
    } else {  // beside the rover, or past it
      const double rover_mps = s_.ego.phases.front().speed_mps;
      if (rover_mps < 0.1) return false;
      heading += s_.ego.phases.front().direction_rad;
      speed = rover_mps * (path == Path::pacing ? 1 : d_.between(1.4, 3));
    }
    return plan_straight(mover, meeting, box, heading, speed, path == Path::shuttle);
  }

  bool is_free(const PlannedMover& mover, const std::vector<PlannedMover>& others) const {
    const std::size_t last = way_.frames.size() - 1;
    for (std::size_t k = 0; k <= 4 * last; ++k) {
      const Stand& before = way_.frames[k / 4];
      const Stand& after = way_.frames[std::min(last, k / 4 + 1)];
      const double share = static_cast<double>(k % 4) / 4;
      const double t = before.t_s + share * (after.t_s - before.t_s);
      const Stand rover{t, before.at_m + share * (after.at_m - before.at_m),
                        before.heading_rad + share * (after.heading_rad - before.heading_rad)};
      const TurnedBox box = mover.box_at(kit_, t);
      if (gap_m(box, way_.box_of(s_.camera, rover)) < kRoverGap_m) return false;
      if (least_gap_m(box, kit_.solids) < 0.02) return false;
      for (const PlannedMover& other : others) {
        if (gap_m(box, other.box_at(kit_, t)) < kGap_m) return false;
      }
    }
    return true;
  }

 private:
  double end_s() const { return way_.frames.back().t_s; }

  /// Speed of an image motion of half the picture width a frame.
  double speed_in_view(double distance_m) const {
    return 0.5 * s_.camera.width_px / focal_px_ * distance_m * s_.camera.rate_hz;
  }

  Meeting meet(double radius) {
    Meeting m;
    const double frames = static_cast<double>(way_.frames.size() - 1);
    m.frame = static_cast<std::size_t>(frames * d_.between(0.3, 0.7));
    const double nearest = 0.45 + radius;
    const double farthest = std::max(nearest * 1.5, traffic_.farthest_m);
    m.distance_m = d_.scaled(nearest, farthest);
    const Stand& stand = way_.frames[m.frame];
    const Vector2d camera = camera_at(s_.camera, stand, 0).head<2>();
    const double bearing = stand.heading_rad + d_.between(-0.42, 0.42) * fovx_;
    m.at_m = camera + m.distance_m * towards(bearing);
    return m;
  }

  bool may_be(TurnedBox box, const Vector2d& at, double level) const {
    if (std::abs(kit_.ground(at) - level) > 0.02) return false;  // movers keep their height
    box.centre_m = at;
    for (const Vector2d& corner : corners_of(box)) {
      const double above = kit_.ground(corner) - level;  // it would sink into a slope
      if (above > 0.005 || above < -0.06) return false;
    }
    box.foot_m += level;
    box.head_m += level;
    return is_within(box, traffic_.low_m, traffic_.high_m) &&
           least_gap_m(box, kit_.solids) > kGap_m;
  }

  /// Length of the free path from the meeting, at most `most_m`.
  double free_way(const TurnedBox& box, const Vector2d& from, double heading, double most_m) const {
    constexpr double kStep_m = 0.1;
    const double level = kit_.ground(from);
    double way = 0;
    while (way + kStep_m <= most_m &&
           may_be(box, from + (way + kStep_m) * towards(heading), level)) {
      way += kStep_m;
    }
    return way;
  }

  /// Plans a straight free path through the meeting; the mover rests before and after it.
  bool plan_straight(PlannedMover& mover, const Meeting& meeting, TurnedBox box, double heading,
                     double speed, bool back_and_forth) {
    box.heading_rad = heading;
    if (!may_be(box, meeting.at_m, kit_.ground(meeting.at_m))) return false;
    const double t = way_.frames[meeting.frame].t_s;
    const double back = free_way(box, meeting.at_m, heading + std::numbers::pi, speed * t);
    const double forth = free_way(box, meeting.at_m, heading, speed * (end_s() + 1 - t));
    if (back + forth < 0.3) return false;
    const Vector2d from = to_cm(meeting.at_m - back * towards(heading));
    const Vector2d until = to_cm(meeting.at_m + forth * towards(heading));
    const double leg_s = (until - from).norm() / speed;
    mover.start_s = std::max(0.0, to_cm(t - back / speed));
    mover.heading_rad = heading;
    scenario::Waypoints path;
    if (back_and_forth) {
      const int legs = std::min(20, 2 + static_cast<int>(end_s() / leg_s));
      for (int i = 0; i <= legs; ++i) {
        path.push_back({to_cm(std::max(0.01, leg_s)) * i, i % 2 ? until : from});
      }
    } else if (d_.chance(0.25)) {  // starts or stops slowly: legs of increasing or decreasing speed
      const bool stops = d_.chance(0.5);
      constexpr int kLegs = 6;
      for (int i = 0; i <= kLegs; ++i) {
        const double share = static_cast<double>(i) / kLegs;
        const double where = stops ? share * (2 - share) : share * share;
        path.push_back(
            {to_cm(1.6 * leg_s * share) + 0.01 * i, to_cm(from + where * (until - from))});
      }
      kit_.tag(stops ? "mover_stops" : "mover_starts");
    } else {
      path = {{0, from}, {std::max(0.02, to_cm(leg_s)), until}};
    }
    mover.trajectory = path;
    return true;
  }

  bool plan_circle(PlannedMover& mover, const Meeting& meeting, const TurnedBox& box,
                   double speed) {
    constexpr double kInwards_mps2 = 1.5;  // greatest lateral acceleration without tipping
    const double radius = to_cm(d_.between(0.5, std::min(3.0, 0.5 * meeting.distance_m + 0.5)));
    speed = std::min(speed, std::sqrt(kInwards_mps2 * radius));
    const double angle = d_.between(-std::numbers::pi, std::numbers::pi);
    const Vector2d centre = to_cm(meeting.at_m - radius * towards(angle));
    const double level = kit_.ground(centre);
    for (int i = 0; i < 24; ++i) {
      TurnedBox there = box;
      there.heading_rad = 2 * std::numbers::pi * i / 24 + std::numbers::pi / 2;
      if (!may_be(there, centre + radius * towards(2 * std::numbers::pi * i / 24), level))
        return false;
    }
    mover.start_s = 0;
    mover.heading_rad = angle + std::numbers::pi / 2;
    mover.trajectory = scenario::Circular{.centre_m = centre,
                                          .radius_m = radius,
                                          .start_angle_rad = to_cm(angle),
                                          .speed_mps = d_.sign() * to_cm(std::max(0.05, speed))};
    return true;
  }

  Kit& kit_;
  Draw& d_;
  const scenario::Scenario& s_;
  const RoverPath& way_;
  const Traffic& traffic_;
  double fovx_ = 1, focal_px_ = 1;
};

struct Sight {
  int points = 0;          ///< of 27, in the picture and not occluded
  Eigen::AlignedBox2d px;  ///< of those in front of the camera
  bool before = false;     ///< a nearer mover hides part of it
};

constexpr int kLeastPoints = 5;

Sight look(const Kit& kit, const Stand& stand, const TurnedBox& box,
           const std::vector<TurnedBox>& others) {
  const scenario::Camera& camera = kit.world.scenario.camera;
  const double level = kit.ground(stand.at_m);
  const Vector3d eye = camera_at(camera, stand, level);
  Sight sight;
  for (const double x : {-0.8, 0.0, 0.8}) {
    for (const double y : {-0.8, 0.0, 0.8}) {
      for (const double z : {-0.8, 0.0, 0.8}) {
        const Vector3d point = point_of(box, x, y, z);
        const Vector3d seen = seen_at(camera, stand, level, point);
        if (seen.z() < 0.06) continue;
        sight.px.extend(seen.head<2>());
        if (seen.x() < 0 || seen.y() < 0 || seen.x() >= camera.width_px ||
            seen.y() >= camera.height_px) {
          continue;
        }
        const auto hides = [&](const TurnedBox& other) { return is_between(other, eye, point); };
        if (std::ranges::any_of(kit.solids, hides)) continue;
        if (std::ranges::any_of(others, hides)) {
          sight.before = true;
          continue;
        }
        ++sight.points;
      }
    }
  }
  return sight;
}

std::vector<TurnedBox> boxes_of_others(const Kit& kit, const std::vector<PlannedMover>& movers,
                                       std::size_t which, double t_s) {
  std::vector<TurnedBox> boxes;
  for (std::size_t i = 0; i < movers.size(); ++i) {
    if (i != which) boxes.push_back(movers[i].box_at(kit, t_s));
  }
  return boxes;
}

bool is_seen(const Sight& sight) {
  return sight.points >= kLeastPoints && sight.px.sizes().y() >= kLeastHeight_px;
}

}  // namespace

TurnedBox PlannedMover::box_at(const Kit& kit, double t_s) const {
  const sim::PlanarPose pose =
      sim::pose_on(trajectory, {Vector2d::Zero(), heading_rad}, t_s - start_s);
  return kit.box_at(thing.parts, pose.position_m, pose.heading_rad);
}

int frames_seen(const Kit& kit, const RoverPath& way, const std::vector<PlannedMover>& movers,
                std::size_t which) {
  int frames = 0;
  for (std::size_t k = 0; k + 1 < way.frames.size(); ++k) {
    const Stand& stand = way.frames[k];
    const TurnedBox now = movers[which].box_at(kit, stand.t_s);
    const TurnedBox next = movers[which].box_at(kit, way.frames[k + 1].t_s);
    const bool moves = (now.centre_m - next.centre_m).norm() > 1e-4;
    if (moves && is_seen(look(kit, stand, now, boxes_of_others(kit, movers, which, stand.t_s)))) {
      ++frames;
    }
  }
  return frames;
}

std::vector<PlannedMover> draw_movers(Kit& kit, const RoverPath& way, const Traffic& traffic,
                                      int count) {
  Planner planner(kit, way, traffic);
  std::vector<PlannedMover> movers;
  while (static_cast<int>(movers.size()) < count) {
    PlannedMover mover;
    const bool alike = !movers.empty() && kit.draw.chance(0.3);
    mover.thing = alike ? movers.back().thing : make_thing(kit, kit.draw.pick(traffic.kinds));
    bool found = false;
    for (int i = 0; i < kTries && !found; ++i) {
      if (!planner.plan(mover) || !planner.is_free(mover, movers)) continue;
      std::vector<PlannedMover> all = movers;
      all.push_back(mover);
      found = true;
      for (std::size_t m = 0; m < all.size(); ++m) {
        found = found && frames_seen(kit, way, all, m) >= kLeastSeen;
      }
      if (found && alike) kit.tag("several_alike");
    }
    if (!found) break;
    movers.push_back(std::move(mover));
  }
  return movers;
}

void add_movers(Kit& kit, const RoverPath& way, const std::vector<PlannedMover>& movers) {
  for (std::size_t i = 0; i < movers.size(); ++i) {
    const PlannedMover& mover = movers[i];
    const TurnedBox first = mover.box_at(kit, 0);
    scenario::Actor actor;
    actor.name = fmt::format("mover_{}_{}", i + 1, mover.thing.kind);
    actor.body = actor.name;
    actor.trajectory = mover.trajectory;
    actor.start.at_s = mover.start_s;
    kit.world.scenario.actors.push_back(actor);
    kit.world.bodies.push_back(
        {actor.name,
         {first.centre_m.x(), first.centre_m.y(),
          first.foot_m - kit.bounds(mover.thing.parts).foot_m},
         Eigen::Quaterniond(Eigen::AngleAxisd(first.heading_rad, Vector3d::UnitZ())),
         mover.thing.parts});
    if (kit.is_bare(mover.thing.parts)) kit.tag("plain_mover");
    const bool is_mesh = std::ranges::any_of(
        mover.thing.parts, [](const Part& part) { return part.shape == Part::Shape::mesh; });
    kit.tag(is_mesh ? "mover_of_meshes" : "mover_of_primitives");
    const scenario::Camera& camera = kit.world.scenario.camera;
    for (const Stand& stand : way.frames) {
      const TurnedBox box = mover.box_at(kit, stand.t_s);
      const Sight sight = look(kit, stand, box, boxes_of_others(kit, movers, i, stand.t_s));
      if (sight.before && sight.points > 0) kit.tag("mover_before_mover");
      if (!is_seen(sight)) continue;
      if (sight.px.min().x() < 0 || sight.px.max().x() > camera.width_px) kit.tag("mover_cut");
      if (sight.px.sizes().x() > camera.width_px || sight.px.sizes().y() > camera.height_px) {
        kit.tag("mover_larger_than_picture");
      }
    }
  }
}

}  // namespace lcs::worlds
