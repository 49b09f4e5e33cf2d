#include "filter/edges.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "filter/geometry.h"

namespace lcs {
namespace {

/// Below this displacement of the reference point a frame says nothing about an edge's depth.
constexpr double kLeastDisplacement_px = 0.2;

/// How many of its steps a rebel's origin stays behind it, so that beta is the direction of now.
constexpr double kOriginSteps = 5;

}  // namespace

EdgeExpert::EdgeExpert(const Intrinsics& camera, const CircleParameters& parameters)
    : camera_(camera), parameters_(parameters) {}

void EdgeExpert::predict(Layers& layers, const MotionField& field) {
  for (Edge& edge : layers.normal_edges) {
    edge.rotated = field.rotated(edge.location);
    if (field.moving()) {
      edge.depth_ratio = parameters_.speed_rule == SpeedRule::paper
                             ? 0.5 * (edge.depth_ratio + 1)
                             : field.advanced_ratio(edge.depth_ratio);
    }
    edge.predicted = field.translated(edge.rotated, edge.depth_ratio);
    edge.origin = field.origin(edge.predicted);
    edge.speed = edge.depth_ratio * field.reference_speed(edge.rotated);
  }
  for (Edge& edge : layers.rebel_edges) {
    edge.rotated = field.rotated(edge.location);
    edge.origin = field.rotated(edge.origin);
    const Vec2 path = edge.rotated - edge.origin;
    if (path.norm() > 0) edge.angle = angle_of(path);
    edge.predicted = edge.rotated + edge.speed * field.dt_s() * unit_vector(edge.angle);
  }
  for (Chain& chain : layers.chains) {
    for (int i = 0; i < chain.count; ++i) chain.sightings[i] = field.rotated(chain.sightings[i]);
  }
}

bool EdgeExpert::in_span(const Edge& edge, const Vec2& x, const MotionField& field) const {
  const Vec2 along = field.direction(edge.rotated);
  if (along.isZero()) return (x - edge.predicted).norm() <= parameters_.corner_noise;
  if (parameters_.span_apex == SpanApex::landmark) {
    const Vec2 step = x - edge.rotated;
    const double advance = step.dot(along);
    const double sideways = std::abs(cross(along, step));
    return sideways <= std::max(parameters_.corner_noise,
                                std::abs(advance) * std::tan(parameters_.delta_v));
  }
  // Seen from O_I the corridor widens with the distance; past half a diagonal (an FOE outside the
  // image) it would let everything in.
  const Vec2 axis = (edge.predicted - edge.origin).normalized();
  const Vec2 ray = x - edge.origin;
  const double reach = std::min(ray.norm(), 0.5 * std::hypot(camera_.width_px, camera_.height_px));
  return ray.dot(axis) >= -parameters_.corner_noise &&
         std::abs(cross(axis, ray)) <= reach * std::sin(parameters_.delta_v) + parameters_.corner_noise;
}

bool EdgeExpert::plausible_speed(const Edge& edge, const Vec2& x, const MotionField& field) const {
  const double advance = (x - edge.rotated).dot(field.direction(edge.rotated));
  const double fastest = field.max_ratio() * field.reference_speed(edge.rotated) * field.dt_s();
  return advance >= -parameters_.corner_noise && advance <= fastest + parameters_.corner_noise;
}

Xi EdgeExpert::classify(const Edge& edge, const Vec2& x, const MotionField& field) const {
  if (!in_span(edge, x, field)) return Xi::five;
  const Vec2 residual = x - edge.predicted;
  if (residual.norm() > edge.mu) return plausible_speed(edge, x, field) ? Xi::one : Xi::four;
  const double ahead = residual.dot(field.direction(edge.rotated));
  return ahead >= -parameters_.corner_noise ? Xi::two : Xi::three;
}

double EdgeExpert::rebel_reach(const Edge& edge, const MotionField& field) const {
  return std::max(2 * parameters_.corner_noise,
                  parameters_.rebel_reach * edge.speed * field.dt_s());
}

/// zeta_r: near the prediction, and in its direction (delta_v and the deviation mu_r) from its origin.
bool EdgeExpert::matches_rebel(const Edge& edge, const Vec2& x, const MotionField& field) const {
  if ((x - edge.predicted).norm() > rebel_reach(edge, field)) return false;
  const Vec2 axis = unit_vector(edge.angle);
  const Vec2 ray = x - edge.origin;
  const double span = std::min(parameters_.delta_v + edge.mu, kPi / 2);
  return std::abs(cross(axis, ray)) <=
         std::max(2 * parameters_.corner_noise, ray.norm() * std::sin(span));
}

void EdgeExpert::assign(const Layers& layers, const Chi& chi, const MotionField& field) {
  const int normals = static_cast<int>(layers.normal_edges.size());
  const int rebels = static_cast<int>(layers.rebel_edges.size());
  pairs_.clear();
  const auto cost = [&](const Edge& edge, double distance2) {
    return std::sqrt(distance2) - parameters_.trust_bonus * (edge.trust - parameters_.trust.critical);
  };
  for (int i = 0; i < normals; ++i) {
    const Edge& edge = layers.normal_edges[i];
    corner_grid_.visit_within(edge.predicted, edge.mu, [&](int corner, double distance2) {
      const Xi xi = classify(edge, chi.locations[corner], field);
      if (xi == Xi::two) pairs_.push_back({cost(edge, distance2), i, corner});
      if (xi == Xi::three) {
        pairs_.push_back({cost(edge, distance2) + parameters_.corner_noise, i, corner});
      }
    });
  }
  for (int i = 0; i < rebels; ++i) {
    const Edge& edge = layers.rebel_edges[i];
    corner_grid_.visit_within(edge.predicted, rebel_reach(edge, field),
                              [&](int corner, double distance2) {
                                if (matches_rebel(edge, chi.locations[corner], field)) {
                                  pairs_.push_back({cost(edge, distance2), normals + i, corner});
                                }
                              });
  }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tuple(a.cost, a.edge, a.corner) < std::tuple(b.cost, b.edge, b.corner);
  });
  match_of_edge_.assign(static_cast<std::size_t>(normals + rebels), -1);
  match_of_corner_.assign(chi.size(), -1);
  for (const Pair& pair : pairs_) {
    if (match_of_edge_[pair.edge] >= 0 || match_of_corner_[pair.corner] >= 0) continue;
    match_of_edge_[pair.edge] = pair.corner;
    match_of_corner_[pair.corner] = pair.edge;
  }
}

