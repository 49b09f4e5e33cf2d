/// \file
/// The Python class of a scenario: loaded and checked, completed by its recording if it has one.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/base/pose.h"

namespace lcs::python {

/// Pinhole camera with square pixels and its frame rate.
struct Camera : sim::Pinhole {
  double rate_hz = 0;  ///< 0: unknown
};

struct Scenario {
  scenario::Scenario asked;  ///< as in the file
  scenario::Scenario full;   ///< as it is run: with the recording's own data, if there is one
  Camera camera;
};

/// "key=value" of each entry of a mapping, in the form of `--set`; empty for None.
/// \param prefix of each key. \throws py::type_error for a value that is neither text nor number.
std::vector<std::string> assignments_of(const pybind11::object& mapping,
                                        const std::string& prefix = "");

/// Issues a UserWarning for each line. \throws py::error_already_set if Python's filters raise it.
void warn(const std::vector<std::string>& lines);

}  // namespace lcs::python
