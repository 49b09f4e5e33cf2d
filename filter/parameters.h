/// \file
/// Every number that the filter can be tuned by, expert by expert. The paper's symbol and value
/// (Table 1, "lab") stand beside each; keys for `set` are "expert.field", as in "circle.mu_0".
/// Angles are radians in the structs and degrees in text.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "filter/paper/parameters.h"
#include "filter/trust.h"

namespace lcs {

/// How stored locations follow the rotation of the camera.
enum class RotationModel {
  first_order,  ///< the motion field integrated once: the paper's, good for small rotations
  homography,   ///< x' ~ K dR K^-1 x, exact
  as_printed,   ///< the paper's first equation with its wrong terms, to be compared with
};

/// How edges are matched and rebels are told.
enum class EdgeRule {
  paper,       ///< the five cases xi, and alpha: three sightings of a single corner in line
  hypotheses,  ///< each corner is a static point or moves by itself, weighed at each sighting
};

/// How circles become squares.
enum class LayerRule {
  couples,  ///< the paper's: the furthest couple of like circles, and what lies inside it
  circles,  ///< each circle that is a body's
};

/// Kinematics.
struct FieldParameters {
  RotationModel rotation = RotationModel::homography;
  double reference_depth_m = 3;    ///< Z_ref: V_v(x) is the image speed of a static point this far
  double nearest_depth_m = 0.8;    ///< no static point is nearer than this (z_min)
  bool ground = true;              ///< no static point is below the ground, where that is known
  double ground_tilt_rad = 0.015;  ///< by which the ground may fall away from its plane
  double still_speed_mps = 0.005;  ///< slower than this the camera stands still: there is no field
};

/// Line expert.
struct LineParameters {
  bool ignore = true;  ///< apply psi; off, every corner is looked at in every frame
  /// Of more than these the nearest to the principal point are looked at. Bounds the memory.
  int max_corners = 20000;
};

/// Two hypotheses a corner (`filter/edges/`), which stand in for xi and alpha. The table of symbols
/// in filter/MODEL.md says where each value comes from.
struct HypothesisParameters {
  /// The least standard deviation of a corner's place on an axis: whole pixels, and FAST. How
  /// much it is above that is estimated.
  double noise_px = 0.6;
  double prior = 0.03;  ///< share of corners that move
  /// Log odds by which a corner that is new is a mover's: FAST finds those again less often.
  double newcomer = 1;
  /// 1/s: how often a corner changes its kind, a track its corner, or a mover its image velocity by
  /// as much as that is.
  double turnover_ps = 1;
  /// The share of it in a frame.
  double turnover(double dt_s) const { return std::min(0.5, turnover_ps * dt_s); }
  double ego_share = 0.02;      ///< of its speed, by which the camera's velocity may be wrong
  double max_speed_pxps = 900;  ///< px/s: the fastest that a mover is looked for, rotation removed
  int coast = 3;                ///< frames that a track goes on unseen
  /// That differ where two signatures are as often of one place as of two; of more no pair is made.
  double bits_even = 77.5;
  double bits_weight = 0.152;      ///< what each bit less counts, log odds
  double step_share = 0.1;         ///< by which the steps of neighbours may differ
  double neighbour_reach_px = 25;  ///< px: where what a voter counts has fallen to 0.6
  double coupling = 8;             ///< J: what those round a corner count at the most, log odds
  int neighbours = 9;              ///< nearest corners, which are asked and have a say
};

/// Circle expert: edges, alpha, circles.
struct CircleParameters : PaperCircleParameters {
  TrustRanks trust{2, 3, 5};  ///< Tr^c
  EdgeRule edge_rule = EdgeRule::hypotheses;
  HypothesisParameters hypotheses;
  int min_members = 3;      ///< edges that make a new circle
  double min_width = 0;     ///< px: deviation across their line of edges that make one
  double gap_m = 0.2;       ///< m: between the edges of one body, about
  double upward = 0.45;     ///< what a distance upwards counts beside one along the horizon
  double roughness = 0.05;  ///< share by which a body's depths and velocities are off a plane
};

/// Square expert.
struct SquareParameters : PaperSquareParameters {
  TrustRanks trust{3, 5, 7};  ///< Tr^s
  LayerRule layer_rule = LayerRule::circles;
  double max_size = 5;  ///< m: what is larger, by its depth, is no object but the setting
};

struct Parameters {
  FieldParameters field;
  LineParameters line;
  CircleParameters circle;
  SquareParameters square;
};

/// Preset by name: "default" (this project's), or the paper's: "lab" (Table 1), "cars" (section
/// 5.2). \throws std::invalid_argument naming the known presets.
Parameters preset(std::string_view name);
std::vector<std::string> preset_names();

/// Sets one parameter from text, as in set(p, "circle.mu_0", "25").
/// \throws std::invalid_argument: unknown key, not a value of its kind, out of range.
void set(Parameters& parameters, std::string_view key, std::string_view value);

/// \throws std::invalid_argument naming the first parameter that is out of its range, or ranks of
///   trust out of order.
void validate(const Parameters& parameters);

/// A choice between rules: the key, and the word that names one of them.
struct Rule {
  std::string key, value;
};

/// Why a parameter has no effect: only these rules ask for it, which are those of these presets.
struct Idle {
  std::vector<Rule> rules;
  std::vector<std::string> presets;
};
/// None for one that is in use. \throws std::invalid_argument as `set`.
std::optional<Idle> idle(const Parameters& parameters, std::string_view key);

/// One line a parameter: key, value, unit, range, symbol. For `--help` and manifests.
struct ParameterInfo {
  std::string key, value, unit, range, symbol;
  bool learnt = false;  ///< the preset `default` has it from worlds of `train` (`learnt.h`)
};
std::vector<ParameterInfo> describe(const Parameters& parameters);

}  // namespace lcs
