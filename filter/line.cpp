#include "filter/line.h"

#include <algorithm>
#include <tuple>

#include "filter/refill.h"

namespace lcs {
namespace {

/// Of the grid of corners: about as wide as a collector.
constexpr double kCell_px = 32;

}  // namespace

bool contains(const IgnoreRegion& region, const Vec2& x) {
  const Vec2 d = x - region.location;
  if (region.shape == IgnoreRegion::Shape::circle) return d.norm() <= region.size.x();
  return std::abs(d.x()) <= region.size.x() && std::abs(d.y()) <= region.size.y();
}

bool inside_any(std::span<const IgnoreRegion> regions, const Vec2& x) {
  return std::any_of(regions.begin(), regions.end(),
                     [&](const IgnoreRegion& region) { return contains(region, x); });
}

void LineExpert::collect(std::span<const Eigen::Vector2f> corners_px,
                         std::span<const Signature> signatures, std::span<const IgnoreRegion> psi,
                         Chi& chi, std::vector<Verdict>& verdicts) {
  refill(verdicts, corners_px.size(), Verdict::pending);
  entries_.clear();
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    const Vec2 x = corners_px[i].cast<double>();
    if (!picture_.contain(x)) continue;  // nor is it where it is not a number
    if (inside_any(psi, x)) {
      verdicts[i] = Verdict::ignored;
    } else {
      entries_.push_back({(x - centre_px_).squaredNorm(), x, static_cast<int>(i)});
    }
  }
  // The distance from the centre survives mirroring and quarter turns of the image; the coordinates
  // only part what it leaves equal, and the signatures those at one place.
  const auto signature = [&](const Entry& entry) {
    return signatures.empty() ? Signature{} : signatures[static_cast<std::size_t>(entry.source)];
  };
  const auto nearer = [&](const Entry& a, const Entry& b) {
    if (a.distance2 != b.distance2) return a.distance2 < b.distance2;
    return std::tuple(a.location.y(), a.location.x(), signature(a), a.source) <
           std::tuple(b.location.y(), b.location.x(), signature(b), b.source);
  };
  if (entries_.size() > max_corners_) {
    const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(max_corners_);
    std::nth_element(entries_.begin(), end, entries_.end(), nearer);
    entries_.erase(end, entries_.end());
  }
  std::sort(entries_.begin(), entries_.end(), nearer);

  chi.locations.clear();
  chi.sources.clear();
  chi.signatures.clear();
  chi.repeats.clear();
  for (const Entry& entry : entries_) {
    if (!chi.locations.empty() && entry.location == chi.locations.back()) {
      chi.repeats.push_back({entry.source, chi.sources.back()});
      continue;
    }
    chi.locations.push_back(entry.location);
    chi.sources.push_back(entry.source);
    if (!signatures.empty()) chi.signatures.push_back(signature(entry));
  }
}

/// Few corners lie in each collector, so that they are looked for from there.
void CornerGrouping::group(std::span<const Collector> lambda, Chi& chi) {
  refill(chi.groups, chi.size(), -1);
  if (lambda.empty()) return;
  grid_.build(chi.locations, kCell_px);
  refill(nearest_, chi.size());
  for (std::size_t c = 0; c < lambda.size(); ++c) {
    // A hair farther, for the distance is compared and not its square.
    grid_.visit_within(lambda[c].location, 1.001 * lambda[c].radius, [&](int i, double) {
      const double distance = (chi.locations[i] - lambda[c].location).norm();
      if (distance > lambda[c].radius) return;
      if (chi.groups[i] >= 0 && !(distance < nearest_[i])) return;
      chi.groups[i] = static_cast<int>(c);
      nearest_[i] = distance;
    });
  }
}

}  // namespace lcs
