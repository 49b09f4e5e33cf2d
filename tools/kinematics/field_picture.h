/// \file
/// The field as a picture: how corners of a rendered frame move until the next one, and how the
/// model says they do.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "tools/kinematics/models.h"

namespace lcs::kinematics {

/// From a place, to where the truth takes it and to where the model does.
struct Arrow {
  Vec2 from_px, true_px, predicted_px;
};

struct FieldFrame {
  cv::Mat3b image;  ///< BGR; empty: there was none
  int index = 0;
  std::vector<Arrow> fixed;   ///< landmarks that do not move; predicted by what they have learnt
  std::vector<Arrow> moving;  ///< corners on movers; predicted as if they stood still
  std::optional<Vec2> foe_px;
};

/// Two panels beside each other, what is fixed and what moves. Arrows are lengthened, and the
/// picture says by how much.
cv::Mat3b draw_field(const FieldFrame& frame);

}  // namespace lcs::kinematics
