/// Written by `lcs tune`, and not by hand: what the preset `default` has learnt from worlds of
/// `train`.
///
/// 2026-11-24, lcs 0.1.0 (f0c373a, changed since), 30 evaluations; objective 0.5537 -> 0.5597:
///   lcs tune out/train --validate out/validate --keys hypotheses.prior,hypotheses.turnover,hypotheses.bits_even,hypotheses.bits_weight,hypotheses.step_share,hypotheses.coupling,hypotheses.coupling_reach --set line.max_corners=1000 --evaluations 30 --seed 1
#pragma once

#include <array>
#include <utility>

namespace lcs {

/// Keys and values as `set` takes them.
inline constexpr std::array<std::pair<const char*, const char*>, 7> kLearnt{{
    {"hypotheses.prior", "0.0373"},
    {"hypotheses.turnover", "0.988"},
    {"hypotheses.bits_even", "86.6"},
    {"hypotheses.bits_weight", "0.162"},
    {"hypotheses.step_share", "0.108"},
    {"hypotheses.coupling", "8.72"},
    {"hypotheses.coupling_reach", "29.6"},
}};

}  // namespace lcs
