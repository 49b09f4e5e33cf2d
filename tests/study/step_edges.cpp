#include "tests/study/step_edges.h"

#include <algorithm>
#include <cmath>

#include "filter/kinematics/geometry.h"
#include "filter/paper/estimate.h"
#include "filter/vectors/refill.h"

namespace lcs::study {

using paper::EdgeLayer;
using paper::estimate;
using paper::Xi;

namespace {

/// Below this displacement of the reference point a frame gives no depth of an edge.
constexpr double kLeastDisplacement_px = 0.2;

/// Deletes edges with trust below the critical rank, and edges outside of the picture.
void delete_lost(std::vector<Edge>& edges, const Intrinsics& camera, const TrustRanks& trust) {
  const Pixels picture{camera.width_px, camera.height_px};
  std::erase_if(edges, [&](const Edge& edge) {
    return !trust.alive(edge.trust) || !picture.contain(edge.location);
  });
}

/// Gives an edge the origin, speed and angle of a static point at its place and depth.
void move_as_static(Edge& edge, const Intrinsics& camera, const MotionField& field) {
  edge.origin = field.origin(edge.location);
  edge.speed = edge.depth_ratio * field.reference_speed(edge.location);
  const Vec2 along = field.direction(edge.location);
  edge.angle = angle_of(along.isZero() ? Vec2(edge.location - camera.centre_px) : along);
}

}  // namespace

// rule velocity
/// (2): the depth at the end of the frame, and its deviation.
void StepEdges::advance_depth(Edge& edge, const MotionField& field) {
  const double before = edge.depth_ratio;
  edge.depth_ratio = field.advanced_ratio(before);
  if (before > 0) edge.depth_ratio_sigma *= edge.depth_ratio * edge.depth_ratio / (before * before);
}

/// (12): a Kalman filter of the depth alone, by the residual along the motion.
/// \param step_px of a point with the depth ratio 1.
void StepEdges::see_depth(Edge& edge, double residual_px, double step_px,
                          const MotionField& field) const {
  const double variance = edge.depth_ratio_sigma * edge.depth_ratio_sigma;
  const double off_px = ours_.ego_share * edge.depth_ratio * step_px;
  const double noise2_px2 = 2 * ours_.noise_px * ours_.noise_px + off_px * off_px;
  const double gain = variance * step_px / (variance * step_px * step_px + noise2_px2);
  edge.depth_ratio = std::clamp(edge.depth_ratio + gain * residual_px, 0.0, field.max_ratio());
  edge.depth_ratio_sigma = std::sqrt(variance * (1 - gain * step_px));
}
// end of rule velocity

// rule gate
/// (6): variances of a corner about the prediction, along the motion and across, px^2.
Vec2 StepEdges::variance_px2(const Edge& edge, const MotionField& field) const {
  const double step_px = field.reference_speed(edge.rotated) * field.dt_s();
  const double by_depth_px = edge.depth_ratio_sigma * step_px;
  const double off_px = ours_.ego_share * edge.depth_ratio * step_px;
  const double noise2_px2 = 2 * ours_.noise_px * ours_.noise_px;
  return {noise2_px2 + by_depth_px * by_depth_px + off_px * off_px,
          noise2_px2 + 0.25 * off_px * off_px};
}

/// Square of the distance of a corner from the prediction, in deviations.
double StepEdges::distance2(const Edge& edge, const Vec2& x, const MotionField& field) const {
  const Vec2 flow = field.direction(edge.rotated), off = x - edge.predicted;
  const Vec2 along = flow.isZero() ? Vec2(1, 0) : flow, variance = variance_px2(edge, field);
  const double ahead = off.dot(along), across = cross(along, off);
  return ahead * ahead / variance.x() + across * across / variance.y();
}
// end of rule gate

// rule signatures
/// (7), ln B: of the signature of an earlier sighting and of a corner; absent if they are no pair,
/// 0 without signatures.
std::optional<double> StepEdges::likeness(const Signature* before, int corner,
                                          const Chi& chi) const {
  if (!rules_.signatures || chi.signatures.empty()) return 0.0;
  const int bits = lcs::distance(*before, chi.signatures[static_cast<std::size_t>(corner)]);
  if (bits > ours_.bits_even) return std::nullopt;
  return ours_.bits_weight * (ours_.bits_even - bits);
}

std::optional<double> StepEdges::likeness(Id edge, int corner, const Chi& chi) const {
  const auto found = look_of_edge_.find(edge);
  if (found == look_of_edge_.end()) return 0.0;
  return likeness(&found->second, corner, chi);
}

/// Keeps the signature of each edge's last sighting.
void StepEdges::remember(const BothKinds<Edge>& edges, const Chi& chi) {
  if (chi.signatures.empty()) return;
  std::unordered_map<int, std::size_t> of_source;
  for (std::size_t c = 0; c < chi.size(); ++c) of_source[chi.sources[c]] = c;
  std::unordered_map<Id, Signature> looks;
  for (const auto* kind : {&edges.normal, &edges.rebel}) {
    for (const Edge& edge : *kind) {
      looks[edge.id] =
          edge.corner >= 0 ? chi.signatures[of_source[edge.corner]] : look_of_edge_[edge.id];
    }
  }
  look_of_edge_ = std::move(looks);
}
// end of rule signatures

// rule coupling
/// (18), (19): the trust above Tr_c is taken for the log odds of an edge's own kind. A corner whose
/// edge is new tells nothing.
const BothKinds<Edge>& StepEdges::believed(const BothKinds<Edge>& edges, const Chi& chi,
                                           const MotionField& field) {
  around_.build(chi.locations, ours_.neighbour_reach_px, ours_.neighbours);
  const double noise2_px2 = ours_.noise_px * ours_.noise_px;
  nodes_.clear();
  std::unordered_map<int, std::size_t> of_source;
  for (std::size_t c = 0; c < chi.size(); ++c) {
    of_source[chi.sources[c]] = c;
    nodes_.push_back({chi.locations[c], 0, Vec2::Zero(), 2 * noise2_px2, false});
  }
  for (const auto* kind : {&edges.normal, &edges.rebel}) {
    for (const Edge& edge : *kind) {
      if (edge.corner < 0 || (edge.age == 0 && !edge.rebel)) continue;
      Coupling::Node& node = nodes_[of_source[edge.corner]];
      const double sure = edge.trust - trust_.critical;
      node.log_odds = edge.rebel ? sure : -sure;
      node.step_px = node.place_px - edge.rotated;
      node.tells = true;
    }
  }
  const std::vector<double>& beliefs = coupling_.settle(
      nodes_, around_, noise2_px2, std::min(ours_.coupling, ours_.most_log_odds(field.dt_s())));
  for (std::size_t c = 0; c < chi.size(); ++c) {
    result_.verdicts[c] = beliefs[c] > 0    ? Verdict::rebel
                          : nodes_[c].tells ? Verdict::normal
                                            : Verdict::pending;
  }
  believed_.normal.clear();
  believed_.rebel.clear();
  for (const auto* kind : {&edges.normal, &edges.rebel}) {
    for (Edge edge : *kind) {
      const std::size_t c = edge.corner >= 0 ? of_source[edge.corner] : chi.size();
      if (c < chi.size() && nodes_[c].tells && edge.rebel != (beliefs[c] > 0)) {
        edge.rebel = !edge.rebel;
        if (edge.rebel) {
          edge.origin = edge.rotated;
          edge.speed = field.dt_s() > 0 ? nodes_[c].step_px.norm() / field.dt_s() : 0;
          edge.angle = angle_of(nodes_[c].step_px);
        } else {
          move_as_static(edge, camera_, field);
        }
      }
      (edge.rebel ? believed_.rebel : believed_.normal).push_back(edge);
    }
  }
  return believed_;
}
// end of rule coupling

// rule two_sightings
/// Pairs of a corner seen once and a corner that no edge took, whose step is that of no static
/// point. By (13) each order of magnitude of a mover's speed is equally likely.
void StepEdges::find_seconds(const std::vector<Chain>& chains, const Chi& chi,
                             const MotionField& field) {
  const double noise2_px2 = 2 * ours_.noise_px * ours_.noise_px;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const Vec2& first = chains[i].sightings[0];
    corner_grid_.visit_within(first, parameters_.alpha_reach, [&](int corner, double distance2) {
      const std::optional<double> alike = likeness(&look_of_row_[i], corner, chi);
      if (!to_alpha_[corner] || !alike) return;
      const double off_px = off_field(first, chi.locations[corner], field);
      if (off_px * off_px <= kFar * kFar * noise2_px2) return;
      pairs_.push_back({std::log(distance2 + noise2_px2) - *alike, static_cast<int>(i), corner});
    });
  }
}
// end of rule two_sightings

