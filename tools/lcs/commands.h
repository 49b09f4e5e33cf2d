/// \file
/// The commands of the program. Each has its options, calls a function of tools/app and prints.
#pragma once

#include "tools/app/run.h"
#include "tools/lcs/command_line.h"
#include "tools/suite/comparison.h"

namespace lcs::tools {

Command run_command();
Command preview_command();
Command replay_command();
Command score_command();
Command suite_command();
Command merge_command();
Command generate_command();
Command compare_command();
Command explain_command();
Command kinematics_command();
Command world_command();
Command tune_command();

/// The texts of help/ that stand below the options.
extern const std::string_view kProgramHelp, kRunHelp, kPreviewHelp, kReplayHelp, kScoreHelp,
    kSuiteHelp, kMergeHelp, kGenerateHelp, kCompareHelp, kExplainHelp, kKinematicsHelp, kWorldHelp,
    kTuneHelp;

/// kRegressed, kError if nothing is judged, else kFine.
ExitCode exit_code_of(suite::Finding finding);

}  // namespace lcs::tools
