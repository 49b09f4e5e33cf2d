/// \file
/// The text of `kinematics.js`, which lays out a study on its page.
#pragma once

#include <string_view>

namespace lcs::kinematics {

extern const std::string_view kKinematicsJs;

}  // namespace lcs::kinematics
