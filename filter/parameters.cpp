#include "filter/parameters.h"

#include "filter/parameter_table.h"

namespace lcs {
namespace {

std::vector<ParameterEntry> entries_of(Parameters& p) {
  std::vector<ParameterEntry> all = entries_of(p.field);
  const std::vector<ParameterEntry> own = {
      {"field.ground", "", "", 0, 0, &p.ground},
      {"line.max_corners", "", "", 1, 10000000, &p.line.max_corners},
      {"circle.Tr_c", "Tr^c_c", "", 0, 1000, &p.circle.trust.critical},
      {"circle.Tr_s", "Tr^c_s", "", 0, 1000, &p.circle.trust.standard},
      {"circle.Tr_m", "Tr^c_m", "", 0, 1000, &p.circle.trust.maximum},
      {"hypotheses.noise", "", "px", 0.01, 100, &p.edge.noise_px},
      {"hypotheses.prior", "", "", 1e-06, 0.5, &p.edge.prior},
      {"hypotheses.newcomer", "", "", 0, 10, &p.edge.newcomer},
      {"hypotheses.turnover", "", "1/s", 0.001, 1000, &p.edge.turnover_ps},
      {"hypotheses.ego_share", "", "", 0, 10, &p.edge.ego_share},
      {"hypotheses.max_speed", "", "px/s", 1, 100000, &p.edge.max_speed_pxps},
      {"hypotheses.coast", "", "", 0, 100, &p.edge.coast},
      {"hypotheses.bits_even", "", "", 0, 256, &p.edge.bits_even},
      {"hypotheses.bits_weight", "", "", 0, 100, &p.edge.bits_weight},
      {"hypotheses.kind_turnover", "", "1/s", 0, 1000, &p.edge.kind_turnover_ps},
      {"hypotheses.crossings", "", "", 0, 1000, &p.edge.crossings},
      {"hypotheses.slide", "", "", 0, 10, &p.edge.slide},
      {"hypotheses.step_share", "", "", 0, 10, &p.edge.step_share},
      {"hypotheses.neighbours", "", "", 0, 1000, &p.edge.neighbours},
      {"hypotheses.coupling", "", "", 0, 1000, &p.edge.coupling},
      {"hypotheses.neighbour_reach", "", "px", 1, 1000, &p.edge.neighbour_reach_px},
      {"circle.min_members", "", "", 1, 1000, &p.circle.min_members},
      {"circle.gap", "", "m", 0.001, 1000, &p.circle.gap_m},
      {"circle.upward", "", "", 0.01, 100, &p.circle.upward},
      {"circle.roughness", "", "", 0, 10, &p.circle.roughness},
      {"circle.min_width", "", "px", 0, 1000, &p.circle.min_width},
      {"comers.hanging", "", "", 1e-09, 1, &p.comers.hanging},
      {"comers.count_power", "", "", 0, 2, &p.comers.count_power},
      {"comers.memory", "", "", 1, 1000, &p.comers.memory},
      {"square.max_size", "", "m", 0, 10000, &p.square.max_size},
  };
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

}  // namespace

void set(Parameters& parameters, std::string_view key, std::string_view value) {
  set(entries_of(parameters), key, value);
}

void validate(const Parameters& parameters) {
  Parameters copy = parameters;  // entries hold pointers to non-const
  validate(entries_of(copy));
  validate(copy.circle.trust, "circle");
}

std::vector<ParameterInfo> describe(const Parameters& parameters) {
  Parameters copy = parameters;
  return describe(entries_of(copy));
}

}  // namespace lcs
