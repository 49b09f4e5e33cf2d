/// Written by `lcs tune`, and not by hand: what the preset `default` has learnt from worlds and
/// recordings of `train`.
///
/// 2026-11-25, lcs 0.1.0 (a3dd727, changed since), 1 evaluations; objective 0.6324 -> 0.6324:
///   lcs tune out/train out/recorded --keys hypotheses.newcomer --set hypotheses.newcomer=1.41 --evaluations 1 --seed 1
#pragma once

#include <array>
#include <utility>

namespace lcs {

/// Keys and values as `set` takes them.
inline constexpr std::array<std::pair<const char*, const char*>, 8> kLearnt{{
    {"hypotheses.newcomer", "1.41"},
    {"hypotheses.prior", "0.045"},
    {"hypotheses.turnover", "0.8"},
    {"hypotheses.bits_even", "86.6"},
    {"hypotheses.bits_weight", "0.23"},
    {"hypotheses.step_share", "0.212"},
    {"hypotheses.coupling", "8.72"},
    {"hypotheses.neighbour_reach", "29.6"},
}};

}  // namespace lcs
