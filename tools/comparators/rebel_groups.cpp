#include "tools/comparators/rebel_groups.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "filter/kinematics/geometry.h"
#include "tools/recording/box.h"
#include "tools/scoring/score_squares.h"

namespace lcs::comparators {
namespace {

Edge edge_of(Id id, int corner, const Vec2& location, const CornerMotion& motion, double dt_s) {
  Edge edge;
  edge.id = id;
  edge.corner = corner;
  edge.location = edge.predicted = location;
  edge.origin = edge.rotated = location - motion.step_px;
  edge.angle = angle_of(motion.step_px);
  if (dt_s > 0) edge.speed = motion.step_px.norm() / dt_s;
  return edge;
}

}  // namespace

RebelGroups::RebelGroups(const GroupParameters& parameters) : parameters_(parameters) {
  if (!(parameters.reach_px > 0) || parameters.least_corners < 1) {
    throw std::invalid_argument("a parameter of the groups of rebels is out of its range");
  }
}

const FrameResult& RebelGroups::group(std::span<const Eigen::Vector2f> corners_px,
                                      std::span<const CornerMotion> motions, double dt_s) {
  result_.layers = {};
  result_.verdicts.assign(corners_px.size(), Verdict::pending);
  points_.clear();
  corner_of_.clear();
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (!motions[i].known) continue;
    result_.verdicts[i] = Verdict::normal;
    if (!motions[i].off) continue;
    points_.push_back(corners_px[i].cast<double>());
    corner_of_.push_back(static_cast<int>(i));
  }
  link(motions);

  members_.collect(sets_.roots(), points_.size());
  for (std::size_t root = 0; root < points_.size(); ++root) {
    const std::span<const int> members = members_.of(root);
    if (std::ssize(members) >= parameters_.least_corners) add_group(members, motions, dt_s);
  }
  name_squares();

  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (result_.verdicts[i] != Verdict::normal) continue;
    result_.layers.normal_edges.push_back(
        edge_of(next_edge_++, static_cast<int>(i), corners_px[i].cast<double>(), motions[i], dt_s));
  }
  return result_;
}

void RebelGroups::link(std::span<const CornerMotion> motions) {
  grid_.build(points_, parameters_.reach_px);
  sets_.reset(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vec2& step = motions[corner_of_[i]].step_px;
    grid_.visit_within(points_[i], parameters_.reach_px, [&](int j, double) {
      if (j <= static_cast<int>(i)) return;
      const Vec2& other = motions[corner_of_[j]].step_px;
      const double like = std::max(parameters_.like_px,
                                   parameters_.like_share * 0.5 * (step.norm() + other.norm()));
      if ((step - other).norm() <= like) sets_.join(static_cast<int>(i), j);
    });
  }
}

void RebelGroups::add_group(std::span<const int> members, std::span<const CornerMotion> motions,
                            double dt_s) {
  Layers& layers = result_.layers;
  Vec2 step = Vec2::Zero();
  hull_.clear();
  for (const int i : members) {
    const int corner = corner_of_[i];
    result_.verdicts[corner] = Verdict::rebel;
    hull_.add(points_[i]);
    step += motions[corner].step_px / static_cast<double>(members.size());
    Edge edge = edge_of(next_edge_++, corner, points_[i], motions[corner], dt_s);
    edge.rebel = true;
    edge.circle = static_cast<int>(layers.rebel_circles.size());
    layers.rebel_edges.push_back(edge);
  }

  const auto [low, high] = hull_.box();
  Circle circle;
  circle.id = next_circle_++;
  circle.rebel = true;
  circle.location = 0.5 * (low + high);
  for (const int i : members) {
    circle.radius = std::max(circle.radius, (points_[i] - circle.location).norm());
  }
  circle.origin = circle.location - step;
  circle.angle = angle_of(step);
  if (dt_s > 0) circle.speed = step.norm() / dt_s;
  circle.members = static_cast<int>(members.size());
  layers.rebel_circles.push_back(circle);

  if ((high - low).prod() < parameters_.least_area_px2) return;
  Square square;
  square.location = circle.location;
  square.half_size = 0.5 * (high - low);
  square.outline = hull_.outline();
  square.origin = circle.origin;
  square.angle = circle.angle;
  square.speed = circle.speed;
  square.circles = square.rebel_circles = 1;
  layers.squares.push_back(square);
}

void RebelGroups::name_squares() {
  std::vector<Square>& squares = result_.layers.squares;
  std::vector<scoring::BoxPair> pairs;  // of positions in the lists
  for (std::size_t a = 0; a < squares.size(); ++a) {
    for (std::size_t b = 0; b < last_squares_.size(); ++b) {
      const double overlap = recording::intersection_over_union(
          recording::box_of(squares[a]), recording::box_of(last_squares_[b]));
      if (overlap >= parameters_.same_overlap) pairs.push_back({overlap, static_cast<int>(a), b});
    }
  }
  for (const auto& [overlap, now, last] : scoring::one_to_one(std::move(pairs))) {
    squares[now].id = last_squares_[last].id;
    squares[now].age = last_squares_[last].age + 1;
  }
  for (Square& square : squares) {
    if (square.id == 0) square.id = next_square_++;
  }
  last_squares_ = squares;
}

}  // namespace lcs::comparators
