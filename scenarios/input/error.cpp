#include "scenarios/input/error.h"

#include <fmt/format.h>

#include "scenarios/input/message.h"

namespace lcs::input {

std::string text_of(const Source& where) {
  return where.line > 0 ? fmt::format("{}:{}", where.file, where.line) : where.file;
}

Error::Error(const Source& where, const std::string& what_and_remedy)
    // printable, because a NUL would end the message.
    : std::runtime_error(printable(where.file.empty() ? what_and_remedy
                                                      : text_of(where) + ": " + what_and_remedy)) {}

}  // namespace lcs::input
