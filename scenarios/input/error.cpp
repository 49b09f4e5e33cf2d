#include "scenarios/input/error.h"

#include <fmt/format.h>

#include "scenarios/input/message.h"

namespace lcs::input {

namespace {

/// "FILE:LINE: "; "" without a file.
std::string place(const Source& where) {
  if (where.file.empty()) return "";
  return where.line > 0 ? fmt::format("{}:{}: ", where.file, where.line) : where.file + ": ";
}

}  // namespace

Error::Error(const Source& where, const std::string& what_and_remedy)
    // printable, because a NUL would end the message.
    : std::runtime_error(printable(place(where) + what_and_remedy)) {}

}  // namespace lcs::input
