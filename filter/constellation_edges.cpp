#include "filter/constellation_edges.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "filter/geometry.h"
#include "filter/refill.h"

namespace lcs {
namespace {

/// Changes of size over a baseline that neighbours may agree on: what approaches grows.
constexpr std::array<double, 6> kScales = {1.0, 1.05, 1.12, 1.23, 0.94, 0.87};
constexpr double kLeastScale = *std::min_element(kScales.begin(), kScales.end());

/// Points looked at along a static path, at the most, and how far apart they lie, px.
constexpr int kMaxDepths = 60;
constexpr double kDepthSpacing_px = 1.5;

/// A static residual of more than this says no more of how surely a rebel moves, px.
constexpr double kFullResidual_px = 6.0;

/// Rebels that are looked at round a corner, about, where more are near.
constexpr double kInheritCrowd = 96;

/// Those move about as the nearest that differ by less than this, or this share of its step, px.
constexpr double kAlikeStep_px = 2.0, kAlikeStepShare = 0.4;

/// px: nearer to the side of the picture no corner is found, for want of pixels round it.
constexpr double kBlind_px = 3;

/// Frames that are remembered, for two baselines.
constexpr std::size_t kMaxHistory = 12;

}  // namespace

ConstellationEdges::ConstellationEdges(const Intrinsics& camera, const CircleParameters& parameters)
    : EdgeExpert(camera, parameters.trust),
      parameters_(parameters),
      chance_(parameters.constellation.hit_1, parameters.constellation.hit_2,
              parameters.constellation.neighbours, parameters.constellation.vote_chance),
      groups_(parameters.constellation, parameters.trust),
      footing_(camera, parameters.footing),
      discs_(camera.width_px, camera.height_px),
      once_(camera),
      twice_(camera),
      once_free_(camera.width_px, camera.height_px),
      twice_free_(camera.width_px, camera.height_px) {}

void ConstellationEdges::predict(Layers& layers, const MotionField& field) {
  for (Edge& edge : layers.normal_edges) {
    edge.rotated = field.rotated(edge.location);
    if (field.moving()) edge.depth_ratio = field.advanced_ratio(edge.depth_ratio);
    edge.predicted = field.translated(edge.rotated, edge.depth_ratio);
    edge.origin = field.origin(edge.predicted);
    edge.path.carry(field);
    edge.speed = edge.depth_ratio * field.reference_speed(edge.rotated);
  }
  for (Edge& edge : layers.rebel_edges) {
    edge.rotated = field.rotated(edge.location);
    edge.origin = field.rotated(edge.origin);
    const Vec2 path = edge.rotated - edge.origin;
    if (!path.isZero()) edge.angle = angle_of(path);
    edge.predicted = edge.rotated + edge.velocity() * field.dt_s();
    edge.path.carry(field);
  }
  for (Past& past : history_) {
    for (Vec2& x : past.corners) x = field.rotated(x);
    for (Vec2& x : past.picture) x = field.rotated(x);
    past.displacement_C_m = field.R_cur_prev() * past.displacement_C_m + field.displacement_C_m();
    past.elapsed_s += field.dt_s();
  }
}

void ConstellationEdges::remember(const Layers& layers, const Chi& chi) {
  // The oldest makes room for the newest.
  if (history_.size() < kMaxHistory) history_.emplace_back();
  std::rotate(history_.begin(), history_.end() - 1, history_.end());
  Past& now = history_.front();
  copy_over(chi.locations, now.corners);
  now.taken.clear();
  for (const Edge& edge : layers.normal_edges) {
    if (edge.corner >= 0) now.taken.emplace_back(edge.id, edge.corner);
  }
  const double right = camera_.width_px - 1 - kBlind_px, bottom = camera_.height_px - 1 - kBlind_px;
  now.picture = {Vec2(kBlind_px, kBlind_px), Vec2(right, kBlind_px), Vec2(right, bottom),
                 Vec2(kBlind_px, bottom)};
  now.displacement_C_m.setZero();
  now.elapsed_s = 0;
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
  edge.path.see(x, camera_, field);
  edge.location = (edge.predicted + 2 * x) / 3;
  edge.speed = edge.depth_ratio * field.reference_speed(edge.location);
  const Vec2 along = field.direction(edge.location);
  if (!along.isZero()) edge.angle = angle_of(along);
  edge.trust = trust_.raised(edge.trust);
}

/// By how much a step leaves the images that a static point of this depth ratio at the least may
/// take, px.
double ConstellationEdges::off_field(const Vec2& x, const Vec2& before, double least_ratio,
                                     const Eigen::Vector3d& displacement_C_m,
                                     const MotionField& field) {
  return distance_to_segment(before, field.earlier(x, least_ratio, displacement_C_m),
                             field.earlier(x, field.max_ratio(), displacement_C_m));
}

/// Whether an edge that followed its corner step by step did not stay on the path of any static
/// point: each step of a slow mover fits into a normal edge's gate, their sum does not. Where the
/// path tells a depth, one below the ground is for `Footing` to judge, which knows what is round
/// it.
bool ConstellationEdges::leaves_path(const Edge& edge, const Vec2& x,
                                     const MotionField& field) const {
  const Path& path = edge.path;
  const double least = path.ratio > 2 * path.sigma() ? 0 : field.least_ratio(x);
  return off_field(x, path.anchor, least, path.travelled_C_m, field) >
         parameters_.constellation.path_across;
}

void ConstellationEdges::update_rebel(Edge& edge, const Vec2& x, const MotionField& field) const {
  const Vec2 step = x - edge.rotated;
  const double weight = std::clamp(edge.trust - trust_.critical, 1, step.norm() < 6 ? 3 : 2);
  const Vec2 velocity = (weight * edge.velocity() + step / field.dt_s()) / (weight + 1);
  const std::size_t frames = stride();
  const Past& past = history_[frames - 1];
  const double off = edge.unfounded > 0
                         ? kFullResidual_px
                         : off_field(x, x - velocity * past.elapsed_s, field.least_ratio(x),
                                     past.displacement_C_m, field);
  edge.off_field_px = 0.5 * edge.off_field_px + 0.5 * std::min(off, kFullResidual_px);
  edge.location = x;
  edge.mu = angle_between(angle_of(step), edge.angle);
  set_velocity(edge, velocity, field.dt_s());
  edge.trust = trust_.raised(edge.trust);
  // Beside a slow mover a static corner stays inside the gate, and is not carried along: it has to
  // show a path of its own.
  const int proof = parameters_.constellation.path_proof * static_cast<int>(frames);
  if (edge.unfounded > 0) {
    edge.path.see(x, camera_, field);  // by which it is judged again
  } else if (edge.age >= proof && !leaves_path(edge, x, field)) {
    edge.trust = 0;
  }
}

/// Corners that no edge took, or only a normal edge too young to be believed.
void ConstellationEdges::find_residuals(const Layers& layers, const Chi& chi) {
  refill(candidates_, chi.size());
  refill(links_, chi.size());
  refill(reasons_, chi.size(), history_.size() < 2 ? Reason::no_past : Reason::no_time);
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
      candidates_[c].unsure =
          layers.rebel_edges[edge - normals].trust < parameters_.constellation.sure;
    }
  }
}

