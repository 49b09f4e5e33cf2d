/// \file
/// Every number that the filter can be tuned by. Each struct stands beside the step that uses it.
/// Keys for `set` are "group.field", as in "circle.gap". Angles are radians in the structs and
/// degrees in text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "filter/circles/circle_parameters.h"
#include "filter/edges/edge_parameters.h"
#include "filter/kinematics/motion_field.h"
#include "filter/line/line.h"
#include "filter/squares/square_expert.h"

namespace lcs {

/// `Parameters{}` is the preset `default`.
struct Parameters {
  bool ground = true;  ///< no static point is below the ground, where the ground is known
  FieldParameters field;
  LineParameters line;
  EdgeParameters edge;
  CircleParameters circle;
  SquareParameters square;
};

/// Sets one parameter from text, as in set(p, "circle.gap", "0.3").
/// \throws std::invalid_argument: unknown key, not a value of its kind, out of range.
void set(Parameters& parameters, std::string_view key, std::string_view value);

/// \throws std::invalid_argument naming the first parameter that is out of its range, or ranks of
///   trust out of order.
void validate(const Parameters& parameters);

/// One line a parameter: key, value, unit, range, symbol. For `--help` and manifests.
struct ParameterInfo {
  std::string key, value, unit, range, symbol;
  bool learnt = false;  ///< its default is from `learnt.h`
};
std::vector<ParameterInfo> describe(const Parameters& parameters);

}  // namespace lcs
