/// \file
/// Pictures for surfaces. They share nothing with `sim/scene/texture.h`, so that development and
/// evaluation use different textures. All of them tile without a seam.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/worlds/draw.h"

namespace lcs::worlds {

enum class Style {
  plain,       ///< nearly one colour
  fractal,     ///< 1/f noise between two colours
  concrete,    ///< low-contrast 1/f noise, with stains and pores
  lettering,   ///< printed matter: words, numbers, lines
  wood,        ///< planks with grain
  bricks,      ///< in bond, with mortar
  tiles,       ///< in a grid, with grout
  stripes,     ///< vertical, horizontal or slanted bars
  grille,      ///< a lattice in front of a dark ground
  corrugated,  ///< sheet metal in waves
  foliage,     ///< overlapping leaves
  worn,        ///< chipped and scratched paint
  speckle,     ///< terrazzo, asphalt, granite
  facade,      ///< windows in rows
};

struct StyleInfo {
  std::string_view name;  ///< for messages and files
  void (*paint)(cv::Mat3b&, Draw&);
  bool
      is_isotropic;  ///< looks the same in all directions, and so fits an object in any orientation
  double least_m, most_m;         ///< width that a picture of it spans
  std::string_view feature = {};  ///< of a world that has it; may be empty
};
const StyleInfo& info_of(Style style);

/// \return a square BGR picture.
cv::Mat3b paint(Style style, int side_px, Draw& draw);

/// Changes the brightness of a picture equally at all scales, like wear, dirt, grain and small
/// shadows, so that it has detail from near and from afar.
/// \param levels standard deviation, in grey levels.
void weather(cv::Mat3b& picture, double levels, Draw& draw);

/// Reduces the contrast of a picture about its mean colour.
void fade(cv::Mat3b& picture, double contrast);

/// A random section of one of the picture files.
/// \throws std::runtime_error for an unreadable picture.
cv::Mat3b photograph(const std::vector<std::string>& files, int side_px, Draw& draw);

/// Pictures (.png, .jpg, .jpeg, .bmp) of a folder, by name. \throws std::runtime_error without any.
std::vector<std::string> pictures_in(const std::string& folder);

}  // namespace lcs::worlds
