#include "sim/scene/drawables.h"

#include <algorithm>

#include "sim/scene/silhouette.h"

namespace lcs::sim {
namespace {

constexpr double kStain_m = 0.01;    // most distance of a stain from the surface behind it
constexpr double kMarker_m = 0.006;  // most size of a site that marks a place; MuJoCo's is 0.005

bool is_fixed(const mjModel& m, int geom) {
  return m.body_weldid[m.geom_bodyid[geom]] == 0;
}

/// Whether a translucent geom lies on a surface: both are fixed in the world, and most points of
/// its back are at most `kStain_m` from that surface, so that they have the same motion. (A shadow
/// that is painted on a road may reach into a kerb.)
bool lies_on_surface(const Model& model, int geom) {
  const mjModel& m = model.m();
  if (!is_fixed(m, geom) || m.geom_type[geom] == mjGEOM_PLANE ||
      m.geom_type[geom] == mjGEOM_HFIELD) {
    return false;
  }
  const Eigen::Matrix3Xd points = geom_hull(m, geom);
  Eigen::Index thin = 0;
  const Eigen::Vector3d low = points.rowwise().minCoeff(), high = points.rowwise().maxCoeff();
  if ((high - low).minCoeff(&thin) > kStain_m) return false;
  const Pose T_WG = model.geom_pose(geom);
  const auto lies_behind = [&](double back, double side) {
    constexpr double kBeyond_m = 1e-4;  // from a geom that a ray has hit, or starts from
    const Eigen::Vector3d direction = side * T_WG.R.col(thin);
    const auto near = std::ranges::count_if(points.colwise(), [&](Eigen::Vector3d p) {
      p[thin] = back;
      const Eigen::Vector3d start = T_WG * p;
      for (double way_m = kBeyond_m; way_m < kStain_m; way_m += kBeyond_m) {
        const Eigen::Vector3d from = start + way_m * direction;
        int hit = -1;
        way_m += mj::ray(m, model.d(), from.data(), direction.data(), -1, hit);
        if (hit < 0 || is_fixed(m, hit)) return hit >= 0 && way_m < kStain_m;
      }
      return false;
    });
    return 2 * near > points.cols();
  };
  return lies_behind(low[thin], -1) || lies_behind(high[thin], 1);
}

}  // namespace

Drawables::Drawables(Model& model, const GeomGroups& groups, int camera)
    : alpha_(static_cast<std::size_t>(model.m().ngeom)) {
  mjv_defaultScene(&scene_);
  mjv_defaultOption(&option_);
  mjv_defaultPerturb(&perturb_);
  mjv_defaultCamera(&camera_);
  std::ranges::fill(option_.flags, mjtByte{0});
  option_.flags[mjVIS_TEXTURE] = option_.flags[mjVIS_STATIC] = 1;
  for (std::size_t i = 0; i < groups.size(); ++i) option_.geomgroup[i] = groups[i];
  std::ranges::fill(option_.sitegroup, mjtByte{0});
  camera_.type = mjCAMERA_FIXED;
  camera_.fixedcamid = camera;
  const int geoms = static_cast<int>(model.m().ngeom) + 1;
  call_mujoco([&] { mjv_makeScene(&model.m(), &scene_, geoms); });
  scene_.flags[mjRND_SHADOW] = 0;
  scene_.flags[mjRND_REFLECTION] = 0;
  scene_.flags[mjRND_FOG] = 0;
  scene_.flags[mjRND_HAZE] = 0;

  collect(model);
  for (int i = 0; i < scene_.ngeom; ++i) {
    const mjvGeom& geom = scene_.geoms[i];
    if (geom.objtype == mjOBJ_GEOM) alpha_[static_cast<std::size_t>(geom.objid)] = geom.rgba[3];
  }
  for (int geom = 0; geom < model.m().ngeom; ++geom) {
    const bool is_translucent = alpha(geom) > 0 && alpha(geom) < 1;
    if (is_translucent && lies_on_surface(model, geom)) stains_.insert(geom);
  }
}

Drawables::~Drawables() {
  mjv_freeScene(&scene_);
}

void Drawables::collect(Model& model) {
  call_mujoco([&] {
    mjv_updateScene(&model.m(), &model.d(), &option_, &perturb_, &camera_,
                    mjCAT_STATIC | mjCAT_DYNAMIC, &scene_);
  });
  // with a full buffer MuJoCo only warns, and then draws a part of the scene
  if (const std::string warning = take_warning(); !warning.empty()) {
    throw MujocoError(in_one_line(warning));
  }
}

void Drawables::update(Model& model) {
  collect(model);
  int count = 0;
  for (int i = 0; i < scene_.ngeom; ++i) {
    mjvGeom& geom = scene_.geoms[i];
    if (geom.objtype != mjOBJ_GEOM || geom.rgba[3] <= 0) continue;
    if (geom.rgba[3] < 1 && !is_stain(geom.objid)) geom.rgba[3] = 1;
    geom.specular = 0;
    geom.segid = count;
    if (count != i) scene_.geoms[count] = geom;
    ++count;
  }
  scene_.ngeom = count;
  // A shadow map begins at the light's place, and spans the extent on each side of it.
  const mjStatistic& whole = model.m().stat;
  for (int i = 0; i < scene_.nlight; ++i) {
    mjvLight& light = scene_.lights[i];
    if (!light.castshadow || light.type != mjLIGHT_DIRECTIONAL) continue;
    for (int c = 0; c < 3; ++c) {
      light.pos[c] = static_cast<float>(whole.center[c] - 2 * whole.extent * light.dir[c]);
    }
  }
}

std::vector<std::pair<mjtObj, int>> undrawn_parts(const Model& model) {
  const mjModel& m = model.m();
  std::vector<std::pair<mjtObj, int>> parts;
  for (int skin = 0; skin < m.nskin; ++skin) parts.emplace_back(mjOBJ_SKIN, skin);
  for (int tendon = 0; tendon < m.ntendon; ++tendon) {
    const bool is_visible = m.tendon_rgba[4 * tendon + 3] > 0 && m.tendon_width[tendon] > 0 &&
                            kUsualGroups[static_cast<std::size_t>(m.tendon_group[tendon])];
    if (is_visible) parts.emplace_back(mjOBJ_TENDON, tendon);
  }
  for (int flex = 0; flex < m.nflex; ++flex) parts.emplace_back(mjOBJ_FLEX, flex);
  for (int site = 0; site < m.nsite; ++site) {
    const bool is_visible = m.site_rgba[4 * site + 3] > 0 && m.site_size[3 * site] > kMarker_m &&
                            kUsualGroups[static_cast<std::size_t>(m.site_group[site])];
    if (is_visible) parts.emplace_back(mjOBJ_SITE, site);
  }
  return parts;
}

}  // namespace lcs::sim
