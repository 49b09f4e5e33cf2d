/// \file
/// Checks that a rover's or actor's file has all required elements; `scenes/README.md` lists them.
#pragma once

#include "sim/scene/xml.h"

namespace lcs::sim {

/// Both take the root of the file, after `mjcf::make_standalone`, before names get a prefix.
/// \throws input::Error at the file's line: the missing or wrong element, and the remedy.
///@{
void check_actor(xml::Element& root);
void check_rover(xml::Element& root);
///@}

/// Whether a rover that passed `check_rover` is wheeled; otherwise it is holonomic.
bool is_wheeled(xml::Element& root);

}  // namespace lcs::sim
