/// \file
/// A study as files: the answer, a CSV a table, the field as a PNG, and one HTML page with all of
/// it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/kinematics/study.h"

namespace lcs::kinematics {

inline constexpr const char* kAnswerFile = "answer.txt";
inline constexpr const char* kPageFile = "kinematics.html";
inline constexpr const char* kFieldFile = "field.png";

/// All names that `write_study` may write, in the form that `bench::OutputFolder` takes.
std::vector<std::string> study_files();

/// \throws bench::OutputError
void write_study(const std::filesystem::path& folder, const Study& study);

}  // namespace lcs::kinematics
