#include "tools/recording/coco_mask.h"

#include <fmt/format.h>

#include <stdexcept>

#include "scenarios/message.h"

namespace lcs::bench {

/// Of each number five bits a letter, from '0' on, the lowest first; 32 says that more come, and 16
/// in the last one that it is below 0. From the fourth on it is the difference to the last but one.
std::vector<std::int64_t> unpacked_runs(std::string_view word) {
  constexpr int kMostShift = 35;  // of pictures
  std::vector<std::int64_t> runs;
  std::int64_t number = 0;
  int shift = 0;
  for (const char letter : word) {
    const int bits = letter - '0';
    if (bits < 0 || bits > 63 || shift >= kMostShift) {
      throw std::invalid_argument(scenario::printable(fmt::format(
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

cv::Rect box_of_runs(const std::vector<std::int64_t>& runs, const cv::Size& size_px) {
  const std::int64_t height = size_px.height, all = height * size_px.width;
  cv::Rect box;
  std::int64_t begin = 0;
  bool is_inside = false;
  for (const std::int64_t run : runs) {
    const std::int64_t end = begin + run;
    if (run < 0 || run > all - begin) {
      begin = -1;
      break;
    }
    if (is_inside && run > 0) {
      const auto left = static_cast<int>(begin / height),
                 right = static_cast<int>((end - 1) / height);
      const auto top = static_cast<int>(begin % height),
                 last = static_cast<int>((end - 1) % height);
      const bool is_one_column = left == right;
      box |= is_one_column ? cv::Rect(left, top, 1, last - top + 1)
                           : cv::Rect(left, 0, right - left + 1, size_px.height);
    }
    begin = end;
    is_inside = !is_inside;
  }
  if (begin != all) {
    throw std::invalid_argument(fmt::format(
        "the mask's counts do not add up to {} x {} pixels; give all of them, of pixels outside "
        "first",
        size_px.height, size_px.width));
  }
  if (box.empty()) {
    throw std::invalid_argument("the mask has no pixel; leave out what is not seen");
  }
  return box;
}

}  // namespace lcs::bench