void StepEdges::assign_one_to_one(std::size_t edges, std::size_t corners) {
  refill(match_of_edge_, edges, -1);
  refill(match_of_corner_, corners, -1);
  if (pairs_.empty()) return;
  const auto [least, most] = std::ranges::minmax(pairs_, {}, &Couple::cost);
  sorter_.sort(pairs_, most.cost, least.cost);
  for (const Couple& pair : pairs_) {
    if (match_of_edge_[pair.a] >= 0 || match_of_corner_[pair.b] >= 0) continue;
    match_of_edge_[pair.a] = pair.b;
    match_of_corner_[pair.b] = pair.a;
  }
}

void StepEdges::coast(Edge& edge, std::span<const IgnoreRegion> psi) const {
  edge.corner = -1;
  edge.location = edge.predicted;
  if (!inside_any(psi, edge.predicted)) --edge.trust;
}

Edge StepEdges::make_normal(const Vec2& x, double mu, const MotionField& field) {
  Edge edge;
  edge.id = next_id_++;
  edge.location = edge.rotated = edge.predicted = x;
  edge.depth_ratio = 1;
  if (rules_.velocity) edge.depth_ratio_sigma = 0.5 * field.max_ratio();
  move_as_static(edge, camera_, field);
  edge.mu = mu;
  edge.trust = trust_.initial_normal();
  return edge;
}

