/// \file
/// The paper's four panels: what each expert made of a frame, drawn over the dimmed image.
///
///     corners: chi, ignored, lambda    | edges: predicted, normal, rebel
///     circles: normal, rebel, psi      | squares: S, psi
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <span>
#include <string>

#include "filter/layers.h"

namespace lcs {

/// \name Colours, BGR, as in the paper.
///@{
namespace colour {
inline const cv::Scalar kCorner{0, 230, 255};         ///< chi: yellow dots
inline const cv::Scalar kIgnoredCorner{40, 40, 255};  ///< chi inside psi: red dots
inline const cv::Scalar kCollector{255, 255, 255};    ///< lambda: thin white circles
inline const cv::Scalar kPredicted{0, 230, 255};      ///< L~ of edges: small yellow squares
inline const cv::Scalar kNormalEdge{255, 110, 30};    ///< E_n: small blue squares
inline const cv::Scalar kRebel{40, 40, 255};          ///< E_r and C_r: red
inline const cv::Scalar kNormalCircle{60, 220, 60};   ///< C_n: green
inline const cv::Scalar kSquare{255, 0, 255};         ///< S: magenta
inline const cv::Scalar kIgnoreRegion{0, 230, 255};   ///< psi: yellow
inline const cv::Scalar kMovingTruth{220, 220, 0};    ///< cyan
inline const cv::Scalar kStaticTruth{150, 150, 150};  ///< grey
}  // namespace colour
///@}

/// Where an object really is, to be drawn thin beneath the layers. Pixel-centre coordinates.
struct TruthBox {
  Vec2 min_px = Vec2::Zero();
  Vec2 max_px = Vec2::Zero();
  bool moving = false;
};

struct PanelContent {
  const cv::Mat3b& image;  ///< BGR
  std::span<const Eigen::Vector2f> corners_px;
  std::span<const Verdict> verdicts;  ///< of each corner
  const Layers& layers;
  std::span<const TruthBox> truth;
  std::string
      caption;  ///< of the frame, as "frame 12  1.20 s"; printed in every panel before its counts
};

enum class Panel { corners, edges, circles, squares };

/// Draws sheets of 2x2 panels of one size for a camera of one size.
class PanelSheet {
 public:
  /// \param image_px size of the camera's image.
  /// \param panel_px longer side of a panel on the sheet; the image is scaled to it. Sides are
  /// even,
  ///   as video codecs want them.
  /// \throws std::invalid_argument unless all sizes are at least 16.
  explicit PanelSheet(cv::Size image_px, int panel_px = 640);

  cv::Size size_px() const { return {2 * panel_.width, 2 * panel_.height}; }

  /// Place on the sheet of a pixel of the image, in the given panel.
  Vec2 at(Panel panel, const Vec2& image_point) const;

  /// \throws std::invalid_argument for an image of another size, or verdicts that do not pair with
  ///   the corners.
  cv::Mat3b draw(const PanelContent& content) const;

 private:
  cv::Rect area(Panel panel) const;

  cv::Size image_;
  cv::Size panel_;
};

}  // namespace lcs
