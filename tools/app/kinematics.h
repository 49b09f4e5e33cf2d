/// \file
/// Measures under which conditions the kinematics model holds for a camera and rover.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/app/caller.h"
#include "tools/app/option.h"
#include "tools/kinematics/answer.h"

namespace lcs::app {

struct KinematicsRequest {
  std::string config;             ///< scenario file; "": `crossing.yaml` of this project
  std::vector<std::string> sets;  ///< "key=value"
  std::string out = "out/kinematics";
  double tolerance_px = 1;
  bool quick = false;
};

Options options_of(KinematicsRequest& request);

struct KinematicsMade {
  std::vector<kinematics::Statement> answer;
  std::string text;  ///< the answer as answer.txt has it
  std::filesystem::path folder;
};

/// \throws input::Error, files::OutputError, sim::PhysicsError, std::exception; then no output is
///   written, and earlier output is unchanged.
KinematicsMade kinematics(const KinematicsRequest& request, Caller& caller);

}  // namespace lcs::app
