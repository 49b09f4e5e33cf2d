#include "filter/constellation_edges.h"

#include <algorithm>
#include <cmath>

#include "filter/geometry.h"

namespace lcs {
namespace {

/// How far behind a rebel its origin is kept, in steps, so that beta is its direction of now.
constexpr double kOriginSteps = 5;

/// Changes of size between frames that neighbours may agree on (an approaching object grows).
constexpr std::array<double, 5> kScales = {1.0, 1.04, 1.1, 1.2, 0.94};

/// Points looked at along a static path, at the most, and how far apart they lie, px.
constexpr int kMaxDepths = 60;
constexpr double kDepthSpacing_px = 1.5;

/// The middle value, of an even number the mean of the middle two, so that -x has the median -m.
double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// A static residual beyond this says that a rebel's motion cannot be static, px; more than
/// kFullResidual_px says no more.
constexpr double kOffField_px = 1.0, kFullResidual_px = 6.0;

}  // namespace

ConstellationEdges::ConstellationEdges(const Intrinsics& camera, const CircleParameters& parameters)
    : EdgeExpert(camera, parameters.trust),
      parameters_(parameters),
      past_{Past(camera), Past(camera)} {}

void ConstellationEdges::predict(Layers& layers, const MotionField& field) {
  for (Edge& edge : layers.normal_edges) {
    edge.rotated = field.rotated(edge.location);
    if (field.moving()) edge.depth_ratio = field.advanced_ratio(edge.depth_ratio);
    edge.predicted = field.translated(edge.rotated, edge.depth_ratio);
    edge.origin = field.origin(edge.predicted);
    predict_path(edge, field);
    edge.speed = edge.depth_ratio * field.reference_speed(edge.rotated);
  }
  for (Edge& edge : layers.rebel_edges) {
    edge.rotated = field.rotated(edge.location);
    edge.origin = field.rotated(edge.origin);
    const Vec2 path = edge.rotated - edge.origin;
    if (!path.isZero()) edge.angle = angle_of(path);
    edge.predicted = edge.rotated + edge.velocity() * field.dt_s();
  }
  for (int i = 0; i < remembered_; ++i) {
    for (Vec2& x : past_[i].corners) x = field.rotated(x);
    past_[i].displacement_C_m =
        field.R_cur_prev() * past_[i].displacement_C_m + field.displacement_C_m();
  }
}

void ConstellationEdges::remember(const Chi& chi) {
  std::swap(past_[0], past_[1]);
  past_[0].corners = chi.locations;
  past_[0].displacement_C_m.setZero();
  remembered_ = std::min(remembered_ + 1, 2);
}

void ConstellationEdges::assign(const Layers& layers, const Chi& chi, const MotionField& field) {
  const ConstellationParameters& p = parameters_.constellation;
  pairs_.clear();
  const auto gate = [&](const Edge& edge, int index, const Vec2& axis, double along,
                        double across) {
    corner_grid_.visit_within(edge.predicted, std::max(along, across), [&](int corner, double) {
      const Vec2 residual = chi.locations[corner] - edge.predicted;
      const double a = residual.dot(axis) / along, b = cross(axis, residual) / across;
      // Where there is no direction the gate is a disc.
      const double fit = axis.isZero() ? residual.squaredNorm() / (across * across) : a * a + b * b;
      if (fit > 1) return;
      const double bonus = 0.08 * (edge.trust - trust_.standard);
      pairs_.push_back({fit - bonus, index, corner});
    });
  };
  const int normals = static_cast<int>(layers.normal_edges.size());
  for (int i = 0; i < normals; ++i) {
    const Edge& edge = layers.normal_edges[i];
    const double length = (edge.predicted - edge.rotated).norm();
    const double base = edge.trust >= p.established ? p.normal_along : 1.6 * p.normal_along;
    gate(edge, i, field.direction(edge.rotated), base + p.normal_along_growth * length,
         p.normal_across);
  }
  for (std::size_t i = 0; i < layers.rebel_edges.size(); ++i) {
    const Edge& edge = layers.rebel_edges[i];
    const double length = (edge.predicted - edge.rotated).norm();
    const double base = std::min(p.rebel_gate_max, p.rebel_gate + p.rebel_growth * length);
    gate(edge, normals + static_cast<int>(i), unit_vector(edge.angle), base + 0.08 * length,
         base + 0.04 * length);
  }
  assign_one_to_one(layers.normal_edges.size() + layers.rebel_edges.size(), chi.size());
}

void ConstellationEdges::update_normal(Edge& edge, const Vec2& x, const MotionField& field) const {
  if (field.moving()) {
    const double measured = field.ratio_from(x, edge.rotated, field.displacement_C_m());
    edge.depth_ratio =
        estimate(std::max(edge.trust, trust_.critical + 1), trust_, edge.depth_ratio, measured);
  }
  measure_path(edge, x, field);
  edge.location = (edge.predicted + 2 * x) / 3;
  edge.speed = edge.depth_ratio * field.reference_speed(edge.location);
  const Vec2 along = field.direction(edge.location);
  if (!along.isZero()) edge.angle = angle_of(along);
  edge.trust = trust_.raised(edge.trust);
}

void ConstellationEdges::set_velocity(Edge& edge, const Vec2& velocity_pxps, double dt_s) const {
  edge.speed = velocity_pxps.norm();
  if (edge.speed > 0) edge.angle = angle_of(velocity_pxps);
  edge.origin = edge.location - kOriginSteps * dt_s * velocity_pxps;
}

/// By how much a step leaves the images that a static point at any plausible depth may take, px.
double ConstellationEdges::off_field(const Vec2& x, const Vec2& before,
                                     const MotionField& field) const {
  return distance_to_segment(before, x,
                             field.earlier(x, field.max_ratio(), field.displacement_C_m()));
}

void ConstellationEdges::update_rebel(Edge& edge, const Vec2& x, const MotionField& field) const {
  const Vec2 step = x - edge.rotated;
  const double weight = std::clamp(edge.trust - trust_.critical, 1, step.norm() < 6 ? 3 : 2);
  const Vec2 velocity = (weight * edge.velocity() + step / field.dt_s()) / (weight + 1);
  const double off = off_field(x, x - velocity * field.dt_s(), field);
  edge.off_field_px = 0.5 * edge.off_field_px + 0.5 * std::min(off, kFullResidual_px);
  edge.location = x;
  edge.mu = angle_between(angle_of(step), edge.angle);
  set_velocity(edge, velocity, field.dt_s());
  edge.trust = trust_.raised(edge.trust);
}

/// Corners that no edge took, or only a normal edge too young to be believed.
void ConstellationEdges::find_residuals(const Layers& layers, const Chi& chi) {
  candidates_.assign(chi.size(), {});
  links_.assign(chi.size(), {});
  reasons_.assign(chi.size(), remembered_ < 2 ? Reason::no_past : Reason::no_time);
  const int normals = static_cast<int>(layers.normal_edges.size());
  for (std::size_t c = 0; c < chi.size(); ++c) {
    const int edge = match_of_corner_[c];
    if (edge < 0) {
      candidates_[c].residual = true;
    } else if (edge < normals) {
      links_[c] = {Kind::normal, edge};
      reasons_[c] = Reason::normal_edge;
      candidates_[c].residual =
          layers.normal_edges[edge].trust < parameters_.constellation.established;
    } else {
      links_[c] = {Kind::rebel, edge - normals};
    }
  }
}

int ConstellationEdges::static_hits(const Vec2& x, double depth_ratio,
                                    const MotionField& field) const {
  const Vec2 once = field.earlier(x, depth_ratio, past_[0].displacement_C_m);
  if (past_[0].map.at(once) < 0) return 0;
  const Vec2 twice = field.earlier(x, depth_ratio, past_[1].displacement_C_m);
  return past_[1].map.at(twice) < 0 ? 1 : 2;
}

/// Sweeps the depth of each residual corner, from infinity to the nearest.
void ConstellationEdges::seek_static_past(const Chi& chi, const MotionField& field) {
  for (std::size_t c = 0; c < chi.size(); ++c) {
    Candidate& candidate = candidates_[c];
    if (!candidate.residual) continue;
    const Vec2& x = chi.locations[c];
    const double length =
        (field.earlier(x, field.max_ratio(), past_[1].displacement_C_m) - x).norm();
    const int depths = std::min(kMaxDepths, 1 + static_cast<int>(length / kDepthSpacing_px));
    for (int i = 0; i <= depths; ++i) {
      const double ratio = field.max_ratio() * i / depths;
      const int hits = static_hits(x, ratio, field);
      if (hits > candidate.static_hits) {
        candidate.static_hits = hits;
        candidate.static_ratio = ratio;
      }
    }
  }
}

/// Votes for the displacement from `before` to x at a change of size by `scale`: for each voter,
/// whether it has a predecessor at its place in the displaced constellation, and that one another.
/// Gives up when it can no longer beat `best`.
int ConstellationEdges::count_votes(const Chi& chi, const Vec2& x, const Vec2& before, double scale,
                                    int own, int best) const {
  int votes = own;
  int left = static_cast<int>(voters_.size());
  for (const int voter : voters_) {
    if (votes + 2 * left < best) return votes;
    --left;
    const Vec2& y = chi.locations[voter];
    const int once = past_[0].map.at(before + (y - x) / scale);
    if (once < 0) continue;
    ++votes;
    const Vec2& y_before = past_[0].corners[once];
    if (past_[1].map.at(y_before - (y - y_before) / scale) >= 0) ++votes;
  }
  return votes;
}

/// Sets the displacement that the neighbours of a corner agree on, if any. \return `voted`, or what
/// speaks against it.
Reason ConstellationEdges::vote_on(std::size_t corner, const Chi& chi, const MotionField& field) {
  const ConstellationParameters& p = parameters_.constellation;
  const Vec2& x = chi.locations[corner];
  near_.clear();
  corner_grid_.visit_within(x, p.radius, [&](int other, double distance2) {
    const bool undecided = candidates_[other].residual || links_[other].kind == Kind::rebel;
    if (other != static_cast<int>(corner) && undecided) near_.emplace_back(distance2, other);
  });
  std::sort(near_.begin(), near_.end());
  if (near_.size() > static_cast<std::size_t>(p.neighbours)) near_.resize(p.neighbours);
  if (near_.size() < 2) return Reason::few_neighbours;
  voters_.clear();
  int static_votes = candidates_[corner].static_hits;
  for (const auto& [distance2, other] : near_) {
    voters_.push_back(other);
    static_votes += candidates_[other].static_hits;
  }

  int best = 0;
  Vec2 best_step = Vec2::Zero();
  const double reach = std::max(p.max_step, p.max_speed * field.dt_s());
  past_grid_.visit_within(x, reach, [&](int predecessor, double) {
    const Vec2& before = past_[0].corners[predecessor];
    const Vec2 step = x - before;
    const int own = past_[1].map.at(before - step) >= 0 ? 2 : 1;
    for (const double scale : kScales) {
      const int votes = count_votes(chi, x, before, scale, own, best);
      // Of equal motions the slower one, so that the order of the search does not matter.
      if (votes > best || (votes == best && step.squaredNorm() < best_step.squaredNorm())) {
        best = votes;
        best_step = step;
      }
    }
  });
  const double all = 2.0 * static_cast<double>(voters_.size() + 1);
  candidates_[corner].step = best_step;
  if (!(best >= p.vote_floor * all)) return Reason::vote_floor;
  if (!(best >= static_votes + p.vote_margin * all)) return Reason::static_wins;
  if (!(off_field(x, x - best_step, field) > p.off_field)) return Reason::vote_on_field;
  return Reason::voted;
}

void ConstellationEdges::vote(const Chi& chi, const MotionField& field) {
  past_grid_.build(past_[0].corners, 16);
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (!candidates_[c].residual) continue;
    reasons_[c] = vote_on(c, chi, field);
    candidates_[c].voted = reasons_[c] == Reason::voted;
  }
}

