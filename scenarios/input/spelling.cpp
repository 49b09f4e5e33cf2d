#include "scenarios/input/spelling.h"

#include <algorithm>

namespace lcs::input {
namespace {

/// Insertions, deletions, replacements and swaps of neighbours (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

/// The least edit distance of a name from a known one, from the last part of a known nested key,
/// such as "prior" of "hypotheses.prior", and from a known name with a word more or less at its
/// end. A word counts as three letters at most, the outer part of a key as one.
std::size_t distance(std::string_view name, std::string_view known) {
  const std::size_t whole = edit_distance(name, known);
  const auto has_more = [](std::string_view longer, std::string_view shorter) {
    return !shorter.empty() && longer.starts_with(shorter) &&
           longer.substr(shorter.size(), 1) == "_";
  };
  if (has_more(name, known) || has_more(known, name)) return std::min<std::size_t>(whole, 3);
  const std::size_t dot = known.rfind('.');
  if (dot == known.npos || name.find('.') != name.npos) return whole;
  return std::min(whole, edit_distance(name, known.substr(dot + 1)) + 1);
}

}  // namespace

std::vector<std::string> nearest_first(std::string_view name, std::vector<std::string> names) {
  std::ranges::stable_sort(names, {}, [&](const auto& known) { return distance(name, known); });
  return names;
}

std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& names) {
  std::optional<std::string> best;
  // Up to a third of the letters wrong is a misspelling; beyond that it is another word.
  std::size_t reach = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const std::string& candidate : names) {
    const std::size_t off = distance(name, candidate);
    if (off < reach && off < candidate.size()) {
      reach = off;
      best = candidate;
    }
  }
  return best;
}

}  // namespace lcs::input
