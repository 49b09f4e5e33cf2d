/// \file
/// Common properties of the module's classes. Every object holds a value from its creation, since
/// only a call of its class or C++ code can create it.
#pragma once

#include <pybind11/pybind11.h>

namespace lcs::python {

namespace py = pybind11;

/// The metaclass of the module's classes. Calling a class makes an object without `tp_new`.
py::handle callable_type();

/// Makes `__new__` raise TypeError.
void refuse_new(PyHeapTypeObject* type);

/// Makes the final class `lcs.NAME` of the module.
template <class T, class... Options>
py::class_<T, Options...> class_of(py::module_& module, const char* name, const char* about) {
  py::class_<T, Options...> made(module, name, about, py::is_final(),
                                 py::metaclass(callable_type()),
                                 py::custom_type_setup(&refuse_new));
  made.attr("__module__") = "lcs";
  return made;
}

/// \name Add the classes of detector.cpp and scorer.cpp to the module.
///@{
void bind_detector(py::module_& module);
void bind_scorer(py::module_& module);
///@}

/// Makes the classes immutable, so that assigning `__class__` cannot turn an object into one of
/// them. To be called after all classes are bound.
void freeze_classes(const py::module_& module);

}  // namespace lcs::python
