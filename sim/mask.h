/// \file
/// The pixels that something covers, in COCO's run-length encoding: column by column from the left,
/// the lengths of runs of pixels, outside and inside in turn. They add up to all pixels.
#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

namespace lcs::sim {

using Runs = std::vector<std::uint32_t>;

struct Mask {
  cv::Rect box;  ///< holds all pixels
  Runs runs;     ///< of the pixels of the box
};

/// Runs of the pixels in a box that hold a number.
/// \param columns an image, transposed: its rows are columns. \param box in the image.
Runs runs_of(const cv::Mat1i& columns, const cv::Rect& box, int number);

/// \name A mask in the smallest box that holds it.
///@{
/// The mask of the pixels that are not 0; empty where there are none.
Mask mask_of(const cv::Mat1b& picture);
/// The mask that runs over a whole picture describe.
/// \throws std::invalid_argument for runs that do not add up to the picture, and for a mask without
///   a pixel.
Mask mask_of(std::span<const std::int64_t> runs, const cv::Size& size_px);
///@}

/// The same mask in another box that holds its pixels.
Runs runs_in(const cv::Rect& box, const Mask& mask);

/// Calls `visit(x, top, bottom)` for each stretch of pixels in a column of the picture, [top,
/// bottom), from the left and from the top.
template <typename Visit>
void visit_stretches(const Mask& mask, Visit&& visit) {
  const std::int64_t height = mask.box.height;
  std::int64_t begin = 0;
  for (std::size_t i = 0; i < mask.runs.size(); ++i) {
    const std::int64_t end = begin + mask.runs[i];
    for (std::int64_t from = begin; i % 2 == 1 && from < end;) {
      const std::int64_t column = from / height, first = column * height;
      const std::int64_t to = std::min(end, first + height);
      visit(mask.box.x + static_cast<int>(column), mask.box.y + static_cast<int>(from - first),
            mask.box.y + static_cast<int>(to - first));
      from = to;
    }
    begin = end;
  }
}

}  // namespace lcs::sim
