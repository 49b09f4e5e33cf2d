/// \file
/// The Python class of the comparators and of detectors in programs.
#pragma once

#include <pybind11/pybind11.h>

namespace lcs::python {

void bind_detector(pybind11::module_& module);

}  // namespace lcs::python
