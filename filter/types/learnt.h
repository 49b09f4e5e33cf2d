/// Written by `lcs tune`: what the preset `default` has learnt from worlds and
/// recordings of `train`.
///
/// 2026-11-26, lcs 0.1.0 (146ad6b, changed since), 22 evaluations; objective 0.6570 -> 0.6636:
///   lcs tune out/train out/recorded --keys
///   hypotheses.noise,hypotheses.coupling,hypotheses.prior,hypotheses.newcomer,hypotheses.step_share
///   --evaluations 22 --seed 1
/// Since then by `lcs compare` on `train` and its plain rooms, 2026-11-29: coupling 13.2 -> 8,
/// newcomer 1.4 -> 1.8, and kind_turnover, which was a part of turnover.
#pragma once

#include <array>
#include <utility>

namespace lcs {

/// Keys and values for `set`.
inline constexpr std::array<std::pair<const char*, double>, 11> kLearnt{{
    {"hypotheses.noise", 0.352},
    {"hypotheses.coupling", 8},
    {"hypotheses.prior", 0.0397},
    {"hypotheses.newcomer", 1.8},
    {"hypotheses.step_share", 0.206},
    {"hypotheses.turnover", 0.8},
    {"hypotheses.kind_turnover", 0.1},
    {"hypotheses.ego_share", 0.02},
    {"hypotheses.bits_even", 86.6},
    {"hypotheses.bits_weight", 0.23},
    {"hypotheses.neighbour_reach", 29.6},
}};

}  // namespace lcs
