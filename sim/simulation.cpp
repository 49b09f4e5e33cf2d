#include "sim/simulation.h"

#include <algorithm>
#include <limits>

#include "sim/camera_renderer.h"
#include "sim/drive.h"
#include "sim/gl_context.h"
#include "sim/photograph.h"
#include "sim/silhouette.h"
#include "sim/world.h"

namespace lcs::sim {
namespace {

/// Outlines of each object; index 0, the world, has none.
std::vector<ConvexParts> outlines(const World& world) {
  std::vector<ConvexParts> parts(world.objects().size() + 1);
  const mjModel& m = world.model().m();
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const int object = world.object_of_geom(geom);
    if (object <= 0) continue;
    // as things stand before the first step; a body is rigid
    const Pose T_OW = world.model().body_pose(world.body_of(object)).inverse();
    const Pose T_OG = T_OW * world.model().geom_pose(geom);
    parts[static_cast<std::size_t>(object)].push_back((T_OG.R * geom_hull(m, geom)).colwise() +
                                                      T_OG.p);
  }
  return parts;
}

Photographer photographer_of(const scenario::Scenario& s, const Pinhole& camera) {
  try {
    return {s.image, camera, s.camera.rate_hz, s.seed};
  } catch (const std::invalid_argument& error) {
    throw scenario::Error({s.file.string(), 0}, error.what());
  }
}

}  // namespace

const scenario::Scenario& require_scene(const scenario::Scenario& scenario) {
  if (!scenario.recording) return scenario;
  throw scenario::Error(scenario.recording->source,
                        "these are recorded frames, and there is no world to simulate; give a "
                        "scenario with a scene");
}

struct Simulation::Impl {
  scenario::Scenario scenario;
  World world;
  CameraRenderer renderer;
  std::vector<ConvexParts> parts;
  Calibration calibration;
  Photographer photographer;
  Snapshot snapshot;           ///< at the frame that comes next
  std::vector<ImuSample> imu;  ///< since the last frame
  std::vector<OdometrySample> odometry;
  std::vector<ImuTruth> imu_truth;
  int next_index = 0;
  cv::Mat1i geoms;

  explicit Impl(const scenario::Scenario& s)
      : scenario(s),
        world(s),
        renderer(world.model(), world.camera_id(), s.camera.width_px, s.camera.height_px),
        parts(outlines(world)),
        calibration(calibrate(world, s.camera)),
        photographer(photographer_of(s, calibration.camera)),
        snapshot(world.snapshot()) {
    world.advance_to(0, imu, odometry, &imu_truth);
  }

  std::int64_t frame_time_ns(int k) const { return event_time_ns(k, scenario.camera.rate_hz); }

  Observation observe() {
    Observation o;
    o.index = next_index;
    o.t_ns = frame_time_ns(next_index);
    o.imu = std::move(imu);
    o.odometry = std::move(odometry);
    o.imu_truth = std::move(imu_truth);
    render(o);
    o.truth.now = std::move(snapshot);
    o.truth.v_WC_mps = world.v_WC_mps();
    o.truth.w_C_radps = world.w_C_radps();

    advance();
    o.truth.next = snapshot;
    o.objects = visible_objects(o.truth);
    return o;
  }

  /// On to the next frame's time, with the readings until then.
  void advance() {
    imu.clear();
    odometry.clear();
    imu_truth.clear();
    ++next_index;
    world.advance_to(frame_time_ns(next_index), imu, odometry, &imu_truth);
    snapshot = world.snapshot();
  }

  void render(Observation& o) {
    renderer.update();
    renderer.render_colour(o.image);
    renderer.render_depth_and_geoms(o.truth.depth_m, geoms);
    photographer.develop(o.image, o.truth.depth_m, o.index);
    o.truth.object.create(geoms.size());
    std::transform(geoms.begin(), geoms.end(), o.truth.object.begin(),
                   [&](int geom) { return geom < 0 ? -1 : world.object_of_geom(geom); });
  }

  std::vector<ObjectTruth> visible_objects(const FrameTruth& truth) const {
    std::vector<ObjectTruth> all = modal_boxes(truth.object, static_cast<int>(parts.size()) - 1);
    std::erase_if(all, [](const ObjectTruth& o) { return o.visible_px == 0; });
    const Pose T_CW = truth.now.T_WC.inverse();
    for (ObjectTruth& o : all) {
      const auto id = static_cast<std::size_t>(o.object);
      const double full = silhouette_px(calibration.camera, T_CW * truth.now.T_WO[id], parts[id],
                                        renderer.near_m());
      o.visible_fraction = full > 0 ? std::min(1.0, o.visible_px / full) : 0;
      o.moving = moved(truth.now.T_WO[id], truth.next.T_WO[id]);
    }
    return all;
  }
};

Simulation::Simulation(const scenario::Scenario& scenario)
    : impl_(std::make_unique<Impl>(require_scene(scenario))) {}
Simulation::~Simulation() = default;

const Calibration& Simulation::calibration() const {
  return impl_->calibration;
}
const std::vector<Object>& Simulation::objects() const {
  return impl_->world.objects();
}

const Warnings& Simulation::warnings() const {
  return impl_->world.warnings();
}

std::optional<Observation> Simulation::next() {
  if (impl_->next_index >= impl_->scenario.frames) return std::nullopt;
  return impl_->observe();
}

void Simulation::skip() {
  if (impl_->next_index < impl_->scenario.frames) impl_->advance();
}

Versions versions() {
  return {mj_versionString(), GlContext().renderer()};
}

}  // namespace lcs::sim
