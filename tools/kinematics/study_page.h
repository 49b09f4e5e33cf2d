/// \file
/// A study as files: the answer, a CSV a table, the field as a PNG, and one HTML page with all of
/// it.
#pragma once

#include <filesystem>

#include "tools/files/output.h"
#include "tools/kinematics/study.h"

namespace lcs::kinematics {

inline constexpr const char* kAnswerFile = "answer.txt";
inline constexpr const char* kPageFile = "kinematics.html";
inline constexpr const char* kFieldFile = "field.png";

/// All files that `write_study` may write.
bench::ResultNames study_files();

/// \throws bench::OutputError
void write_study(const std::filesystem::path& folder, const Study& study);

}  // namespace lcs::kinematics
