/// \file
/// The Python classes of the filter and of its result for a frame.
#pragma once

#include <pybind11/pybind11.h>

#include "filter/paper/any_filter.h"

namespace lcs::python {

/// The filter's result for one frame. Immutable, because NumPy arrays are views of it.
struct Result {
  FrameResult said;
  double filter_ms = 0;  ///< duration of the filter's step
};

void bind_filter(pybind11::module_& module);

}  // namespace lcs::python