int ConstellationEdges::static_hits(const Vec2& x, double depth_ratio,
                                    const MotionField& field) const {
  const Vec2 once = field.earlier(x, depth_ratio, once_.displacement_C_m);
  if (!once_.all.at(once)) return 0;
  const Vec2 twice = field.earlier(x, depth_ratio, twice_.displacement_C_m);
  return twice_.all.at(twice) ? 2 : 1;
}

/// How many frames make a baseline: as many as it takes to last `baseline`, for at a high frame
/// rate nothing moves far enough from one frame to the next. Fewer while there is no more to see.
std::size_t ConstellationEdges::stride() const {
  std::size_t frames = 1;
  while (2 * (frames + 1) <= history_.size() &&
         history_[frames - 1].elapsed_s < parameters_.constellation.baseline) {
    ++frames;
  }
  return frames;
}

void ConstellationEdges::look_back(const Layers& layers) {
  explaining_.clear();
  for (const Edge& edge : layers.normal_edges) {
    const bool explains = edge.corner >= 0 && edge.trust >= parameters_.constellation.established;
    if (explains) explaining_.push_back(edge.id);
  }
  const std::size_t frames = stride();
  const double hit_1 = parameters_.constellation.hit_1, hit_2 = parameters_.constellation.hit_2;
  index(history_[frames - 1], once_);
  discs_.build(once_.corners, hit_1);
  once_.all.build(discs_);
  once_free_.build(once_.corners, discs_);
  discs_.build(explained_, hit_1);
  once_.all.add(discs_);
  once_grid_.build(once_.corners, 16);
  index(history_[2 * frames - 1], twice_);
  discs_.build(twice_.corners, hit_2);
  twice_free_.build(discs_);
  twice_.all = twice_free_;
  discs_.build(explained_, hit_2);
  twice_.all.add(discs_);
  again_ = (twice_.elapsed_s - once_.elapsed_s) / once_.elapsed_s;
  // At a constant velocity from the camera the image is c + f (a + b t) / Z(t), and Z is linear
  // too, so that the steps from t_0 back to t_1 and on to t_2 are as (t_0 - t_1) / (Z_0 Z_1) to
  // (t_1 - t_2) / (Z_1 Z_2).
  earlier_.clear();
  for (const double scale : kScales) {
    const double depth_then = 1 + (scale - 1) * (1 + again_);  // Z_2 / Z_0
    earlier_.push_back(depth_then > 0 ? again_ / depth_then : 0);
  }
  needs_own_past_ = frames >= static_cast<std::size_t>(parameters_.constellation.vote_own_past);
}

