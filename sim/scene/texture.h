/// \file
/// Procedural textures: few large features with straight edges, so that corners are fixed points of
/// the world and can be tracked. Equal name and seed give equal bytes.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/random.h"
#include "sim/scene/model.h"

namespace lcs::sim {

/// The styles that `paint` accepts, in alphabetical order.
const std::vector<std::string>& texture_styles();

bool is_texture_style(std::string_view name);

/// Textures of the scene with this in their name are painted after loading. A style follows, then
/// any text that makes the name unique: "procedural:windows:2".
inline constexpr std::string_view kProceduralPrefix = "procedural:";

/// The style in a texture's name, after any prefix; empty if the texture is not procedural.
std::string_view procedural_style(std::string_view texture_name);

/// One image of a style, top row first, RGB.
/// \throws std::invalid_argument for an unknown style, with the known styles.
cv::Mat3b paint(std::string_view style, int width_px, int height_px, RandomStream random);

/// Paints a texture of the model, if it is procedural, from its own random stream. \throws as
/// `paint`
void fill_procedural_texture(Model& model, int texture, std::uint64_t scenario_seed);

/// Fills a texture with an image (RGB); for a cube texture, each face.
void fill_texture(Model& model, int texture, const cv::Mat3b& picture);

}  // namespace lcs::sim
