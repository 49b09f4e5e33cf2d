/// \file
/// An overview of a scenario without a run: a plan from above, the ways of rover and actors, and a
/// few of its frames. And its world as a file, for other programs.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/simulation.h"

namespace lcs::sim {

/// A part of a world from above, at the start: a convex outline in W, counter-clockwise, m.
struct Footprint {
  std::vector<Eigen::Vector2d> outline_m;
  int object = 0;    ///< as in FrameTruth::object: 0 is the setting, -1 the rover
  double low_m = 0;  ///< its lowest and its highest point
  double high_m = 0;
};

struct Survey {
  std::vector<Footprint> footprints;  ///< without floors and what is not drawn
  std::vector<Object> objects;
  std::vector<int> actors;                  ///< the object that each actor of the scenario is
  std::vector<Eigen::Vector2d> rover_m;     ///< in W, in each frame
  std::vector<Snapshot> snapshots;          ///< of each frame
  std::vector<std::string> wrong_at_start;  ///< what a run refuses, a line each
  std::vector<std::string> inside;          ///< a line for each thing that the camera gets into
  Warnings warnings;
};

/// \param looks how many frames to make pictures of, evenly spread from the first to the last.
/// \param on_look handed each of these.
/// \param on_frame called after each frame with how many are done; what it throws ends the survey.
/// \throws what a `Simulation` throws, but for what starts inside of something else.
Survey survey(const scenario::Scenario& scenario, int looks,
              const std::function<void(const Observation&)>& on_look,
              const std::function<void(int)>& on_frame = {});

enum class WorldFormat {
  mjcf,
  mjb,  ///< MuJoCo's binary, which also holds the painted textures and the bumps of the ground
};

/// The bytes of a file of the world, with rover and actors at the start. \throws as `survey`
std::string world_file(const scenario::Scenario& scenario, WorldFormat format);

}  // namespace lcs::sim