/// What an established edge took then and has a corner for now cannot be a moving corner's past.
/// The static explanation keeps it: better to call too few corners rebels.
void ConstellationEdges::index(const Past& past, Lookup& lookup) {
  // Ids rise in the lists of edges, so that both lists can be gone through at once.
  refill(is_explained_, past.corners.size());
  auto explaining = explaining_.begin();
  for (const auto& [id, corner] : past.taken) {
    while (explaining != explaining_.end() && *explaining < id) ++explaining;
    is_explained_[corner] = explaining != explaining_.end() && *explaining == id;
  }
  lookup.corners.clear();
  explained_.clear();
  for (std::size_t i = 0; i < past.corners.size(); ++i) {
    (is_explained_[i] ? explained_ : lookup.corners).push_back(past.corners[i]);
  }
  lookup.picture = past.picture;
  lookup.displacement_C_m = past.displacement_C_m;
  lookup.elapsed_s = past.elapsed_s;
}

/// Whether a static point that is at x now was in the picture then, however far away it is.
bool ConstellationEdges::showed(const Lookup& then, const Vec2& x, const MotionField& field) const {
  const Pixels picture{camera_.width_px, camera_.height_px};
  const Vec2 nearest = field.earlier(x, field.max_ratio(), then.displacement_C_m);
  return picture.contain(nearest) && holds(then.picture, x) && holds(then.picture, nearest);
}

