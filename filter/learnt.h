/// Written by `lcs tune`, and not by hand: what the preset `default` has learnt from worlds of
/// `train`.
///
/// 2026-11-24, lcs 0.1.0 (741e0aa, changed since), 1 evaluations; objective 0.6205 -> 0.6205:
///   lcs tune out/train --validate out/validate --evaluations 1 --seed 1
#pragma once

#include <array>
#include <utility>

namespace lcs {

/// Keys and values as `set` takes them.
inline constexpr std::array<std::pair<const char*, const char*>, 13> kLearnt{{
    {"field.nearest_depth", "0.4"},
    {"hypotheses.noise", "0.6"},
    {"hypotheses.prior", "0.03"},
    {"hypotheses.turnover", "1"},
    {"hypotheses.wrong", "0.05"},
    {"hypotheses.ego_share", "0.02"},
    {"hypotheses.bits_even", "77.5"},
    {"hypotheses.bits_weight", "0.152"},
    {"hypotheses.voters_share", "0.5"},
    {"hypotheses.step_share", "0.1"},
    {"hypotheses.coupling", "8"},
    {"hypotheses.coupling_reach", "30"},
    {"circle.min_width", "1.5"},
}};

}  // namespace lcs
