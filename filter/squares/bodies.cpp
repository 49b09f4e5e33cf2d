#include "filter/squares/bodies.h"

#include <algorithm>
#include <cmath>

#include "filter/edges/gauss.h"
#include "filter/kinematics/geometry.h"
#include "filter/radial/median.h"
#include "filter/squares/convex_hull.h"
#include "filter/vectors/refill.h"

namespace lcs {
namespace {

/// Intersection over union from which two boxes are of one thing.
constexpr double kSame = 0.5;
/// Share of a box, about its centre, that the body itself fills: nearer the rim a box shows what is
/// beside the body.
constexpr double kInner = 0.5;

double overlap(const Square& a, const Square& b) {
  const Vec2 low = (a.location - a.half_size).cwiseMax(b.location - b.half_size);
  const Vec2 high = (a.location + a.half_size).cwiseMin(b.location + b.half_size);
  const double both = (high - low).cwiseMax(0).prod();
  return both / (4 * (a.half_size.prod() + b.half_size.prod()) - both);
}

/// The part of each edge, where both are by rising id.
template <typename Parts>
auto part_of(const Edge& edge, Parts from, Parts end) {
  while (from != end && from->edge < edge.id) ++from;
  return from;
}

}  // namespace

void Bodies::forget() {
  bodies_.clear();
  parts_.clear();
}

void Bodies::predict(const MotionField& field) {
  for (Body& body : bodies_) {
    body.centre_px = field.rotated(body.centre_px) + body.velocity_pxps * field.dt_s();
    place(body.square, body.place_px().center(), body.square.half_size);
    body.unseen_s += field.dt_s();
    body.now = {};
    ++body.square.age;
  }
}

void Bodies::find_parts(const BothKinds<Edge>& edges) {
  seen_.clear();
  body_of_seen_.clear();
  for (const std::vector<Edge>* kind : {&edges.normal, &edges.rebel}) {
    auto part = parts_.begin();
    for (const Edge& edge : *kind) {
      part = part_of(edge, part, parts_.end());
      if (part == parts_.end()) break;
      if (part->edge != edge.id || edge.corner < 0) continue;
      seen_.push_back({static_cast<int>(part - parts_.begin()), &edge});
      body_of_seen_.push_back(part->body);
    }
  }
  members_.collect(body_of_seen_, bodies_.size());
}

/// Finds the body of each rebel circle. A body has the circle with most of its edges, others with
/// edges of it within its box, and without any the one at its place. Other circles start bodies.
void Bodies::claim(const BothKinds<Edge>& edges, const CircleExpert::Result& circles,
                   std::span<const Square> rebels) {
  std::vector<int>& body_of = body_of_circle_.rebel;
  const std::size_t known = bodies_.size();
  refill(body_of, rebels.size(), -1);
  refill(shared_, rebels.size() * known);
  for (const Seen& seen : seen_) {
    if (!seen.edge->rebel) continue;
    const int circle = circles.of_edges.rebel[seen.edge - edges.rebel.data()];
    if (circle >= 0) ++shared_[circle * known + parts_[seen.part].body];
  }
  for (std::size_t c = 0; c < rebels.size() && known > 0; ++c) {
    const auto first = shared_.begin() + static_cast<std::ptrdiff_t>(c * known);
    const auto most = std::max_element(first, first + static_cast<std::ptrdiff_t>(known));
    if (*most == 0) continue;
    body_of[c] = static_cast<int>(most - first);
    Body::Now& now = bodies_[body_of[c]].now;
    if (*most <= now.shared) continue;
    now.shared = *most;
    now.first = static_cast<int>(c);
  }
  for (std::size_t c = 0; c < rebels.size(); ++c) {
    if (body_of[c] < 0) continue;
    Body& body = bodies_[body_of[c]];
    if (body.now.first != static_cast<int>(c) && !body.holds(rebels[c])) {
      body_of[c] = -1;
    } else {
      ++body.now.circles;
    }
  }
  for (std::size_t c = 0; c < rebels.size(); ++c) {
    if (body_of[c] >= 0) continue;
    const auto same = std::ranges::find_if(bodies_, [&](const Body& body) {
      return body.square.id == rebels[c].id ||
             (body.now.circles == 0 && body.is_at(rebels[c].location));
    });
    body_of[c] = static_cast<int>(same - bodies_.begin());
    if (same == bodies_.end()) {
      Body& body = bodies_.emplace_back();
      body.square = rebels[c];
      body.centre_px = rebels[c].location;
      body.box_px = {-rebels[c].half_size, rebels[c].half_size};
      body.velocity_pxps = rebels[c].speed * unit_vector(rebels[c].angle);
    }
    ++bodies_[body_of[c]].now.circles;
  }
}

/// Moves and scales a body with its parts that are seen. Drops those that move otherwise.
void Bodies::follow(int b, const MotionField& field) {
  Body& body = bodies_[b];
  // While it moves visibly, normal edges do not move with it.
  const auto counts = [&](int i) { return body.now.circles == 0 || seen_[i].edge->rebel; };
  const auto miss_px = [&](int i) -> Vec2 {
    return seen_[i].edge->location - body.centre_px - parts_[seen_[i].part].off_px;
  };
  Vec2 middle_px;
  for (const int axis : {0, 1}) {
    misses_px_.clear();
    for (const int i : members_.of(static_cast<std::size_t>(b))) {
      if (counts(i)) misses_px_.push_back(miss_px(i)[axis]);
    }
    if (misses_px_.empty()) return;
    middle_px[axis] = median(misses_px_);
  }
  const double most_px2 =
      kFar * kFar * step_variance(body.velocity_pxps * field.dt_s() + middle_px);
  double n = 0, products = 0, squares = 0;
  Vec2 place = Vec2::Zero(), off = Vec2::Zero(), velocity = Vec2::Zero();
  for (const int i : members_.of(static_cast<std::size_t>(b))) {
    Part& part = parts_[seen_[i].part];
    if ((miss_px(i) - middle_px).squaredNorm() > most_px2) {
      part.body = -1;
    } else if (counts(i)) {
      const Edge& edge = *seen_[i].edge;
      ++n;
      place += edge.location;
      off += part.off_px;
      velocity += edge.velocity();
      products += edge.location.dot(part.off_px);
      squares += part.off_px.squaredNorm();
    }
  }
  if (n == 0) return;
  // Least squares; the prior scale of 1 has the deviation of the turnover.
  const double prior_px2 = 2 * std::pow(edges_.noise_px / edges_.turnover(field.dt_s()), 2);
  const double scale =
      (products - place.dot(off) / n + prior_px2) / (squares - off.squaredNorm() / n + prior_px2);
  body.centre_px = (place - scale * off) / n;
  body.box_px = {scale * body.box_px.min(), scale * body.box_px.max()};
  body.velocity_pxps = velocity / n;
  body.unseen_s = 0;
  body.now.parts = static_cast<int>(n);
}

/// Finds the static circles that are bodies at rest, by their boxes.
void Bodies::claim_static(const std::vector<Circle>& circles, std::span<const Square> squares) {
  refill(body_of_circle_.normal, circles.size(), -1);
  std::size_t c = 0;
  for (const Square& square : squares) {
    while (circles[c].id != square.id) ++c;
    double most = kSame;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const double share = overlap(bodies_[b].square, square);
      if (bodies_[b].now.circles > 0 || !is_sure(bodies_[b]) || share <= most) continue;
      most = share;
      body_of_circle_.normal[c] = static_cast<int>(b);
    }
    if (body_of_circle_.normal[c] < 0) continue;
    Body& body = bodies_[body_of_circle_.normal[c]];
    if (body.now.parts > 0) continue;
    // Its tracks broke when it stopped.
    body.centre_px += square.location - body.square.location;
    body.velocity_pxps = square.speed * unit_vector(square.angle);
    body.unseen_s = 0;
  }
}

