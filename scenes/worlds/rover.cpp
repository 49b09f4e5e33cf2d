#include "scenes/worlds/families.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "scenarios/imu_presets.h"
#include "sim/base/pose.h"
#include "sim/world/rover.h"

namespace lcs::worlds {
namespace {

using scenario::EgoPhase;
constexpr double kStep_s = 0.005;

/// Rounds to a file's decimals, so that plan and simulation agree.
double to(double value, double step) {
  return std::round(value / step) * step;
}

void draw_camera(Kit& kit, const Lane& lane) {
  Draw& d = kit.draw;
  scenario::Camera& camera = kit.world.scenario.camera;
  // most are small, so that a whole split runs in minutes
  static const std::vector<std::pair<int, int>> kSizes{
      {320, 240}, {320, 240}, {424, 240}, {400, 300}, {480, 360}, {512, 384}, {640, 360},
      {640, 400}, {640, 480}, {640, 480}, {752, 480}, {848, 480}, {1280, 720}};
  std::tie(camera.width_px, camera.height_px) = d.pick(kSizes);
  const double shape = static_cast<double>(camera.height_px) / camera.width_px;
  const double fovx = d.between(45, 100) * kDegree;
  camera.fovy_rad = to(2 * std::atan(std::tan(fovx / 2) * shape), 0.1 * kDegree);
  camera.rate_hz = d.pick({3, 4, 5, 6, 8, 10, 10, 12, 15, 20, 25, 30});
  kit.world.scenario.frames = d.whole(40, camera.width_px > 800 ? 44 : 64);
  const double height = to(d.scaled(0.2, lane.highest_camera_m), 0.01);
  camera.mount_position_m = {0.2, 0, height};
  const double down = d.between(-6, 6 + 10 * height);
  camera.mount_rpy_rad = {0, to(down, 0.1) * kDegree, 0};
  if (d.chance(0.35)) {
    kit.tag("told_with_error");
    camera.told.height_error_m = to(height * d.either(0.02, 0.12), 0.001);
    camera.told.pitch_error_rad = to(d.either(0.2, 1.5), 0.01) * kDegree;
  }
}

/// Draws the image properties; noise is always present.
void draw_image(Kit& kit) {
  Draw& d = kit.draw;
  scenario::Image image;
  image.noise = {.full_well_e = to(d.scaled(2000, 20000), 10), .read_e = to(d.scaled(2, 12), 0.1)};
  if (d.chance(0.4)) image.blur_px = to(d.between(0.2, 1.0), 0.01);
  // less light on the sensor, and a gain that roughly compensates
  const double light = d.scaled(0.3, 1);
  image.exposure_s = to(light * scenario::Image::kDaylightExposure_s, 1e-5);
  image.gain = to(d.between(0.75, 1.15) / light, 0.01);
  if (d.chance(0.4)) {
    kit.tag("jpeg");
    image.jpeg_quality = d.whole(35, 92);
  }
  kit.world.scenario.image = image;
}

void draw_sensors(Kit& kit) {
  Draw& d = kit.draw;
  scenario::Scenario& s = kit.world.scenario;
  s.imu.preset = d.pick({"adis16448", "adis16448", "tumvi", "esim"});
  s.imu.noise = *scenario::imu_preset(s.imu.preset);
  s.odometry.enabled = d.chance(0.7);
  if (!s.odometry.enabled) kit.tag("no_odometry");
}

enum class Kind { stand, crawl, drive, bend, spin, aside, brake, weave };

std::vector<EgoPhase> phases_of(Draw& d, Kind kind, double duration_s, double fastest_mps,
                                bool on_wheels) {
  const double speed = d.between(0.2, fastest_mps);
  EgoPhase first{.at_s = 0, .speed_mps = speed};
  if (kind == Kind::stand || kind == Kind::spin) first.speed_mps = 0;
  if (kind == Kind::crawl) first.speed_mps = d.scaled(0.03, 0.15);
  if (kind == Kind::drive && d.chance(0.15)) first.direction_rad = std::numbers::pi;  // backwards
  if (kind == Kind::aside && !on_wheels) first.direction_rad = d.either(40, 140) * kDegree;
  if (kind == Kind::bend) first.yaw_rate_radps = d.either(3, 25) * kDegree;
  if (kind == Kind::spin) first.yaw_rate_radps = d.either(4, 30) * kDegree;
  if (kind == Kind::weave) first.yaw_rate_radps = d.either(3, 20) * kDegree;
  EgoPhase second = first;
  if (kind == Kind::brake) {
    second.at_s = duration_s * d.between(0.3, 0.6);
    first.acceleration_mps2 = d.chance(0.5) ? 0 : d.between(0, 0.4);
    second.speed_mps = first.speed_mps + first.acceleration_mps2 * second.at_s;
    second.acceleration_mps2 = -d.between(0.2, 1);
    return {first, second};
  }
  if (kind == Kind::weave) {
    second.at_s = duration_s * d.between(0.3, 0.5);
    second.yaw_rate_radps = -first.yaw_rate_radps * d.between(0.6, 1.3);
    return {first, second};
  }
  return {first};
}

bool stays_in(const std::vector<Stand>& frames, const Lane& lane) {
  return std::ranges::all_of(frames, [&](const Stand& stand) {
    const Vector2d in_lane = stand.at_m - lane.start_m;
    return in_lane.x() >= -0.05 && in_lane.x() <= lane.length_m &&
           std::abs(in_lane.y()) <= lane.half_width_m;
  });
}

}  // namespace

TurnedBox RoverPath::box_of(const scenario::Camera& camera, const Stand& stand) const {
  return {.centre_m = stand.at_m,
          .half_m = {0.27, 0.22},
          .heading_rad = stand.heading_rad,
          .foot_m = 0,
          .head_m = std::max(0.45, camera.mount_position_m.z() + 0.12)};
}

RoverPath way_of(const scenario::Scenario& s) {
  sim::SmoothCommand command(s.ego.phases);
  RoverPath way;
  Stand now{0, s.ego.start_m, s.ego.heading_rad};
  std::int64_t steps = 0;
  for (int k = 0; k <= s.frames; ++k) {
    const double until = k / s.camera.rate_hz;
    for (; kStep_s * static_cast<double>(steps) < until; ++steps) {
      const auto v = command.at(static_cast<std::int64_t>(1e9 * kStep_s) * steps);
      now.heading_rad += kStep_s * v.yaw_rate_radps;
      now.at_m += kStep_s * turned(v.linear_mps, now.heading_rad);
    }
    now.t_s = until;
    way.frames.push_back(now);
  }
  return way;
}

RoverPath draw_rover(Kit& kit, const Lane& lane) {
  Draw& d = kit.draw;
  scenario::Scenario& s = kit.world.scenario;
  draw_camera(kit, lane);
  draw_image(kit);
  draw_sensors(kit);
  s.ego.drive = lane.is_rough ? scenario::Drive::wheeled : scenario::Drive::holonomic;
  if (lane.is_rough) kit.tag("wheeled");
  const double duration_s = s.frames / s.camera.rate_hz;
  const Kind kind = d.pick({Kind::stand, Kind::stand, Kind::crawl, Kind::drive, Kind::drive,
                            Kind::drive, Kind::drive, Kind::bend, Kind::bend, Kind::spin,
                            Kind::aside, Kind::brake, Kind::weave});
  const double fastest = std::clamp(0.9 * lane.length_m / duration_s, 0.25, lane.fastest_mps);
  s.ego.phases = phases_of(d, kind, duration_s, fastest, lane.is_rough);
  // it needs free lane behind it if it drives backwards, and beside it if sideways
  const double direction = s.ego.phases.front().direction_rad;
  const bool backwards = std::abs(direction) > 100 * kDegree;
  s.ego.heading_rad = to(d.between(-8, 8), 0.1) * kDegree;
  const double along = backwards ? 0.5 * lane.length_m : 0;
  const double across = kind == Kind::aside ? -0.6 * lane.half_width_m * std::sin(direction)
                                            : lane.half_width_m * d.between(-0.4, 0.4);
  const Vector2d start = lane.start_m + Vector2d(along, across);
  s.ego.start_m = {to(start.x(), 0.01), to(start.y(), 0.01)};
  RoverPath way;
  for (;;) {  // reduces the speed until it stays in its lane
    for (EgoPhase& phase : s.ego.phases) {
      phase.at_s = to(phase.at_s, 0.01);
      phase.speed_mps = to(phase.speed_mps, 0.001);
      phase.acceleration_mps2 = to(phase.acceleration_mps2, 0.001);
      phase.direction_rad = to(phase.direction_rad / kDegree, 0.1) * kDegree;
      phase.yaw_rate_radps = to(phase.yaw_rate_radps / kDegree, 0.1) * kDegree;
    }
    way = way_of(s);
    if (stays_in(way.frames, lane)) return way;
    for (EgoPhase& phase : s.ego.phases) {
      phase.speed_mps *= 0.8;
      phase.acceleration_mps2 *= 0.8;
      phase.yaw_rate_radps *= 0.95;
    }
  }
}

Vector3d camera_at(const scenario::Camera& camera, const Stand& stand, double ground_m) {
  const Vector2d mount = camera.mount_position_m.head<2>();
  const Vector2d at = stand.at_m + turned(mount, stand.heading_rad);
  return {at.x(), at.y(), ground_m + camera.mount_position_m.z()};
}

Vector3d seen_at(const scenario::Camera& camera, const Stand& stand, double ground_m,
                 const Vector3d& point_m) {
  const auto pinhole = sim::Pinhole::from_fovy(camera.width_px, camera.height_px, camera.fovy_rad);
  const Vector3d from = point_m - camera_at(camera, stand, ground_m);
  const Vector2d flat = turned(from.head<2>(), -stand.heading_rad);
  const double down = camera.mount_rpy_rad.y();
  const double c = std::cos(down), s = std::sin(down);
  const double depth = c * flat.x() - s * from.z();
  const Vector3d in_camera(-flat.y(), -(s * flat.x() + c * from.z()), depth);
  const Vector2d px = pinhole.project(in_camera);
  return {px.x(), px.y(), depth};
}

}  // namespace lcs::worlds
