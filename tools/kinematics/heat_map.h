/// \file
/// An error over the image, cell by cell.
#pragma once

#include <string>
#include <vector>

#include "tools/kinematics/rendered.h"

namespace lcs::kinematics {

struct HeatMap {
  std::string name;  ///< as "first order, pan 5 deg"
  int columns = 0, rows = 0;
  std::vector<double> errors_px;  ///< row by row; NaN: no point there stays in the image
};

/// The models where they fail: by angle, by depth, by mount.
std::vector<HeatMap> geometric_heat_maps(const StudyConfig& config);

/// Means over cells.
HeatMap heat_map_of(const std::string& name, const sim::Pinhole& camera,
                    const std::vector<ErrorAt>& errors);

}  // namespace lcs::kinematics
