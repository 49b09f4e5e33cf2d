/// \file
/// Masks as COCO has them: lengths of runs down the columns from the left, of pixels outside and
/// inside in turns.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string_view>
#include <vector>

namespace lcs::bench {

/// The lengths in one word, as pycocotools writes them. \throws std::invalid_argument
std::vector<std::int64_t> unpacked_runs(std::string_view word);

/// What holds the mask.
/// \throws std::invalid_argument for runs that do not add up to the picture, and for a mask without
///   a pixel.
cv::Rect box_of_runs(const std::vector<std::int64_t>& runs, const cv::Size& size_px);

}  // namespace lcs::bench
