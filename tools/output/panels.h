/// \file
/// The paper's four panels: each expert's result for a frame, over the dimmed image.
///
///     corners: chi, ignored, lambda    | edges: predicted, normal, rebel
///     circles: normal, rebel, psi      | squares: S with their ids and outlines, psi
///
/// Each panel has counts above the image and a legend below it. If the truth is known, found,
/// missed and false items are marked, and objects are named.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>

#include "filter/types/layers.h"
#include "filter/types/paper_layers.h"

namespace lcs::output {

/// \name Colours, BGR: each has one meaning in all panels, and marks also differ in shape. Corners,
/// edges and circles are coloured as in the paper.
///@{
namespace colour {
inline const cv::Scalar kCorner{0, 230, 255};        ///< chi: yellow dots
inline const cv::Scalar kIgnored{0, 150, 150};       ///< psi and the corners in it: olive
inline const cv::Scalar kCollector{190, 170, 255};   ///< lambda: thin pink circles
inline const cv::Scalar kPredicted{235, 206, 180};   ///< L~ of edges: small pale squares
inline const cv::Scalar kNormalEdge{255, 110, 30};   ///< E_n: small blue squares
inline const cv::Scalar kRebel{40, 40, 255};         ///< E_r and C_r: red
inline const cv::Scalar kNormalCircle{60, 220, 60};  ///< C_n: green
inline const cv::Scalar kSquare{255, 255, 255};  ///< S: white boxes, thin outlines of their edges
inline const cv::Scalar kMovingTruth{220, 220, 0};    ///< cyan
inline const cv::Scalar kStaticTruth{150, 150, 150};  ///< grey
inline const cv::Scalar kMissed{0, 150, 255};         ///< orange rings and boxes
inline const cv::Scalar kFalse{255, 60, 255};         ///< violet crosses
}  // namespace colour
///@}

/// True box of an object, drawn thin beneath the layers. Pixel-centre coordinates.
struct TruthBox {
  Vec2 min_px = Vec2::Zero();
  Vec2 max_px = Vec2::Zero();
  bool moving = false;
  std::string name = {};  ///< written above it; "" for none
  bool missed = false;    ///< its square is missing
};

/// Comparison of a corner, circle or square with the truth.
enum class Mark : std::uint8_t { none, found, missed, wrong };

struct PanelContent {
  const cv::Mat3b& image;  ///< BGR
  std::span<const Eigen::Vector2f> corners_px;
  std::span<const Verdict> verdicts;  ///< of each corner
  const Layers& layers;
  const PaperLayers& paper;
  std::span<const TruthBox> truth;
  std::string caption;  ///< of the frame, such as "frame 12  1.20 s"; printed over all panels
  /// \name Of each corner, rebel circle and square; empty if the truth is unknown.
  ///@{
  std::span<const Mark> corner_marks = {};
  std::span<const Mark> rebel_circle_marks = {};
  std::span<const Mark> square_marks = {};
  ///@}
  std::span<const Vec2> radial_px = {};  ///< places of the rebels that are radial
};

enum class Panel { corners, edges, circles, squares };

/// Draws sheets of 2x2 panels of one size for a camera of one size.
class PanelSheet {
 public:
  /// \param image_px size of the camera's image.
  /// \param panel_px longer side of a panel on the sheet, px; the image is scaled to it. Sides are
  ///   even, for video codecs.
  /// \throws std::invalid_argument if a size is below 16.
  explicit PanelSheet(cv::Size image_px, int panel_px = 640);

  /// Height of the bands over the sheet, over each panel and below each panel.
  static constexpr int kTitle_px = 28, kCaption_px = 22, kLegend_px = 20;
  cv::Size size_px() const {
    return {2 * panel_.width, kTitle_px + 2 * (kCaption_px + panel_.height + kLegend_px)};
  }

  /// Place on the sheet, px, of an image pixel in the given panel.
  Vec2 at(Panel panel, const Vec2& image_point) const;

  /// \throws std::invalid_argument for an image of another size, or if the counts of verdicts or
  ///   marks do not match.
  cv::Mat3b draw(const PanelContent& content) const;

 private:
  cv::Rect area(Panel panel) const;  ///< of the image in the panel

  cv::Size image_;
  cv::Size panel_;
};

}  // namespace lcs::output
