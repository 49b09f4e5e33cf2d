/// \file
/// Figures of whatever a detector said of a run's frames, by the bench's own scorer.
#pragma once

#include <pybind11/pybind11.h>

namespace lcs::python {

void bind_scorer(pybind11::module_& module);

}  // namespace lcs::python
