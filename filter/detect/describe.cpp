#include "filter/detect/describe.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <stdexcept>

#include "filter/kinematics/camera.h"

namespace lcs {
namespace {

/// Side of a patch, and ORB's least distance of a keypoint from the border.
constexpr int kPatch_px = 31;
/// Margin added round the picture, so that ORB accepts every corner in it.
constexpr int kMargin_px = kPatch_px + 1;

/// Keypoints of the corners in the picture, in padded pixels; `class_id`: corner index.
std::vector<cv::KeyPoint> keypoints_at(std::span<const Eigen::Vector2f> corners_px,
                                       const Pixels& picture) {
  std::vector<cv::KeyPoint> keypoints;
  keypoints.reserve(corners_px.size());
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    const Vec2 x = corners_px[i].cast<double>();
    if (!picture.contain(x)) continue;  // false for NaN too
    keypoints.emplace_back(cv::Point2f(static_cast<float>(std::lround(x.x()) + kMargin_px),
                                       static_cast<float>(std::lround(x.y()) + kMargin_px)),
                           static_cast<float>(kPatch_px), /*angle=*/0.F, /*response=*/0.F,
                           /*octave=*/0, static_cast<int>(i));
  }
  return keypoints;
}

/// One row of 32 bytes for each keypoint.
cv::Mat1b orb_at(const cv::Mat1b& grey, std::vector<cv::KeyPoint>& keypoints) {
  cv::Mat1b framed;
  // Isolated: of a region of interest, pixels outside of it are not used.
  cv::copyMakeBorder(grey, framed, kMargin_px, kMargin_px, kMargin_px, kMargin_px,
                     cv::BORDER_REFLECT_101 | cv::BORDER_ISOLATED);
  const auto orb = cv::ORB::create(static_cast<int>(keypoints.size()), /*scaleFactor=*/1.2F,
                                   /*nlevels=*/1, /*edgeThreshold=*/kPatch_px, /*firstLevel=*/0,
                                   /*WTA_K=*/2, cv::ORB::HARRIS_SCORE, kPatch_px);
  cv::Mat1b descriptors;
  const std::size_t asked = keypoints.size();
  orb->compute(framed, keypoints, descriptors);
  if (keypoints.size() != asked || static_cast<std::size_t>(descriptors.rows) != asked ||
      descriptors.cols != static_cast<int>(sizeof(Signature))) {
    throw std::logic_error("ORB left out corners, or gave other than 32 bytes for each");
  }
  return descriptors;
}

}  // namespace

std::vector<Signature> describe(const cv::Mat1b& grey,
                                std::span<const Eigen::Vector2f> corners_px) {
  std::vector<Signature> signatures(corners_px.size(), Signature{});
  std::vector<cv::KeyPoint> keypoints = keypoints_at(corners_px, {grey.cols, grey.rows});
  if (keypoints.empty()) return signatures;
  const cv::Mat1b descriptors = orb_at(grey, keypoints);
  for (std::size_t k = 0; k < keypoints.size(); ++k) {
    SignatureBytes bytes;
    std::copy_n(descriptors[static_cast<int>(k)], bytes.size(), bytes.begin());
    signatures[static_cast<std::size_t>(keypoints[k].class_id)] = std::bit_cast<Signature>(bytes);
  }
  return signatures;
}

}  // namespace lcs
