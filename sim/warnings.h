/// \file
/// Counts of what hints at a mistake in a scenario, as a rover that tips over. The figures of such
/// a run are right, but seldom those that its author wanted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lcs::sim {

enum class Warning : std::uint8_t {
  rover_below_ground,
  rover_tipped,
  rover_collisions,
  actor_collisions,
  objects_below_ground,
};

struct WarningText {
  const char* word;    ///< as in "warnings.WORD" of metrics.json
  const char* remedy;  ///< what to do, printed after what happened
};

/// In the order of `Warning`.
inline constexpr std::array<WarningText, 5> kWarnings{{
    {"rover_below_ground", "give what it drives on contacts, or change its start or its path"},
    {"rover_tipped", "make it slower, or the ground smoother"},
    {"rover_collisions", "change its start or its path, or what stands there"},
    {"actor_collisions", "change its trajectory, or what stands there"},
    {"objects_below_ground", "give it contacts (contype, conaffinity), or take its joint away"},
}};
static_assert(kWarnings.size() == static_cast<std::size_t>(Warning::objects_below_ground) + 1);

constexpr const WarningText& text_of(Warning warning) {
  return kWarnings[static_cast<std::size_t>(warning)];
}

/// How often each happened, and the first times in words: what, when, where, and what to do.
class Warnings {
 public:
  struct Met {
    std::int64_t count = 0;
    std::string first;
    std::vector<std::string> next;  ///< up to `kMostNext`, without what to do
  };
  static constexpr std::size_t kMostNext = 9;

  void add(Warning warning, const std::string& what) {
    Met& met = of(warning);
    if (met.count++ == 0) {
      met.first = what + ": " + text_of(warning).remedy;
    } else if (met.next.size() < kMostNext) {
      met.next.push_back(what);
    }
  }

  Met& of(Warning warning) { return met_[static_cast<std::size_t>(warning)]; }
  const Met& of(Warning warning) const { return met_[static_cast<std::size_t>(warning)]; }

 private:
  std::array<Met, kWarnings.size()> met_;
};

}  // namespace lcs::sim
