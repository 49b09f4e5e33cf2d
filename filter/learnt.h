/// Written by `lcs tune`, and not by hand: what the preset `default` has learnt from worlds and
/// recordings of `train`.
///
/// 2026-11-25, lcs 0.1.0 (0045680, changed since), 14 evaluations; objective 0.6300 -> 0.6369:
///   lcs tune out/train out/recorded --keys hypotheses.coupling,hypotheses.prior,hypotheses.newcomer --evaluations 14 --seed 1
#pragma once

#include <array>
#include <utility>

namespace lcs {

/// Keys and values as `set` takes them.
inline constexpr std::array<std::pair<const char*, const char*>, 8> kLearnt{{
    {"hypotheses.coupling", "10.4"},
    {"hypotheses.prior", "0.0378"},
    {"hypotheses.newcomer", "1.4"},
    {"hypotheses.turnover", "0.8"},
    {"hypotheses.bits_even", "86.6"},
    {"hypotheses.bits_weight", "0.23"},
    {"hypotheses.step_share", "0.212"},
    {"hypotheses.neighbour_reach", "29.6"},
}};

}  // namespace lcs
