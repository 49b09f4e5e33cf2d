/// \file
/// Defaults found by `lcs tune`.
#pragma once

#include <stdexcept>
#include <string_view>

#include "filter/learnt.h"

namespace lcs {

/// The value of a key of `learnt.h`. A missing key is a compile-time error.
consteval double learnt(std::string_view key) {
  for (const auto& [name, value] : kLearnt) {
    if (key == name) return value;
  }
  throw std::invalid_argument("learnt.h lacks the key");
}

}  // namespace lcs