/// Sweeps the depth of each corner that may have stood, from infinity to the nearest. Where a
/// pattern repeats, rebel edges go from one period to the next: unless their corners speak for rest
/// too, the motion that they have wins every vote beside them.
void ConstellationEdges::seek_static_past(const Chi& chi, const MotionField& field) {
  for (std::size_t c = 0; c < chi.size(); ++c) {
    Candidate& candidate = candidates_[c];
    if (!candidate.residual && !candidate.unsure) continue;
    const Vec2& x = chi.locations[c];
    const double length = (field.earlier(x, field.max_ratio(), twice_.displacement_C_m) - x).norm();
    const int depths = std::min(kMaxDepths, 1 + static_cast<int>(length / kDepthSpacing_px));
    for (int i = 0; i <= depths && candidate.static_hits < 2; ++i) {
      const double ratio = field.max_ratio() * i / depths;
      const int hits = static_hits(x, ratio, field);
      if (hits > candidate.static_hits) {
        candidate.static_hits = hits;
        candidate.static_ratio = ratio;
      }
    }
    // What could not be seen speaks against nothing: where a turn brings a pattern into the
    // picture, what is there is the past of what follows.
    candidate.static_votes = candidate.static_hits;
    if (candidate.static_hits == 2) continue;
    if (!showed(once_, x, field) || (candidate.static_hits == 1 && !showed(twice_, x, field)))
      candidate.static_votes = 2;
  }
}

/// The votes that a motion needs beside what chance gives it. Corners crowd, so that those are
/// counted that lie about the voters.
int ConstellationEdges::least_votes(const Vec2& x, int voters) const {
  const double reach = parameters_.constellation.max_speed * once_.elapsed_s;
  const PointGrid::Crowd here = once_grid_.crowd(x, 2 * std::sqrt(near_.back().distance2));
  const PointGrid::Crowd all = once_grid_.crowd(x, reach);
  return chance_.least(here.count / here.area_px2, voters, kScales.size() * all.count);
}

/// Votes for the displacement from `before` to x at a change of size, the corner's own among them:
/// for each voter that has a predecessor at its place in the displaced constellation, the first
/// `hits` of hits_, one, and one more where that has another. Gives up when `least` is out of
/// reach. Where a baseline takes several frames, a corner that has just come into view is asked in
/// each of them, and beside a mover the mover's corners win its vote: it has to have a past of its
/// own.
int ConstellationEdges::count_votes(const Vec2& x, const Vec2& before, double earlier, int hits,
                                    int least) const {
  if (!(earlier > 0)) return 0;
  int votes = twice_free_.at(before - earlier * (x - before)) ? 2 : 1;
  if (votes < 2 && needs_own_past_) return 0;
  votes += hits;
  for (int i = 0; i < hits && votes + hits - i >= least; ++i) {
    const Vec2& y = voters_[hits_[i].look_up];
    const Vec2& y_before = once_.corners[hits_[i].point];
    votes += twice_free_.at(y_before - earlier * (y - y_before));
  }
  return votes;
}

/// The eight nearest (`neighbours`) of the corners that are not decided vote. \return the votes of
/// all of them and of the corner itself for standing still in the world, -1: there are too few.
int ConstellationEdges::gather_voters(std::size_t corner, const Chi& chi) {
  const ConstellationParameters& p = parameters_.constellation;
  undecided_grid_.nearest(
      chi.locations[corner], p.radius, static_cast<std::size_t>(p.neighbours),
      [&](int other) { return undecided_[other] != static_cast<int>(corner); }, near_);
  if (near_.size() < 2) return -1;
  int static_votes = candidates_[corner].static_votes;
  for (const auto& [distance2, other] : near_)
    static_votes += candidates_[undecided_[other]].static_votes;
  return static_votes;
}

/// The voters' places about x, and where those were at each change of size.
void ConstellationEdges::place_voters(const Vec2& x) {
  voters_.clear();
  for (const Neighbour& near : near_) voters_.push_back(undecided_locations_[near.index]);
  hits_.resize(voters_.size() + 1);  // it is written past what is found
  arms_.clear();
  longest_arm_px_ = std::sqrt(near_.back().distance2) / kLeastScale;
  for (const double scale : kScales) {
    for (const Vec2& y : voters_) arms_.push_back(NearestMap::way((y - x) / scale));
  }
}

