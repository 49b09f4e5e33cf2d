/// \file
/// Lists that are filled anew each frame, in the same memory: where it does not do, half as much
/// again is taken, so that it is asked for a few times in the beginning and not with every frame
/// that is busier than any before.
#pragma once

#include <cstddef>
#include <vector>

namespace lcs {

/// Leaves `size` items, each of them `value`.
template <typename T>
void refill(std::vector<T>& list, std::size_t size, const T& value = {}) {
  if (list.capacity() < size) list.reserve(size + size / 2);
  list.assign(size, value);
}

/// Leaves a copy of `from`.
template <typename T>
void copy_over(const std::vector<T>& from, std::vector<T>& list) {
  if (list.capacity() < from.size()) list.reserve(from.size() + from.size() / 2);
  list = from;
}

}  // namespace lcs
