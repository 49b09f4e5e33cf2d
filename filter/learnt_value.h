/// \file
/// Defaults that `lcs tune` has found.
#pragma once

#include <stdexcept>
#include <string_view>

#include "filter/learnt.h"

namespace lcs {

/// The value of a key of `learnt.h`. A key that it lacks is an error of compilation.
consteval double learnt(std::string_view key) {
  for (const auto& [name, value] : kLearnt) {
    if (key == name) return value;
  }
  throw std::invalid_argument("learnt.h lacks the key");
}

}  // namespace lcs