/// The motions from a predecessor to x, one for each change of size: the one with the most votes
/// becomes `best` if that has no more. Which motion is the best matters only where it wins; else,
/// whether there is one at the floor. Of equal motions the slower one, so that the order of the
/// search does not matter.
void ConstellationEdges::try_motions(const Vec2& x, const Vec2& before, int floor, int winning,
                                     Motion& best) {
  const Vec2 step = x - before;
  const NearestMap::Steps anchor = NearestMap::place(before);
  const bool can_count = once_free_.can_count(before, longest_arm_px_);
  for (std::size_t i = 0; i < kScales.size(); ++i) {
    const int least = best.votes < floor ? floor : std::max(best.votes, winning);
    const std::span arms(arms_.data() + i * voters_.size(), voters_.size());
    if (can_count && 2 + 2 * once_free_.count(anchor, arms) < least) continue;
    const int hits = once_free_.find(anchor, arms, hits_.data());
    const int votes = count_votes(x, before, earlier_[i], hits, least);
    if (votes < least) continue;
    if (votes > best.votes || step.squaredNorm() < best.step.squaredNorm()) best = {votes, step};
  }
}

/// Sets the displacement that the neighbours of a corner agree on, if any. \return `voted`, or what
/// speaks against it.
Reason ConstellationEdges::vote_on(std::size_t corner, const Chi& chi, const MotionField& field) {
  const ConstellationParameters& p = parameters_.constellation;
  const Vec2& x = chi.locations[corner];
  const int static_votes = gather_voters(corner, chi);
  if (static_votes < 0) return Reason::few_neighbours;
  const int voters = static_cast<int>(near_.size());
  const int all = 2 * (voters + 1);
  // A motion is chosen out of many, the static explanation is not: where that one is good, another
  // that is better is chance, as in a pattern that repeats.
  if (static_votes >= p.vote_static_cap * all) return Reason::static_wins;
  const int floor = least_votes(x, voters);
  if (floor > all) return Reason::vote_floor;
  const int winning =
      std::max(floor, static_votes + static_cast<int>(std::ceil(p.vote_margin * all)));
  if (winning > all) return Reason::static_wins;

  place_voters(x);
  Motion best;
  once_grid_.visit_within(x, p.max_speed * once_.elapsed_s, [&](int predecessor, double) {
    try_motions(x, once_.corners[predecessor], floor, winning, best);
  });
  if (best.votes < floor) return Reason::vote_floor;
  if (best.votes < winning) return Reason::static_wins;
  candidates_[corner].step = best.step;
  if (!(off_field(x, x - best.step, field.least_ratio(x), once_.displacement_C_m, field) >
        p.off_field))
    return Reason::vote_on_field;
  return Reason::voted;
}

void ConstellationEdges::vote(const Chi& chi, const MotionField& field) {
  undecided_.clear();
  undecided_locations_.clear();
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (!candidates_[c].residual && links_[c].kind != Kind::rebel) continue;
    undecided_.push_back(static_cast<int>(c));
    undecided_locations_.push_back(chi.locations[c]);
  }
  undecided_grid_.build(undecided_locations_, 16);
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
  edge.path.start(x, edge.depth_ratio, camera_);
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
      layers.rebel_edges.push_back(make_rebel(x, candidate.step / once_.elapsed_s, field.dt_s()));
      layers.rebel_edges.back().corner = static_cast<int>(c);
    } else if (candidate.residual && links_[c].kind == Kind::none && candidate.static_hits >= 2) {
      links_[c] = {Kind::normal, static_cast<int>(layers.normal_edges.size())};
      layers.normal_edges.push_back(
          make_normal(x, candidate.static_ratio, parameters_.constellation.normal_along, field));
      layers.normal_edges.back().corner = static_cast<int>(c);
    }
  }
}

