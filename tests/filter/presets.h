/// Tests that hold for every preset.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "filter/paper/any_filter.h"

namespace lcs::testing {

/// The parameter is a preset's name.
struct OfEachPreset : ::testing::TestWithParam<std::string> {
  AnyParameters parameters() const { return preset(GetParam()); }
};

/// Ranks of the trust of edges and circles.
inline TrustRanks circle_trust(const AnyParameters& parameters) {
  return std::visit([](const auto& p) { return p.circle.trust; }, parameters);
}
/// Ranks of the trust of squares: in the default each has that of its circle.
inline TrustRanks square_trust(const AnyParameters& parameters) {
  const auto* paper = std::get_if<paper::PaperParameters>(&parameters);
  return paper ? paper->square.trust : circle_trust(parameters);
}

inline auto each_preset() {
  return ::testing::ValuesIn(preset_names());
}

inline std::string name_of_preset(const ::testing::TestParamInfo<std::string>& info) {
  return info.param;
}

}  // namespace lcs::testing
