#include "sim/world/watch.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lcs::sim {
namespace {

// Smaller overlaps are ignored: an image does not show them (feet in carpets, wheels that deform).
constexpr double kLeastDepth_m = 0.02;
// Actors keep their height and may step over obstacles up to this height above their feet (kerbs,
// stairs, cables).
constexpr double kStep_m = 0.2;
// The rover's origin may be this far below a bump between its wheels; no wheel is larger.
constexpr double kSunk_m = 0.1;
// Planes this far above the rover's start are tables and bridges, which the rover may be under.
constexpr double kOverhead_m = 0.5;
// Rays down to floors begin here, above the highest that a camera sees.
constexpr double kAbove_m = 1e4;
// No rover recovers from this tilt, and no road is as steep.
constexpr double kTipped_rad = std::numbers::pi / 4;
// A contact of the wheels with a flatter normal is with a wall. It is steeper than a step of half
// the wheel radius, which the wheels could climb.
constexpr double kSteep = 0.5;  // upward part of the normal
// An actor's size may differ from its stated size by this factor.
constexpr double kMostSize = 1.25;
// A rover may differ from its command, over a second, by a share and by a little more, as its
// wheels slip. Bumps of a height field turn it.
constexpr double kDriveSpan_s = 1, kDriveShare = 0.2, kDrive_mps = 0.05;
constexpr double kDrive_radps = 2 * std::numbers::pi / 180, kBump_radps = 5 * kDrive_radps;
// Smaller motions since the last check are ignored: the rover and a pedestrian are some tenths of a
// metre deep.
constexpr double kStride_m = 0.05, kStride_rad = 0.1;

bool is_plane(const mjModel& m, int geom) {
  return m.geom_type[geom] == mjGEOM_PLANE;
}

std::string at_place(const Vector3d& p) {
  return fmt::format("({:.2f}, {:.2f}) m", p.x(), p.y());
}

std::string at(std::int64_t t_ns, const Vector3d& p) {
  return fmt::format("at {:.2f} s, at {}", 1e-9 * static_cast<double>(t_ns), at_place(p));
}

std::string name_of(const Model& model, int geom) {
  const std::string_view name = model.name(mjOBJ_GEOM, geom);
  if (!name.empty()) return fmt::format("the setting's geom '{}'", name);
  return fmt::format("the setting's geom without a name round {}",
                     at_place(model.geom_pose(geom).p));
}

}  // namespace

bool is_floor(const Model& model, int geom) {
  const int type = model.m().geom_type[geom];
  return type == mjGEOM_HFIELD || (type == mjGEOM_PLANE && model.geom_pose(geom).R(2, 2) > kSteep);
}

Watch::Watch(const Model& model, int rover_body, std::vector<Solid> objects,
             const std::vector<int>& object_of_geom, const std::vector<char>& is_drawn)
    : last_T_WB_(model.body_pose(rover_body)) {
  const mjModel& m = model.m();
  objects.insert(
      objects.begin(),
      Solid{.kind = Kind::rover, .name = "the rover", .body = rover_body, .moves = true});
  std::vector<Solid> setting;
  lowest_m_ = std::numeric_limits<double>::infinity();
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const int object = object_of_geom[static_cast<std::size_t>(geom)];
    const Pose T_WG = model.geom_pose(geom);
    if (is_floor(model, geom)) {
      floors_.push_back(geom);
      has_field_ |= !is_plane(m, geom);
      lowest_m_ = std::min(lowest_m_, T_WG.p.z());
    } else if (!is_drawn[static_cast<std::size_t>(geom)]) {
      continue;
    } else if (object == 0) {
      lowest_m_ = std::min(lowest_m_, T_WG.p.z() - m.geom_rbound[geom]);
      setting.push_back(
          {.name = name_of(model, geom), .body = m.geom_bodyid[geom], .geoms = {geom}});
    } else {
      objects[static_cast<std::size_t>(std::max(object, 0))].geoms.push_back(geom);
    }
  }
  if (!std::isfinite(lowest_m_)) lowest_m_ = -lowest_m_;  // no setting to fall below
  solid_of_geom_.assign(static_cast<std::size_t>(m.ngeom), -1);
  for (Solid& solid : objects) add_solid(model, std::move(solid));
  for (const Solid& solid : solids_) {
    if (solid.size_m) check_size(model, solid, *solid.size_m);
  }
  for (Solid& solid : setting) add_solid(model, std::move(solid));
  start_m_ = model.body_pose(rover_body).p.z();
}