void StepEdges::predict(EdgeLayer& layer, const MotionField& field) const {
  for (Edge& edge : layer.edges.normal) {
    edge.rotated = field.rotated(edge.location);
    // V~ = (V + V_v) / 2; no depth information while the camera stands still.
    if (rules_.velocity) {
      advance_depth(edge, field);
    } else if (field.moving()) {
      edge.depth_ratio = 0.5 * (edge.depth_ratio + 1);
    }
    edge.predicted = field.translated(edge.rotated, edge.depth_ratio);
    edge.origin = field.origin(edge.predicted);
    edge.speed = edge.depth_ratio * field.reference_speed(edge.rotated);
    const Vec2 along = field.direction(edge.predicted);
    if (!along.isZero()) edge.angle = angle_of(along);
    if (rules_.gate) {
      const double sigma_px = std::sqrt(variance_px2(edge, field).maxCoeff());
      edge.mu = std::min(kFar * sigma_px, parameters_.mu_max);
    }
  }
  for (Edge& edge : layer.edges.rebel) {
    edge.rotated = field.rotated(edge.location);
    edge.origin = field.rotated(edge.origin);
    const Vec2 path = edge.rotated - edge.origin;
    if (!path.isZero()) edge.angle = angle_of(path);
    edge.predicted = edge.rotated + edge.speed * field.dt_s() * unit_vector(edge.angle);
  }
  for (Chain& chain : layer.chains) {
    for (int i = 0; i < chain.count; ++i) chain.sightings[i] = field.rotated(chain.sightings[i]);
  }
}

bool StepEdges::in_span(const Edge& edge, const Vec2& x, const MotionField& field) const {
  if (field.direction(edge.rotated).isZero()) {
    return (x - edge.predicted).norm() <= parameters_.corner_noise;
  }
  // The corridor widens with the distance from O_I. It stops widening at half a diagonal, as it
  // would accept everything for an FOE far outside of the image.
  const Vec2 axis = (edge.predicted - edge.origin).normalized();
  const Vec2 ray = x - edge.origin;
  const double reach = std::min(ray.norm(), 0.5 * std::hypot(camera_.width_px, camera_.height_px));
  return ray.dot(axis) >= -parameters_.corner_noise &&
         std::abs(cross(axis, ray)) <=
             reach * std::sin(parameters_.delta_v) + parameters_.corner_noise;
}

