#include "tools/files/json_node.h"

namespace lcs::files {

void require_shallow(std::string_view text) {
  int depth = 0, lines = 0;
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++lines;
    if (c == '"') is_quoted = !is_quoted;
    if (is_quoted && c == '\\') ++i;  // skip the escaped character
    if (is_quoted) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth <= kDeepestJson) continue;
    throw JsonError(fmt::format("lists and objects are nested more than {} deep at byte {}",
                                kDeepestJson, i + 1),
                    lines);
  }
}

}  // namespace lcs::files
