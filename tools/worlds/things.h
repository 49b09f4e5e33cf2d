/// \file
/// Standing, hanging and moving things: each consists of a few parts about its origin.
#pragma once

#include <string>
#include <vector>

#include "tools/worlds/kit.h"

namespace lcs::worlds {

struct Thing {
  std::string kind;
  Parts parts;
};

/// A thing with random size and surfaces. \throws std::invalid_argument for an unknown kind.
Thing make_thing(Kit& kit, const std::string& kind);

/// \name Things of a given size.
///@{
Thing carton(Kit& kit, const Eigen::Vector3d& size_m);
/// Boards between uprights, with goods on them; length along x.
Thing shelf(Kit& kit, const Eigen::Vector3d& size_m, int boards, bool is_rack);
/// A thing that hangs from a ceiling of that height.
Thing hanging(Kit& kit, double ceiling_m, double foot_m);
///@}

}  // namespace lcs::worlds
