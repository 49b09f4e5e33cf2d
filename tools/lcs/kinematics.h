/// \file
/// `lcs kinematics`: the conditions under which the kinematics model holds for a camera and rover.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct KinematicsOptions {
  std::string config;             ///< scenario file; "": `crossing.yaml` of this project
  std::vector<std::string> sets;  ///< "key=value"
  std::string out = "out/kinematics";
  double tolerance_px = 1;
  bool quick = false;
  bool quiet = false;
};

/// Adds the sub-command to `app`. \param options filled in by parsing.
CLI::App& add_kinematics_command(CLI::App& app, KinematicsOptions& options);

/// \throws input::Error, bench::OutputError, sim::PhysicsError, Interrupted, std::exception;
///   then no output is written, and earlier output is unchanged.
ExitCode kinematics(const KinematicsOptions& options);

}  // namespace lcs::tools
