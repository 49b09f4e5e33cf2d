#include "filter/line/line.h"

#include <algorithm>
#include <tuple>

#include "filter/vectors/refill.h"

namespace lcs {
bool contains(const IgnoreRegion& region, const Vec2& x) {
  const Vec2 d = x - region.location;
  if (region.shape == IgnoreRegion::Shape::circle) return d.norm() <= region.size.x();
  return std::abs(d.x()) <= region.size.x() && std::abs(d.y()) <= region.size.y();
}

bool inside_any(std::span<const IgnoreRegion> regions, const Vec2& x) {
  return std::ranges::any_of(regions,
                             [&](const IgnoreRegion& region) { return contains(region, x); });
}

const Chi& LineExpert::collect(std::span<const Eigen::Vector2f> corners_px,
                               std::span<const Signature> signatures,
                               std::span<const IgnoreRegion> psi) {
  refill(chi_.rejected, corners_px.size(), Reason::too_many);
  entries_.clear();
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    const Vec2 x = corners_px[i].cast<double>();
    if (!x.allFinite()) {
      chi_.rejected[i] = Reason::not_finite;
    } else if (!picture_.contain(x)) {
      chi_.rejected[i] = Reason::outside;
    } else if (inside_any(psi, x)) {
      chi_.rejected[i] = Reason::in_psi;
    } else {
      entries_.push_back({(x - centre_px_).squaredNorm(), x, static_cast<int>(i)});
    }
  }
  // The distance from the centre is invariant to mirroring and quarter turns of the image. Ties are
  // broken by coordinates, then by signatures.
  const auto signature = [&](const ParameterEntry& entry) {
    return signatures.empty() ? Signature{} : signatures[static_cast<std::size_t>(entry.source)];
  };
  const auto nearer = [&](const ParameterEntry& a, const ParameterEntry& b) {
    if (a.distance2 != b.distance2) return a.distance2 < b.distance2;
    return std::tuple(a.location.y(), a.location.x(), signature(a), a.source) <
           std::tuple(b.location.y(), b.location.x(), signature(b), b.source);
  };
  if (entries_.size() > max_corners_) {
    const auto end = entries_.begin() + static_cast<std::ptrdiff_t>(max_corners_);
    std::nth_element(entries_.begin(), end, entries_.end(), nearer);
    entries_.erase(end, entries_.end());
  }
  std::ranges::sort(entries_, nearer);

  chi_.locations.clear();
  chi_.sources.clear();
  chi_.signatures.clear();
  chi_.repeats.clear();
  for (const ParameterEntry& entry : entries_) {
    chi_.rejected[static_cast<std::size_t>(entry.source)] = Reason::unknown;
    if (!chi_.locations.empty() && entry.location == chi_.locations.back()) {
      chi_.repeats.push_back({entry.source, chi_.sources.back()});
      continue;
    }
    chi_.locations.push_back(entry.location);
    chi_.sources.push_back(entry.source);
    if (!signatures.empty()) chi_.signatures.push_back(signature(entry));
  }
  return chi_;
}

void count_rejected(const Chi& chi, Diagnostics& diagnostics) {
  const auto count = [&](Fault fault, Reason reason) {
    diagnostics.add(fault, std::ranges::count(chi.rejected, reason));
  };
  count(Fault::corner_not_finite, Reason::not_finite);
  count(Fault::corner_outside, Reason::outside);
  count(Fault::corner_too_many, Reason::too_many);
  diagnostics.add(Fault::corner_repeated, static_cast<std::int64_t>(chi.repeats.size()));
}

namespace {

void repeat_verdicts(const Chi& chi, FrameResult& result) {
  for (const Chi::Repeat& repeat : chi.repeats) {
    result.verdicts[repeat.source] = result.verdicts[repeat.of_source];
    result.reasons[repeat.source] = result.reasons[repeat.of_source];
    if (result.log_odds.empty()) continue;
    result.log_odds[repeat.source] = result.log_odds[repeat.of_source];
  }
}

}  // namespace

void assign_verdicts(const Chi& chi, std::span<const Verdict> verdicts,
                     std::span<const Reason> reasons, std::span<const float> log_odds,
                     FrameResult& result) {
  copy_over(chi.rejected, result.reasons);
  refill(result.verdicts, chi.rejected.size(), Verdict::pending);
  for (std::size_t i = 0; i < chi.rejected.size(); ++i) {
    if (chi.rejected[i] == Reason::in_psi) result.verdicts[i] = Verdict::ignored;
  }
  refill(result.log_odds, log_odds.empty() ? 0 : chi.rejected.size());
  for (std::size_t c = 0; c < log_odds.size(); ++c) {
    result.log_odds[chi.sources[c]] = log_odds[c];
  }
  for (std::size_t c = 0; c < chi.size(); ++c) {
    result.verdicts[chi.sources[c]] = verdicts[c];
    result.reasons[chi.sources[c]] = reasons[c];
  }
  repeat_verdicts(chi, result);
}

void assign_rebels(const Chi& chi, std::span<const CornerOdds> corners, Reason reason,
                   FrameResult& result) {
  for (const auto& [c, log_odds] : corners) {
    result.verdicts[c] = Verdict::rebel;
    result.reasons[c] = reason;
    result.log_odds[c] = log_odds;
  }
  repeat_verdicts(chi, result);
}

}  // namespace lcs
