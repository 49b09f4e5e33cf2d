/// \file
/// The Python classes that score any detector's results on a run's frames by the bench's scorer.
#pragma once

#include <pybind11/pybind11.h>

namespace lcs::python {

void bind_scorer(pybind11::module_& module);

}  // namespace lcs::python
