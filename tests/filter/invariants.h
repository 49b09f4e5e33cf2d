/// \file
/// Invariants after every step of the filter, for any input; shared by tests and fuzzers.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>

#include "filter/paper/any_filter.h"

namespace lcs::testing {

/// Ranks of the trust of edges and circles.
inline TrustRanks circle_trust(const AnyParameters& parameters) {
  return std::visit([](const auto& p) { return p.circle.trust; }, parameters);
}
/// Ranks of the trust of squares: in the default each has that of its circle.
inline TrustRanks square_trust(const AnyParameters& parameters) {
  const auto* paper = std::get_if<paper::PaperParameters>(&parameters);
  return paper ? paper->square.trust : circle_trust(parameters);
}

inline bool finite(std::initializer_list<double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

inline bool is_finite(const Edge& e) {
  return e.location.allFinite() && e.origin.allFinite() && e.rotated.allFinite() &&
         e.predicted.allFinite() && finite({e.speed, e.depth_ratio, e.angle, e.mu}) &&
         e.speed >= 0 && e.depth_ratio_sigma > 0;
}

inline bool is_finite(const Circle& c) {
  return c.location.allFinite() && c.origin.allFinite() &&
         finite({c.radius, c.speed, c.depth_ratio, c.angle}) && c.radius >= 0;
}

inline bool is_finite(const Square& s) {
  return s.location.allFinite() && s.half_size.allFinite() && s.origin.allFinite() &&
         finite({s.speed, s.depth_ratio, s.angle}) && s.half_size.minCoeff() >= 0;
}

/// Whether the outline is convex and as wide and high as its square, up to rounding.
inline bool is_outline(const Square& square) {
  const auto vertices = square.outline.vertices();
  if (vertices.empty()) return true;
  const double rounding = 1e-9 * (1 + square.location.norm() + square.half_size.norm());
  Vec2 low = vertices[0], high = low;
  bool turns = true;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec2 &a = vertices[i], &b = vertices[(i + 1) % vertices.size()],
               &c = vertices[(i + 2) % vertices.size()];
    if (!a.allFinite()) return false;
    low = low.cwiseMin(a);
    high = high.cwiseMax(a);
    const Vec2 ab = b - a, bc = c - b;
    turns &= ab.x() * bc.y() - ab.y() * bc.x() >= -rounding * (ab.norm() + bc.norm());
  }
  return turns && (0.5 * (low + high) - square.location).norm() <= rounding &&
         (0.5 * (high - low) - square.half_size).norm() <= rounding;
}

/// The first violated invariant in the result for `corners` corners, if any.
inline std::optional<std::string> violation(const FrameResult& result, std::size_t corners,
                                            const Intrinsics& camera,
                                            const AnyParameters& parameters) {
  const Layers& layers = result.layers;
  if (result.verdicts.size() != corners) return "a corner has no verdict";
  if (result.reasons.size() != corners) return "a corner has no reason";
  std::optional<std::string> found;
  const auto expect = [&](bool holds, const char* what) {
    if (!holds && !found) found = what;
  };
  const auto inside = [&](const Vec2& x) {
    return x.x() >= -0.5 && x.y() >= -0.5 && x.x() <= camera.width_px && x.y() <= camera.height_px;
  };
  const auto trusted = [](int trust, const TrustRanks& ranks) {
    return trust >= ranks.critical && trust <= ranks.maximum;
  };
  const auto check_edges = [&](const std::vector<Edge>& edges, std::size_t circles, bool rebel) {
    Id last = 0;
    for (const Edge& edge : edges) {
      expect(is_finite(edge), "an edge is not finite");
      expect(inside(edge.location), "an edge is outside of the picture");
      expect(edge.rebel == rebel, "an edge is in the wrong list");
      expect(edge.id > last, "edges are not in the order of their ids");
      expect(trusted(edge.trust, circle_trust(parameters)), "an edge has a trust out of its ranks");
      expect(edge.corner < static_cast<int>(corners), "an edge has a corner that there is not");
      expect(edge.circle < static_cast<int>(circles), "an edge has a circle that there is not");
      last = edge.id;
    }
  };
  check_edges(layers.normal_edges, layers.normal_circles.size(), false);
  check_edges(layers.rebel_edges, layers.rebel_circles.size(), true);
  for (const auto* circles : {&layers.normal_circles, &layers.rebel_circles}) {
    for (const Circle& circle : *circles) {
      expect(is_finite(circle), "a circle is not finite");
      expect(inside(circle.location), "a circle is outside of the picture");
      expect(trusted(circle.trust, circle_trust(parameters)), "a circle's trust is out of ranks");
    }
  }
  for (const Square& square : layers.squares) {
    expect(is_finite(square), "a square is not finite");
    expect(is_outline(square), "an outline is not convex, or not as large as its square");
    expect(inside(square.location), "a square is outside of the picture");
    expect(trusted(square.trust, square_trust(parameters)), "a square's trust is out of ranks");
  }
  for (const IgnoreRegion& region : result.paper.ignored) {
    expect(region.location.allFinite() && region.size.allFinite(), "psi is not finite");
  }
  for (const Collector& collector : result.paper.collectors) {
    expect(collector.location.allFinite() && finite({collector.radius, collector.depth_ratio}),
           "lambda is not finite");
  }
  for (const Chain& chain : result.paper.chains) {
    for (int i = 0; i < chain.count; ++i) {
      expect(chain.sightings[static_cast<std::size_t>(i)].allFinite(), "alpha is not finite");
    }
    expect(std::isfinite(chain.off_field_px), "alpha is not finite");
  }
  return found;
}

}  // namespace lcs::testing
