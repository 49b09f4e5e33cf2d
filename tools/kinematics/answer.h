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
};

std::vector<Statement> answer(const Study& study);

/// What the answer is about: camera, rover, IMU.
std::string subject(const StudyConfig& config);

/// For people, with a heading.
std::string text_of(const StudyConfig& config, const std::vector<Statement>& statements);

}  // namespace lcs::kinematics
