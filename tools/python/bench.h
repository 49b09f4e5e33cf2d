/// \file
/// The commands of the program as Python functions.
#pragma once

#include <pybind11/pybind11.h>

namespace lcs::python {

void bind_bench(pybind11::module_& module);

}  // namespace lcs::python
