#include "tools/python/arrays.h"

#include <fmt/format.h>

#include <string_view>

namespace lcs::python {
namespace {

std::string text_of(py::handle value) {
  return py::cast<std::string>(py::str(value));
}

[[noreturn]] void refuse_shape(const py::array& array, const char* name, const char* expected) {
  throw py::value_error(
      fmt::format("{} has the shape {}; give {}", name, text_of(array.attr("shape")), expected));
}

/// \throws py::type_error for an array of larger numbers than bytes.
void require_bytes(const py::array& array, const char* name, const char* expected) {
  if (array.itemsize() == 1) return;
  throw py::type_error(fmt::format("{} is of {}; give {}", name, text_of(array.dtype()), expected));
}

cv::Mat picture_of(py::handle value, int channels, const char* expected) {
  const py::array array = array_of(value, "picture", expected, "u");
  require_bytes(array, "picture", expected);
  const bool fits = channels == 1 ? array.ndim() == 2 : array.ndim() == 3 && array.shape(2) == 3;
  if (!fits) refuse_shape(array, "picture", expected);
  const py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast> pixels(array);
  cv::Mat copy(static_cast<int>(pixels.shape(0)), static_cast<int>(pixels.shape(1)),
               CV_8UC(channels));
  std::memcpy(copy.data, pixels.data(), static_cast<std::size_t>(pixels.nbytes()));
  return copy;
}

}  // namespace

py::array array_of(py::handle value, const char* name, const char* expected, const char* kinds) {
  const auto array = value.is_none() ? py::array() : py::array::ensure(value);
  if (value.is_none() || !array) {
    throw py::type_error(fmt::format("{} is no array; give {}", name, expected));
  }
  const auto kind = py::cast<std::string>(array.dtype().attr("kind"));
  // An empty list has no numbers, so its dtype does not matter.
  if (array.size() > 0 && std::string_view(kinds).find(kind) == std::string_view::npos) {
    throw py::type_error(
        fmt::format("{} is of {}; give {}", name, text_of(array.dtype()), expected));
  }
  return array;
}

Numbers table_of(py::handle value, const char* name, const char* expected, py::ssize_t columns) {
  const py::array array = array_of(value, name, expected, "fiu");
  using Shape = std::vector<py::ssize_t>;
  if (array.ndim() == 1 && array.size() == 0) {
    return Numbers(columns == 0 ? Shape{0} : Shape{0, columns});
  }
  const bool fits =
      columns == 0 ? array.ndim() == 1 : array.ndim() == 2 && array.shape(1) == columns;
  if (!fits) refuse_shape(array, name, expected);
  return Numbers(array);
}

std::vector<Eigen::Vector2f> points_of(py::handle value, const char* name) {
  const Numbers table = table_of(value, name, "N x 2 numbers, x and y in pixels", 2);
  std::vector<Eigen::Vector2f> points(static_cast<std::size_t>(table.shape(0)));
  const double* number = table.data();
  for (Eigen::Vector2f& point : points) {
    point = Eigen::Vector2d(number[0], number[1]).cast<float>();
    number += 2;
  }
  return points;
}

std::vector<Signature> signatures_of(py::handle value) {
  constexpr const char* kExpected = "N x 32 of uint8, a row for each corner";
  constexpr py::ssize_t kBytes = sizeof(SignatureBytes);
  const py::array array = array_of(value, "signatures", kExpected, "u");
  if (array.size() == 0) return {};
  require_bytes(array, "signatures", kExpected);
  if (array.ndim() != 2 || array.shape(1) != kBytes) refuse_shape(array, "signatures", kExpected);
  const py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast> table(array);
  std::vector<Signature> signatures(static_cast<std::size_t>(table.shape(0)));
  std::memcpy(signatures.data(), table.data(), static_cast<std::size_t>(table.nbytes()));
  return signatures;
}

cv::Mat1b grey_of(py::handle value) {
  return picture_of(value, 1, "height x width of uint8");
}

cv::Mat3b bgr_of(py::handle value) {
  return picture_of(value, 3, "height x width x 3 of uint8: blue, green, red");
}

std::vector<bool> flags_of(py::handle value, const char* name) {
  constexpr const char* kExpected = "N of bool, one for each corner";
  const py::array array = array_of(value, name, kExpected, "b");
  if (array.size() > 0 && array.ndim() != 1) refuse_shape(array, name, kExpected);
  const py::array_t<bool, py::array::c_style | py::array::forcecast> flags(array);
  return std::vector<bool>(flags.data(), flags.data() + flags.size());
}

}  // namespace lcs::python
