/// \file
/// Renders by MuJoCo alone, one sample in the middle of each pixel, with selectable settings.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "sim/world/world.h"

namespace lcs::test {

/// Renders for the truth.
enum class TruthRenders {
  none,
  together,  ///< depth and ids from one render
  apart,     ///< one render for each
};

struct RenderSettings {
  int samples = 0;       ///< per pixel
  bool shadows = false;  ///< of all lights, with MuJoCo's default resolution
  TruthRenders truth = TruthRenders::together;
  bool read_back = true;  ///< if false, only waits until all is drawn

  bool operator==(const RenderSettings&) const = default;
};

struct NamedRenderSettings {
  const char* name;
  const char* what;
  RenderSettings settings;
};

inline constexpr NamedRenderSettings kRenderSettings[] = {
    {"plain", "colour, then depth and ids at once", {}},
    {"no_read_back", "nothing is read back", {.read_back = false}},
    {"colour_only", "neither depth nor ids", {.truth = TruthRenders::none}},
    {"truth_apart", "depth and ids from a render each", {.truth = TruthRenders::apart}},
    {"samples_4", "4 samples a pixel", {.samples = 4}},
    {"shadows", "all lights cast shadows", {.shadows = true}},
    {"all_three",
     "samples, shadows, and depth and ids apart",
     {.samples = 4, .shadows = true, .truth = TruthRenders::apart}},
};

class RawRenderer {
 public:
  /// Renders the world's camera in its current state. \param world must outlive the renderer, which
  /// changes it for the settings: use a world of its own.
  /// \throws std::runtime_error if GL does not support the settings.
  RawRenderer(sim::World& world, const cv::Size& size_px, const RenderSettings& settings);
  ~RawRenderer();
  RawRenderer(const RawRenderer&) = delete;
  RawRenderer& operator=(const RawRenderer&) = delete;

  void render();

  /// The colour codes of the last frame.
  cv::Mat3b picture() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lcs::test
