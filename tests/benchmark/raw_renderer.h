/// \file
/// What `sim::CameraRenderer` renders, by the same calls of MuJoCo and with settings to choose:
/// what each of the project's choices saves is measured with this.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "sim/world.h"

namespace lcs::bench {

/// What is rendered for the truth.
enum class TruthRenders {
  none,
  together,  ///< depth and ids from one render
  apart,     ///< from one each
};

/// As the project has them, unless changed.
struct RenderSettings {
  int samples = 0;       ///< a pixel
  bool shadows = false;  ///< of all lights, with MuJoCo's default resolution
  TruthRenders truth = TruthRenders::together;
  bool read_back = true;  ///< else only waits until all is drawn

  bool operator==(const RenderSettings&) const = default;
};

struct NamedRenderSettings {
  const char* name;
  const char* what;
  RenderSettings settings;
};

inline constexpr NamedRenderSettings kRenderSettings[] = {
    {"project", "as the project renders: colour, then depth and ids at once", {}},
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
  /// Of the world's camera, as things stand. \param world outlives the renderer, and is changed as
  /// the settings need it: it should be the renderer's own.
  /// \throws std::runtime_error where GL cannot do what the settings ask for.
  RawRenderer(sim::World& world, const cv::Size& size_px, const RenderSettings& settings);
  ~RawRenderer();
  RawRenderer(const RawRenderer&) = delete;
  RawRenderer& operator=(const RawRenderer&) = delete;

  /// One frame, with all that `sim::CameraRenderer` does in `update`.
  void render();

  /// The colour of the last frame before the lens blurs it, as `sim::CameraRenderer` does it.
  cv::Mat3b picture() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lcs::bench
