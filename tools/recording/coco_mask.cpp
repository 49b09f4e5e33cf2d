#include "tools/recording/recording_io.h"

#include <fmt/format.h>

#include <stdexcept>

#include "scenarios/input/message.h"

namespace lcs::recording {

std::string packed_runs(const sim::PixelRuns& runs) {
  std::string word;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::int64_t number = runs[i];
    if (i > 2) number -= runs[i - 2];
    for (bool more = true; more;) {
      int bits = static_cast<int>(number & 31);
      number >>= 5;
      more = number != ((bits & 16) != 0 ? -1 : 0);
      if (more) bits |= 32;
      word += static_cast<char>('0' + bits);
    }
  }
  return word;
}

/// A letter above '0' holds five bits, lowest first; 32 marks a continuation, 16 in the last letter
/// a negative number. From the fourth on, a number is the difference to the last but one.
std::vector<std::int64_t> unpacked_runs(std::string_view word) {
  constexpr int kMostShift = 35;  // of an image's runs
  std::vector<std::int64_t> runs;
  std::int64_t number = 0;
  int shift = 0;
  for (const char letter : word) {
    const int bits = letter - '0';
    if (bits < 0 || bits > 63 || shift >= kMostShift) {
      throw std::invalid_argument(input::printable(fmt::format(
          "the mask's counts have '{}' where none can be; give COCO's word or its numbers",
          letter)));
    }
    number |= std::int64_t{bits & 31} << shift;
    shift += 5;
    if ((bits & 32) != 0) continue;
    if ((bits & 16) != 0) number -= std::int64_t{1} << shift;
    if (runs.size() > 2) number += runs[runs.size() - 2];
    runs.push_back(number);
    number = shift = 0;
  }
  if (shift > 0) {
    throw std::invalid_argument("the mask's counts end within a number; give all of them");
  }
  return runs;
}

}  // namespace lcs::recording
