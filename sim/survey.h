/// \file
/// A preview of a scenario: a plan from above, the paths of rover and actors, and some of its
/// frames. Also exports the scenario's world as a file for other programs.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/simulation.h"

namespace lcs::sim {

/// Plan view of a part of the world at the start: convex outline in W, counter-clockwise, m.
struct Footprint {
  std::vector<Eigen::Vector2d> outline_m;
  int object = 0;    ///< as in FrameTruth::object: 0 is the setting, -1 the rover
  double low_m = 0;  ///< z of its lowest and its highest point, in W
  double high_m = 0;
};

struct Survey {
  std::vector<Footprint> footprints;  ///< without floors and invisible geoms
  std::vector<Object> objects;
  /// Of each actor of the scenario: its object id, and the places of its limbs in `Snapshot::T_WO`.
  std::vector<std::vector<std::size_t>> actors;
  std::vector<Eigen::Vector2d> rover_m;     ///< in W, per frame
  std::vector<Snapshot> snapshots;          ///< per frame
  std::vector<std::string> wrong_at_start;  ///< one line per fault that a run rejects
  std::vector<std::string> inside;          ///< one line per geom or object that the camera enters
  Warnings warnings;
};

/// \param looks number of frames to render, evenly spread from the first to the last.
/// \param on_look receives each rendered frame.
/// \param on_frame called after each frame with the count so far; its exceptions end the survey.
/// \throws as `Simulation`, except for overlaps at the start.
Survey survey(const scenario::Scenario& scenario, int looks,
              const std::function<void(const Observation&)>& on_look,
              const std::function<void(int)>& on_frame = {});

enum class WorldFormat {
  mjcf,
  mjb,  ///< MuJoCo's binary; includes painted textures and rough ground
};

/// The content of a file of the world, with rover and actors at the start. \throws as `survey`
std::string world_file(const scenario::Scenario& scenario, WorldFormat format);

}  // namespace lcs::sim