Edge ConstellationEdges::make_rebel(const Vec2& x, const Vec2& velocity_pxps, double dt_s) {
  Edge edge;
  edge.id = next_id();
  edge.rebel = true;
  edge.location = edge.predicted = x;
  edge.rotated = x - velocity_pxps * dt_s;
  set_velocity(edge, velocity_pxps, dt_s);
  edge.off_field_px = 3;
  edge.trust = trust_.initial_rebel();
  return edge;
}

void ConstellationEdges::make_edges(Layers& layers, const Chi& chi, const MotionField& field) {
  for (std::size_t c = 0; c < chi.size(); ++c) {
    const Candidate& candidate = candidates_[c];
    const Vec2& x = chi.locations[c];
    if (candidate.voted) {
      // The young normal edge that had the corner was wrong about it.
      if (links_[c].kind == Kind::normal) layers.normal_edges[links_[c].index].trust = 0;
      if (links_[c].kind == Kind::normal) layers.normal_edges[links_[c].index].corner = -1;
      links_[c] = {Kind::rebel, static_cast<int>(layers.rebel_edges.size())};
      layers.rebel_edges.push_back(make_rebel(x, candidate.step / field.dt_s(), field.dt_s()));
      layers.rebel_edges.back().corner = static_cast<int>(c);
    } else if (candidate.residual && links_[c].kind == Kind::none && candidate.static_hits >= 2) {
      links_[c] = {Kind::normal, static_cast<int>(layers.normal_edges.size())};
      layers.normal_edges.push_back(
          make_normal(x, candidate.static_ratio, parameters_.constellation.normal_along, field));
      layers.normal_edges.back().corner = static_cast<int>(c);
    }
  }
}

