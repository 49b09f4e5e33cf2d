#include "filter/line.h"

#include <algorithm>
#include <tuple>

namespace lcs {

bool contains(const IgnoreRegion& region, const Vec2& x) {
  const Vec2 d = x - region.location;
  if (region.shape == IgnoreRegion::Shape::circle) return d.norm() <= region.size.x();
  return std::abs(d.x()) <= region.size.x() && std::abs(d.y()) <= region.size.y();
}

bool inside_any(std::span<const IgnoreRegion> regions, const Vec2& x) {
  return std::any_of(regions.begin(), regions.end(),
                     [&](const IgnoreRegion& region) { return contains(region, x); });
}

const Chi& LineExpert::collect(std::span<const Eigen::Vector2f> corners_px,
                               std::span<const IgnoreRegion> psi, std::span<const Collector> lambda,
                               std::vector<Verdict>& verdicts) {
  verdicts.assign(corners_px.size(), Verdict::pending);
  entries_.clear();
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    if (!corners_px[i].allFinite()) continue;
    const Vec2 x = corners_px[i].cast<double>();
    if (inside_any(psi, x)) {
      verdicts[i] = Verdict::ignored;
    } else {
      entries_.push_back({(x - centre_px_).squaredNorm(), x, static_cast<int>(i)});
    }
  }
  // The distance from the centre survives mirroring and quarter turns of the image; the coordinates
  // only part what it leaves equal.
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return std::tuple(a.distance2, a.location.y(), a.location.x(), a.source) <
           std::tuple(b.distance2, b.location.y(), b.location.x(), b.source);
  });

  chi_.locations.clear();
  chi_.sources.clear();
  chi_.groups.clear();
  for (const Entry& entry : entries_) {
    int group = -1;
    double nearest = 0;
    for (std::size_t c = 0; c < lambda.size(); ++c) {
      const double distance = (entry.location - lambda[c].location).norm();
      if (distance <= lambda[c].radius && (group < 0 || distance < nearest)) {
        group = static_cast<int>(c);
        nearest = distance;
      }
    }
    chi_.locations.push_back(entry.location);
    chi_.sources.push_back(entry.source);
    chi_.groups.push_back(group);
  }
  return chi_;
}

}  // namespace lcs
