/// \file
/// Columns of numbers of one length, for the loops that take several items at once.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "filter/vectors/vectors.h"

namespace lcs {

/// Columns in one block of memory, which is kept from frame to frame. A loop takes `data()`.
template <typename Number, std::size_t kCount>
class Columns {
 public:
  Columns() { make(0); }
  Columns(const Columns&) = delete;  // the columns point into the block
  Columns& operator=(const Columns&) = delete;
  Columns(Columns&&) noexcept = default;
  Columns& operator=(Columns&&) noexcept = default;

  /// Makes room for `size` numbers in each column, and for a loop behind them. Their values are
  /// undefined.
  void make(std::size_t size) {
    const std::size_t length = size + kLanes;
    if (block_.size() < kCount * length) block_.assign(kCount * (length + length / 2), 0);
    for (std::size_t i = 0; i < kCount; ++i) columns_[i] = block_.data() + i * length;
  }

  Number* operator[](std::size_t column) { return columns_[column]; }
  const Number* operator[](std::size_t column) const { return columns_[column]; }
  Number* const* data() { return columns_.data(); }
  const Number* const* data() const { return columns_.data(); }

 private:
  std::vector<Number> block_;
  std::array<Number*, kCount> columns_;
};

}  // namespace lcs