/// Rebels near each other that move alike, and of which enough move as no static point does, bear
/// each other out. Those that do not hold together lose trust.
void ConstellationEdges::support(Layers& layers, const MotionField& field) {
  const ConstellationParameters& p = parameters_.constellation;
  std::vector<Edge>& rebels = layers.rebel_edges;
  points_.clear();
  for (const Edge& edge : rebels) points_.push_back(edge.location);
  rebel_grid_.build(points_, p.radius);
  borne_out_.assign(rebels.size(), 0);
  support_.assign(rebels.size(), Reason::rebel_alone);

  // Connected components of like velocity.
  component_.resize(rebels.size());
  for (std::size_t i = 0; i < rebels.size(); ++i) component_[i] = static_cast<int>(i);
  const auto root = [&](int i) {
    while (component_[i] != i) i = component_[i] = component_[component_[i]];
    return i;
  };
  for (std::size_t i = 0; i < rebels.size(); ++i) {
    if (!trust_.alive(rebels[i].trust)) continue;
    rebel_grid_.visit_within(rebels[i].location, p.radius, [&](int j, double) {
      if (j <= static_cast<int>(i) || !trust_.alive(rebels[j].trust)) return;
      const double difference = (rebels[i].velocity() - rebels[j].velocity()).norm() * field.dt_s();
      const double mean = 0.5 * (rebels[i].speed + rebels[j].speed) * field.dt_s();
      if (difference < std::max(1.0, 0.2 * mean)) component_[root(j)] = root(static_cast<int>(i));
    });
  }
  std::vector<int> size(rebels.size(), 0);
  for (std::size_t i = 0; i < rebels.size(); ++i) ++size[root(static_cast<int>(i))];

  std::vector<char> stray(rebels.size(), 0);
  for (std::size_t i = 0; i < rebels.size(); ++i) {
    if (!trust_.alive(rebels[i].trust) || size[root(static_cast<int>(i))] < p.support) continue;
    int near = 0, off = 0;
    rebel_grid_.visit_within(rebels[i].location, p.radius, [&](int j, double) {
      if (root(j) != root(static_cast<int>(i)) || !trust_.alive(rebels[j].trust)) return;
      ++near;
      off += rebels[j].off_field_px > kOffField_px;
    });
    const bool moves = off >= p.support_off_field * near;
    borne_out_[i] = near >= p.support && moves;
    if (near >= p.support && !moves) support_[i] = Reason::rebel_on_field;
    stray[i] = !moves && rebels[i].age >= 2;
  }
  for (std::size_t i = 0; i < rebels.size(); ++i) {
    if (stray[i]) rebels[i].trust -= 2;
  }
  for (std::size_t i = 0; i < rebels.size(); ++i) component_[i] = root(static_cast<int>(i));
  smooth(rebels, field.dt_s());
}

