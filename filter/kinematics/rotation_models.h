/// \file
/// First-order displacement of an image point by a small rotation of the camera.
#pragma once

#include <Eigen/Core>

#include "filter/kinematics/camera.h"

namespace lcs {

/// The motion field of a rotation, integrated once; px.
/// \param x px, from the principal point. \param w rad, about the camera's axes.
/// \param f focal length, px.
inline Vec2 first_order_rotation(const Vec2& x, const Eigen::Vector3d& w, double f) {
  return {x.x() * x.y() / f * w.x() - (f + x.x() * x.x() / f) * w.y() + x.y() * w.z(),
          (f + x.y() * x.y() / f) * w.x() - x.x() * x.y() / f * w.y() - x.x() * w.z()};
}

/// The same by the paper's first equation as printed, with its errors.
inline Vec2 printed_rotation(const Vec2& x, const Eigen::Vector3d& w, double f) {
  return {f * w.y() + x.y() * w.z() + (x.x() * x.y() * w.x() - x.x() * x.x() * w.y()) / f,
          f * w.x() + x.x() * w.z() + (x.x() * x.y() * w.y() - x.y() * x.y() * w.y()) / f};
}

}  // namespace lcs
