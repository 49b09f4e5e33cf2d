/// \file
/// Procedural textures: few large features with straight edges, so that a corner is a point of the
/// world and is found again in the next frame. Seeded: the same name and seed give the same bytes.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "sim/model.h"
#include "sim/random.h"

namespace lcs::sim {

/// Styles that `paint` knows, in alphabetical order.
const std::vector<std::string>& texture_styles();

bool is_texture_style(std::string_view name);

/// A texture of the scene with this in its name is painted after loading. As in
/// "procedural:windows:2", the style follows, and then anything that tells it from others of its
/// style.
inline constexpr std::string_view kProceduralPrefix = "procedural:";

/// The style named in a texture's name, behind whatever prefix; empty if it is not procedural.
std::string_view procedural_style(std::string_view texture_name);

/// One picture of a style, top row first, RGB.
/// \throws std::invalid_argument for an unknown style, naming the known ones.
cv::Mat3b paint(std::string_view style, int width_px, int height_px, RandomStream random);

/// Fills every procedural texture of the model, each from a stream of its own.
void fill_procedural_textures(Model& model, std::uint64_t scenario_seed);

/// Fills a texture with a picture (RGB); on a cube, each face.
void fill_texture(Model& model, int texture, const cv::Mat3b& picture);

}  // namespace lcs::sim
