/// \file
/// How much of a picture is not of the scene: what its own pixels show of the camera's noise and of
/// compression. Of one picture alone, so that the same picture always gives the same.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

namespace lcs {

/// Standard deviation of the noise, grey levels: Immerkaer's operator ("Fast Noise Variance
/// Estimation", CVIU 1996) over the flattest tenth of the picture's blocks. Blocks are told flat by
/// the means of their quarters, on which the noise of a pixel has next to no say. None where all
/// flat blocks are black or white, which has no noise.
std::optional<double> noise_levels(const cv::Mat1b& grey);

/// Standard deviation of what compression in blocks of 8x8 pixels (JPEG, MPEG) has changed, grey
/// levels; 0 where no grid shows. Blocks are changed each for itself, so that brightness jumps
/// between them as nowhere else: by how much its mean square is larger there is what both blocks
/// have been changed by. In pictures without compression it is below 1; of what JPEG does to the
/// surroundings of corners it tells four fifths to all. A decoder that smooths its blocks' sides
/// (H.264) hides the most of it.
double compression_levels(const cv::Mat1b& grey);

/// FAST's threshold, by what of the picture is not of the scene: at least 20 grey levels, as for a
/// picture of the scene alone, and eight standard deviations of the noise, which looks like corners
/// otherwise. Against compression, which moves corners about rather than making them, it goes on to
/// eight of both, but no further than there is a corner for every 16x16 pixels: where there are
/// few, weak ones are better than none.
int threshold_of(const cv::Mat1b& grey);

}  // namespace lcs
