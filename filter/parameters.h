/// \file
/// All tuning parameters of the filter. Each struct is declared with the step that uses it. Keys
/// for `set` are "group.field", such as "circle.gap". Angles are radians in structs, degrees in
/// text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "filter/circles/circle_parameters.h"
#include "filter/edges/edge_parameters.h"
#include "filter/kinematics/motion_field.h"
#include "filter/line/line.h"
#include "filter/radial/comer_parameters.h"
#include "filter/squares/square_expert.h"

namespace lcs {

/// `Parameters{}` is the preset `default`.
struct Parameters {
  bool ground = true;  ///< no static point lies below a known ground
  FieldParameters field;
  LineParameters line;
  EdgeParameters edge;
  CircleParameters circle;
  ComerParameters comers;
  SquareParameters square;
};

/// Sets one parameter from text, as in set(p, "circle.gap", "0.3").
/// \throws std::invalid_argument for an unknown key, a wrong type or a value out of range.
void set(Parameters& parameters, std::string_view key, std::string_view value);

/// \throws std::invalid_argument naming the first parameter out of range, or unordered ranks.
void validate(const Parameters& parameters);

/// One line per parameter: key, value, unit, range, symbol. For `--help` and manifests.
struct ParameterInfo {
  std::string key, value, unit, range, symbol;
  bool learnt = false;  ///< its default comes from `learnt.h`
};
std::vector<ParameterInfo> describe(const Parameters& parameters);

}  // namespace lcs