/// Corners of rebel edges are rebels where these are borne out.
void ConstellationEdges::settle_rebels() {
  for (std::size_t c = 0; c < links_.size(); ++c) {
    if (links_[c].kind != Kind::rebel) continue;
    called_[c] = borne_out_[links_[c].index];
    if (!called_[c]) {
      reasons_[c] = support_[links_[c].index];
    } else if (!candidates_[c].voted) {
      reasons_[c] = Reason::rebel_edge;
    }
  }
}

/// A shift and a change of size are fitted to the velocities of each component, and pull them; an
/// edge that is far off the fit loses trust.
void ConstellationEdges::smooth(std::vector<Edge>& rebels, double dt_s) {
  std::vector<std::vector<std::size_t>> members(rebels.size());
  for (std::size_t i = 0; i < rebels.size(); ++i) {
    if (trust_.alive(rebels[i].trust)) members[component_[i]].push_back(i);
  }
  std::vector<double> vx, vy;
  for (const auto& group : members) {
    if (group.size() < 4) continue;
    vx.clear();
    vy.clear();
    Vec2 centre = Vec2::Zero();
    for (const std::size_t i : group) {
      const Vec2 step = rebels[i].velocity() * dt_s;
      centre += rebels[i].location;
      vx.push_back(step.x());
      vy.push_back(step.y());
    }
    centre /= static_cast<double>(group.size());
    const Vec2 shift(median(vx), median(vy));
    const double tolerance = 3 + 0.3 * shift.norm();
    double growth = 0;
    if (group.size() >= 5) {
      double numerator = 0, denominator = 1;
      for (const std::size_t i : group) {
        const Vec2 arm = rebels[i].location - centre;
        const Vec2 rest = rebels[i].velocity() * dt_s - shift;
        if (rest.norm() > tolerance) continue;
        numerator += arm.dot(rest);
        denominator += arm.squaredNorm();
      }
      growth = numerator / denominator;
    }
    for (const std::size_t i : group) {
      const Vec2 fitted = shift + growth * (rebels[i].location - centre);
      const Vec2 step = rebels[i].velocity() * dt_s;
      if ((step - fitted).norm() > tolerance && rebels[i].corner >= 0) --rebels[i].trust;
      const double faster = 1 + std::clamp(growth, -0.2, 0.3);
      set_velocity(rebels[i], faster * (0.4 * step + 0.6 * fitted) / dt_s, dt_s);
    }
  }
}

