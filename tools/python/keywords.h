/// \file
/// The arguments of a function that carries out a request, from the rows of its options
/// (tools/app/option.h): names, types and defaults are stated there only.
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <string>

#include "tools/app/option.h"

namespace lcs::python {

namespace py = pybind11;

/// How a function is called.
struct Call {
  std::size_t positional = 1;  ///< so many of the options may be given without their names
  bool takes_progress = false;
};

/// The first line of a function's docstring, in the words of pybind11.
/// \param options of a request in which nothing is set.
std::string signature_of(const Call& call, const app::Options& options);

/// Sets the options that the arguments of a call name.
/// \return the argument `progress`, or None.
/// \throws py::type_error for unknown, missing and wrong arguments; as `Option::read`.
py::object read_arguments(const Call& call, const app::Options& options, const py::args& values,
                          const py::kwargs& named);

}  // namespace lcs::python
