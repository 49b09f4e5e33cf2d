/// \file
/// Lists that are filled anew each frame in the same memory. Where that is too small it grows by
/// half, so that a few frames in the beginning allocate, and not every frame that is busier than
/// all before.
#pragma once

#include <cstddef>
#include <vector>

namespace lcs {

/// Room for `size` items.
template <typename T>
void make_room(std::vector<T>& list, std::size_t size) {
  if (list.capacity() < size) list.reserve(size + size / 2);
}

/// Leaves `size` items, each of them `value`.
template <typename T>
void refill(std::vector<T>& list, std::size_t size, const T& value = {}) {
  make_room(list, size);
  list.assign(size, value);
}

/// Leaves a copy of `from`.
template <typename T>
void copy_over(const std::vector<T>& from, std::vector<T>& list) {
  make_room(list, from.size());
  list = from;
}

}  // namespace lcs