bool StepEdges::plausible_speed(const Edge& edge, const Vec2& x, const MotionField& field) const {
  const double advance = (x - edge.rotated).dot(field.direction(edge.rotated));
  const double fastest = field.max_ratio() * field.reference_speed(edge.rotated) * field.dt_s();
  return advance >= -parameters_.corner_noise && advance <= fastest + parameters_.corner_noise;
}

Xi StepEdges::classify(const Edge& edge, const Vec2& x, const MotionField& field) const {
  if (rules_.gate) {
    if (distance2(edge, x, field) > kFar * kFar) return Xi::five;
    return plausible_speed(edge, x, field) ? Xi::two : Xi::four;
  }
  if (!in_span(edge, x, field)) return Xi::five;
  if (!plausible_speed(edge, x, field)) return Xi::four;
  const Vec2 residual = x - edge.predicted;
  if (residual.norm() > edge.mu) return Xi::one;
  const double ahead = residual.dot(field.direction(edge.rotated));
  return ahead >= -parameters_.corner_noise ? Xi::two : Xi::three;
}

double StepEdges::rebel_reach(const Edge& edge, const MotionField& field) const {
  return std::max(2 * parameters_.corner_noise,
                  parameters_.rebel_reach * edge.speed * field.dt_s());
}

/// zeta_r: near the prediction, and within delta_v plus mu_r of its direction from its origin.
bool StepEdges::matches_rebel(const Edge& edge, const Vec2& x, const MotionField& field) const {
  if ((x - edge.predicted).norm() > rebel_reach(edge, field)) return false;
  const Vec2 ray = x - edge.origin;
  const double span = std::min(parameters_.delta_v + edge.mu, kPi / 2);
  return std::abs(cross(unit_vector(edge.angle), ray)) <=
         std::max(2 * parameters_.corner_noise, ray.norm() * std::sin(span));
}

/// Records the most advanced test among all rejections of a corner.
void StepEdges::came_to(int corner, Reason reason) {
  result_.reasons[corner] = std::max(result_.reasons[corner], reason);
}

void StepEdges::assign(const BothKinds<Edge>& edges, const Chi& chi, const MotionField& field) {
  const auto& [normal_edges, rebel_edges] = edges;
  const int normals = static_cast<int>(normal_edges.size());
  const int rebels = static_cast<int>(rebel_edges.size());
  const auto cost = [&](const Edge& edge, double distance2) {
    return std::sqrt(distance2) - parameters_.trust_bonus * (edge.trust - trust_.critical);
  };
  pairs_.clear();
  result_.reasons.assign(chi.size(), Reason::alpha_first);
  for (int i = 0; i < normals; ++i) {
    const Edge& edge = normal_edges[i];
    corner_grid_.visit_within(edge.predicted, edge.mu, [&](int corner, double distance2) {
      const Xi xi = classify(edge, chi.locations[corner], field);
      double base = cost(edge, distance2);
      if (rules_.signatures) {
        const std::optional<double> alike = likeness(edge.id, corner, chi);
        if (!alike) return;
        base = 0.5 * this->distance2(edge, chi.locations[corner], field) - *alike;
      }
      if (xi == Xi::two) pairs_.push_back({base, i, corner});
      if (xi == Xi::three) pairs_.push_back({base + parameters_.corner_noise, i, corner});
      came_to(corner, xi == Xi::five   ? Reason::xi_5
                      : xi == Xi::four ? Reason::xi_4
                                       : Reason::outbid);
    });
  }
  for (int i = 0; i < rebels; ++i) {
    const Edge& edge = rebel_edges[i];
    const double reach = rebel_reach(edge, field);
    corner_grid_.visit_within(edge.predicted, reach, [&](int corner, double distance2) {
      if (!matches_rebel(edge, chi.locations[corner], field)) return;
      double base = cost(edge, distance2);
      if (rules_.signatures) {
        const std::optional<double> alike = likeness(edge.id, corner, chi);
        if (!alike) return;
        base = 0.5 * kFar * kFar * distance2 / (reach * reach) - *alike;
      }
      pairs_.push_back({base, normals + i, corner});
      came_to(corner, Reason::outbid);
    });
  }
  assign_one_to_one(normal_edges.size() + rebel_edges.size(), chi.size());
}

