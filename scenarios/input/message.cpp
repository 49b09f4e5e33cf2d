#include "scenarios/input/message.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <new>
#include <system_error>

#include "scenarios/input/error.h"

namespace lcs::input {
namespace {

constexpr std::size_t kLongest = 1000, kHead = 600, kTail = 300;

/// \param bytes one UTF-8 sequence.
std::uint32_t code_point(std::string_view bytes) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
  if (bytes.size() == 1) return byte(0);
  std::uint32_t code = byte(0) & (0x7Fu >> bytes.size());
  for (std::size_t i = 1; i < bytes.size(); ++i) code = code << 6 | (byte(i) & 0x3Fu);
  return code;
}

bool is_control(std::uint32_t code) {
  return (code < 0x20 && code != '\t' && code != '\n') || (code >= 0x7F && code < 0xA0);
}

/// Changes the direction of writing, ends a line, or is no character, which XML cannot contain.
bool is_unseen(std::uint32_t code) {
  return code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069) || code == 0xFEFF || code == 0xFFFE || code == 0xFFFF;
}

/// Whether a cut before this byte would split a UTF-8 character.
bool is_within(char c) {
  return (static_cast<std::uint8_t>(c) & 0xC0u) == 0x80u;
}

std::string remedy(const std::error_code& error) {
  if (error == std::errc::too_many_files_open ||
      error == std::errc::too_many_files_open_in_system) {
    return "raise the limit of open files (ulimit -n)";
  }
  if (error == std::errc::resource_unavailable_try_again) {
    return "end other programs, or raise the limit of processes (ulimit -u)";
  }
  return "end other programs, and try again";
}

}  // namespace

std::string text_of(const Source& where) {
  return where.line > 0 ? fmt::format("{}:{}", where.file, where.line) : where.file;
}

Error::Error(const Source& where, const std::string& what_and_remedy)
    // printable, because a NUL would end the message.
    : std::runtime_error(printable(where.file.empty() ? what_and_remedy
                                                      : text_of(where) + ": " + what_and_remedy)) {}

std::string printable(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      shown += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(text.front()));
      text.remove_prefix(1);
      continue;
    }
    const std::uint32_t code = code_point(text.substr(0, length));
    if (is_control(code)) {
      shown += fmt::format("\\x{:02x}", code);
    } else if (is_unseen(code)) {
      shown += fmt::format("\\u{:04x}", code);
    } else {
      shown += text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  return shown;
}

std::string one_line(std::string_view text) {
  while (text.ends_with('\n')) text.remove_suffix(1);
  std::string line;
  for (const char c : printable(text)) {
    if (c == '\t') {
      line += "\\t";
    } else {
      line += c == '\n' ? ' ' : c;
    }
  }
  if (line.size() <= kLongest) return line;
  std::size_t head = kHead, tail = line.size() - kTail;
  while (is_within(line[head])) --head;
  while (is_within(line[tail])) ++tail;
  return line.replace(head, tail - head, fmt::format(" [... {} bytes ...] ", tail - head));
}

std::string joined(const std::vector<std::string>& words, std::string_view last_separator) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? last_separator : std::string_view(", ");
    text += words[i];
  }
  return text;
}

std::string message_of(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error)) {
    return "there is not enough memory; end other programs, raise the limit (ulimit -v), or give "
           "less to do at a time";
  }
  if (const auto* of_files = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    return one_line(of_files->path1().string() + ": " + of_files->code().message() +
                    "; check the name and its permissions");
  }
  const std::string what = error.what();
  const auto* of_system = dynamic_cast<const std::system_error*>(&error);
  const bool has_remedy = what.find(';') != what.npos;
  return one_line(of_system && !has_remedy ? what + "; " + remedy(of_system->code()) : what);
}

std::size_t utf8_length(std::string_view bytes) {
  struct Row {  // the range of the first byte, the length, and the range of the second byte
    std::uint8_t first, last;
    std::size_t length;
    std::uint8_t low, high;
  };
  constexpr Row kTable[] = {
      {0x00, 0x7F, 1, 0, 0},       {0xC2, 0xDF, 2, 0x80, 0xBF}, {0xE0, 0xE0, 3, 0xA0, 0xBF},
      {0xE1, 0xEC, 3, 0x80, 0xBF}, {0xED, 0xED, 3, 0x80, 0x9F}, {0xEE, 0xEF, 3, 0x80, 0xBF},
      {0xF0, 0xF0, 4, 0x90, 0xBF}, {0xF1, 0xF3, 4, 0x80, 0xBF}, {0xF4, 0xF4, 4, 0x80, 0x8F}};
  const auto is_in = [&](std::size_t i, std::uint8_t low, std::uint8_t high) {
    const auto byte = static_cast<std::uint8_t>(i < bytes.size() ? bytes[i] : 0);
    return low <= byte && byte <= high;
  };
  for (const Row& row : kTable) {
    if (!is_in(0, row.first, row.last)) continue;
    bool is_whole = row.length == 1 || is_in(1, row.low, row.high);
    for (std::size_t i = 2; i < row.length; ++i) is_whole = is_whole && is_in(i, 0x80, 0xBF);
    return is_whole ? row.length : 0;
  }
  return 0;
}

}  // namespace lcs::input
