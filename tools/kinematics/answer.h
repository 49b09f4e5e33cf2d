/// \file
/// The plain answer of a study: sentences, and the figures in them beside what theory expects.
#pragma once

#include <string>
#include <vector>

#include "tools/kinematics/study.h"

namespace lcs::kinematics {

struct Figure {
  std::string name;  ///< as "first_order.pan"
  double value = 0;
  std::string unit;
  double expected = 0;  ///< by theory; NaN where it has nothing to say
};

struct Statement {
  std::string topic;  ///< "rotation", "translation", "IMU", "mount", "bumps", "drift"
  std::string text;
  std::vector<Figure> figures;
  /// Whether, or how far, it stays within `StudyConfig::tolerance_px`, as "yes: 0.021 px"; empty
  /// for what the tolerance does not judge.
  std::string verdict = {};
  bool is_own = false;  ///< of what the scenario's filter and sensors do, not of what they might
};

/// The scenario's own IMU is the first of those that are told of.
std::vector<Statement> answer(const Study& study);

/// What the answer is about: camera, rover, IMU.
std::string subject(const StudyConfig& config);

/// The verdicts on what is the scenario's own, in a line.
std::string bottom_line(const StudyConfig& config, const std::vector<Statement>& statements);

/// For people, with a heading.
std::string text_of(const StudyConfig& config, const std::vector<Statement>& statements);

}  // namespace lcs::kinematics
