/// \file
/// The Python module behind the package `lcs`.
#include <pybind11/pybind11.h>

#include <opencv2/core.hpp>

#include "scenarios/input/message.h"
#include "tools/python/type.h"
#include "tools/recording/recording_fields.h"

namespace lcs::python {
namespace {

PyObject* error_type = nullptr;  // lives as long as the process

/// Converts a C++ exception to a Python one, with the text that the program prints after "lcs: ".
void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const py::error_already_set&) {
    throw;
  } catch (const py::cast_error&) {
    PyErr_SetString(PyExc_TypeError,
                    "an argument is not of its class; see help() of the called name");
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::invalid_argument& error) {
    PyErr_SetString(PyExc_ValueError, input::message_of(error).c_str());
  } catch (const cv::Exception& error) {
    PyErr_SetString(error.code == cv::Error::StsNoMem ? PyExc_MemoryError : error_type,
                    input::message_of(error).c_str());
  } catch (const std::exception& error) {
    PyErr_SetString(error_type, input::message_of(error).c_str());
  }
}

/// Adds an IntEnum. \param words the members' names by number; empty for an unused number.
template <class Words>
void add_enumeration(py::module_& module, const char* name, const char* about, const Words& words) {
  py::dict members;
  int number = 0;
  for (const std::string word : words) {
    if (!word.empty()) members[py::str(word).attr("upper")()] = number;
    ++number;
  }
  const py::object type =
      py::module_::import("enum").attr("IntEnum")(name, members, py::arg("module") = "lcs");
  type.attr("__doc__") = about;
  module.attr(name) = type;
}

}  // namespace
}  // namespace lcs::python

PYBIND11_MODULE(_core, module) {
  namespace python = lcs::python;
  python::error_type = PyErr_NewExceptionWithDoc(
      "lcs.Error", "An error as the program lcs prints it: the problem, its place, the remedy.",
      nullptr, nullptr);
  module.attr("Error") = pybind11::handle(python::error_type);
  pybind11::register_exception_translator(python::translate);
  module.attr("__version__") = LCS_VERSION;
  python::add_enumeration(module, "Verdict", "The verdict on a corner.", lcs::recording::kVerdicts);
  python::add_enumeration(
      module, "Reason",
      "Which of the filter's rules settled a corner's verdict (filter/types/reason.h).",
      lcs::recording::kReasonWords);
  python::add_enumeration(module, "Label", "The truth of a corner (tools/scoring/SCORING.md).",
                          lcs::recording::kLabels);
  python::bind_scenario(module);
  python::bind_frame(module);
  python::bind_filter(module);
  python::bind_live(module);
  python::bind_scorer(module);
  python::bind_detector(module);
  python::bind_bench(module);
  for (const auto& [name, value] : pybind11::cast<pybind11::dict>(module.attr("__dict__"))) {
    if (PyCFunction_Check(value.ptr())) value.attr("__module__") = "lcs";  // as the classes
  }
  python::freeze_classes(module);
}
