/// \file
/// The answer of a study: for each part of the model its figures beside the theoretical ones, and
/// whether it is within the tolerance. A study as files has the answer, a CSV file for each
/// experiment, and one HTML page with plots.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/files/output.h"
#include "tools/kinematics/study.h"

namespace lcs::kinematics {

struct Figure {
  std::string name;  ///< for example "first_order.limit.pan"
  double value = 0;
  std::string unit;
  double expected = 0;  ///< by theory; NaN without a formula
};

struct Statement {
  std::string topic;  ///< "rotation", "translation", "IMU", "mount", "bumps", "drift", "camera"
  std::string text;   ///< describes how the figures were measured
  std::vector<Figure> figures;
  /// Whether the error is within `StudyConfig::tolerance_px`, and the error, as "yes: 0.021 px".
  std::string verdict;
  bool is_own = false;  ///< concerns the scenario's own filter and sensors, not alternatives
};

std::vector<Statement> answer(const Study& study);

/// Camera, rover and IMU in one line.
std::string subject(const StudyConfig& config);

/// The verdicts on the scenario's own filter and sensors in one line.
std::string bottom_line(const StudyConfig& config, const std::vector<Statement>& statements);

/// A readable text with a heading.
std::string text_of(const StudyConfig& config, const std::vector<Statement>& statements);

/// All files that `write_study` may write.
files::ResultNames study_files();

/// \throws files::OutputError
void write_study(const std::filesystem::path& folder, const Study& study);

}  // namespace lcs::kinematics
