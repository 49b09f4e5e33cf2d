#include "sim/survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

#include "sim/observer.h"
#include "sim/scene/silhouette.h"
#include "sim/world/watch.h"

namespace lcs::sim {
namespace {

std::vector<Footprint> footprints(const World& world) {
  std::vector<Footprint> all;
  const Model& model = world.model();
  const mjModel& m = model.m();
  for (int geom = 0; geom < m.ngeom; ++geom) {
    if (!world.is_drawn(geom) || is_floor(model, geom) || m.geom_type[geom] == mjGEOM_PLANE)
      continue;
    const Pose T_WG = model.geom_pose(geom);
    const Eigen::Matrix3Xd points = (T_WG.R * geom_hull(m, geom)).colwise() + T_WG.p;
    std::vector<cv::Point2f> seen, hull;
    for (const auto& p : points.colwise()) {
      seen.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    }
    cv::convexHull(seen, hull);
    Footprint& print = all.emplace_back();
    for (const cv::Point2f& p : hull) print.outline_m.emplace_back(p.x, p.y);
    print.object = world.object_of_geom(geom);
    print.low_m = points.row(2).minCoeff();
    print.high_m = points.row(2).maxCoeff();
  }
  return all;
}

/// Whether a point is inside a geom. Always false for meshes, which may be rooms.
bool is_in(const Model& model, int geom, const Eigen::Vector3d& point_W) {
  const int type = model.m().geom_type[geom];
  if (type == mjGEOM_PLANE || type == mjGEOM_HFIELD || type == mjGEOM_MESH) return false;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d normal = up;
  const double way_m =
      mj::ray_geom(model.m(), model.d(), geom, point_W.data(), up.data(), normal.data());
  return way_m >= 0 && normal.z() > 0;  // it goes out, and did not come in
}

/// Appends a line for each geom or object that the camera newly entered.
void note_inside(const World& world, double t_s, std::set<std::string>& known,
                 std::vector<std::string>& lines) {
  const Model& model = world.model();
  const Eigen::Vector3d eye = model.camera_pose(world.camera_id()).p;
  for (int geom = 0; geom < model.m().ngeom; ++geom) {
    const int object = world.object_of_geom(geom);
    if (object < 0 || !world.is_drawn(geom) || !is_in(model, geom, eye)) continue;
    const std::string what =
        object > 0 ? fmt::format("'{}'", world.objects()[static_cast<std::size_t>(object - 1)].name)
                   : fmt::format("the setting's geom '{}'", model.name(mjOBJ_GEOM, geom));
    if (!known.insert(what).second) continue;
    lines.push_back(
        fmt::format("the camera is inside {} at {:.2f} s, at ({:.2f}, {:.2f}, {:.2f}) m: move its "
                    "mount or the rover's way",
                    what, t_s, eye.x(), eye.y(), eye.z()));
  }
}

}  // namespace

Survey survey(const scenario::Scenario& scenario, int looks,
              const std::function<void(const Observation&)>& on_look,
              const std::function<void(int)>& on_frame) {
  scenario::Scenario without_events = require_scene(scenario);  // a preview shows none
  without_events.events.reset();
  Observer observer(without_events, WrongStart::told);
  const World& world = observer.world();
  Survey s;
  s.footprints = footprints(world);
  s.objects = world.objects();
  s.wrong_at_start = world.wrong_at_start();
  for (const scenario::Actor& actor : scenario.actors) {
    const std::string name = actor.body.value_or(actor.name);
    const int id = std::ranges::find(s.objects, name, &Object::name)->id;
    std::vector<std::size_t>& parts = s.actors.emplace_back(1, id);
    for (std::size_t i = 0; i < world.limb_objects().size(); ++i) {
      if (world.limb_objects()[i] == id) parts.push_back(s.objects.size() + 1 + i);
    }
  }
  std::set<int> looked_at;
  for (int i = 0; i < looks; ++i) {
    looked_at.insert(static_cast<int>(
        std::lround(i * static_cast<double>(scenario.frames - 1) / std::max(looks - 1, 1))));
  }
  std::set<std::string> known;
  for (int k = 0; k < scenario.frames; ++k) {
    s.snapshots.push_back(observer.frame().now);
    s.rover_m.emplace_back(observer.frame().T_WB.p.head<2>());
    note_inside(world, 1e-9 * static_cast<double>(event_time_ns(k, scenario.camera.rate_hz)), known,
                s.inside);
    if (looked_at.contains(k)) {
      on_look(observer.observe());
    } else {
      observer.advance();
    }
    if (on_frame) on_frame(k + 1);
  }
  s.warnings = world.warnings();
  return s;
}

std::string world_file(const scenario::Scenario& scenario, WorldFormat format) {
  World world(require_scene(scenario), WrongStart::told);
  return world.saved(format == WorldFormat::mjcf);
}

}  // namespace lcs::sim
