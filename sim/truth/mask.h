/// \file
/// Masks in COCO's run-length encoding: column by column from the left, alternating lengths of runs
/// outside and inside. The lengths add up to the number of pixels.
#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

namespace lcs::sim {

using PixelRuns = std::vector<std::uint32_t>;

struct Mask {
  cv::Rect box;    ///< bounds all pixels of the mask
  PixelRuns runs;  ///< runs over the pixels of the box
};

/// Runs of the pixels in a box that equal `number`.
/// \param columns a transposed image: its rows are columns. \param box in the untransposed image.
PixelRuns runs_of(const cv::Mat1i& columns, const cv::Rect& box, int number);

/// \name A mask in its smallest bounding box.
///@{
/// The mask of the non-zero pixels; empty without such pixels.
Mask mask_of(const cv::Mat1b& picture);
/// The mask whose runs cover a whole image.
/// \throws std::invalid_argument if the runs do not add up to the image's pixels, or if the mask is
/// empty.
Mask mask_of(std::span<const std::int64_t> runs, const cv::Size& size_px);
///@}

/// The runs of the mask in another box, which must hold all its pixels.
PixelRuns runs_in(const cv::Rect& box, const Mask& mask);

/// Calls `visit(x, top, bottom)` for each vertical run [top, bottom) in image column x, from left
/// to right and top to bottom.
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