/// Corners of rebel edges are rebels where these are borne out.
void ConstellationEdges::settle_rebels() {
  for (std::size_t c = 0; c < links_.size(); ++c) {
    if (links_[c].kind != Kind::rebel) continue;
    called_[c] = groups_.borne_out(links_[c].index);
    if (!called_[c]) {
      reasons_[c] = groups_.reason(links_[c].index);
    } else if (!candidates_[c].voted) {
      reasons_[c] = Reason::rebel_edge;
    }
  }
}

/// Whether the corner's own past shows it moving by `step` in both of the last frames.
bool ConstellationEdges::confirms(const Vec2& x, const Vec2& step) const {
  const int once = once_free_.at(x - step);
  if (once < 0) return false;
  const Vec2& before = once_.corners[once];
  return twice_free_.at(before - 0.5 * again_ * (x - before + step));
}

/// The rebel edge of a corner that was called before neighbours were asked.
const Edge& ConstellationEdges::edge_of(int decided, const Layers& layers) const {
  return layers.rebel_edges[links_[decided_corners_[decided]].index];
}

/// What is round a corner: a decided one that is the nearest, others that move about as it does,
/// and what stands.
Surroundings ConstellationEdges::look_around(std::size_t corner, int nearest, double reach_px,
                                             const Layers& layers, const Chi& chi) {
  const Vec2& x = chi.locations[corner];
  const Vec2& step = decided_steps_[nearest];
  const double like_px = std::max(kAlikeStep_px, kAlikeStepShare * step.norm());
  Surroundings around;
  Bearings bearings;
  decided_grid_.visit_within(x, reach_px, [&](int decided, double) {
    if ((decided_steps_[decided] - step).squaredNorm() > like_px * like_px) return;
    ++around.rebels;
    bearings.add(decided_locations_[decided] - x);
  });
  around.gap_rad = bearings.widest_gap_rad();
  around.rebel_px = (decided_locations_[nearest] - x).norm();
  const auto stands = [&](int other) {
    return is_normal_[other] && other != static_cast<int>(corner);
  };
  corner_grid_.nearest(x, reach_px, 1, stands, near_);
  around.normal_px = near_.empty() ? reach_px : std::sqrt(near_.front().distance2);
  around.unfounded = edge_of(nearest, layers).unfounded > 0;
  return around;
}

/// A corner that is a rebel likely enough, by what is round it, takes the verdict of the nearest,
/// and becomes a rebel edge where its own past confirms that one's motion. Of a group that stands
/// on nothing the image motion says little: the path stays, for Footing to judge by.
void ConstellationEdges::inherit(Layers& layers, const Chi& chi, const MotionField& field) {
  const InheritanceParameters& p = parameters_.inheritance;
  const int established = parameters_.constellation.established;
  decided_corners_.clear();
  decided_locations_.clear();
  decided_steps_.clear();
  refill(is_normal_, chi.size());
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (called_[c]) {
      decided_corners_.push_back(static_cast<int>(c));
      decided_locations_.push_back(chi.locations[c]);
      decided_steps_.push_back(layers.rebel_edges[links_[c].index].velocity() * field.dt_s());
    } else {
      is_normal_[c] = links_[c].kind == Kind::normal &&
                      layers.normal_edges[links_[c].index].trust >= established;
    }
  }
  decided_grid_.build(decided_locations_, p.radius);
  const double least_odds = std::log(p.chance) - std::log1p(-p.chance);
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (called_[c]) continue;
    const Vec2& x = chi.locations[c];
    const double reach = std::min(p.radius, decided_grid_.crowd_radius(x, kInheritCrowd));
    decided_grid_.nearest(
        x, reach, 1, [](int) { return true; }, near_);
    if (near_.empty()) continue;
    const int nearest = near_.front().index;
    const Surroundings around = look_around(c, nearest, reach, layers, chi);
    const Edge model = edge_of(nearest, layers);
    Edge* normal = links_[c].kind == Kind::normal ? &layers.normal_edges[links_[c].index] : nullptr;
    const bool trusted = normal && normal->trust >= trust_.maximum;
    const OwnPast own{confirms(x, model.velocity() * once_.elapsed_s),
                      candidates_[c].static_hits == 1, normal != nullptr, trusted};
    if (!(rebel_log_odds(p, around, own) >= least_odds)) {
      if (normal) reasons_[c] = Reason::normal_stands;
      continue;
    }
    called_[c] = 1;
    reasons_[c] = Reason::inherited;
    if (trusted) normal->trust -= 2;
    const bool is_kept =
        trusted || links_[c].kind == Kind::rebel || (normal && normal->trust >= established);
    if (!own.confirms || is_kept) {
      followers_.push_back({x, model.id});
      continue;
    }
    if (normal) normal->trust = 0;
    if (normal) normal->corner = -1;
    Edge edge = make_rebel(x, model.velocity(), field.dt_s());
    if (normal && around.unfounded) edge.path = normal->path;
    edge.trust = trust_.standard;
    edge.off_field_px = std::min(model.off_field_px, kOffField_px);
    edge.unfounded = model.unfounded;
    edge.corner = static_cast<int>(c);
    edge.called = true;
    links_[c] = {Kind::rebel, static_cast<int>(layers.rebel_edges.size())};
    layers.rebel_edges.push_back(edge);
  }
}

