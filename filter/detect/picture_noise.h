/// \file
/// Estimates the camera's noise and the traces of compression in a picture from its own pixels.
/// Pure: the same picture gives the same numbers.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

namespace lcs {

/// Standard deviation of the noise, grey levels: Immerkaer's operator ("Fast Noise Variance
/// Estimation", CVIU 1996) over the flattest tenth of the picture's blocks. A block counts as flat
/// by the means of its quarters, which depend little on the noise of single pixels. None where all
/// flat blocks are black or white, which show no noise.
std::optional<double> noise_levels(const cv::Mat1b& grey);

/// Standard deviation of what compression in blocks of 8x8 pixels (JPEG, MPEG) has changed, grey
/// levels; 0 where no grid shows. Each block is compressed by itself, so that brightness jumps from
/// block to block: the mean square of these jumps, less that of jumps elsewhere, is what
/// compression has changed in both blocks. It is below 1 in pictures without compression, and finds
/// four fifths or more of what JPEG changes near corners. A decoder that smooths the borders of
/// blocks (H.264) hides most of it.
double compression_levels(const cv::Mat1b& grey);

/// FAST's threshold for this noise and compression: at least 20 grey levels, which do for a clean
/// picture, and eight standard deviations of the noise, which would look like corners otherwise.
/// Compression moves corners about rather than making them: for it the threshold rises to eight
/// standard deviations of both, but no further than leaves a corner for every 16x16 pixels, as weak
/// corners are better than none.
int threshold_of(const cv::Mat1b& grey);

}  // namespace lcs
