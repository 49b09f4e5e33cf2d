#include "sim/world/watch.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "sim/scene/mujoco.h"

namespace lcs::sim {
namespace {

constexpr double kFlush_m = 1e-4;   // two surfaces that near have one depth in a picture
constexpr double kBefore_m = 0.02;  // from there on the eye has to see
constexpr int kGrid = 8;            // rays along each side of a geom's box
constexpr int kLeastRays = 16;      // that meet two surfaces at once, of 64 onto a side

/// Distance to the outside of a geom; -1 for none, and for its inside.
double ray(const Model& model, int geom, const Vector3d& from, const Vector3d& along) {
  Vector3d normal = Vector3d::Zero();
  const double way_m =
      mj::ray_geom(model.m(), model.d(), geom, from.data(), along.data(), normal.data());
  return normal.dot(along) < 0 ? way_m : -1;
}

}  // namespace

std::vector<std::pair<int, int>> coplanar_geoms(const Model& model,
                                                const std::vector<char>& is_drawn,
                                                const Vector3d& eye) {
  const mjModel& m = model.m();
  const auto is_plane = [&](int geom) { return m.geom_type[geom] == mjGEOM_PLANE; };
  std::vector<int> drawn;
  for (int geom = 0; geom < m.ngeom; ++geom) {
    if (is_drawn[static_cast<std::size_t>(geom)]) drawn.push_back(geom);
  }
  const auto is_hidden = [&](const Vector3d& place) {
    return std::ranges::any_of(drawn, [&](int geom) {
      const double share = ray(model, geom, eye, place - eye);
      return share >= 0 && share < 1;
    });
  };
  std::map<std::pair<int, int>, int> rays;
  std::vector<int> near;
  const auto cast = [&](int a, const Vector3d& from, const Vector3d& along) {
    const double way_m = ray(model, a, from, along);
    if (way_m < 0) return;
    const Vector3d at = from + way_m * along;
    for (const int b : near) {
      if (std::abs(ray(model, b, from, along) - way_m) > kFlush_m) continue;
      if (!is_hidden(at - kBefore_m * along)) ++rays[std::minmax(a, b)];
    }
  };
  for (const int geom : drawn) {
    const Pose T_WG = model.geom_pose(geom);
    near.clear();
    std::ranges::copy_if(drawn, std::back_inserter(near), [&](int b) {
      const double reach_m = m.geom_rbound[geom] + m.geom_rbound[b] + kBefore_m;
      return b != geom &&
             (is_plane(geom) || is_plane(b) || (model.geom_pose(b).p - T_WG.p).norm() < reach_m);
    });
    const Eigen::Map<const Vector3d> middle(m.geom_aabb + 6 * geom),
        half(m.geom_aabb + 6 * geom + 3);
    const Eigen::Map<const Vector3d> size(m.geom_size + 3 * geom);
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2, x = (axis + 1) % 3, y = (axis + 2) % 3;
      const double side = face % 2 == 0 ? 1 : -1;
      if (is_plane(geom) && (axis != 2 || side < 0)) continue;
      const auto reach_m = [&](int i) {
        return !is_plane(geom) ? half[i] : size[i] > 0 ? size[i] : m.stat.extent;
      };
      for (int i = 0; i < kGrid * kGrid; ++i) {
        Vector3d from = is_plane(geom) ? Vector3d::Zero() : Vector3d(middle);
        from[axis] += side * ((is_plane(geom) ? 0 : half[axis]) + kBefore_m);
        from[x] += reach_m(x) * ((2 * (i % kGrid) + 1.0) / kGrid - 1);
        from[y] += reach_m(y) * ((2 * (i / kGrid) + 1.0) / kGrid - 1);
        cast(geom, T_WG * from, -side * T_WG.R.col(axis));
      }
    }
  }
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [pair, count] : rays) {
    if (count >= kLeastRays) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace lcs::sim
