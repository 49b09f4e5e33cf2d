#include "sim/observer.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "sim/drive.h"
#include "sim/random.h"

namespace lcs::sim {
namespace {

/// Convex parts of each object; index 0, the world, has none.
std::vector<ConvexParts> outlines(const World& world) {
  std::vector<ConvexParts> parts(world.objects().size() + 1);
  const mjModel& m = world.model().m();
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const int object = world.object_of_geom(geom);
    if (object <= 0 || !world.is_drawn(geom)) continue;
    // at t = 0; the parts are constant, as bodies are rigid
    const Pose T_OW = world.model().body_pose(world.body_of(object)).inverse();
    const Pose T_OG = T_OW * world.model().geom_pose(geom);
    parts[static_cast<std::size_t>(object)].push_back((T_OG.R * geom_hull(m, geom)).colwise() +
                                                      T_OG.p);
  }
  return parts;
}

Photographer photographer_of(const scenario::Scenario& s, const Optics& camera) {
  try {
    // Each camera of a rig has its own noise; that of the first is as of a single camera.
    const std::uint64_t seed =
        s.rig_place == 0 ? s.seed
                         : RandomStream(s.seed, fmt::format("camera.{}", s.rig_place)).bits();
    return {s.image, camera, s.camera.rate_hz, seed};
  } catch (const std::invalid_argument& error) {
    throw input::Error({s.file.string(), 0}, error.what());
  }
}

}  // namespace

Observer::Observer(const scenario::Scenario& scenario, WrongStart wrong_start)
    : scenario_(scenario),
      world_(scenario, wrong_start),
      calibration_(calibrate(world_, scenario.camera)),
      renderer_(world_.model(), world_.camera_id(), calibration_.optics, world_.groups()),
      parts_(outlines(world_)),
      photographer_(photographer_of(scenario, calibration_.optics)),
      snapshot_(world_.snapshot()) {
  world_.advance_to(0, imu_, odometry_, &imu_truth_);
}

Observation Observer::observe() {
  Observation o;
  o.index = next_index_;
  o.t_ns = event_time_ns(next_index_, scenario_.camera.rate_hz);
  o.imu = std::move(imu_);
  o.odometry = std::move(odometry_);
  o.imu_truth = std::move(imu_truth_);
  render(o);
  o.truth.now = std::move(snapshot_);
  o.truth.v_WC_mps = world_.v_WC_mps();
  o.truth.w_C_radps = world_.w_C_radps();

  advance();
  o.truth.next = snapshot_;
  o.objects = visible_objects(o.truth);
  for (const ObjectTruth& object : o.objects) seen_.insert(object.object);
  if (++observed_ == scenario_.frames) note_unseen();
  return o;
}

/// Warns of actors that no frame of the whole scenario shows.
void Observer::note_unseen() {
  for (const scenario::Actor& actor : scenario_.actors) {
    const Object& object =
        *std::ranges::find(world_.objects(), actor.body.value_or(actor.name), &Object::name);
    if (seen_.contains(object.id)) continue;
    const bool is_drawn = !parts_[static_cast<std::size_t>(object.id)].empty();
    world_.warnings().add(
        Warning::actors_never_seen,
        fmt::format("actor '{}' is in none of the {} pictures{}", actor.name, scenario_.frames,
                    is_drawn ? "" : " (none of its geoms is in camera.groups and has an alpha)"));
  }
}

void Observer::advance() {
  imu_.clear();
  odometry_.clear();
  imu_truth_.clear();
  ++next_index_;
  world_.advance_to(event_time_ns(next_index_, scenario_.camera.rate_hz), imu_, odometry_,
                    &imu_truth_);
  snapshot_ = world_.snapshot();
}

void Observer::render(Observation& o) {
  renderer_.update();
  renderer_.render_colour(o.rendered);
  CameraRenderer::blur(o.rendered, o.image);
  renderer_.render_depth_and_geoms(o.truth.depth_m, o.geom);
  photographer_.develop(o.image, o.truth.depth_m, o.index);
  o.truth.object.create(o.geom.size());
  std::transform(o.geom.begin(), o.geom.end(), o.truth.object.begin(),
                 [&](int geom) { return geom < 0 ? -1 : world_.object_of_geom(geom); });
}

/// Area of each object's pixels in the picture of the pinhole, by id.
std::vector<double> Observer::areas_px(const cv::Mat1i& object) const {
  const Optics& optics = calibration_.optics;
  const double focal_px = calibration_.camera.focal_px;
  std::vector<double> areas_px(parts_.size(), 0);
  for (int y = 0; y < object.rows; ++y) {
    for (int x = 0; x < object.cols; ++x) {
      if (object(y, x) <= 0) continue;
      areas_px[static_cast<std::size_t>(object(y, x))] +=
          optics.is_pinhole()
              ? 1
              : focal_px * focal_px / optics.jacobian_px(optics.ray(x, y)).determinant();
    }
  }
  return areas_px;
}

std::vector<ObjectTruth> Observer::visible_objects(const FrameTruth& truth) const {
  std::vector<ObjectTruth> all = modal_boxes(truth.object, static_cast<int>(parts_.size()) - 1);
  std::erase_if(all, [](const ObjectTruth& o) { return o.visible_px == 0; });
  const Pose T_CW = truth.now.T_WC.inverse();
  const std::vector<double> seen_px = areas_px(truth.object);
  for (ObjectTruth& o : all) {
    const auto id = static_cast<std::size_t>(o.object);
    const double full = silhouette_px(calibration_.camera, T_CW * truth.now.T_WO[id], parts_[id],
                                      renderer_.near_m());
    o.visible_fraction = full > 0 ? std::min(1.0, seen_px[id] / full) : 0;
    o.moving = moved(truth.now.T_WO[id], truth.next.T_WO[id]);
  }
  return all;
}

}  // namespace lcs::sim