/// Cor of the group's x and y, 1 - rho^2: small when the corners that the landmark was matched among
/// lie on a line. 1 for fewer than three, which have no correlation to speak of.
double EdgeExpert::spread(const Edge& edge, const Chi& chi, int corner) const {
  double n = 0;
  Vec2 sum = Vec2::Zero();
  double xx = 0, yy = 0, xy = 0;
  corner_grid_.visit_within(edge.predicted, edge.mu, [&](int other, double) {
    if (chi.groups[other] != chi.groups[corner]) return;
    const Vec2 d = chi.locations[other] - edge.predicted;
    n += 1;
    sum += d;
    xx += d.x() * d.x();
    yy += d.y() * d.y();
    xy += d.x() * d.y();
  });
  if (n < 3) return 1;
  const double var_x = xx - sum.x() * sum.x() / n;
  const double var_y = yy - sum.y() * sum.y() / n;
  const double covariance = xy - sum.x() * sum.y() / n;
  const double product = var_x * var_y;
  return product > 0 ? std::clamp(1 - covariance * covariance / product, 0.0, 1.0) : 0.0;
}

void EdgeExpert::update_normal(Edge& edge, const Vec2& x, Xi xi, const Chi& chi,
                               const MotionField& field) {
  const double reference_step = field.reference_speed(edge.rotated) * field.dt_s();
  const double predicted_ratio = edge.depth_ratio;
  if (reference_step > kLeastDisplacement_px) {
    const double residual = (x - edge.predicted).dot(field.direction(edge.rotated));
    const double measured = predicted_ratio + residual / reference_step;
    edge.depth_ratio =
        parameters_.speed_rule == SpeedRule::paper
            ? std::abs(measured)
            : std::max(0.0, estimate(edge.trust, parameters_.trust, predicted_ratio, measured));
    edge.depth_ratio = std::min(edge.depth_ratio, 2 * field.max_ratio());
  }
  // mu^ = ( |V_v - V~| t_f / Cor + mu ) / 2, with a length in place of the printed speed.
  const double off_reference = std::abs(1 - predicted_ratio) * reference_step;
  const double correlation = std::max(spread(edge, chi, edge.corner), 1e-3);
  edge.mu = std::clamp(0.5 * (off_reference / correlation + edge.mu), parameters_.mu_min,
                       parameters_.mu_max);

  edge.location = estimate(edge.trust, parameters_.trust, edge.predicted, x);
  edge.speed = edge.depth_ratio * field.reference_speed(edge.location);
  const Vec2 along = field.direction(edge.location);
  if (!along.isZero()) edge.angle = angle_of(along);
  edge.trust = xi == Xi::two ? parameters_.trust.raised(edge.trust) : edge.trust - 1;
}

