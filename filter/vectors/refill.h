/// \file
/// Vectors that are refilled each frame in the same memory. If too small they grow by half, so that
/// only the first few frames allocate.
#pragma once

#include <cstddef>
#include <vector>

namespace lcs {

/// Reserves room for at least `size` items.
template <typename T>
void make_room(std::vector<T>& list, std::size_t size) {
  if (list.capacity() < size) list.reserve(size + size / 2);
}

/// Sets the list to `size` copies of `value`.
template <typename T>
void refill(std::vector<T>& list, std::size_t size, const T& value = {}) {
  make_room(list, size);
  list.assign(size, value);
}

/// Copies `from` into the list.
template <typename T>
void copy_over(const std::vector<T>& from, std::vector<T>& list) {
  make_room(list, from.size());
  list = from;
}

}  // namespace lcs
