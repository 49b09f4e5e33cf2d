#include "filter/paper/parameters.h"

#include "filter/parameter_table.h"

namespace lcs {

std::vector<Entry> paper_entries() {
  const AskedBy kPaper{{"circle.edge_rule", "paper"}};
  const AskedBy kCouples{{"square.layer_rule", "couples"}};
  return {
      {"circle.delta_v", "delta_v", "deg", 0, 90, LCS_REAL(circle.delta_v), kPaper},
      {"circle.mu_0", "mu_0", "px", 0.1, 1000, LCS_REAL(circle.mu_0), kPaper},
      {"circle.mu_min", "", "px", 0.1, 1000, LCS_REAL(circle.mu_min), kPaper},
      {"circle.mu_max", "", "px", 0.1, 1000, LCS_REAL(circle.mu_max), kPaper},
      {"circle.corner_noise", "", "px", 0, 100, LCS_REAL(circle.corner_noise), kPaper},
      {"circle.trust_bonus", "", "px", 0, 100, LCS_REAL(circle.trust_bonus), kPaper},
      {"circle.alpha_reach", "", "px", 0, 1000, LCS_REAL(circle.alpha_reach), kPaper},
      {"circle.alpha_deviation", "mu_r", "deg", 0, 180, LCS_REAL(circle.alpha_deviation), kPaper},
      {"circle.alpha_stretch", "", "", 0, 10, LCS_REAL(circle.alpha_stretch), kPaper},
      {"circle.alpha_branches", "", "", 1, 100, LCS_FIELD(int, circle.alpha_branches), kPaper},
      {"circle.rebel_reach", "", "", 0, 10, LCS_REAL(circle.rebel_reach), kPaper},
      {"circle.epsilon_beta_n", "eps_beta,n", "deg", 0, 180, LCS_REAL(circle.epsilon_beta_n),
       kPaper},
      {"circle.epsilon_beta_r", "eps_beta,r", "deg", 0, 180, LCS_REAL(circle.epsilon_beta_r),
       kPaper},
      {"circle.epsilon_v_n", "eps_v,n", "V_v", 0, 1000, LCS_REAL(circle.epsilon_v_n), kPaper},
      {"circle.epsilon_v_r", "eps_v,r", "V_v", 0, 1000, LCS_REAL(circle.epsilon_v_r), kPaper},
      {"circle.epsilon_v", "eps_v", "V_v", 0, 1000, LCS_REAL(circle.epsilon_v), kPaper},
      {"circle.rho_c", "rho_c", "%", 0, 100, LCS_REAL(circle.rho_c), kPaper},
      {"circle.reach_n", "", "px", 0.1, 10000, LCS_REAL(circle.reach_n), kPaper},
      {"circle.reach_r", "", "px", 0.1, 10000, LCS_REAL(circle.reach_r), kPaper},
      {"square.Tr_c", "Tr^s_c", "", 0, 1000, LCS_FIELD(int, square.trust.critical), kCouples},
      {"square.Tr_s", "Tr^s_s", "", 0, 1000, LCS_FIELD(int, square.trust.standard), kCouples},
      {"square.Tr_m", "Tr^s_m", "", 0, 1000, LCS_FIELD(int, square.trust.maximum), kCouples},
      {"square.delta_beta_1", "delta_beta,1", "deg", 0, 180, LCS_REAL(square.delta_beta_1),
       kCouples},
      {"square.delta_beta_2", "delta_beta,2", "deg", 0, 180, LCS_REAL(square.delta_beta_2),
       kCouples},
      {"square.epsilon_beta_1", "eps_beta,1", "deg", 0, 180, LCS_REAL(square.epsilon_beta_1),
       kCouples},
      {"square.epsilon_beta_2", "eps_beta,2", "deg", 0, 180, LCS_REAL(square.epsilon_beta_2),
       kCouples},
      {"square.epsilon_beta", "eps_beta", "deg", 0, 180, LCS_REAL(square.epsilon_beta), kCouples},
      {"square.epsilon_beta_s", "eps_beta,s", "deg", 0, 180, LCS_REAL(square.epsilon_beta_s),
       kCouples},
      {"square.epsilon_v", "eps_v", "V_v", 0, 1000, LCS_REAL(square.epsilon_v), kCouples},
      {"square.epsilon_v_s", "eps_v,s", "V_v", 0, 1000, LCS_REAL(square.epsilon_v_s), kCouples},
      {"square.rho_c", "rho_c", "%", 0, 100, LCS_REAL(square.rho_c), kCouples},
      {"square.d_t", "d_t", "diagonals", 0, 10, LCS_REAL(square.d_t), kCouples},
      {"square.mix_kinds", "", "", 0, 0, LCS_FIELD(bool, square.mix_kinds), kCouples},
  };
}

}  // namespace lcs