void Watch::add_solid(const Model& model, Solid solid) {
  const mjModel& m = model.m();
  const Pose T_BW = model.body_pose(solid.body).inverse();
  Eigen::AlignedBox3d box;
  for (const int geom : solid.geoms) {
    const Vector3d p = T_BW * model.geom_pose(geom).p;
    const auto reach = Vector3d::Constant(m.geom_rbound[geom]);
    box.extend(p - reach).extend(p + reach);
    solid_of_geom_[static_cast<std::size_t>(geom)] = static_cast<int>(solids_.size());
  }
  if (!box.isEmpty()) solid.centre_B = box.center();
  double foot_m = std::numeric_limits<double>::infinity();
  for (const int geom : solid.geoms) {
    const Pose T_WG = model.geom_pose(geom);
    const double reach_m =
        is_plane(m, geom) ? std::numeric_limits<double>::infinity() : m.geom_rbound[geom];
    solid.radius_m = std::max(solid.radius_m, (T_BW * T_WG.p - solid.centre_B).norm() + reach_m);
    if (solid.kind != Kind::actor) continue;
    if (m.body_weldid[m.geom_bodyid[geom]] != 0)
      solid.radius_m = std::numeric_limits<double>::infinity();
    const Eigen::RowVectorXd z = T_WG.R.row(2) * overlap_.hull(model, geom);
    foot_m = std::min(foot_m, T_WG.p.z() + z.minCoeff() - model.body_pose(solid.body).p.z());
  }
  if (std::isfinite(foot_m)) solid.foot_m = foot_m;
  solids_.push_back(std::move(solid));
}

/// Whether a geom is so low that an actor steps over it.
bool Watch::is_step(const Model& model, const Solid& who, const Solid& what, int geom) {
  if (who.kind != Kind::actor || (what.kind != Kind::object && what.kind != Kind::setting)) {
    return false;
  }
  if (is_plane(model.m(), geom)) return false;  // a wall, as the floors are not among the solids
  const Pose T_WG = model.geom_pose(geom);
  const Eigen::RowVectorXd z = T_WG.R.row(2) * overlap_.hull(model, geom);
  const double foot_W_m = model.body_pose(who.body).p.z() + who.foot_m;
  return T_WG.p.z() + z.maxCoeff() < foot_W_m + kStep_m;
}

/// The deepest overlap of two solids; depth 0 if they are apart.
Overlap::Place Watch::meeting(const Model& model, const Solid& who, const Solid& what) {
  const mjModel& m = model.m();
  const auto far = [](const Vector3d& a, const Vector3d& b, double reach) {
    return (a - b).squaredNorm() > reach * reach;
  };
  const Vector3d centre = model.body_pose(who.body) * who.centre_B;
  if (far(centre, model.body_pose(what.body) * what.centre_B, who.radius_m + what.radius_m)) {
    return {};
  }
  Overlap::Place deepest;
  for (const int b : what.geoms) {
    const Vector3d p_b = model.geom_pose(b).p;
    for (const int a : who.geoms) {
      Overlap::Place place;
      if (is_plane(m, b)) {
        place = overlap_.across(model, b, a, kLeastDepth_m);
      } else if (!far(model.geom_pose(a).p, p_b, m.geom_rbound[a] + m.geom_rbound[b])) {
        place = overlap_.of(model, a, b, kLeastDepth_m);
      }
      if (place.depth_m > deepest.depth_m && !is_step(model, who, what, b)) deepest = place;
    }
  }
  return deepest;
}

/// Calls `found(pair, place)` for each new overlap of the rover or an actor with another solid.
void Watch::find_meetings(const Model& model, const auto& found) {
  const auto is_traveller = [&](std::size_t i) {
    return solids_[i].kind == Kind::rover || solids_[i].kind == Kind::actor;
  };
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    if (!is_traveller(i)) continue;
    for (std::size_t k = 0; k < solids_.size(); ++k) {
      if ((is_traveller(k) && k <= i) || met_.contains({i, k})) continue;
      const Overlap::Place place = meeting(model, solids_[i], solids_[k]);
      if (place.depth_m > 0) found(Pair(i, k), place);
    }
  }
}

std::vector<Watch::Meeting> Watch::meetings(const Model& model) {
  std::vector<Meeting> all;
  find_meetings(model, [&](const Pair& pair, const Overlap::Place& place) {
    const Solid& a = solids_[pair.first];
    const Solid& b = solids_[pair.second];
    all.push_back({static_cast<int>(pair.first), static_cast<int>(pair.second), b.kind, a.name,
                   b.name, at_place(place.point_m), place.depth_m});
  });
  return all;
}

