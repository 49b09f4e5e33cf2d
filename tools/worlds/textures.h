/// \file
/// Pictures for surfaces. They share nothing with those of `sim/texture.h`: what the filter was
/// developed with is not what it is measured with. Each repeats without a seam where it is tiled.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tools/worlds/draw.h"

namespace lcs::worlds {

enum class Style {
  plain,       ///< one colour, nearly
  fractal,     ///< 1/f noise between two colours
  concrete,    ///< the same at low contrast, with stains and pores
  lettering,   ///< printed matter: words, numbers, rules
  wood,        ///< planks with grain
  bricks,      ///< in bond, with mortar
  tiles,       ///< in a grid, with grout
  stripes,     ///< bars, upright, lying or slanting
  grille,      ///< a lattice before a dark ground
  corrugated,  ///< sheet metal in waves
  foliage,     ///< leaves over each other
  worn,        ///< paint that chipped and was scratched
  speckle,     ///< terrazzo, asphalt, granite
  facade,      ///< windows in rows
};

/// For messages and names of files.
std::string_view name_of(Style style);

/// Whether a style looks alike from every side, so that it may be put round an object in any way.
bool is_isotropic(Style style);

/// A square picture, BGR, top row first.
cv::Mat3b paint(Style style, int side_px, Draw& draw);

/// Lightens and darkens a picture at all sizes alike, as wear, dirt, grain and small shadows do, so
/// that there is something to be seen from near and from afar. \param levels deviation, grey
/// levels.
void weather(cv::Mat3b& picture, double levels, Draw& draw);

/// A part of one of the pictures of a folder.
/// \throws std::runtime_error for a picture that cannot be read.
cv::Mat3b photograph(const std::vector<std::string>& files, int side_px, Draw& draw);

/// Pictures (.png, .jpg, .jpeg, .bmp) of a folder, by name. \throws std::runtime_error without any.
std::vector<std::string> pictures_in(const std::string& folder);

}  // namespace lcs::worlds
