/// \file
/// What all classes of the module have in common: an object holds a value from the moment that it
/// is there, since it comes from a call of its class or from C++ and in no other way.
#pragma once

#include <pybind11/pybind11.h>

namespace lcs::python {

namespace py = pybind11;

/// The metaclass of the module's classes. A call allocates and initialises, without `tp_new`.
py::handle callable_type();

/// Makes `__new__` raise TypeError.
void refuse_new(PyHeapTypeObject* type);

/// A class of the module, `lcs.NAME`. None is derived from it.
template <class T, class... Options>
py::class_<T, Options...> class_of(py::module_& module, const char* name, const char* about) {
  py::class_<T, Options...> made(module, name, about, py::is_final(),
                                 py::metaclass(callable_type()),
                                 py::custom_type_setup(&refuse_new));
  made.attr("__module__") = "lcs";
  return made;
}

/// From then on no object of another class becomes one of these by its `__class__`. To be called
/// when all is bound.
void freeze_classes(const py::module_& module);

}  // namespace lcs::python
