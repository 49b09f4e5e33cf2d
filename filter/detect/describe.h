/// \file
/// Signatures of corners by OpenCV's ORB descriptor (Rublee, Rabaud, Konolige, Bradski, "ORB: an
/// efficient alternative to SIFT or SURF", ICCV 2011): 256 comparisons of brightness in the blurred
/// 31x31 pixels round a corner, without orientation and scales.
///
/// Upright: a rover's camera hardly rolls, and a rotation-invariant descriptor distinguishes less.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "filter/types/signature.h"

namespace lcs {

/// Pure: the same picture and corners give the same bits on any number of threads. A corner's
/// signature does not depend on other corners. The picture is mirrored at its border.
/// \param corners_px in pixels, rounded to the nearest pixel.
/// \return one signature for each corner, in order; all zero for a corner that is not finite or
///   outside of the picture.
std::vector<Signature> describe(const cv::Mat1b& grey, std::span<const Eigen::Vector2f> corners_px);

}  // namespace lcs
