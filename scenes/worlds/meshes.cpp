#include "scenes/worlds/world.h"

#include <fmt/format.h>

#include <cmath>

namespace lcs::worlds {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Adds a flat quad; corners are counter-clockwise from outside.
void add_quad(Mesh& mesh, const std::array<Vector3d, 4>& corners,
              const std::array<Vector2d, 4>& texture) {
  const Vector3d normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalized();
  const int first = static_cast<int>(mesh.vertices.size());
  for (std::size_t i = 0; i < 4; ++i) mesh.vertices.push_back({corners[i], normal, texture[i]});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// Adds an upright side over two points of the foot. Texture coordinates run to the right and up,
/// as seen from outside. \param start of its texture. \return the end of its texture.
double add_side(Mesh& mesh, const Vector3d& left, const Vector3d& right, double height_m,
                double start, double side_m) {
  const double end = start + (right - left).norm() / side_m, up = height_m / side_m;
  const Vector3d h(0, 0, height_m);
  add_quad(mesh, {left, right, right + h, left + h},
           {Vector2d(start, 0), Vector2d(end, 0), Vector2d(end, up), Vector2d(start, up)});
  return end;
}

/// Adds a flat face as a fan about a point from which the whole face is visible.
void add_fan(Mesh& mesh, const Vector3d& middle, const std::vector<Vector3d>& rim,
             const Vector3d& normal, double side_m) {
  const int first = static_cast<int>(mesh.vertices.size());
  const auto add = [&](const Vector3d& p) {
    mesh.vertices.push_back({p, normal, p.head<2>() / side_m});
  };
  add(middle);
  for (const Vector3d& p : rim) add(p);
  const int n = static_cast<int>(rim.size());
  for (int i = 0; i < n; ++i) {
    const int a = first + 1 + i, b = first + 1 + (i + 1) % n;
    if (normal.z() > 0) {
      mesh.triangles.push_back({first, a, b});
    } else {
      mesh.triangles.push_back({first, b, a});
    }
  }
}

std::vector<Vector3d> ring(double radius_m, double z_m, int around) {
  std::vector<Vector3d> points;
  for (int i = 0; i < around; ++i) {
    const double a = kTurn * i / around;
    points.emplace_back(radius_m * std::cos(a), radius_m * std::sin(a), z_m);
  }
  return points;
}

}  // namespace

Mesh box_mesh(const Vector3d& size_m, double side_m) {
  Mesh mesh;
  const double x = size_m.x() / 2, y = size_m.y() / 2, z = size_m.z();
  const Vector3d a(-x, -y, 0), b(x, -y, 0), c(x, y, 0), d(-x, y, 0), h(0, 0, z);
  add_side(mesh, a, b, z, 0, side_m);
  add_side(mesh, b, c, z, 0, side_m);
  add_side(mesh, c, d, z, 0, side_m);
  add_side(mesh, d, a, z, 0, side_m);
  const double u = 2 * x / side_m, v = 2 * y / side_m;
  const std::array<Vector2d, 4> flat{Vector2d(0, 0), Vector2d(u, 0), Vector2d(u, v),
                                     Vector2d(0, v)};
  add_quad(mesh, {a + h, b + h, c + h, d + h}, flat);
  add_quad(mesh, {d, c, b, a}, flat);
  return mesh;
}

Mesh prism_mesh(const std::vector<Vector2d>& polygon_m, double height_m, double side_m) {
  Mesh mesh;
  double along = 0;
  Vector2d middle = Vector2d::Zero();
  std::vector<Vector3d> foot, head;
  for (const Vector2d& p : polygon_m) {
    middle += p / static_cast<double>(polygon_m.size());
    foot.emplace_back(p.x(), p.y(), 0);
    head.emplace_back(p.x(), p.y(), height_m);
  }
  for (std::size_t i = 0; i < foot.size(); ++i) {
    along = add_side(mesh, foot[i], foot[(i + 1) % foot.size()], height_m, along, side_m);
  }
  add_fan(mesh, {middle.x(), middle.y(), height_m}, head, Vector3d::UnitZ(), side_m);
  add_fan(mesh, {middle.x(), middle.y(), 0}, foot, -Vector3d::UnitZ(), side_m);
  return mesh;
}

Mesh turned_mesh(const std::vector<Vector2d>& profile_m, double side_m, int around) {
  Mesh mesh;
  const double widest =
      std::ranges::max_element(profile_m, [](const Vector2d& a, const Vector2d& b) {
        return a.x() < b.x();
      })->x();
  // a whole number of pictures round it, so that they meet
  const double pictures = std::max(1.0, std::round(kTurn * widest / side_m));
  double up = 0;
  for (std::size_t i = 0; i + 1 < profile_m.size(); ++i) {
    const Vector2d low = profile_m[i], high = profile_m[i + 1];
    const double slant = (high - low).norm();
    const Vector2d out = Vector2d(high.y() - low.y(), low.x() - high.x()) / slant;
    const int first = static_cast<int>(mesh.vertices.size());
    for (int k = 0; k <= around; ++k) {
      const double a = kTurn * (k % around) / around;
      const Vector3d radial(std::cos(a), std::sin(a), 0);
      const Vector3d normal = out.x() * radial + Vector3d(0, 0, out.y());
      const double u = pictures * k / around;
      mesh.vertices.push_back(
          {low.x() * radial + Vector3d(0, 0, low.y()), normal, {u, up / side_m}});
      mesh.vertices.push_back(
          {high.x() * radial + Vector3d(0, 0, high.y()), normal, {u, (up + slant) / side_m}});
    }
    for (int k = 0; k < around; ++k) {
      const int a = first + 2 * k;
      mesh.triangles.push_back({a, a + 2, a + 3});
      mesh.triangles.push_back({a, a + 3, a + 1});
    }
    up += slant;
  }
  const Vector2d& foot = profile_m.front();
  const Vector2d& head = profile_m.back();
  add_fan(mesh, {0, 0, head.y()}, ring(head.x(), head.y(), around), Vector3d::UnitZ(), side_m);
  add_fan(mesh, {0, 0, foot.y()}, ring(foot.x(), foot.y(), around), -Vector3d::UnitZ(), side_m);
  return mesh;
}

Mesh lump_mesh(const Vector3d& radii_m, double bumps, double side_m, Draw& draw) {
  constexpr int kAround = 18, kRings = 10;
  // plane waves over the sphere are smooth and periodic
  struct Wave {
    Vector3d along;
    double phase;
  };
  std::array<Wave, 4> waves;
  for (Wave& wave : waves) {
    const Vector3d along{draw.normal(), draw.normal(), draw.normal()};
    wave = {along.normalized() * draw.between(1.5, 5), draw.between(0, kTurn)};
  }
  const auto point = [&](int r, int k) {
    const double latitude = std::numbers::pi * (static_cast<double>(r) / kRings - 0.5);
    const double longitude = kTurn * (k % kAround) / kAround;
    const Vector3d unit(std::cos(latitude) * std::cos(longitude),
                        std::cos(latitude) * std::sin(longitude), std::sin(latitude));
    double sum = 0;
    for (const Wave& wave : waves) sum += std::cos(wave.along.dot(unit) + wave.phase);
    const double scale = 1 + bumps * sum / 2;
    return Vector3d(scale * unit.cwiseProduct(radii_m));
  };
  Mesh mesh;
  const double pictures = std::max(1.0, std::round(kTurn * radii_m.head<2>().maxCoeff() / side_m));
  for (int r = 0; r <= kRings; ++r) {
    for (int k = 0; k <= kAround; ++k) {
      const Vector3d p = point(r, k);
      const Vector3d normal = p.cwiseQuotient(radii_m).cwiseQuotient(radii_m).normalized();
      mesh.vertices.push_back(
          {p,
           normal,
           {pictures * k / kAround, std::numbers::pi * radii_m.z() * r / kRings / side_m}});
    }
  }
  for (int r = 0; r < kRings; ++r) {
    for (int k = 0; k < kAround; ++k) {
      const int a = r * (kAround + 1) + k, b = a + kAround + 1;
      if (r > 0) mesh.triangles.push_back({a, a + 1, b + 1});
      if (r + 1 < kRings) mesh.triangles.push_back({a, b + 1, b});
    }
  }
  return mesh;
}

Mesh chips_mesh(const std::vector<Chip>& chips) {
  Mesh mesh;
  for (const Chip& chip : chips) {
    const Vector3d along = (chip.tip_m - chip.foot_m).normalized();
    const Vector3d side = along.unitOrthogonal(), front = along.cross(side);
    const double half = chip.width_m / 2;
    const int first = static_cast<int>(mesh.vertices.size());
    for (const Vector3d& off : {side, front, Vector3d(-side)}) {
      mesh.vertices.push_back({chip.foot_m + half * off, off, {0, 0}});
    }
    mesh.vertices.push_back({chip.tip_m, along, {0, 0}});
    const int a = first, b = first + 1, c = first + 2, tip = first + 3;
    mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {a, b, tip}, {b, c, tip}, {c, a, tip}});
  }
  return mesh;
}

std::string obj_text(const Mesh& mesh) {
  std::string text;
  for (const Mesh::Vertex& v : mesh.vertices) {
    const Vector3d& p = v.position_m;
    text += fmt::format("v {:.4f} {:.4f} {:.4f}\n", p.x(), p.y(), p.z());
  }
  for (const Mesh::Vertex& v : mesh.vertices) {
    text += fmt::format("vt {:.4f} {:.4f}\n", v.texture.x(), v.texture.y());
  }
  for (const Mesh::Vertex& v : mesh.vertices) {
    text += fmt::format("vn {:.4f} {:.4f} {:.4f}\n", v.normal.x(), v.normal.y(), v.normal.z());
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    text += fmt::format("f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", a + 1, b + 1, c + 1);
  }
  return text;
}

}  // namespace lcs::worlds
