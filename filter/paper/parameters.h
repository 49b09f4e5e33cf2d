/// \file
/// What only the paper's rules ask for (Table 1, "lab"). Angles are radians here, degrees in text.
#pragma once

#include "filter/kinematics/geometry.h"

namespace lcs {

/// Of edges, alpha and circles.
struct PaperCircleParameters {
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
  double reach_n = 50;  ///< px: how far apart the edges of one normal circle may lie
  double reach_r = 50;  ///< px: and of a rebel one
};

/// Of squares.
struct PaperSquareParameters {
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

}  // namespace lcs
