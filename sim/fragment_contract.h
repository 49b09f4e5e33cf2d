/// \file
/// Checks that the file of a rover or an actor has what it must have; `scenes/README.md` lists it.
#pragma once

#include "sim/xml.h"

namespace lcs::sim {

/// Both are given the whole file, made standalone (`sim/mjcf.h`), before its names get a prefix.
/// \throws scenario::Error at the file's line: what is missing or wrong, and what to do.
///@{
void check_actor(xml::Element& root);
void check_rover(xml::Element& root);
///@}

/// Whether a rover that passed the check drives on wheels; otherwise it is holonomic.
bool is_wheeled(xml::Element& root);

}  // namespace lcs::sim
