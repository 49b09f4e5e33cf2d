#include "tools/python/type.h"

#include <array>

namespace lcs::python {
namespace {

PyObject* make(PyObject* type, PyObject* arguments, PyObject* keywords) {
  auto* const made = reinterpret_cast<PyTypeObject*>(type);
  PyObject* const self = py::detail::make_new_instance(made);
  if (made->tp_init(self, arguments, keywords) == 0) return self;
  Py_DECREF(self);
  return nullptr;
}

PyObject* refuse(PyTypeObject* type, PyObject*, PyObject*) {
  PyErr_Format(PyExc_TypeError,
               "%.200s.__new__() would make an object without a value; call the class instead",
               type->tp_name);
  return nullptr;
}

}  // namespace

py::handle callable_type() {
  static const py::handle metaclass = [] {  // lives as long as the process
    std::array<PyType_Slot, 2> slots{{{Py_tp_call, reinterpret_cast<void*>(&make)}, {0, nullptr}}};
    PyType_Spec spec{"lcs._core.Type", 0, 0, Py_TPFLAGS_DEFAULT, slots.data()};
    const py::handle base(
        reinterpret_cast<PyObject*>(py::detail::get_internals().default_metaclass));
    PyObject* const made = PyType_FromSpecWithBases(&spec, py::make_tuple(base).ptr());
    if (made == nullptr) throw py::error_already_set();
    return py::handle(made);
  }();
  return metaclass;
}

void refuse_new(PyHeapTypeObject* type) {
  type->ht_type.tp_new = &refuse;
}

void freeze_classes(const py::module_& module) {
#ifdef Py_TPFLAGS_IMMUTABLETYPE  // Python 3.10
  for (const auto& [name, value] : py::cast<py::dict>(module.attr("__dict__"))) {
    if (!py::isinstance(value, callable_type())) continue;
    reinterpret_cast<PyTypeObject*>(value.ptr())->tp_flags |= Py_TPFLAGS_IMMUTABLETYPE;
    PyType_Modified(reinterpret_cast<PyTypeObject*>(value.ptr()));
  }
#else
  static_cast<void>(module);
#endif
}

}  // namespace lcs::python