void Watch::pass_over(const Meeting& meeting) {
  met_.insert(
      {static_cast<std::size_t>(meeting.traveller), static_cast<std::size_t>(meeting.other)});
}

bool Watch::has_moved(const Model& model) {
  std::vector<Pose> now;
  for (const Solid& solid : solids_) {
    if (solid.moves) now.push_back(model.body_pose(solid.body));
    for (const int geom : solid.geoms) {
      const int carrier = model.m().body_weldid[model.m().geom_bodyid[geom]];  // 0: with its body
      if (solid.kind == Kind::actor && carrier != 0) now.push_back(model.body_pose(carrier));
    }
  }
  const auto is_near = [](const Pose& a, const Pose& b) {
    // trace of a rotation: 1 + 2 cos of its angle
    return (a.p - b.p).norm() < kStride_m &&
           (a.R.transpose() * b.R).trace() > 1 + 2 * std::cos(kStride_rad);
  };
  if (std::equal(now.begin(), now.end(), last_.begin(), last_.end(), is_near)) return false;
  last_ = std::move(now);
  return true;
}

void Watch::note_meeting(const Pair& pair, const Vector3d& point, std::int64_t t_ns) {
  if (!met_.insert(pair).second) return;
  const Solid& who = solids_[pair.first];
  const Solid& what = solids_[pair.second];
  if (who.kind == Kind::rover) {
    warnings_.add(Warning::rover_collisions,
                  fmt::format("the rover runs into {} {}", what.name, at(t_ns, point)));
  } else {
    warnings_.add(Warning::actor_collisions,
                  fmt::format("{} passes through {} {}", who.name, what.name, at(t_ns, point)));
  }
}

/// Counts contacts of the wheels with walls: they hinder the wheels from overlapping.
void Watch::note_contacts(const Model& model, std::int64_t t_ns) {
  const mjData& d = model.d();
  for (int i = 0; i < d.ncon; ++i) {
    const mjContact& contact = d.contact[i];
    const auto solid_of = [&](int geom) { return solid_of_geom_[static_cast<std::size_t>(geom)]; };
    const int a = solid_of(contact.geom1), b = solid_of(contact.geom2);
    if (a < 0 || b < 0 || (a == 0) == (b == 0)) continue;  // floor: -1; rover: 0
    if (std::abs(contact.frame[2]) > kSteep || contact.dist > 0) continue;
    note_meeting({0, static_cast<std::size_t>(std::max(a, b))},
                 Eigen::Map<const Vector3d>(contact.pos), t_ns);
  }
}

/// Height of the floor below a place in W, or above it for a body that has fallen; outside all
/// floors, the lowest height of the setting.
double Watch::floor_m(const Model& model, const Vector3d& at) const {
  std::optional<double> highest_m;
  for (const int geom : floors_) {
    const Vector3d above(at.x(), at.y(), kAbove_m), down = -Vector3d::UnitZ();
    const double way_m = mj::ray_geom(model.m(), model.d(), geom, above.data(), down.data());
    const double height_m = kAbove_m - way_m;
    const bool may_be_bridge = is_plane(model.m(), geom);
    if (way_m >= 0 && (!may_be_bridge || height_m < start_m_ + kOverhead_m)) {
      highest_m = std::max(highest_m.value_or(height_m), height_m);
    }
  }
  return highest_m.value_or(lowest_m_);
}

void Watch::note_falls(const Model& model, std::int64_t t_ns) {
  for (Solid& solid : solids_) {
    const bool is_rover = solid.kind == Kind::rover, is_actor = solid.kind == Kind::actor;
    if (!is_rover && !is_actor && !(solid.kind == Kind::object && solid.moves)) continue;
    const Pose T_WB = model.body_pose(solid.body);
    Vector3d p = is_rover ? T_WB.p : T_WB * solid.centre_B;
    if (is_actor) p.z() = T_WB.p.z() + solid.foot_m;
    const double sunk_m = floor_m(model, p) - p.z();
    const bool was_low = std::exchange(solid.is_low, sunk_m > kSunk_m);
    if (was_low || !solid.is_low) continue;
    if (is_actor) {
      warnings_.add(Warning::actors_in_ground, fmt::format("{} reaches {:.2f} m into the ground {}",
                                                           solid.name, sunk_m, at(t_ns, p)));
    } else {
      warnings_.add(is_rover ? Warning::rover_below_ground : Warning::objects_below_ground,
                    fmt::format("{} is below the ground {}", solid.name, at(t_ns, p)));
    }
  }
}

