/// \file
/// The detector that a request names.
#pragma once

#include <string>

#include "tools/comparators/detectors.h"

namespace lcs::app {

struct DetectorChoice {
  std::string name;     ///< "": lcs, or a default name for a program or file
  std::string command;  ///< of a detector program; "": no program
  double timeout_s = comparators::Program{}.timeout_s;
  std::string detections;  ///< CSV file or folder; "": none
};

/// The detector. Records the files that a detector's command names as inputs of this process.
/// \throws std::invalid_argument as the `comparators::spec_of` functions do.
comparators::DetectorSpec spec_of(const DetectorChoice& choice);

}  // namespace lcs::app
