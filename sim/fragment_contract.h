/// \file
/// What a rover's or actor's file must have, whoever wrote it; `scenes/README.md` tells it to
/// people.
#pragma once

#include "sim/xml.h"

namespace lcs::sim {

/// Both are given the whole file, made standalone (`sim/mjcf.h`), before its names get a prefix.
/// \throws scenario::Error at the file's line: what is missing or wrong, and what to do.
///@{
void check_actor(xml::Element& root);
void check_rover(xml::Element& root);
///@}

/// Of a rover that has kept the contract: it has wheels to be driven by, else it is holonomic.
bool is_wheeled(xml::Element& root);

}  // namespace lcs::sim