void EdgeExpert::update_rebel(Edge& edge, const Vec2& x, const MotionField& field) {
  const Vec2 axis = unit_vector(edge.angle);
  if (field.dt_s() > 0) {
    const double measured = std::abs(edge.speed + (x - edge.predicted).dot(axis) / field.dt_s());
    edge.speed = parameters_.speed_rule == SpeedRule::paper
                     ? measured
                     : estimate(edge.trust, parameters_.trust, edge.speed, measured);
  }
  edge.location = estimate(edge.trust, parameters_.trust, edge.predicted, x);
  const double before = edge.angle;
  const Vec2 path = edge.location - edge.origin;
  if (path.norm() > 0) edge.angle = angle_of(path);
  // mu^_r = |beta~ - beta^|, beta~ seen from the origin to the corner itself.
  edge.mu = std::min(angle_between(angle_of(x - edge.origin), before), kPi / 4);
  if (parameters_.speed_rule == SpeedRule::trusted) {
    const double longest = kOriginSteps * edge.speed * field.dt_s();
    if (path.norm() > longest) edge.origin = edge.location - longest * unit_vector(edge.angle);
  }
  edge.trust = parameters_.trust.raised(edge.trust);
}

/// An edge without a corner follows its prediction. It loses trust for that, unless it lies in a region
/// that was not looked at.
void EdgeExpert::coast(Edge& edge, const std::vector<IgnoreRegion>& psi) const {
  edge.corner = -1;
  edge.location = edge.predicted;
  if (!inside_any(psi, edge.predicted)) --edge.trust;
}

void EdgeExpert::bury(std::vector<Edge>& edges) const {
  const auto gone = [&](const Edge& edge) {
    return !parameters_.trust.alive(edge.trust) || edge.location.x() < -0.5 ||
           edge.location.y() < -0.5 || edge.location.x() > camera_.width_px - 0.5 ||
           edge.location.y() > camera_.height_px - 0.5;
  };
  edges.erase(std::remove_if(edges.begin(), edges.end(), gone), edges.end());
}

/// What becomes of the corners that no edge took. By xi_1 a corner belongs to the layer of a normal
/// edge that lost its own; all others may be rebels, and start normal edges of their own meanwhile.
void EdgeExpert::classify_rest(const Layers& layers, const Chi& chi, const MotionField& field) {
  to_alpha_.assign(chi.size(), 0);
  to_normal_.assign(chi.size(), 0);
  scratch_points_.clear();
  for (const Edge& edge : layers.normal_edges) scratch_points_.push_back(edge.predicted);
  edge_grid_.build(scratch_points_, parameters_.mu_0);
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (match_of_corner_[c] >= 0) continue;
    bool further = false;
    edge_grid_.visit_within(chi.locations[c], parameters_.mu_0, [&](int e, double) {
      further = further || (match_of_edge_[e] < 0 &&
                            classify(layers.normal_edges[e], chi.locations[c], field) == Xi::one);
    });
    to_normal_[c] = 1;
    to_alpha_[c] = !further;
  }
}

/// By how much a step between two sightings (rotation removed) leaves the images that a static point
/// at any plausible depth may take, px.
double EdgeExpert::off_field(const Vec2& from, const Vec2& to, const MotionField& field) const {
  return distance_to_segment(to, from, field.translated(from, field.max_ratio()));
}

Edge EdgeExpert::make_rebel(const Chain& chain, const Vec2& x, const MotionField& field) {
  const Vec2& first = chain.sightings[0];
  const Vec2& second = chain.sightings[1];
  Edge edge;
  edge.id = next_id_++;
  edge.rebel = true;
  edge.location = edge.predicted = x;
  edge.rotated = second;
  edge.origin = first;
  edge.speed = (x - second).norm() / field.dt_s();
  edge.angle = angle_of(x - first);
  edge.mu = angle_between(edge.angle, angle_of(second - first));
  edge.trust = parameters_.trust.initial_rebel();
  return edge;
}

