/// \file
/// Estimates camera noise and compression artefacts of a picture from its own pixels. Pure: the
/// same picture gives the same numbers.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

namespace lcs {

/// Standard deviation of the noise, grey levels: Immerkaer's operator ("Fast Noise Variance
/// Estimation", CVIU 1996) over the flattest tenth of the picture's blocks. Flatness is the range
/// of the means of a block's quarters, which depend little on pixel noise. Absent if too few blocks
/// are neither black nor white, as clipped pixels show no noise.
std::optional<double> noise_levels(const cv::Mat1b& grey);

/// Standard deviation of the error by compression in 8x8 blocks (JPEG, MPEG), grey levels; 0 if no
/// block grid is found. Blocks are compressed separately, so brightness jumps at their borders. The
/// mean square of these jumps, less their mean square elsewhere, is the error of both blocks.
/// Below 1 for uncompressed pictures; at least four fifths of JPEG's error near corners. A
/// deblocking decoder (H.264) hides most of it.
double compression_levels(const cv::Mat1b& grey);

/// FAST's threshold for this noise and compression, grey levels: at least 20, which suffices for a
/// clean picture, and eight standard deviations of the noise, which would cause false corners.
/// Compression mostly moves corners. For it the threshold rises to eight standard deviations of
/// both, but keeps one corner for every 16x16 pixels, since weak corners are better than none.
int threshold_of(const cv::Mat1b& grey);

}  // namespace lcs
