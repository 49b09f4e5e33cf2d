/// \file
/// Parameters of the paper's filter, with the paper's symbol and value (Table 1, "lab"). Values
/// without a symbol are not given in the paper. Angles are radians here, degrees in text.
#pragma once

#include <string_view>
#include <vector>

#include "filter/kinematics/geometry.h"
#include "filter/parameters.h"

namespace lcs::paper {

/// Parameters of edges and alpha.
struct PaperEdgeParameters {
  double delta_v = 9 * kDegree;           ///< delta_v: half angle of the error span, seen from O_I
  double mu_0 = 25;                       ///< mu_0, px: radius of detection of a new normal edge
  double mu_min = 3;                      ///< px: bounds of mu
  double mu_max = 25;                     ///< px
  double corner_noise = 1.5;              ///< px: error of a corner's place
  double trust_bonus = 0.25;              ///< px: distance worth one step of trust in assignment
  double alpha_reach = 50;                ///< px: between two sightings in alpha
  double alpha_deviation = 20 * kDegree;  ///< mu_r: bend of the line through three sightings
  double alpha_stretch = 0.35;            ///< relative change between the first and second step
  int alpha_branches = 4;                 ///< most rows that one sighting branches into
  double rebel_reach = 0.35;              ///< relative error of a rebel's predicted displacement
};

struct PaperCircleParameters {
  TrustRanks trust{2, 3, 5};             ///< Tr^c, also of edges
  int min_members = 3;                   ///< fewest edges of a new circle
  double epsilon_beta_n = 20 * kDegree;  ///< eps_beta,n
  double epsilon_beta_r = 50 * kDegree;  ///< eps_beta,r
  double epsilon_v_n = 0.4;              ///< eps_v,n, 40 % of V_v
  double epsilon_v_r = 1.0;              ///< eps_v,r, 100 % of V_v
  double epsilon_v = 0.7;                ///< eps_v, of V_v, between a predicted circle and a group
  double rho_c = 40;                     ///< rho_c, %: overlap of a group with the predicted circle
  double reach_n = 50;                   ///< px: between edges of one normal circle
  double reach_r = 50;                   ///< px: between edges of one rebel circle
};

struct PaperSquareParameters {
  TrustRanks trust{3, 5, 7};             ///< Tr^s
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

/// `PaperParameters{}` is the preset `lab`: Table 1.
struct PaperParameters {
  FieldParameters field{.nearest_depth_m = 0.8};
  bool ignore = true;  ///< key "line.ignore": use regions psi
  LineParameters line;
  PaperEdgeParameters edge;
  PaperCircleParameters circle;
  PaperSquareParameters square;
};

/// The preset `cars`, section 5.2: other ranks of trust. The paper does not print its other "minor
/// changes".
PaperParameters cars();

/// Like the functions for `lcs::Parameters`.
///@{
void set(PaperParameters& parameters, std::string_view key, std::string_view value);
void validate(const PaperParameters& parameters);
std::vector<ParameterInfo> describe(const PaperParameters& parameters);
///@}

}  // namespace lcs::paper
