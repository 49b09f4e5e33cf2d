/// \file
/// A scenario as Python has it: loaded and checked, with what its recording says where it has one.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "filter/kinematics/camera.h"
#include "scenarios/scenario.h"
#include "sim/pose.h"

namespace lcs::python {

/// Pinhole with square pixels, and how often it takes a picture.
struct Camera {
  sim::Pinhole pinhole;
  double rate_hz = 0;  ///< 0: not known
};

struct Scenario {
  scenario::Scenario asked;  ///< as it is written
  scenario::Scenario full;   ///< and as it is run: of a recording, with what that says of itself
  Camera camera;
};

/// "key=value" of each entry of a mapping, as `--set` takes it; none for None.
/// \param prefix before each key. \throws py::type_error for a value that is no text and no number.
std::vector<std::string> assignments_of(const pybind11::object& mapping,
                                        const std::string& prefix = "");

/// A UserWarning for each line. \throws py::error_already_set where the user has made them errors.
void warn(const std::vector<std::string>& lines);

void bind_scenario(pybind11::module_& module);

}  // namespace lcs::python
