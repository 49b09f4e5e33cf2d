/// \file
/// Trusted edges and circles, moved by the field `ahead`.
#pragma once

#include "filter/kinematics/geometry.h"
#include "filter/types/layers.h"
#include "tests/filter/world.h"

namespace lcs::testing {

/// A static item at `at`, px. \param depth_ratio reference depth divided by the item's depth.
template <class Item>
Item item(const Vec2& at, double depth_ratio) {
  Item item;
  item.location = at;
  item.origin = vga().centre_px;
  item.depth_ratio = depth_ratio;
  item.speed = depth_ratio * ahead().reference_speed(at);
  item.angle = angle_of(at - item.origin);
  item.trust = 4;
  return item;
}

inline Edge normal(const Vec2& at, double depth_ratio = 1) {
  return item<Edge>(at, depth_ratio);
}

inline Circle circle(const Vec2& at, double radius, double depth_ratio = 1) {
  Circle circle = item<Circle>(at, depth_ratio);
  circle.radius = radius;
  circle.members = 5;
  return circle;
}

/// An edge or a circle with its own motion, first detected 50 px away.
template <class Item>
Item moved(Item item, double angle, double speed) {
  item.rebel = true;
  item.angle = angle;
  item.speed = speed;
  item.origin = item.location - 50 * unit_vector(angle);
  return item;
}

inline Edge rebel(const Vec2& at, double angle, double speed) {
  return moved(normal(at), angle, speed);
}

}  // namespace lcs::testing
