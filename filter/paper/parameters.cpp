#include "filter/paper/parameters.h"

#include <stdexcept>

#include "filter/parameter_table.h"

namespace lcs::paper {
namespace {

std::vector<ParameterEntry> entries_of(PaperParameters& p) {
  std::vector<ParameterEntry> all = lcs::entries_of(p.field);
  const std::vector<ParameterEntry> own = {
      {"line.ignore", "psi", "", 0, 0, &p.ignore},
      {"line.max_corners", "", "", 1, 10000000, &p.line.max_corners},
      {"circle.Tr_c", "Tr^c_c", "", 0, 1000, &p.circle.trust.critical},
      {"circle.Tr_s", "Tr^c_s", "", 0, 1000, &p.circle.trust.standard},
      {"circle.Tr_m", "Tr^c_m", "", 0, 1000, &p.circle.trust.maximum},
      {"circle.min_members", "", "", 1, 1000, &p.circle.min_members},
      {"circle.delta_v", "delta_v", "deg", 0, 90, &p.edge.delta_v},
      {"circle.mu_0", "mu_0", "px", 0.1, 1000, &p.edge.mu_0},
      {"circle.mu_min", "", "px", 0.1, 1000, &p.edge.mu_min},
      {"circle.mu_max", "", "px", 0.1, 1000, &p.edge.mu_max},
      {"circle.corner_noise", "", "px", 0, 100, &p.edge.corner_noise},
      {"circle.trust_bonus", "", "px", 0, 100, &p.edge.trust_bonus},
      {"circle.alpha_reach", "", "px", 0, 1000, &p.edge.alpha_reach},
      {"circle.alpha_deviation", "mu_r", "deg", 0, 180, &p.edge.alpha_deviation},
      {"circle.alpha_stretch", "", "", 0, 10, &p.edge.alpha_stretch},
      {"circle.alpha_branches", "", "", 1, 100, &p.edge.alpha_branches},
      {"circle.rebel_reach", "", "", 0, 10, &p.edge.rebel_reach},
      {"circle.epsilon_beta_n", "eps_beta,n", "deg", 0, 180, &p.circle.epsilon_beta_n},
      {"circle.epsilon_beta_r", "eps_beta,r", "deg", 0, 180, &p.circle.epsilon_beta_r},
      {"circle.epsilon_v_n", "eps_v,n", "V_v", 0, 1000, &p.circle.epsilon_v_n},
      {"circle.epsilon_v_r", "eps_v,r", "V_v", 0, 1000, &p.circle.epsilon_v_r},
      {"circle.epsilon_v", "eps_v", "V_v", 0, 1000, &p.circle.epsilon_v},
      {"circle.rho_c", "rho_c", "%", 0, 100, &p.circle.rho_c},
      {"circle.reach_n", "", "px", 0.1, 10000, &p.circle.reach_n},
      {"circle.reach_r", "", "px", 0.1, 10000, &p.circle.reach_r},
      {"square.Tr_c", "Tr^s_c", "", 0, 1000, &p.square.trust.critical},
      {"square.Tr_s", "Tr^s_s", "", 0, 1000, &p.square.trust.standard},
      {"square.Tr_m", "Tr^s_m", "", 0, 1000, &p.square.trust.maximum},
      {"square.delta_beta_1", "delta_beta,1", "deg", 0, 180, &p.square.delta_beta_1},
      {"square.delta_beta_2", "delta_beta,2", "deg", 0, 180, &p.square.delta_beta_2},
      {"square.epsilon_beta_1", "eps_beta,1", "deg", 0, 180, &p.square.epsilon_beta_1},
      {"square.epsilon_beta_2", "eps_beta,2", "deg", 0, 180, &p.square.epsilon_beta_2},
      {"square.epsilon_beta", "eps_beta", "deg", 0, 180, &p.square.epsilon_beta},
      {"square.epsilon_beta_s", "eps_beta,s", "deg", 0, 180, &p.square.epsilon_beta_s},
      {"square.epsilon_v", "eps_v", "V_v", 0, 1000, &p.square.epsilon_v},
      {"square.epsilon_v_s", "eps_v,s", "V_v", 0, 1000, &p.square.epsilon_v_s},
      {"square.rho_c", "rho_c", "%", 0, 100, &p.square.rho_c},
      {"square.d_t", "d_t", "diagonals", 0, 10, &p.square.d_t},
      {"square.mix_kinds", "", "", 0, 0, &p.square.mix_kinds},
  };
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

}  // namespace

PaperParameters cars() {
  PaperParameters p;
  p.circle.trust = {1, 4, 7};
  p.square.trust = {2, 5, 8};
  return p;
}

void set(PaperParameters& parameters, std::string_view key, std::string_view value) {
  lcs::set(entries_of(parameters), key, value);
}

void validate(const PaperParameters& parameters) {
  PaperParameters copy = parameters;  // entries hold pointers to non-const
  lcs::validate(entries_of(copy));
  lcs::validate(copy.circle.trust, "circle");
  lcs::validate(copy.square.trust, "square");
  if (copy.edge.mu_min > copy.edge.mu_max) {
    throw std::invalid_argument("'circle.mu_min' is above 'circle.mu_max'");
  }
}

std::vector<ParameterInfo> describe(const PaperParameters& parameters) {
  PaperParameters copy = parameters;
  return lcs::describe(entries_of(copy));
}

}  // namespace lcs::paper
