/// \file
/// Conversion between the project's values and NumPy arrays. Returned arrays are read-only: views
/// of data that they keep alive, or structured arrays with the fields of `layers.jsonl` and
/// `truth.jsonl`. Arrays from the user are checked here.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <opencv2/core.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "filter/types/signature.h"
#include "tools/recording/recording_fields.h"

namespace lcs::python {

namespace py = pybind11;

inline py::array read_only(py::array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// A view without a copy. \param owner owns the data; the array keeps it alive.
template <class Number>
py::array view(const std::vector<py::ssize_t>& shape, const Number* data, py::handle owner) {
  return read_only(py::array_t<Number>(shape, data, owner));
}

/// A view of a picture, H x W or H x W x C, without a copy. \param owner as above.
template <class Pixel>
py::array view(const cv::Mat_<Pixel>& picture, py::handle owner) {
  using Number = typename cv::DataType<Pixel>::channel_type;
  std::vector<py::ssize_t> shape{picture.rows, picture.cols},
      strides{static_cast<py::ssize_t>(picture.step[0]), sizeof(Pixel)};
  if (picture.channels() > 1) {
    shape.push_back(picture.channels());
    strides.push_back(sizeof(Number));
  }
  const auto* const data = reinterpret_cast<const Number*>(picture.data);
  return read_only(py::array_t<Number>(shape, strides, data, owner));
}

/// Copies a matrix to an array in row-major order; a column vector becomes one-dimensional.
template <class Derived>
py::array copy(const Eigen::MatrixBase<Derived>& matrix) {
  constexpr bool is_vector = Derived::ColsAtCompileTime == 1;
  using Rows =
      Eigen::Matrix<typename Derived::Scalar, Derived::RowsAtCompileTime,
                    Derived::ColsAtCompileTime, is_vector ? Eigen::ColMajor : Eigen::RowMajor>;
  return read_only(py::cast(Rows(matrix)));
}

/// A float64 array with a row for each item. \tparam Size of a row. \param row_of gives its
/// numbers, a matrix row-major.
template <py::ssize_t... Size, class Items, class RowOf>
py::array table(const Items& items, const RowOf& row_of) {
  py::array_t<double> array({std::ssize(items), Size...});
  double* to = array.mutable_data();
  for (const auto& item : items) {
    const auto row = row_of(item);
    for (const double number : row.template reshaped<Eigen::RowMajor>()) *to++ = number;
  }
  return read_only(array);
}

/// Whether a field holds a number; false for outlines and masks.
template <class Member>
constexpr bool kIsNumber = !requires(Member & member) {
  member.value;
};

/// The number that NumPy stores for a numeric field of `recording::fields`; an enumerator's is
/// uint8.
template <class Member>
auto number_of(const Member& member) {
  if constexpr (requires { member.number; }) {
    return member.number;
  } else if constexpr (std::is_enum_v<Member>) {
    return static_cast<std::uint8_t>(member);
  } else {
    return member;
  }
}

/// Visits the fields of `recording::fields` and also `rebel`, which the files encode as separate
/// lists.
template <class Item, class Visit>
void all_fields(Item& item, const Visit& visit) {
  if constexpr (requires { item.rebel; }) visit("rebel", item.rebel);
  recording::fields(item, visit);
}

/// A structured array with one row per item, its fields aligned as those of a C struct.
template <class Item>
py::array rows(std::vector<Item> items) {
  py::list fields;
  Item any{};
  all_fields(any, [&](const char* name, const auto& member) {
    if constexpr (kIsNumber<std::remove_cvref_t<decltype(member)>>) {
      fields.append(py::make_tuple(name, py::dtype::of<decltype(number_of(member))>()));
    }
  });
  const py::dtype type =
      py::module_::import("numpy").attr("dtype")(fields, py::arg("align") = true);
  std::vector<std::size_t> places;  // in a row, in bytes
  for (const py::handle field : fields) {
    places.push_back(py::cast<std::size_t>(type.attr("fields")[field[py::int_(0)]][py::int_(1)]));
  }
  py::array array(type, std::ssize(items));
  auto* to = static_cast<std::byte*>(array.mutable_data());
  for (Item& item : items) {
    auto place = places.begin();
    all_fields(item, [&](const char*, const auto& member) {
      if constexpr (kIsNumber<std::remove_cvref_t<decltype(member)>>) {
        const auto number = number_of(member);
        std::memcpy(to + *place++, &number, sizeof number);
      }
    });
    to += array.itemsize();
  }
  return read_only(std::move(array));
}

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Converts `value` to an array. \param expected such as "N x 2 numbers, x and y in pixels".
/// \param kinds NumPy's letters of the accepted dtype kinds.
/// \throws py::type_error if `value` is no array or its dtype is of another kind.
py::array array_of(py::handle value, const char* name, const char* expected, const char* kinds);

/// \param columns of the N x columns table; 0: a list of N numbers. An empty list has N = 0.
/// \throws py::type_error as `array_of`; py::value_error if the shape differs.
Numbers table_of(py::handle value, const char* name, const char* expected, py::ssize_t columns);

/// \throws as `table_of`.
template <int Rows, int Columns>
Eigen::Matrix<double, Rows, Columns> matrix_of(py::handle value, const char* name,
                                               const char* expected) {
  constexpr bool is_vector = Columns == 1;
  const Numbers table = table_of(value, name, expected, is_vector ? 0 : Columns);
  if (table.shape(0) != Rows) {
    throw py::value_error(std::string(name) + " has " + std::to_string(table.shape(0)) +
                          (is_vector ? " numbers" : " rows") + "; give " + expected);
  }
  using RowMajor =
      Eigen::Matrix<double, Rows, Columns, is_vector ? Eigen::ColMajor : Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(table.data());
}

/// N x 2, x and y in pixels. \throws as `table_of`.
std::vector<Eigen::Vector2f> points_of(py::handle value, const char* name);

/// N x 32 of uint8. \throws as `table_of`.
std::vector<Signature> signatures_of(py::handle value);

/// Height x width, or height x width x 3, of uint8, a copy. \throws as `table_of`.
cv::Mat1b grey_of(py::handle value);
cv::Mat3b bgr_of(py::handle value);

/// N of bool. \throws as `table_of`.
std::vector<bool> flags_of(py::handle value, const char* name);

}  // namespace lcs::python
