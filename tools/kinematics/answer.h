/// \file
/// The answer of a study: for each part of the model its figures beside what theory expects, and
/// whether it is within the tolerance.
#pragma once

#include <string>
#include <vector>

#include "tools/kinematics/study.h"

namespace lcs::kinematics {

struct Figure {
  std::string name;  ///< as "first_order.limit.pan"
  double value = 0;
  std::string unit;
  double expected = 0;  ///< by theory; NaN where theory has no formula
};

struct Statement {
  std::string topic;  ///< "rotation", "translation", "IMU", "mount", "bumps", "drift"
  std::string text;   ///< says how the figures were taken
  std::vector<Figure> figures;
  /// Whether the error stays within `StudyConfig::tolerance_px`, and the error, as "yes: 0.021 px".
  std::string verdict;
  bool is_own = false;  ///< tells of the scenario's own filter and sensors, not of alternatives
};

std::vector<Statement> answer(const Study& study);

/// Camera, rover and IMU in one line.
std::string subject(const StudyConfig& config);

/// The verdicts on the scenario's own filter and sensors in one line.
std::string bottom_line(const StudyConfig& config, const std::vector<Statement>& statements);

/// For people, with a heading.
std::string text_of(const StudyConfig& config, const std::vector<Statement>& statements);

}  // namespace lcs::kinematics