/// Normal edges of groups that stand on nothing are turned into rebels.
void ConstellationEdges::turn_unfounded(Layers& layers, const Chi& chi, const MotionField& field) {
  footing_.judge(layers.normal_edges, layers.rebel_edges, field);
  for (Edge& edge : layers.normal_edges) {
    const int c = edge.corner;
    if (c < 0 || !footing_.is_unfounded(edge)) continue;
    Edge rebel =
        make_rebel(chi.locations[c], (edge.location - edge.rotated) / field.dt_s(), field.dt_s());
    rebel.path = edge.path;
    rebel.unfounded = edge.unfounded;
    rebel.trust = trust_.standard;
    rebel.called = true;
    rebel.corner = c;
    edge.trust = 0;
    edge.corner = -1;
    called_[c] = 1;
    reasons_[c] = Reason::unfounded;
    links_[c] = {Kind::rebel, static_cast<int>(layers.rebel_edges.size())};
    layers.rebel_edges.push_back(rebel);
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
      if (leaves_path(edge, chi.locations[edge.corner], field)) {
        match_of_corner_[edge.corner] = -1;
        edge.corner = -1;
        edge.trust = 0;
      }
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
  refill(called_, chi.size());
  followers_.clear();
  if (history_.size() >= 2 && field.dt_s() > 0) {
    look_back(layers);
    seek_static_past(chi, field);
    vote(chi, field);
    make_edges(layers, chi, field);
    groups_.judge(layers.rebel_edges, field.dt_s());
    for (std::size_t i = 0; i < layers.rebel_edges.size(); ++i) {
      // One that only follows its prediction says nothing of now.
      layers.rebel_edges[i].called = groups_.borne_out(i) && layers.rebel_edges[i].corner >= 0;
    }
    settle_rebels();
    inherit(layers, chi, field);
    turn_unfounded(layers, chi, field);
  }

  for (std::size_t c = 0; c < chi.size(); ++c) {
    Verdict& verdict = verdicts[chi.sources[c]];
    if (called_[c]) {
      verdict = Verdict::rebel;
    } else if (links_[c].kind == Kind::normal) {
      verdict = Verdict::normal;
    }
  }
  remember(layers, chi);
  for (auto* edges : {&layers.normal_edges, &layers.rebel_edges}) {
    for (Edge& edge : *edges) {
      if (edge.corner >= 0) edge.corner = chi.sources[edge.corner];
    }
    bury(*edges);
  }
}

}  // namespace lcs
