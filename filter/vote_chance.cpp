#include "filter/vote_chance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lcs {
namespace {

/// Corners expected about a place: fewer than the first level count as the first, and so on up;
/// with more than the last nearly every place has one.
constexpr double kFirstLevel = 1e-3, kLastLevel = 4, kLevelRatio = 1.2;

/// That a place has a corner, if as many are expected there and they lie without order.
double occupied(double expected) {
  return 1 - std::exp(-expected);
}

/// The probabilities of 0, 1, ... votes with one voter more.
std::vector<double> with_another(const std::vector<double>& votes, double once, double twice) {
  std::vector<double> more(votes.size() + 2, 0.0);
  for (std::size_t i = 0; i < votes.size(); ++i) {
    more[i] += votes[i] * (1 - once);
    more[i + 1] += votes[i] * once * (1 - twice);
    more[i + 2] += votes[i] * once * twice;
  }
  return more;
}

}  // namespace

VoteChance::VoteChance(double hit_1_px, double hit_2_px, int max_voters, double false_motions)
    : hit_1_px2_(hit_1_px * hit_1_px), false_motions_(false_motions) {
  for (double level = kFirstLevel; level < kLastLevel; level *= kLevelRatio)
    levels_.push_back(level);
  for (const double level : levels_) {
    const double once = occupied(level);
    const double twice = occupied(level * hit_2_px * hit_2_px / hit_1_px2_);
    std::vector<double> votes = {0, 1 - twice, twice};  // the corner's own
    std::vector<AtLeast>& by_voters = at_least_.emplace_back();
    for (int voters = 0; voters <= max_voters; ++voters) {
      if (voters > 0) votes = with_another(votes, once, twice);
      AtLeast& at_least = by_voters.emplace_back(votes);
      for (std::size_t i = votes.size() - 1; i > 0; --i) at_least[i - 1] += at_least[i];
    }
  }
}

int VoteChance::least(double corners_ppx2, int voters, double tries) const {
  const double expected = corners_ppx2 * std::numbers::pi * hit_1_px2_;
  const auto level = std::lower_bound(levels_.begin(), levels_.end() - 1, expected);
  const auto level_index = static_cast<std::size_t>(level - levels_.begin());
  const AtLeast& at_least = at_least_[level_index][static_cast<std::size_t>(voters)];
  const auto enough = std::find_if(at_least.begin() + 1, at_least.end(),
                                   [&](double p) { return tries * p < false_motions_; });
  return static_cast<int>(enough - at_least.begin());
}

}  // namespace lcs