/// Finds the edges of each body for the next frame: those that it has, and new ones of its circles.
/// \param known bodies of the last frame; the others take all edges of their circle.
void Bodies::assign(const BothKinds<Edge>& edges, const BothKinds<int>& of_edges, int known) {
  next_parts_.clear();
  make_room(next_parts_, edges.normal.size() + edges.rebel.size());
  for (const bool rebel : {false, true}) {
    const std::vector<Edge>& kind = rebel ? edges.rebel : edges.normal;
    auto part = parts_.begin();
    for (std::size_t i = 0; i < kind.size(); ++i) {
      const Edge& edge = kind[i];
      const int circle = (rebel ? of_edges.rebel : of_edges.normal)[i];
      const int claimed =
          circle < 0 ? -1 : (rebel ? body_of_circle_.rebel : body_of_circle_.normal)[circle];
      part = part_of(edge, part, parts_.end());
      const bool is_part =
          claimed < known && part != parts_.end() && part->edge == edge.id && part->body >= 0;
      Part next = is_part ? *part : Part{edge.id, claimed, Vec2::Zero()};
      if (next.body < 0) continue;
      Body& body = bodies_[next.body];
      if (edge.corner >= 0) next.off_px = edge.location - body.centre_px;
      next_parts_.push_back(next);
      if (claimed < 0) continue;  // edges of circles have a corner
      if (!is_part) ++body.now.parts;
      if (!rebel) continue;
      body.now.range_px.extend(edge.location);
      ++body.now.edges;
    }
  }
}

