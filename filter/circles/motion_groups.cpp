#include "filter/circles/motion_groups.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "filter/kinematics/geometry.h"
#include "filter/vectors/refill.h"
#include "filter/vectors/vectors.h"

namespace lcs {
namespace {

/// Log odds that two edges at one place belong to one body.
constexpr double kNear = 2;
/// Cost of the links that are tried first; has no effect on the result. One unit of distance.
const float kShort = 0.5;

}  // namespace

MotionGroups::MotionGroups(const Intrinsics& camera, const CircleParameters& parameters,
                           const EdgeParameters& edges)
    : camera_(camera), parameters_(parameters), edge_parameters_(edges) {}

void MotionGroups::gather(const std::vector<Edge>& edges, const MotionField& field) {
  // Image projection of the unit vector upwards; zero if the camera looks straight down.
  const Vec2 up = field.ground() ? Vec2(field.ground()->up_C.head<2>()) : Vec2::Zero();
  const Vec2 axis = up.isZero() ? Vec2(Vec2::UnitY()) : up.normalized();
  const double upward =
      std::sqrt(1 - (1 - parameters_.upward * parameters_.upward) * up.squaredNorm());
  const auto seen = static_cast<std::size_t>(
      std::ranges::count_if(edges, [](const Edge& edge) { return edge.corner >= 0; }));
  const auto empty = [&](auto&... columns) { (..., (columns.clear(), make_room(columns, seen))); };
  empty(of_edge_, sums_, depths_, variances_, reach_px_, points_);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& edge = edges[i];
    if (edge.corner < 0 || (!edge.rebel && !has_depth(edge))) continue;
    const Vec2 h = (edge.location - camera_.centre_px) / camera_.focal_px;
    Vec2 value;
    double sigma = 0;
    if (edge.rebel) {
      value = edge.velocity() * field.dt_s();
      sigma = 2 * edge_parameters_.noise_px;
      reach_px_.push_back(edge_parameters_.neighbour_reach_px);
    } else {
      value = {edge.depth_ratio / field.reference_depth_m(), 0};
      sigma = edge.depth_ratio_sigma / field.reference_depth_m();
      reach_px_.push_back(parameters_.gap_m * value.x() * camera_.focal_px);
    }
    const double deviation = Vec2(sigma, parameters_.roughness * value.norm()).norm();
    sums_.emplace_back(h, value, deviation);
    // Parts of a near body that overtakes have unlike velocities; only depths are compared.
    depths_.push_back(value.x());
    variances_.push_back(edge.rebel ? std::numeric_limits<double>::infinity()
                                    : deviation * deviation);
    of_edge_.push_back(static_cast<int>(i));
    points_.emplace_back(cross(axis, edge.location), upward * axis.dot(edge.location));
  }
  rebel_ = !edges.empty() && edges.front().rebel;
  ground_known_ = !rebel_ && field.ground().has_value();
  if (!ground_known_) return;
  const Ground& ground = *field.ground();
  ground_.mean.col(0) << -ground.up_C.z(), -ground.up_C.x(), -ground.up_C.y();
  ground_.mean.col(0) /= ground.height_m;
  ground_.level_sigma = ground_.slope_sigma =
      std::max(1e-6, field.ground_slack() / field.reference_depth_m());
}

/// Links each two nodes that are near each other and, if they are normal, have like depths.
void MotionGroups::link() {
  grid_.build(points_, edge_parameters_.neighbour_reach_px);
  const std::size_t count = points_.size();
  for (auto* column : {&reach2_px2_, &depth_, &variance_}) {
    refill_column(*column, count);
  }
  refill_column(found_, count);
  refill_column(distance2_, count);
  for (std::size_t place = 0; place < count; ++place) {
    const int node = grid_.index_at(place);
    reach2_px2_[place] = static_cast<float>(reach_px_[node] * reach_px_[node]);
    depth_[place] = static_cast<float>(depths_[node]);
    variance_[place] = static_cast<float>(variances_[node]);
  }
  const LinkColumns nodes = {grid_.x_px(),  grid_.y_px(),     reach2_px2_.data(),
                             depth_.data(), variance_.data(), static_cast<float>(kFar * kFar)};
  // Reserves the most links, so that no later frame allocates.
  for (std::vector<Couple>* links : {&short_links_, &long_links_}) {
    links->clear();
    make_room(*links, kCrowd / 2 * count);
  }
  sorter_.make_room(kCrowd / 2 * count);
  for (std::size_t place = 0; place < count; ++place) {
    const int i = grid_.index_at(place);
    const double radius_px =
        std::min<double>(kFar * reach_px_[i], grid_.crowd_radius(points_[i], kCrowd));
    grid_.visit_runs_after(place, radius_px, [&](std::size_t first, std::size_t last) {
      const std::size_t found =
          loops().links(nodes, place, static_cast<float>(radius_px * radius_px), first, last,
                        found_.data(), distance2_.data());
      for (std::size_t k = 0; k < found; ++k) {
        const int j = grid_.index_at(static_cast<std::size_t>(found_[k]));
        const float cost = 0.5F * distance2_[k];
        (cost < kShort ? short_links_ : long_links_)
            .emplace_back(cost, std::min(i, j), std::max(i, j));
      }
    });
  }
}

/// Evidence of a body whose values have the size `scale`. Velocities may vary by their own size
/// over an approaching body.
double MotionGroups::body_evidence(const PlaneSums& sums, double scale) const {
  const double slope = (rebel_ ? 1 : kSlant) * scale;
  return sums.evidence({PlaneCoefficients::Zero(), scale, slope}, rebel_ ? 2 : 1);
}

