/// \file
/// The Python classes of the filter and of its result for a frame.
#pragma once

#include <pybind11/pybind11.h>

#include "filter/types/frame_result.h"
#include "tools/recording/recording.h"

namespace lcs::python {

/// A detector's result for one frame. Immutable, because NumPy arrays are views of it.
struct Result {
  FrameResult said;
  double step_ms = 0;  ///< duration of the detector's step
  bench::DetectorInfo detector = {};
  double bench::FrameTimes::*step_time = &bench::FrameTimes::filter_ms;  ///< null: none
  bool wants_signatures = true;
  bench::SquareMasks masks = {};
};

void bind_filter(pybind11::module_& module);

}  // namespace lcs::python
