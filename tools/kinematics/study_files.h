/// \file
/// A study as files: the answer, a CSV file for each experiment, and one HTML page with plots.
#pragma once

#include <filesystem>

#include "tools/files/output.h"
#include "tools/kinematics/study.h"

namespace lcs::kinematics {

/// All files that `write_study` may write.
files::ResultNames study_files();

/// \throws files::OutputError
void write_study(const std::filesystem::path& folder, const Study& study);

}  // namespace lcs::kinematics
