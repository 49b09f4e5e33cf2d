/// \file
/// MuJoCo 3.17 to 4.x: the only file that includes it and handles differences between its versions.
/// Product code outside `sim/` must not include it.
#pragma once

#include <mujoco/mujoco.h>

#if mjVERSION_HEADER < 3017000
#error "MuJoCo 3.17 or later is needed; tools/run downloads it"
#endif

#include <array>

namespace lcs::sim::mj {

/// Distance along `direction`, in units of its length, to the nearest visible geom, and that geom;
/// -1 without a hit.
inline double ray(const mjModel& m, const mjData& d, const double from[3],
                  const double direction[3], int exclude_body, int& geom) {
  int hit[1] = {-1};
  const double distance = mj_ray(&m, &d, from, direction, nullptr, 1, exclude_body, hit, nullptr);
  geom = hit[0];
  return distance;
}

/// The same to one geom of any type. \param normal of its surface there; may be null.
inline double ray_geom(const mjModel& m, const mjData& d, int geom, const double from[3],
                       const double direction[3], double* normal = nullptr) {
  const int type = m.geom_type[geom];
  if (type == mjGEOM_MESH) return mj_rayMesh(&m, &d, geom, from, direction, normal);
  if (type == mjGEOM_HFIELD) return mj_rayHfield(&m, &d, geom, from, direction, normal);
  return mju_rayGeom(d.geom_xpos + 3 * geom, d.geom_xmat + 9 * geom, m.geom_size + 3 * geom, from,
                     direction, type, normal);
}

/// Calls `found(distance, point, normal)` for each contact that MuJoCo's collision function finds
/// between two geoms. The type of `function` determines its output type (mjContact, later
/// mjPreContact) and whether the data is const.
template <typename Data, typename Contact, typename Found>
void collide(int (*function)(const mjModel*, Data*, Contact*, int, int, mjtNum), const mjModel& m,
             const mjData& d, int geom_a, int geom_b, const Found& found) {
  if (!function) return;
  std::array<Contact, mjMAXCONPAIR> contacts;
  const int count = function(&m, const_cast<mjData*>(&d), contacts.data(), geom_a, geom_b, 0);
  for (const Contact* c = contacts.data(); c != contacts.data() + count; ++c) {
    if constexpr (requires { c->normal; }) {
      found(c->dist, c->pos, c->normal);
    } else {
      found(c->dist, c->pos, c->frame);
    }
  }
}

}  // namespace lcs::sim::mj