/// Transition of alpha: rows of two sightings find their third or fail, rows of one branch into rows of
/// two, and what is left starts rows of one. Every row lives three frames at the most.
void EdgeExpert::grow_chains(Layers& layers, const Chi& chi, const MotionField& field) {
  // Third sightings: near the line through the first two, one row for a corner and one for an end.
  pairs_.clear();
  for (std::size_t i = 0; i < layers.chains.size(); ++i) {
    const Chain& chain = layers.chains[i];
    if (chain.count != 2) continue;
    const Vec2 step = chain.sightings[1] - chain.sightings[0];
    const Vec2 expected = chain.sightings[1] + step;
    const double reach = std::max(2 * parameters_.corner_noise,
                                  parameters_.alpha_stretch * step.norm());
    corner_grid_.visit_within(expected, reach, [&](int corner, double distance2) {
      if (!to_alpha_[corner]) return;
      const Vec2& x = chi.locations[corner];
      const double bend = angle_between(angle_of(x - chain.sightings[0]), angle_of(step));
      const double deviation = (x - chain.sightings[0]).norm() * std::sin(std::min(bend, kPi / 2));
      if (bend > parameters_.alpha_deviation && deviation > parameters_.corner_noise) return;
      const double off = chain.off_field_px + off_field(chain.sightings[1], x, field);
      if (off < 2 * parameters_.corner_noise) return;
      pairs_.push_back({distance2, static_cast<int>(i), corner});
    });
  }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tuple(a.cost, a.edge, a.corner) < std::tuple(b.cost, b.edge, b.corner);
  });
  std::vector<Vec2> used_ends;
  for (const Pair& pair : pairs_) {
    if (!to_alpha_[pair.corner]) continue;
    const Chain& chain = layers.chains[pair.edge];
    const Vec2& end = chain.sightings[1];
    if (std::find(used_ends.begin(), used_ends.end(), end) != used_ends.end()) continue;
    used_ends.push_back(end);
    layers.rebel_edges.push_back(make_rebel(chain, chi.locations[pair.corner], field));
    layers.rebel_edges.back().corner = pair.corner;
    to_alpha_[pair.corner] = to_normal_[pair.corner] = 0;
  }

  // Second sightings.
  grown_.clear();
  std::vector<std::pair<double, int>> nearest;
  for (const Chain& chain : layers.chains) {
    if (chain.count != 1) continue;
    nearest.clear();
    corner_grid_.visit_within(chain.sightings[0], parameters_.alpha_reach,
                              [&](int corner, double distance2) {
                                if (to_alpha_[corner]) nearest.emplace_back(distance2, corner);
                              });
    std::sort(nearest.begin(), nearest.end());
    const std::size_t branches =
        std::min(nearest.size(), static_cast<std::size_t>(parameters_.alpha_branches));
    for (std::size_t b = 0; b < branches; ++b) {
      Chain longer = chain;
      longer.sightings[1] = chi.locations[nearest[b].second];
      longer.count = 2;
      longer.off_field_px = off_field(longer.sightings[0], longer.sightings[1], field);
      grown_.push_back(longer);
    }
  }

  // First sightings.
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (!to_alpha_[c]) continue;
    Chain chain;
    chain.sightings[0] = chain.sightings[1] = chi.locations[c];
    chain.count = 1;
    grown_.push_back(chain);
  }
  layers.chains.swap(grown_);
}

void EdgeExpert::add_normals(Layers& layers, const Chi& chi, const MotionField& field) {
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (!to_normal_[c]) continue;
    const Vec2& x = chi.locations[c];
    Edge edge;
    edge.id = next_id_++;
    edge.location = edge.rotated = edge.predicted = x;
    edge.origin = field.origin(x);
    // V(0) = V_v; inside a trusted circle its depth is the better guess.
    if (chi.groups[c] >= 0 && parameters_.speed_rule == SpeedRule::trusted) {
      edge.depth_ratio = layers.collectors[chi.groups[c]].depth_ratio;
    }
    edge.speed = edge.depth_ratio * field.reference_speed(x);
    const Vec2 along = field.direction(x);
    edge.angle = angle_of(along.isZero() ? Vec2(x - camera_.centre_px) : along);
    edge.mu = parameters_.mu_0;
    edge.trust = parameters_.trust.initial_normal();
    edge.corner = chi.sources[c];
    layers.normal_edges.push_back(edge);
  }
}

void EdgeExpert::update(Layers& layers, const Chi& chi, const MotionField& field,
                        std::vector<Verdict>& verdicts) {
  corner_grid_.build(chi.locations, parameters_.mu_max);
  assign(layers, chi, field);

  const std::size_t normals = layers.normal_edges.size();
  for (std::size_t i = 0; i < normals; ++i) {
    Edge& edge = layers.normal_edges[i];
    ++edge.age;
    edge.corner = match_of_edge_[i];
    if (edge.corner < 0) continue;
    const Vec2& x = chi.locations[edge.corner];
    update_normal(edge, x, classify(edge, x, field), chi, field);
  }
  for (std::size_t i = 0; i < layers.rebel_edges.size(); ++i) {
    Edge& edge = layers.rebel_edges[i];
    ++edge.age;
    edge.corner = match_of_edge_[normals + i];
    if (edge.corner >= 0) update_rebel(edge, chi.locations[edge.corner], field);
  }
  classify_rest(layers, chi, field);
  // Sightings at one and the same time are no chain.
  if (field.dt_s() > 0 || layers.chains.empty()) grow_chains(layers, chi, field);

  for (auto* edges : {&layers.normal_edges, &layers.rebel_edges}) {
    for (Edge& edge : *edges) {
      if (edge.corner < 0) {
        coast(edge, layers.ignored);
        continue;
      }
      edge.corner = chi.sources[edge.corner];
      verdicts[edge.corner] = edge.rebel ? Verdict::rebel : Verdict::normal;
    }
    bury(*edges);
  }
  add_normals(layers, chi, field);
}

}  // namespace lcs
