/// \file
/// Common properties of the module's classes and functions. Every object holds a value from its
/// creation, since only a call of its class or C++ code can create it.
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstddef>
#include <utility>

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

/// \name Add the classes and functions of the files of these names to the module.
///@{
void bind_bench(py::module_& module);
void bind_detector(py::module_& module);
void bind_filter(py::module_& module);
void bind_frame(py::module_& module);
void bind_live(py::module_& module);
void bind_scenario(py::module_& module);
void bind_scorer(py::module_& module);
///@}

/// Makes the classes immutable, so that assigning `__class__` cannot turn an object into one of
/// them. To be called after all classes are bound.
void freeze_classes(const py::module_& module);

// ---- Arguments and results whose Python type the signature names, for the stubs and for help().
// The functions check arguments themselves, with messages of their own.

template <std::size_t Size>
struct TypeName {
  consteval TypeName(const char (&name)[Size]) { std::copy_n(name, Size, text); }  // implicit
  char text[Size]{};
};

template <TypeName kName>
struct Typed : py::object {
  using py::object::object;
  explicit Typed(py::object value) : py::object(std::move(value)) {}
  static bool check_(py::handle value) { return static_cast<bool>(value); }
};

using ArrayLike = Typed<"numpy.typing.ArrayLike">;
using OptionalArray = Typed<"numpy.typing.ArrayLike | None">;
using Settings = Typed<"collections.abc.Mapping[str, object] | None">;
using OptionalSeed = Typed<"int | None">;
using OptionalVector = Typed<"numpy.typing.NDArray[numpy.float64] | None">;
using Frames = Typed<"collections.abc.Iterator[Frame]">;
using Answer = Typed<"Result | Detections | numpy.typing.ArrayLike">;

}  // namespace lcs::python

/// \cond  Doxygen does not know the namespace.
template <lcs::python::TypeName kName>
struct pybind11::detail::handle_type_name<lcs::python::Typed<kName>> {
  static constexpr auto name = const_name(kName.text);
};
/// \endcond
