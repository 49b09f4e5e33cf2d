#include "filter/line/line.h"

#include <algorithm>
#include <tuple>

#include "filter/matching/refill.h"

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

}  // namespace lcs
