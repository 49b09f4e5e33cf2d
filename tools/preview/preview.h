/// \file
/// Previews a scenario without a run: paths and times of actors, their visibility, number of
/// corners, and problems.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/survey.h"

namespace lcs::preview {

/// Number of frames that are rendered, including the first, the middle and the last one.
inline constexpr int kLooks = 13;

/// An actor with its path.
struct PreviewMover {
  std::string name;
  int object = 0;                           ///< as FrameTruth::object
  std::vector<Eigen::Vector2d> way_m = {};  ///< in W, m, one point per frame
  struct Span {
    double from_s = 0, to_s = 0;
  };
  std::optional<Span> moves = {};  ///< from its first to its last step; absent: it never moves
  double nearest_m = 0;            ///< least distance to the rover, m, between origins
  double nearest_s = 0;
  int looks = 0;  ///< number of looks that show some of it
};

/// Most pixels of a rendered picture. Larger cameras are rendered at a reduced size, as their
/// pictures take gigabytes, and seconds each.
inline constexpr int kMostLookPixels = 2048 * 2048;

/// A rendered frame.
struct Look {
  int index = 0;
  cv::Size image_px = {};
  std::vector<sim::ObjectTruth> objects = {};
  std::string jpeg = {};
};

struct Preview {
  sim::Survey survey;
  std::vector<Look> looks;
  std::vector<std::vector<Eigen::Vector2f>> corners_px;  ///< of each look
  std::vector<PreviewMover> movers;                      ///< by the scenario's actors
  std::vector<std::string> wrong;  ///< problems with remedies, those that a run rejects first
};

/// \param on_frame as in `sim::survey`. \throws like `sim::survey`.
Preview preview(const scenario::Scenario& scenario, const std::function<void(int)>& on_frame = {});

/// Writes one HTML file with embedded pictures. \throws files::OutputError
void write_preview(const std::filesystem::path& file, const scenario::Scenario& scenario,
                   const Preview& preview);

}  // namespace lcs::preview
