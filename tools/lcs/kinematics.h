/// \file
/// `lcs kinematics`: when the kinematics model holds, for a user's own camera and rover.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/lcs/exit_codes.h"

namespace lcs::tools {

struct KinematicsOptions {
  std::string config;             ///< scenario file; "": the project's `crossing.yaml`
  std::vector<std::string> sets;  ///< "key=value"
  std::string out = "out/kinematics";
  double tolerance_px = 1;
  bool quick = false;
  bool quiet = false;
};

/// Adds the sub-command to the program's. \param options are filled in by parsing.
CLI::App& add_kinematics_command(CLI::App& app, KinematicsOptions& options);

/// \throws scenario::Error, bench::OutputError, sim::PhysicsError, Interrupted, std::exception;
///   then there is no new output, and an earlier one is as it was.
ExitCode kinematics(const KinematicsOptions& options);

}  // namespace lcs::tools
