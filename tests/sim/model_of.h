/// \file
/// A model of MJCF text, for tests.
#pragma once

#include <array>
#include <string>

#include "sim/scene/model.h"
#include "sim/scene/spec.h"

namespace lcs::sim::test {

inline Model model_of(const std::string& mjcf) {
  std::array<char, 1000> said{};
  const Spec spec(mj_parseXMLString(mjcf.c_str(), nullptr, said.data(), said.size()));
  if (!spec) throw MujocoError(said.data());
  return Model(*spec);
}

}  // namespace lcs::sim::test
