/// \file
/// Compatibility layer for MuJoCo 2.2.2 (Debian) to 4.x: the only file that includes MuJoCo and
/// handles differences between its versions. Product code outside `sim/` must not include it.
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>

namespace lcs::sim::mj {

/// Adds a file to MuJoCo's virtual file system.
inline void add_to_vfs(mjVFS& vfs, const char* name, const std::string& content) {
#if mjVERSION_HEADER >= 313
  const int failed = mj_addBufferVFS(&vfs, name, content.data(), static_cast<int>(content.size()));
#else
  const int failed = mj_makeEmptyFileVFS(&vfs, name, static_cast<int>(content.size()));
  if (!failed) {
    std::memcpy(vfs.filedata[mj_findFileVFS(&vfs, name)], content.data(), content.size());
  }
#endif
  if (failed) throw std::runtime_error("MuJoCo's virtual file system is full");
}

/// Bytes of one texture: `texture_channels(m, id)` per pixel, top row first.
inline mjtByte* texture_bytes(mjModel& m, int texture) {
#if mjVERSION_HEADER >= 321
  return m.tex_data + m.tex_adr[texture];
#else
  return m.tex_rgb + m.tex_adr[texture];
#endif
}

inline int texture_channels([[maybe_unused]] const mjModel& m, [[maybe_unused]] int texture) {
#if mjVERSION_HEADER >= 321
  return m.tex_nchannel[texture];
#else
  return 3;
#endif
}

/// Distance along `direction`, in units of its length, to the nearest visible geom, and that geom;
/// -1 without a hit.
inline double ray(const mjModel& m, const mjData& d, const double from[3],
                  const double direction[3], int exclude_body, int& geom) {
  int hit[1] = {-1};
#if mjVERSION_HEADER >= 3005000
  const double distance = mj_ray(&m, &d, from, direction, nullptr, 1, exclude_body, hit, nullptr);
#else
  const double distance = mj_ray(&m, &d, from, direction, nullptr, 1, exclude_body, hit);
#endif
  geom = hit[0];
  return distance;
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