double MotionGroups::ground_evidence(const PlaneSums& sums) const {
  return sums.evidence(ground_, 1);
}

/// The larger of the body's and the ground's evidence. \param ground the ground's, if it is known.
double MotionGroups::evidence(const PlaneSums& sums, double scale, double ground) const {
  const double body = body_evidence(sums, scale);
  return ground_known_ ? std::max(body, ground) : body;
}

/// Whether the two groups were compared before, and have not grown since. The links grow costlier,
/// so that the answer was and stays no.
bool MotionGroups::is_refused(int a, int b) const {
  const Refusal& last = refused_[a];
  return last.other == b && last.size == sizes_[a] && last.other_size == sizes_[b];
}

/// Merges groups along links, cheapest first. \param most the links cost less.
void MotionGroups::merge(std::vector<Couple>& links, float most) {
  sorter_.sort(links, most);
  for (const Couple& link : links) {
    if (sets_.are_together(link.a, link.b)) continue;
    const int a = sets_.root(link.a), b = sets_.root(link.b);
    if (is_refused(a, b) || is_refused(b, a)) continue;
    PlaneSums both = sums_[a];
    both += sums_[b];
    const double scale = both.magnitude();
    const double ground = ground_known_ ? ground_evidence(both) : 0;
    const double gain = evidence(both, scale, ground) - evidence(sums_[a], scale, of_ground_[a]) -
                        evidence(sums_[b], scale, of_ground_[b]) + kNear - link.cost;
    if (!(gain > 0)) {
      refused_[a] = {b, sizes_[a], sizes_[b]};
      refused_[b] = {a, sizes_[b], sizes_[a]};
      continue;
    }
    sets_.join(a, b);
    sums_[a] = both;
    of_ground_[a] = ground;
    sizes_[a] += sizes_[b];
  }
}

void MotionGroups::merge() {
  sets_.reset(points_.size());
  refill(of_ground_, points_.size());
  refill(sizes_, points_.size(), 1);
  refill(refused_, points_.size());
  if (ground_known_) {
    for (std::size_t i = 0; i < sums_.size(); ++i) of_ground_[i] = ground_evidence(sums_[i]);
  }
  // Most links lie within a group that the short ones make, and need not be sorted.
  merge(short_links_, kShort);
  std::erase_if(long_links_,
                [&](const Couple& link) { return sets_.are_together(link.a, link.b); });
  merge(long_links_, static_cast<float>(0.5 * kFar * kFar));
}

const std::vector<MotionGroups::Group>& MotionGroups::group(const std::vector<Edge>& edges,
                                                            const MotionField& field) {
  gather(edges, field);
  link();
  merge();
  grouped_.clear();
  groups_.clear();
  make_room(grouped_, points_.size());
  make_room(groups_, points_.size());
  members_.collect(sets_.roots(), points_.size());
  for (std::size_t root = 0; root < points_.size(); ++root) {
    const std::span<const int> members = members_.of(root);
    if (members.empty()) continue;
    const PlaneSums& sums = sums_[root];
    const bool ground =
        ground_known_ && ground_evidence(sums) > body_evidence(sums, sums.magnitude());
    groups_.push_back({grouped_.size(), members.size(), ground});
    for (const int node : members) grouped_.push_back(of_edge_[node]);
  }
  return groups_;
}

PlaneSums::PlaneSums(const Vec2& h, const Vec2& value, double sigma) {
  const double weight = 1 / (sigma * sigma);
  const Eigen::Vector3d x(1, h.x(), h.y());
  squares_ = weight * x * x.transpose();
  products_ = weight * x * value.transpose();
  values2_ = weight * value.squaredNorm();
}

PlaneSums& PlaneSums::operator+=(const PlaneSums& other) {
  squares_ += other.squares_;
  products_ += other.products_;
  values2_ += other.values2_;
  return *this;
}

double PlaneSums::evidence(const PlanePrior& prior, int values) const {
  return values == 1 ? evidence_of<1>(prior) : evidence_of<2>(prior);
}

template <int kValues>
double PlaneSums::evidence_of(const PlanePrior& prior) const {
  using Coefficients = Eigen::Matrix<double, 3, kValues>;
  const Coefficients products = products_.leftCols<kValues>(),
                     mean = prior.mean.leftCols<kValues>();
  // Relative to the prior mean and to the centroid of the places, where the level's prior holds.
  // There level and slopes are uncorrelated.
  const double count = squares_(0, 0);
  const Vec2 middle = squares_.block<2, 1>(1, 0) / count;
  const Coefficients left = products - squares_ * mean;
  const double left2 = values2_ - (mean.array() * (products + left).array()).sum();
  const Eigen::Matrix<double, 2, kValues> T = left.template bottomRows<2>() - middle * left.row(0);
  const double level_P = 1 / (prior.level_sigma * prior.level_sigma);
  const double slope_P = 1 / (prior.slope_sigma * prior.slope_sigma);
  Eigen::Matrix2d A = squares_.bottomRightCorner<2, 2>() - count * middle * middle.transpose();
  A.diagonal().array() += slope_P;
  const double level_A = count + level_P;
  const double explained =
      left.row(0).squaredNorm() / level_A + (T.array() * (A.inverse() * T).array()).sum();
  const double spread = level_A * A.determinant() / (level_P * slope_P * slope_P);
  return -0.5 * (left2 - explained + kValues * double{std::log(static_cast<float>(spread))});
}

}  // namespace lcs
