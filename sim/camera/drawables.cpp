#include "sim/camera/drawables.h"

#include <algorithm>

#include "sim/scene/refusal.h"

namespace lcs::sim {

Drawables::Drawables(const Model& model, const GeomGroups& groups, int camera) {
  mjv_defaultScene(&scene_);
  mjv_defaultOption(&option_);
  mjv_defaultPerturb(&perturb_);
  mjv_defaultCamera(&camera_);
  std::fill(std::begin(option_.flags), std::end(option_.flags), mjtByte{0});
  option_.flags[mjVIS_TEXTURE] = option_.flags[mjVIS_STATIC] = 1;
  for (std::size_t i = 0; i < groups.size(); ++i) option_.geomgroup[i] = groups[i];
  std::fill(std::begin(option_.sitegroup), std::end(option_.sitegroup), mjtByte{0});
  camera_.type = mjCAMERA_FIXED;
  camera_.fixedcamid = camera;
  mjv_makeScene(&model.m(), &scene_, static_cast<int>(model.m().ngeom) + 1);
  scene_.flags[mjRND_SHADOW] = 0;
  scene_.flags[mjRND_REFLECTION] = 0;
  scene_.flags[mjRND_FOG] = 0;
  scene_.flags[mjRND_HAZE] = 0;
}

Drawables::~Drawables() {
  mjv_freeScene(&scene_);
}

void Drawables::collect(Model& model) {
  mjv_updateScene(&model.m(), &model.d(), &option_, &perturb_, &camera_,
                  mjCAT_STATIC | mjCAT_DYNAMIC, &scene_);
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
    geom.rgba[3] = 1;
    geom.specular = 0;
    geom.segid = count;
    if (count != i) scene_.geoms[count] = geom;
    ++count;
  }
  scene_.ngeom = count;
}

std::vector<float> Drawables::alpha(Model& model, const GeomGroups& groups, int camera) {
  Drawables drawables(model, groups, camera);
  drawables.collect(model);
  std::vector<float> alpha(static_cast<std::size_t>(model.m().ngeom));
  for (int i = 0; i < drawables.scene_.ngeom; ++i) {
    const mjvGeom& geom = drawables.scene_.geoms[i];
    if (geom.objtype == mjOBJ_GEOM) alpha[static_cast<std::size_t>(geom.objid)] = geom.rgba[3];
  }
  return alpha;
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
#if mjVERSION_HEADER >= 300
  for (int flex = 0; flex < m.nflex; ++flex) parts.emplace_back(mjOBJ_FLEX, flex);
#endif
  return parts;
}

}  // namespace lcs::sim
