/// \file
/// Signatures of corners by OpenCV: ORB's descriptor (Rublee, Rabaud, Konolige, Bradski, "ORB: an
/// efficient alternative to SIFT or SURF", ICCV 2011) without its turn and its scales, that is 256
/// comparisons of brightness in the blurred 31x31 pixels round a corner.
///
/// Upright, as a rover's camera hardly rolls, and a descriptor that turns with the corner
/// distinguishes less.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "filter/signature.h"

namespace lcs {

/// Pure: the same picture and corners give the same bits, on however many threads, and a corner
/// the same ones whatever other corners there are. Near the border the picture goes on mirrored.
/// \param corners_px taken at the nearest pixel.
/// \return one for each corner, in their order; all zero for one that is not finite or not in the
///   picture.
std::vector<Signature> describe(const cv::Mat1b& grey, std::span<const Eigen::Vector2f> corners_px);

}  // namespace lcs
