/// \file
/// The filter, and what it says of a frame, as Python has them.
#pragma once

#include <pybind11/pybind11.h>

#include "filter/paper/any_filter.h"

namespace lcs::python {

/// What the filter says of a frame; never changed once it is made, so that arrays may look at it.
struct Result {
  FrameResult said;
  double filter_ms = 0;  ///< that it took
};

void bind_filter(pybind11::module_& module);

}  // namespace lcs::python
