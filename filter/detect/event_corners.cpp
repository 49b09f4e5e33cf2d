#include "filter/detect/event_corners.h"

#include <algorithm>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

namespace lcs {
namespace {

template <std::size_t N>
using Ring = std::array<std::array<int, 2>, N>;

/// The circle of which this is the first of four quarters.
template <std::size_t N>
constexpr Ring<4 * N> circle_of(Ring<N> quarter) {
  Ring<4 * N> circle{};
  for (std::size_t i = 0; i < circle.size(); ++i) {
    auto& [x, y] = quarter[i % N];
    circle[i] = {x, y};
    x = std::exchange(y, -x);  // its place in the next quarter
  }
  return circle;
}

/// Bresenham's circles, counter-clockwise from the pixel below the centre.
constexpr Ring<16> kSmall = circle_of<4>({{{0, 3}, {1, 3}, {2, 2}, {3, 1}}});
constexpr Ring<20> kLarge = circle_of<5>({{{0, 4}, {1, 4}, {2, 3}, {3, 2}, {4, 1}}});
/// Least and greatest length of the arc of a corner.
constexpr int kSmallLeast = 3, kSmallMost = 6, kLargeLeast = 4, kLargeMost = 8;

constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::min() / 2;

}  // namespace

ArcStar::ArcStar(int width_px, int height_px)
    : width_px_(width_px),
      height_px_(height_px),
      pixels_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px),
              {{kNever_ns, kNever_ns}, {kNever_ns, kNever_ns}}) {}

/// Whether the arc of the newest events on a circle is as long as an arc of a corner.
/// \param least,most length of the arc of a corner, pixels.
template <std::size_t N>
bool ArcStar::has_arc(const Ring<N>& circle, int x, int y, bool is_on, int least, int most) const {
  std::array<std::int64_t, N> t_ns;
  for (std::size_t i = 0; i < N; ++i) {
    t_ns[i] = pixels_[index(x + circle[i][0], y + circle[i][1])].surface_ns[is_on];
  }
  const auto newest = static_cast<std::size_t>(std::ranges::max_element(t_ns) - t_ns.begin());
  // the neighbours at both ends of the arc, and the oldest that each side has passed so far
  std::size_t right = (newest + 1) % N, left = (newest + N - 1) % N;
  std::int64_t oldest_ns = t_ns[newest], right_oldest_ns = t_ns[right], left_oldest_ns = t_ns[left];
  int arc = least;  // its number of pixels, at least so many
  for (int length = 1; length < static_cast<int>(N); ++length) {
    const bool is_right = t_ns[right] > t_ns[left];
    std::size_t& next = is_right ? right : left;
    std::int64_t& side_oldest_ns = is_right ? right_oldest_ns : left_oldest_ns;
    // the first `least` pixels are of the arc in any case
    if (length < least || t_ns[next] >= oldest_ns) {
      if (length >= least) arc = length + 1;
      oldest_ns = std::min(oldest_ns, side_oldest_ns);
    }
    next = is_right ? (right + 1) % N : (left + N - 1) % N;
    side_oldest_ns = std::min(side_oldest_ns, t_ns[next]);
  }
  const int rest = static_cast<int>(N) - arc;
  return arc <= most || (rest >= least && rest <= most);
}

bool ArcStar::add(int x, int y, std::int64_t t_ns, bool is_on) {
  Pixel& pixel = pixels_[index(x, y)];
  const std::int64_t last_ns = pixel.last_ns[is_on];
  now_ns_ = t_ns;
  pixel.last_ns[is_on] = t_ns;
  if (t_ns <= last_ns + kBurst_ns && pixel.last_ns[!is_on] <= last_ns) return false;
  pixel.surface_ns[is_on] = t_ns;
  if (x < kBorder_px || y < kBorder_px || x >= width_px_ - kBorder_px ||
      y >= height_px_ - kBorder_px) {
    return false;
  }
  return has_arc(kSmall, x, y, is_on, kSmallLeast, kSmallMost) &&
         has_arc(kLarge, x, y, is_on, kLargeLeast, kLargeMost);
}

cv::Mat1b ArcStar::picture() const {
  constexpr int kNeutral = 128, kMost = 127;
  cv::Mat1b picture(height_px_, width_px_);
  std::ranges::transform(pixels_, picture.begin(), [&](const Pixel& pixel) {
    const bool is_on = pixel.surface_ns[1] > pixel.surface_ns[0];
    const std::int64_t left_ns = kFade_ns - (now_ns_ - pixel.surface_ns[is_on]);
    const auto grey = static_cast<int>(kMost * std::max<std::int64_t>(left_ns, 0) / kFade_ns);
    return static_cast<std::uint8_t>(kNeutral + (is_on ? grey : -grey));
  });
  return picture;
}

void EventCorners::add(int x, int y, std::int64_t t_ns, bool is_on) {
  if (!arc_star_.add(x, y, t_ns, is_on)) return;
  static_assert(kReach_px < ArcStar::kBorder_px);
  int nearest = kNone, nearest_px2 = 0;
  for (int dy = -kReach_px; dy <= kReach_px; ++dy) {
    for (int dx = -kReach_px; dx <= kReach_px; ++dx) {
      const int chain = chain_at_(y + dy, x + dx), px2 = dx * dx + dy * dy;
      if (chain == kNone || px2 > kReach_px * kReach_px) continue;
      // of two at one distance the elder
      if (nearest != kNone && std::tie(nearest_px2, nearest) < std::tie(px2, chain)) continue;
      nearest = chain;
      nearest_px2 = px2;
    }
  }
  if (nearest == kNone) {
    nearest = static_cast<int>(chains_.size());
    chains_.emplace_back();
  }
  Chain& chain = chains_[static_cast<std::size_t>(nearest)];
  if (!chain.events_px.empty()) pixel_of(chain) = kNone;
  chain.events_px.emplace_back(static_cast<float>(x), static_cast<float>(y));
  chain.last_ns = t_ns;
  pixel_of(chain) = nearest;
}

int& EventCorners::pixel_of(const Chain& chain) {
  const Eigen::Vector2i px = chain.events_px.back().cast<int>();
  return chain_at_(px.y(), px.x());
}

std::vector<Eigen::Vector2f> EventCorners::step() {
  for (const Chain& chain : chains_) pixel_of(chain) = kNone;
  std::erase_if(chains_, [](const Chain& chain) { return chain.events_px.size() < kLeastEvents; });
  // chains are in the order of their first events, so that equal times keep an order
  std::ranges::stable_sort(chains_, std::ranges::greater(), &Chain::last_ns);
  std::vector<Eigen::Vector2f> corners_px;
  for (const Chain& chain : chains_) {
    const std::size_t taken = std::min(chain.events_px.size(), kMeanEvents);
    Eigen::Vector2f sum = Eigen::Vector2f::Zero();
    for (const Eigen::Vector2f& px : std::span(chain.events_px).last(taken)) sum += px;
    const Eigen::Vector2f place_px = sum / static_cast<float>(taken);
    const auto is_near = [&](const Eigen::Vector2f& other_px) {
      return (other_px - place_px).norm() < kApart_px;
    };
    if (std::ranges::none_of(corners_px, is_near)) corners_px.push_back(place_px);
  }
  chains_.clear();
  std::ranges::sort(corners_px, {},
                    [](const Eigen::Vector2f& px) { return std::tuple(px.y(), px.x()); });
  return corners_px;
}

}  // namespace lcs