/// Cor of x and y of the group, 1 - rho^2: small if the corners near the prediction lie on a line.
/// 1 for fewer than three, which have no correlation.
double StepEdges::spread(const Edge& edge, const Chi& chi, std::span<const int> groups) const {
  double n = 0, xx = 0, yy = 0, xy = 0;
  Vec2 sum = Vec2::Zero();
  corner_grid_.visit_within(edge.predicted, edge.mu, [&](int other, double) {
    if (groups[other] != groups[edge.corner]) return;
    const Vec2 d = chi.locations[other] - edge.predicted;
    n += 1;
    sum += d;
    xx += d.x() * d.x();
    yy += d.y() * d.y();
    xy += d.x() * d.y();
  });
  if (n < 3) return 1;
  const double product = (xx - sum.x() * sum.x() / n) * (yy - sum.y() * sum.y() / n);
  const double covariance = xy - sum.x() * sum.y() / n;
  return product > 0 ? std::clamp(1 - covariance * covariance / product, 0.0, 1.0) : 0.0;
}

void StepEdges::update_normal(Edge& edge, const Chi& chi, std::span<const int> groups,
                              const MotionField& field) {
  const Vec2& x = chi.locations[edge.corner];
  const Xi xi = classify(edge, x, field);
  const double reference_step = field.reference_speed(edge.rotated) * field.dt_s();
  // mu^ = ( |V_v - V~| t_f / Cor + mu ) / 2, with a length in place of the printed speed.
  if (!rules_.gate) {
    const double off_reference = std::abs(1 - edge.depth_ratio) * reference_step;
    edge.mu =
        std::clamp(0.5 * (off_reference / std::max(spread(edge, chi, groups), 1e-3) + edge.mu),
                   parameters_.mu_min, parameters_.mu_max);
  }
  // V^ = |V~ +- residual / t_f|, signed along the direction of motion.
  if (reference_step > kLeastDisplacement_px) {
    const double residual = (x - edge.predicted).dot(field.direction(edge.rotated));
    if (rules_.velocity) {
      see_depth(edge, residual, reference_step, field);
    } else {
      edge.depth_ratio =
          std::min(std::abs(edge.depth_ratio + residual / reference_step), 2 * field.max_ratio());
    }
  }
  edge.location = estimate(edge.trust, trust_, edge.predicted, x);
  edge.speed = edge.depth_ratio * field.reference_speed(edge.location);
  const Vec2 along = field.direction(edge.location);
  if (!along.isZero()) edge.angle = angle_of(along);
  edge.trust = xi == Xi::two ? trust_.raised(edge.trust) : edge.trust - 1;
  result_.reasons[edge.corner] = xi == Xi::two ? Reason::xi_2 : Reason::xi_3;
}

void StepEdges::update_rebel(Edge& edge, const Vec2& x, const MotionField& field) {
  if (field.dt_s() > 0) {
    const double residual = (x - edge.predicted).dot(unit_vector(edge.angle));
    edge.speed = std::abs(edge.speed + residual / field.dt_s());
  }
  edge.location = estimate(edge.trust, trust_, edge.predicted, x);
  // mu^_r = |beta~ - beta^|, where beta~ is the direction from the origin to the corner.
  edge.mu = std::min(angle_between(angle_of(x - edge.origin), edge.angle), kPi / 4);
  const Vec2 path = edge.location - edge.origin;
  if (!path.isZero()) edge.angle = angle_of(path);
  edge.trust = trust_.raised(edge.trust);
  result_.reasons[edge.corner] = Reason::rebel_edge;
}

