/// \file
/// Things that stand, hang and move about: each a handful of parts about the point where it stands.
#pragma once

#include <string>
#include <vector>

#include "tools/worlds/kit.h"

namespace lcs::worlds {

struct Thing {
  std::string kind;
  Parts parts;
};

/// A thing of a kind, of drawn size and surfaces. \throws std::invalid_argument for no such kind.
Thing make_thing(Kit& kit, const std::string& kind);

/// \name Of a given size.
///@{
Thing carton(Kit& kit, const Eigen::Vector3d& size_m);
/// Boards between uprights, with what lies on them; length along x.
Thing shelf(Kit& kit, const Eigen::Vector3d& size_m, int boards, bool is_rack);
/// What hangs from a ceiling of that height.
Thing hanging(Kit& kit, double ceiling_m, double foot_m);
///@}

}  // namespace lcs::worlds
