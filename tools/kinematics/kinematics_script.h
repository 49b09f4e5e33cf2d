/// \file
/// `kinematics.js` as it lies beside this file: what lays out a study's data.
#pragma once

#include <string_view>

namespace lcs::kinematics {

extern const std::string_view kKinematicsJs;

}  // namespace lcs::kinematics