/// Starts a new normal edge at each corner that no edge took. The corner also goes to alpha, except
/// in case xi_1: there it joins the layer of a normal edge that lost its own corner.
void StepEdges::classify_rest(const std::vector<Edge>& normal_edges, const Chi& chi,
                              const MotionField& field) {
  to_alpha_.assign(chi.size(), 0);
  to_normal_.assign(chi.size(), 0);
  predictions_.clear();
  for (const Edge& edge : normal_edges) predictions_.push_back(edge.predicted);
  edge_grid_.build(predictions_, parameters_.mu_0);
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (match_of_corner_[c] >= 0) continue;
    bool further = false;
    edge_grid_.visit_within(chi.locations[c], parameters_.mu_0, [&](int e, double) {
      if (rules_.gate) return;
      further = further || (match_of_edge_[e] < 0 &&
                            classify(normal_edges[e], chi.locations[c], field) == Xi::one);
    });
    to_normal_[c] = 1;
    to_alpha_[c] = !further;
    if (further) result_.reasons[c] = Reason::xi_1;
  }
}

/// px: distance of a step between two sightings, rotation removed, from the steps of static points
/// at any plausible depth.
double StepEdges::off_field(const Vec2& from, const Vec2& to, const MotionField& field) const {
  return distance_to_segment(to, from, field.translated(from, field.max_ratio()));
}

/// The initial values of a rebel edge, from its three sightings.
Edge StepEdges::make_rebel(const Chain& chain, const Vec2& x, const MotionField& field) {
  const Vec2& first = chain.sightings[0];
  const Vec2& second = chain.sightings[chain.count == 2 ? 1 : 0];
  Edge edge;
  edge.id = next_id_++;
  edge.rebel = true;
  edge.location = edge.predicted = x;
  edge.rotated = second;
  edge.origin = first;
  edge.speed = (x - second).norm() / field.dt_s();
  edge.angle = angle_of(x - first);
  edge.mu = chain.count == 2 ? angle_between(edge.angle, angle_of(second - first)) : 0;
  edge.trust = trust_.initial_rebel();
  return edge;
}

/// Extends rows of two sightings by a third, near their line and off the field, to rebel edges: at
/// most one row per corner and per shared sighting.
void StepEdges::complete_chains(EdgeLayer& layer, const Chi& chi, const MotionField& field) {
  const std::vector<Chain>& chains = layer.chains;
  std::vector<Edge>& rebels = layer.edges.rebel;
  pairs_.clear();
  if (rules_.two_sightings) find_seconds(chains, chi, field);
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const Chain& chain = chains[i];
    if (chain.count != 2) continue;
    const Vec2 step = chain.sightings[1] - chain.sightings[0];
    const double reach =
        std::max(2 * parameters_.corner_noise, parameters_.alpha_stretch * step.norm());
    corner_grid_.visit_within(chain.sightings[1] + step, reach, [&](int corner, double distance2) {
      if (!to_alpha_[corner]) return;
      if (!likeness(&look_of_row_[i], corner, chi)) return;
      const Vec2& x = chi.locations[corner];
      const Vec2 path = x - chain.sightings[0];
      const double bend = angle_between(angle_of(path), angle_of(step));
      const double deviation = path.norm() * std::sin(std::min(bend, kPi / 2));
      came_to(corner, Reason::alpha_bend);
      if (bend > parameters_.alpha_deviation && deviation > parameters_.corner_noise) return;
      came_to(corner, Reason::alpha_on_field);
      const double off = chain.off_field_px + off_field(chain.sightings[1], x, field);
      if (off < 2 * parameters_.corner_noise) return;
      came_to(corner, Reason::alpha_taken);
      pairs_.push_back({distance2, static_cast<int>(i), corner});
    });
  }
  std::sort(pairs_.begin(), pairs_.end());
  std::vector<Vec2> used;
  for (const auto& [distance2, row, corner] : pairs_) {
    const Chain& chain = chains[row];
    if (!to_alpha_[corner] || std::ranges::find(used, chain.sightings[1]) != used.end()) {
      continue;
    }
    used.push_back(chain.sightings[1]);
    rebels.push_back(make_rebel(chain, chi.locations[corner], field));
    rebels.back().corner = corner;
    to_alpha_[corner] = to_normal_[corner] = 0;
    result_.reasons[corner] = Reason::alpha_third;
  }
}