/// Fuses the box of a body with that of its edges in this frame's circles.
void Bodies::measure(const std::vector<Circle>& circles, std::span<const Square> rebels,
                     const MotionField& field) {
  for (std::size_t c = 0; c < rebels.size(); ++c) {
    Body& body = bodies_[body_of_circle_.rebel[c]];
    if (circles[c].members <= body.now.largest) continue;
    body.now.largest = circles[c].members;
    const Square before = body.square;
    body.square = rebels[c];
    body.square.id = before.id;
    body.square.age = before.age;
    body.square.trust = std::max(before.trust, rebels[c].trust);
  }
  for (Body& body : bodies_) {
    const double n = body.now.edges;
    if (body.now.circles > 0 && n >= 2) {
      if (body.unseen_s > 0) {  // it is found anew
        body.centre_px = body.square.location - body.box_px.center();
        body.velocity_pxps = body.square.speed * unit_vector(body.square.angle);
        body.unseen_s = 0;
      }
      // A range of n even samples has a deviation of about 1 / n.
      body.weight = std::pow(1 - edges_.turnover(field.dt_s()), 2) * body.weight + n * n;
      const double share = n * n / body.weight;
      const Vec2 middle = body.now.range_px.center() - body.centre_px;
      const Vec2 half =
          0.5 * beyond(static_cast<std::size_t>(body.now.edges)) * body.now.range_px.sizes();
      body.box_px = {(1 - share) * body.box_px.min() + share * (middle - half),
                     (1 - share) * body.box_px.max() + share * (middle + half)};
    }
    place(body.square, body.place_px().center(), 0.5 * body.box_px.sizes());
    body.square.circles = body.square.rebel_circles = body.now.circles;
    if (body.now.circles > 0) continue;
    body.square.speed = body.velocity_pxps.norm();
    if (body.square.speed > 0) body.square.angle = angle_of(body.velocity_pxps);
  }
}

/// Whether more edges of other, not nearer things are seen at the middle of a body than of it.
bool Bodies::is_seen_through(int b, const BothKinds<Edge>& edges, const MotionField& field) const {
  const Body& body = bodies_[b];
  const Square& square = body.square;
  const std::optional<double> foot =
      field.ground_ratio(square.location + Vec2(0, square.half_size.y()));
  int others = 0;
  auto part = parts_.begin();
  for (const Edge& edge : edges.normal) {
    part = part_of(edge, part, parts_.end());
    const Vec2 off = (edge.location - square.location).cwiseAbs();
    const bool is_own = part != parts_.end() && part->edge == edge.id && part->body == b;
    if (is_own || edge.corner < 0 || (off.array() > kInner * square.half_size.array()).any()) {
      continue;
    }
    others += !(foot && edge.depth_ratio - edge.depth_ratio_sigma > *foot);
  }
  return others > body.now.parts;
}

/// Ends the bodies without a rebel circle that are not there any more.
void Bodies::end(const BothKinds<Edge>& edges, const MotionField& field) {
  const Pixels picture{camera_.width_px, camera_.height_px};
  int next = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    // The velocity changes by itself at the rate of the turnover.
    const double sigma_px =
        0.5 * edges_.turnover_ps * body.velocity_pxps.norm() * body.unseen_s * body.unseen_s;
    const bool is_there =
        body.now.circles > 0 || (is_sure(body) && picture.contain(body.square.location) &&
                                 sigma_px <= body.square.half_size.minCoeff() &&
                                 !is_seen_through(static_cast<int>(b), edges, field));
    body.next = is_there ? next++ : -1;
  }
}

void Bodies::give_out(std::span<const Square> normal) {
  parts_.clear();
  make_room(parts_, next_parts_.size());
  for (Part& part : next_parts_) {
    part.body = bodies_[part.body].next;
    if (part.body >= 0) parts_.push_back(part);
  }
  std::ranges::sort(parts_, {}, &Part::edge);
  std::erase_if(bodies_, [](const Body& body) { return body.next < 0; });
  squares_.clear();
  make_room(squares_, normal.size() + bodies_.size());
  for (const Square& square : normal) {
    const bool is_body = std::ranges::any_of(bodies_, [&](const Body& body) {
      return body.square.id == square.id || overlap(body.square, square) > kSame;
    });
    if (!is_body) squares_.push_back(square);
  }
  for (const Body& body : bodies_) squares_.push_back(body.square);
}

const std::vector<Square>& Bodies::step(const BothKinds<Edge>& edges,
                                        const CircleExpert::Result& circles,
                                        const std::vector<Square>& squares,
                                        const MotionField& field) {
  const auto& [normal, rebel] = circles.circles;
  const std::span<const Square> statics = std::span(squares).first(squares.size() - rebel.size());
  const std::span<const Square> rebels = std::span(squares).last(rebel.size());
  predict(field);
  find_parts(edges);
  const int known = static_cast<int>(bodies_.size());
  claim(edges, circles, rebels);
  for (int b = 0; b < known; ++b) follow(b, field);
  claim_static(normal, statics);
  assign(edges, circles.of_edges, known);
  measure(rebel, rebels, field);
  end(edges, field);
  give_out(statics);
  return squares_;
}

}  // namespace lcs