/// Whether the corner's own past shows it moving by `step` in both of the last frames.
bool ConstellationEdges::confirms(const Vec2& x, const Vec2& step) const {
  const int once = past_[0].map.at(x - step);
  if (once < 0) return false;
  const Vec2& before = past_[0].corners[once];
  return past_[1].map.at(before - 0.5 * (x - before + step)) >= 0;
}

/// A corner most of whose decided neighbours are rebels is one; it becomes a rebel edge where its
/// own past confirms their motion. A trusted normal edge is not overruled without that.
void ConstellationEdges::inherit(Layers& layers, const Chi& chi, const MotionField& field) {
  const ConstellationParameters& p = parameters_.constellation;
  const std::vector<char> decided = called_;
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (decided[c]) continue;
    const Vec2& x = chi.locations[c];
    near_.clear();
    corner_grid_.visit_within(x, p.inherit_radius, [&](int other, double distance2) {
      if (other == static_cast<int>(c)) return;
      const Link& link = links_[other];
      const bool normal =
          link.kind == Kind::normal && layers.normal_edges[link.index].trust >= p.established;
      if (decided[other] || normal) near_.emplace_back(distance2, other);
    });
    std::sort(near_.begin(), near_.end());
    if (near_.size() > 5) near_.resize(5);
    if (near_.size() < 2) continue;
    int rebels = 0, nearest = -1;
    for (const auto& [distance2, other] : near_) {
      if (!decided[other]) continue;
      ++rebels;
      if (nearest < 0 && links_[other].kind == Kind::rebel) nearest = links_[other].index;
    }
    const double share = static_cast<double>(rebels) / static_cast<double>(near_.size());
    if (nearest < 0 || share < p.inherit_share) continue;
    const Edge model = layers.rebel_edges[nearest];
    const bool confirmed = confirms(x, model.velocity() * field.dt_s());

    Edge* normal = links_[c].kind == Kind::normal ? &layers.normal_edges[links_[c].index] : nullptr;
    if (normal && normal->trust >= trust_.maximum) {
      if (!confirmed || share < 0.75) {
        reasons_[c] = Reason::normal_stands;
        continue;
      }
      called_[c] = 1;
      reasons_[c] = Reason::inherited;
      normal->trust -= 2;
      continue;
    }
    called_[c] = 1;
    reasons_[c] = Reason::inherited;
    if (!confirmed || links_[c].kind == Kind::rebel) continue;
    if (normal && normal->trust >= p.established) continue;
    if (normal) normal->trust = 0;
    if (normal) normal->corner = -1;
    Edge edge = make_rebel(x, model.velocity(), field.dt_s());
    edge.trust = trust_.standard;
    edge.off_field_px = std::min(model.off_field_px, kOffField_px);
    edge.corner = static_cast<int>(c);
    edge.called = true;
    links_[c] = {Kind::rebel, static_cast<int>(layers.rebel_edges.size())};
    layers.rebel_edges.push_back(edge);
  }
}