/// Extends rows of one sighting to rows of two; the remaining corners start new rows. A row without
/// a continuation is deleted, so a row lasts at most three frames.
void StepEdges::branch_chains(std::vector<Chain>& chains, const Chi& chi,
                              const MotionField& field) {
  grown_.clear();
  grown_looks_.clear();
  const auto look_at = [&](int corner) {
    return chi.signatures.empty() ? Signature{} : chi.signatures[static_cast<std::size_t>(corner)];
  };
  for (std::size_t row = 0; row < chains.size() && !rules_.two_sightings; ++row) {
    const Chain& chain = chains[row];
    if (chain.count != 1) continue;
    const auto accept = [&](int corner) {
      return to_alpha_[corner] != 0 && likeness(&look_of_row_[row], corner, chi);
    };
    corner_grid_.nearest(chain.sightings[0], parameters_.alpha_reach,
                         std::size_t(parameters_.alpha_branches), accept, near_);
    for (const Neighbour& branch : near_) {
      came_to(branch.index, Reason::alpha_second);
      Chain longer = chain;
      longer.sightings[1] = chi.locations[branch.index];
      longer.count = 2;
      longer.off_field_px = off_field(longer.sightings[0], longer.sightings[1], field);
      grown_.push_back(longer);
      grown_looks_.push_back(look_at(branch.index));
    }
  }
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (!to_alpha_[c]) continue;
    grown_.push_back({.sightings = {chi.locations[c], chi.locations[c]}, .count = 1});
    grown_looks_.push_back(look_at(static_cast<int>(c)));
  }
  chains.swap(grown_);
  look_of_row_.swap(grown_looks_);
}

const paper::PaperEdges::Result& StepEdges::update(EdgeLayer& layer, const Chi& chi,
                                                   std::span<const int> groups,
                                                   std::span<const IgnoreRegion> psi,
                                                   const MotionField& field) {
  auto& [edges, chains] = layer;
  if (edges.normal.empty() && edges.rebel.empty()) look_of_edge_.clear();
  look_of_row_.resize(chains.size());
  corner_grid_.build(chi.locations, parameters_.mu_max);
  assign(edges, chi, field);

  const std::size_t normals = edges.normal.size();
  for (std::size_t i = 0; i < normals; ++i) {
    Edge& edge = edges.normal[i];
    ++edge.age;
    edge.corner = match_of_edge_[i];
    if (edge.corner >= 0) update_normal(edge, chi, groups, field);
  }
  for (std::size_t i = 0; i < edges.rebel.size(); ++i) {
    Edge& edge = edges.rebel[i];
    ++edge.age;
    edge.corner = match_of_edge_[normals + i];
    if (edge.corner >= 0) update_rebel(edge, chi.locations[edge.corner], field);
  }
  classify_rest(edges.normal, chi, field);
  // Sightings at the same time form no chain.
  if (field.dt_s() > 0) complete_chains(layer, chi, field);
  if (field.dt_s() > 0 || chains.empty()) {
    branch_chains(chains, chi, field);
  } else {
    for (std::size_t c = 0; c < chi.size(); ++c) {
      if (to_alpha_[c]) result_.reasons[c] = Reason::no_time;
    }
  }

  refill(result_.verdicts, chi.size(), Verdict::pending);
  for (auto* kind : {&edges.normal, &edges.rebel}) {
    for (Edge& edge : *kind) {
      if (edge.corner < 0) {
        coast(edge, psi);
        continue;
      }
      result_.verdicts[edge.corner] = edge.rebel ? Verdict::rebel : Verdict::normal;
      edge.corner = chi.sources[edge.corner];
    }
    delete_lost(*kind, camera_, trust_);
  }
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (!to_normal_[c]) continue;
    // V(0) = V_v.
    edges.normal.push_back(make_normal(chi.locations[c], parameters_.mu_0, field));
    edges.normal.back().corner = chi.sources[c];
  }
  if (rules_.signatures) remember(edges, chi);
  return result_;
}

}  // namespace lcs::study
