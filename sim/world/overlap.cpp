#include "sim/world/watch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/scene/silhouette.h"

namespace lcs::sim {
namespace {

struct Box {
  Pose T_WX;
  Vector3d half_m = Vector3d::Zero();
};

/// A box inside a geom; for a mesh, its bounding box.
Box box_in(const Model& model, int geom, const Eigen::Matrix3Xd& hull) {
  const double* s = model.m().geom_size + 3 * geom;
  Box box{model.geom_pose(geom), {s[0], s[1], s[2]}};
  const double square = std::numbers::sqrt2 / 2, cube = std::numbers::inv_sqrt3;
  const int type = model.m().geom_type[geom];
  if (type == mjGEOM_SPHERE) box.half_m.setConstant(cube * s[0]);
  if (type == mjGEOM_ELLIPSOID) box.half_m *= cube;
  if (type == mjGEOM_CAPSULE || type == mjGEOM_CYLINDER) {
    box.half_m = {square * s[0], square * s[0], s[1]};
  }
  if (type == mjGEOM_MESH) {
    const Vector3d low = hull.rowwise().minCoeff(), high = hull.rowwise().maxCoeff();
    box.T_WX.p = box.T_WX * Vector3d(0.5 * (low + high));
    box.half_m = 0.5 * (high - low);
  }
  return box;
}

using Triangle = std::array<Vector3d, 3>;

/// Overlap test of a triangle with a box around the origin, by separating axes.
bool meets(const Triangle& t, const Vector3d& half) {
  const auto apart_along = [&](const Vector3d& axis) {
    const double reach = half.dot(axis.cwiseAbs());
    const double a = t[0].dot(axis), b = t[1].dot(axis), c = t[2].dot(axis);
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  for (int i = 0; i < 3; ++i) {
    if (apart_along(Vector3d::Unit(i))) return false;
  }
  if (apart_along((t[1] - t[0]).cross(t[2] - t[0]))) return false;
  for (int edge = 0; edge < 3; ++edge) {
    for (int i = 0; i < 3; ++i) {
      if (apart_along((t[(edge + 1) % 3] - t[edge]).cross(Vector3d::Unit(i)))) return false;
    }
  }
  return true;
}

/// Signed solid angle of a triangle from the origin: positive if its front faces away.
double solid_angle(const Triangle& t) {
  const double a = t[0].norm(), b = t[1].norm(), c = t[2].norm();
  return 2 * std::atan2(t[0].dot(t[1].cross(t[2])),
                        a * b * c + t[0].dot(t[1]) * c + t[1].dot(t[2]) * a + t[2].dot(t[0]) * b);
}

/// Whether the surface of a mesh intersects a box, or encloses the box's centre.
bool solid_meets(const Model& model, int geom, const Box& box) {
  const mjModel& m = model.m();
  const int mesh = m.geom_dataid[geom];
  const Pose T_XG = box.T_WX.inverse() * model.geom_pose(geom);
  const float* vertices = m.mesh_vert + 3 * std::size_t(m.mesh_vertadr[mesh]);
  const int* face = m.mesh_face + 3 * std::size_t(m.mesh_faceadr[mesh]);
  double angle = 0;
  for (int i = 0; i < m.mesh_facenum[mesh]; ++i, face += 3) {
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      t[k] = T_XG *
             Eigen::Map<const Eigen::Vector3f>(vertices + 3 * std::size_t(face[k])).cast<double>();
    }
    if (meets(t, box.half_m)) return true;
    angle += solid_angle(t);
  }
  return angle > 2 * std::numbers::pi;  // 4 pi inside a closed surface, 0 outside
}

}  // namespace

const Eigen::Matrix3Xd& Overlap::hull(const Model& model, int geom) {
  const auto found = hulls_.find(geom);
  return found != hulls_.end() ? found->second
                               : hulls_.emplace(geom, geom_hull(model.m(), geom)).first->second;
}

/// Width of the overlap along a direction: an upper bound of the depth.
double Overlap::width_m(const Model& model, int geom_a, int geom_b, const Vector3d& direction_W) {
  const auto span = [&](int geom) {
    const Pose T_WG = model.geom_pose(geom);
    const Eigen::RowVectorXd along =
        (T_WG.R.transpose() * direction_W).transpose() * hull(model, geom);
    const double origin = T_WG.p.dot(direction_W);
    return std::pair(origin + along.minCoeff(), origin + along.maxCoeff());
  };
  const auto [low_a, high_a] = span(geom_a);
  const auto [low_b, high_b] = span(geom_b);
  return std::min(high_a - low_b, high_b - low_a);
}

Overlap::Place Overlap::of(const Model& model, int geom_a, int geom_b, double least_depth_m) {
  const mjModel& m = model.m();
  if (m.geom_type[geom_a] > m.geom_type[geom_b]) std::swap(geom_a, geom_b);
  Place place;
  Vector3d normal = Vector3d::Zero();
  mj::collide(mjCOLLISIONFUNC[m.geom_type[geom_a]][m.geom_type[geom_b]], m, model.d(), geom_a,
              geom_b, [&](double distance, const double* at, const double* along) {
                if (-distance <= place.depth_m) return;
                place = {-distance, Eigen::Map<const Vector3d>(at)};
                normal = Eigen::Map<const Vector3d>(along);
              });
  if (place.depth_m <= least_depth_m) return {};
  // For round geoms and hulls this normal is not always the direction of the least depth.
  place.depth_m = width_m(model, geom_a, geom_b, normal);
  for (const int geom : {geom_a, geom_b}) {
    const Eigen::Matrix3d R_WG = model.geom_pose(geom).R;
    for (int i = 0; i < 3; ++i) {
      place.depth_m = std::min(place.depth_m, width_m(model, geom_a, geom_b, R_WG.col(i)));
    }
  }
  if (place.depth_m <= least_depth_m) return {};
  for (const auto& [mesh, other] : {std::pair(geom_a, geom_b), std::pair(geom_b, geom_a)}) {
    if (m.geom_type[mesh] != mjGEOM_MESH) continue;
    Box box = box_in(model, other, hull(model, other));
    box.half_m = (box.half_m.array() - least_depth_m).max(0);
    if (!solid_meets(model, mesh, box)) return {};
  }
  return place;
}

Overlap::Place Overlap::across(const Model& model, int plane, int geom, double least_depth_m) {
  const Pose T_PG = model.geom_pose(plane).inverse() * model.geom_pose(geom);
  const Eigen::Matrix3Xd points_P = (T_PG.R * hull(model, geom)).colwise() + T_PG.p;
  const Vector3d low = points_P.rowwise().minCoeff(), high = points_P.rowwise().maxCoeff();
  for (int i = 0; i < 2; ++i) {
    const double half_m = model.m().geom_size[3 * plane + i];
    if (half_m > 0 && std::min(high[i] + half_m, half_m - low[i]) < least_depth_m) return {};
  }
  const double depth_m = std::min(high.z(), -low.z());
  if (depth_m <= least_depth_m) return {};
  return {depth_m, model.geom_pose(geom).p};
}

}  // namespace lcs::sim
