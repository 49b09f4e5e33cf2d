#include "tools/input/error.h"

#include "tools/input/message.h"

namespace lcs::input {

namespace {

std::string place(const Source& where) {
  std::string text = where.file;
  if (where.line > 0) text.append(":").append(std::to_string(where.line));
  return text;
}

}  // namespace

Error::Error(const Source& where, const std::string& what_and_remedy)
    // printable, because a NUL would end the message.
    : std::runtime_error(printable(place(where) + ": " + what_and_remedy)) {}

}  // namespace lcs::input
