/// Written by `lcs tune`, and not by hand: what the preset `default` has learnt from worlds and
/// recordings of `train`.
///
/// 2026-11-26, lcs 0.1.0 (10de188, changed since), 26 evaluations; objective 0.6399 -> 0.6499:
///   lcs tune out/train out/recorded --keys hypotheses.noise,hypotheses.coupling,hypotheses.prior,hypotheses.newcomer --evaluations 26 --seed 1
#pragma once

#include <array>
#include <utility>

namespace lcs {

/// Keys and values as `set` takes them.
inline constexpr std::array<std::pair<const char*, const char*>, 10> kLearnt{{
    {"hypotheses.noise", "0.348"},
    {"hypotheses.ego_share", "0.02"},
    {"hypotheses.coupling", "12.3"},
    {"hypotheses.prior", "0.0349"},
    {"hypotheses.newcomer", "1.29"},
    {"hypotheses.turnover", "0.8"},
    {"hypotheses.bits_even", "86.6"},
    {"hypotheses.bits_weight", "0.23"},
    {"hypotheses.step_share", "0.212"},
    {"hypotheses.neighbour_reach", "29.6"},
}};

}  // namespace lcs
