/// \file
/// Lists that are filled anew each frame, in the same memory: where it does not do, half as much
/// again is taken, so that it is asked for a few times in the beginning and not with every frame
/// that is busier than any before.
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
