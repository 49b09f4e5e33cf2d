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

inline auto each_preset() {
  return ::testing::ValuesIn(preset_names());
}

inline std::string name_of_preset(const ::testing::TestParamInfo<std::string>& info) {
  return info.param;
}

}  // namespace lcs::testing
