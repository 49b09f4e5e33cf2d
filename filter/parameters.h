/// \file
/// Every number that the filter can be tuned by, expert by expert. The paper's symbol and value
/// (Table 1, "lab") stand beside each; keys for `set` are "expert.field", as in "circle.mu_0".
/// Angles are radians in the structs and degrees in text.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "filter/kinematics/geometry.h"
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

/// Two hypotheses a corner (`filter/edges/`), which stand in for xi and alpha; where each
/// comes from is in filter/RULES.md.
struct HypothesisParameters {
  double noise_px = 0.6;  ///< standard deviation of a corner's place on an axis: whole pixels, FAST
  double prior = 0.03;    ///< share of corners that move
  /// 1/s: how often a corner changes its kind, a track its corner, or a mover its image velocity by
  /// as much as that is.
  double turnover_ps = 1;
  double wrong = 0.05;          ///< share of matches that are none
  double ego_share = 0.02;      ///< of the image motion by which the camera's velocity may be wrong
  double max_speed_pxps = 900;  ///< px/s: the fastest that a mover is looked for, rotation removed
  int coast = 3;                ///< frames that a track goes on unseen
  /// That differ where two signatures are as often of one place as of two; of more no pair is made.
  double bits_even = 77.5;
  double bits_weight = 0.152;     ///< what each bit less counts, log odds
  int voters = 8;                 ///< neighbours that are asked about a match
  double voters_share = 0.5;      ///< of them that are found again beside it where it is right
  double step_share = 0.1;        ///< by which the steps of neighbours may differ
  double coupling = 8;            ///< J: what those round a corner count at the most, log odds
  double coupling_reach_px = 25;  ///< px: where it has fallen to 0.6, and what voters count, too
};

/// Circle expert: edges, alpha, circles.
struct CircleParameters {
  TrustRanks trust{2, 3, 5};  ///< Tr^c
  EdgeRule edge_rule = EdgeRule::hypotheses;
  HypothesisParameters hypotheses;
  double delta_v = 9 * kDegree;  ///< delta_v: half angle of the error span, seen from O_I
  double mu_0 = 25;              ///< mu_0, px: radius of detection of a new normal edge
  double mu_min = 3;             ///< px: bounds on mu, which the paper leaves open
  double mu_max = 25;            ///< px
  double corner_noise = 1.5;     ///< px: how far a corner may lie off for no reason
  double trust_bonus = 0.25;     ///< px of distance that a step of trust is worth in assignment
  double alpha_reach = 50;       ///< px: between two sightings in alpha
  double alpha_deviation = 20 * kDegree;  ///< mu_r: bend of the line through three sightings
  double alpha_stretch = 0.35;  ///< share by which the second step may differ from the first
  int alpha_branches = 4;       ///< rows that one sighting may branch into
  double rebel_reach = 0.35;    ///< share of the predicted displacement by which a rebel may err

  double epsilon_beta_n = 20 * kDegree;  ///< eps_beta,n
  double epsilon_beta_r = 50 * kDegree;  ///< eps_beta,r
  double epsilon_v_n = 0.4;              ///< eps_v,n, 40 % of V_v
  double epsilon_v_r = 1.0;              ///< eps_v,r, 100 % of V_v
  double epsilon_v = 0.7;                ///< eps_v, of V_v, between a predicted circle and a group
  double rho_c = 40;                     ///< rho_c, %: overlap of a group with the predicted circle
  double reach_n = 50;      ///< px: how far apart the edges of one normal circle may lie
  double reach_r = 50;      ///< px: and of a rebel one
  int min_members = 3;      ///< edges that make a new circle
  double min_width = 0;     ///< px: deviation across their line of rebels that make one
  double gap_m = 0.2;       ///< m: between the edges of one body, about
  double upward = 0.45;     ///< what a distance upwards counts beside one along the horizon
  double roughness = 0.05;  ///< share by which a body's depths and velocities are off a plane
};

/// Square expert.
struct SquareParameters {
  TrustRanks trust{3, 5, 7};  ///< Tr^s
  LayerRule layer_rule = LayerRule::circles;
  double max_size = 5;    ///< m: what is larger, by its depth, is no object but the setting
  double min_area = 250;  ///< px^2: of an object's box
  double delta_beta_1 = 90 * kDegree;    ///< delta_beta,1: between the circles of a corner (case 1)
  double delta_beta_2 = 0;               ///< delta_beta,2: between aligned circles (case 2)
  double epsilon_beta_1 = 15 * kDegree;  ///< eps_beta,1
  double epsilon_beta_2 = 35 * kDegree;  ///< eps_beta,2
  double epsilon_beta = 20 * kDegree;    ///< eps_beta: of minor circles
  double epsilon_beta_s = 20 * kDegree;  ///< eps_beta,s: between predicted and mean square
  double epsilon_v = 0.7;                ///< eps_v, of V_v: between circles
  double epsilon_v_s = 0.7;              ///< eps_v,s, of V_v: between predicted and mean square
  double rho_c = 40;                     ///< rho_c, %: least overlap
  double d_t = 1.0;                      ///< start of d_t, as a share of the image's diagonal
  bool mix_kinds = true;                 ///< normal and rebel circles may form one square
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
/// \throws std::invalid_argument: unknown key (with the nearest known one), not a value of its
/// kind,
///   out of range.
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
