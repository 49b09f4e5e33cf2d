/// \file
/// The message of an expected error.
#pragma once

#include <exception>
#include <string>

namespace lcs::test {

/// The message of the `Error` that `action` throws.
template <class Error = std::exception, class Action>
std::string refusal_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was refused";
}

}  // namespace lcs::test
