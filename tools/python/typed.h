/// \file
/// Arguments and results whose Python type the signature names, for the stubs and for help(). The
/// functions check arguments themselves, with messages of their own.
#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace lcs::python {

namespace py = pybind11;

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
