/// \file
/// Masks as COCO stores them: lengths of runs, column by column.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace lcs::sequence {

/// For each id from 0 to `count`, the pixels of the mask that are not that id and that are, in
/// turns, down the columns from the left; they add up to all pixels.
std::vector<std::vector<std::uint32_t>> run_lengths(const cv::Mat1b& mask, int count);

}  // namespace lcs::sequence
