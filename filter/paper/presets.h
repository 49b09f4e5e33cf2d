/// \file
/// The paper's values. What they have in common with the preset `default` stands in `Parameters`.
#pragma once

#include "filter/parameters.h"

namespace lcs {

/// Table 1. Its rules are the printed ones.
inline Parameters lab_preset() {
  Parameters p;
  p.circle.edge_rule = EdgeRule::paper;
  p.square.layer_rule = LayerRule::couples;
  return p;
}

/// Section 5.2: the ranks of trust are re-tuned, the rest has "minor changes" that are not printed.
inline Parameters cars_preset() {
  Parameters p = lab_preset();
  p.circle.trust = {1, 4, 7};
  p.square.trust = {2, 5, 8};
  return p;
}

}  // namespace lcs
