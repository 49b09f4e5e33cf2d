/// \file
/// What a scenario is going to be, known without a run: who goes where and when, who is ever seen,
/// how many corners there are, and what is wrong.
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

/// How many frames are looked at; the first, the middle one and the last are among them.
inline constexpr int kLooks = 13;

/// An actor, as far as its way tells.
struct Mover {
  std::string name;
  int object = 0;                           ///< as in FrameTruth::object
  std::vector<Eigen::Vector2d> way_m = {};  ///< in W, in each frame
  struct Span {
    double from_s = 0, to_s = 0;
  };
  std::optional<Span> moves = {};  ///< from its first step to its last one; none: it stands
  double nearest_m = 0;            ///< to the rover, of both origins
  double nearest_s = 0;
  int looks = 0;  ///< in which some of it is seen
};

/// Pixels of a picture that is looked at. Larger cameras are looked through at a smaller size: the
/// largest one's pictures take gigabytes, and seconds each.
inline constexpr int kMostLookPixels = 2048 * 2048;

/// A frame that was looked at.
struct Look {
  int index = 0;
  cv::Size image_px = {};
  std::vector<sim::ObjectTruth> objects = {};
  std::vector<unsigned char> jpeg = {};
};

struct Preview {
  sim::Survey survey;
  std::vector<Look> looks;
  std::vector<std::vector<Eigen::Vector2f>> corners_px;  ///< of each look
  std::vector<Mover> movers;                             ///< by the scenario's actors
  std::vector<std::string> wrong;  ///< a line each, with what to do; what a run refuses is first
};

/// \param on_frame as of `sim::survey`. \throws as `sim::survey`.
Preview preview(const scenario::Scenario& scenario, const std::function<void(int)>& on_frame = {});

/// One HTML file with its pictures inside. \throws bench::OutputError
void write_preview(const std::filesystem::path& file, const scenario::Scenario& scenario,
                   const Preview& preview);

}  // namespace lcs::preview