/// Compares the extents of a body's visible geoms, along the body's axes, with its stated size.
void Watch::check_size(const Model& model, const Solid& solid, const Vector3d& stated_m) {
  const Pose T_BW = model.body_pose(solid.body).inverse();
  Eigen::AlignedBox3d box;
  for (const int geom : solid.geoms) {
    const Pose T_BG = T_BW * model.geom_pose(geom);
    const Eigen::Matrix3Xd points = (T_BG.R * overlap_.hull(model, geom)).colwise() + T_BG.p;
    box.extend(points.rowwise().minCoeff()).extend(points.rowwise().maxCoeff());
  }
  const Vector3d size_m = box.sizes();
  const Vector3d ratio = size_m.cwiseQuotient(stated_m);
  if (solid.geoms.empty() ||
      ((ratio.array() < kMostSize).all() && (ratio.array() * kMostSize > 1).all()))
    return;
  const auto text = [](const Vector3d& size) {
    return fmt::format("{:.2f} x {:.2f} x {:.2f} m", size.x(), size.y(), size.z());
  };
  warnings_.add(
      Warning::actors_of_other_size,
      fmt::format("{} is {} large, and should be {}", solid.name, text(size_m), text(stated_m)));
}

/// Compares each second of the rover's path with its commands.
void Watch::note_drive(const Model& model, std::int64_t t_ns, const PlanarVelocity& asked) {
  const Pose T_WB = model.body_pose(solids_.front().body);
  const double dt_s = 1e-9 * static_cast<double>(t_ns - last_ns_);
  const Pose T_LB = last_T_WB_.inverse() * T_WB;
  drive_.asked.linear_mps += dt_s * asked.linear_mps;
  drive_.asked.yaw_rate_radps += dt_s * asked.yaw_rate_radps;
  drive_.done.linear_mps += T_LB.p.head<2>();
  drive_.done.yaw_rate_radps += std::atan2(T_LB.R(1, 0), T_LB.R(0, 0));
  last_T_WB_ = T_WB;
  last_ns_ = t_ns;
  const double span_s = 1e-9 * static_cast<double>(t_ns - drive_.from_ns);
  if (span_s < kDriveSpan_s) return;
  const PlanarVelocity& a = drive_.asked;
  const PlanarVelocity& d = drive_.done;
  const auto differ = [](double difference, double asked_for, double tolerance) {
    return difference > tolerance + kDriveShare * std::abs(asked_for);
  };
  if (differ((d.linear_mps - a.linear_mps).norm(), a.linear_mps.norm(),
             kDriveSpan_s * kDrive_mps) ||
      differ(std::abs(d.yaw_rate_radps - a.yaw_rate_radps), a.yaw_rate_radps,
             kDriveSpan_s * (has_field_ ? kBump_radps : kDrive_radps))) {
    const auto text = [&](const PlanarVelocity& v) {
      return fmt::format("({:.2f}, {:.2f}) m/s and {:.1f} deg/s", v.linear_mps.x() / span_s,
                         v.linear_mps.y() / span_s,
                         v.yaw_rate_radps / span_s * 180 / std::numbers::pi);
    };
    warnings_.add(Warning::rover_off_command,
                  fmt::format("the rover drives {} from {:.1f} to {:.1f} s, where {} are asked",
                              text(d), 1e-9 * static_cast<double>(drive_.from_ns),
                              1e-9 * static_cast<double>(t_ns), text(a)));
  }
  drive_ = {.from_ns = t_ns, .asked = {}, .done = {}};
}

void Watch::note_attitude(const Model& model, std::int64_t t_ns) {
  const Pose T_WB = model.body_pose(solids_.front().body);
  const bool was_tipped = std::exchange(is_tipped_, T_WB.R(2, 2) < std::cos(kTipped_rad));
  if (was_tipped || !is_tipped_) return;
  warnings_.add(Warning::rover_tipped,
                fmt::format("the rover has tipped over {}", at(t_ns, T_WB.p)));
}

void Watch::look(const Model& model, std::int64_t t_ns,
                 const std::optional<PlanarVelocity>& asked) {
  if (asked) note_drive(model, t_ns, *asked);
  note_contacts(model, t_ns);
  if (!has_moved(model)) return;
  if (asked) note_attitude(model, t_ns);
  note_falls(model, t_ns);
  find_meetings(model, [&](const Pair& pair, const Overlap::Place& place) {
    note_meeting(pair, place.point_m, t_ns);
  });
}

}  // namespace lcs::sim