void ConstellationEdges::update(Layers& layers, const Chi& chi, const MotionField& field,
                                std::vector<Verdict>& verdicts) {
  corner_grid_.build(chi.locations, 16);
  assign(layers, chi, field);
  const std::size_t normals = layers.normal_edges.size();
  for (std::size_t i = 0; i < normals; ++i) {
    Edge& edge = layers.normal_edges[i];
    ++edge.age;
    edge.corner = match_of_edge_[i];
    if (edge.corner >= 0) {
      update_normal(edge, chi.locations[edge.corner], field);
    } else {
      coast(edge, layers.ignored);
    }
  }
  for (std::size_t i = 0; i < layers.rebel_edges.size(); ++i) {
    Edge& edge = layers.rebel_edges[i];
    ++edge.age;
    edge.corner = match_of_edge_[normals + i];
    if (edge.corner >= 0 && field.dt_s() > 0) {
      update_rebel(edge, chi.locations[edge.corner], field);
    } else {
      coast(edge, layers.ignored);
    }
  }
  find_residuals(layers, chi);
  called_.assign(chi.size(), 0);
  if (remembered_ == 2 && field.dt_s() > 0) {
    past_[0].map.build(past_[0].corners, parameters_.constellation.hit_1);
    past_[1].map.build(past_[1].corners, parameters_.constellation.hit_2);
    seek_static_past(chi, field);
    vote(chi, field);
    make_edges(layers, chi, field);
    support(layers, field);
    for (std::size_t i = 0; i < layers.rebel_edges.size(); ++i) {
      layers.rebel_edges[i].called = borne_out_[i];
    }
    settle_rebels();
    inherit(layers, chi, field);
  }

  for (std::size_t c = 0; c < chi.size(); ++c) {
    Verdict& verdict = verdicts[chi.sources[c]];
    if (called_[c]) {
      verdict = Verdict::rebel;
    } else if (links_[c].kind == Kind::normal) {
      verdict = Verdict::normal;
    }
  }
  for (auto* edges : {&layers.normal_edges, &layers.rebel_edges}) {
    for (Edge& edge : *edges) {
      if (edge.corner >= 0) edge.corner = chi.sources[edge.corner];
    }
    bury(*edges);
  }
  remember(chi);
}

}  // namespace lcs
