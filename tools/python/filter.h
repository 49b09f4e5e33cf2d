/// \file
/// The Python classes of the filter and of its result for a frame.
#pragma once

#include "filter/types/frame_result.h"
#include "tools/recording/recording.h"

namespace lcs::python {

/// A detector's result for one frame. Immutable, because NumPy arrays are views of it.
struct Result {
  FrameResult said;
  double step_ms = 0;  ///< duration of the detector's step
  recording::DetectorInfo detector = {};
  double recording::FrameTimes::*step_time = &recording::FrameTimes::filter_ms;  ///< null: none
  bool wants_signatures = true;
  recording::SquareMasks masks = {};
};

}  // namespace lcs::python
