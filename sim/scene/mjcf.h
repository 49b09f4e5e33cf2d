/// \file
/// Semantics of MJCF: numbers, rotations, defaults, and all values whose meaning depends on the
/// document that they are merged into.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/scene/xml.h"

namespace lcs::sim::mjcf {

/// The leading numbers of an attribute's text; empty for an empty text.
std::vector<double> numbers(const std::string& text);
void set_numbers(xml::Element& e, const char* key, const std::vector<double>& values);

/// The value of an attribute: the element's own, or else its class's (its own class, or the
/// `childclass` of the nearest enclosing body). "" if neither has it.
std::string effective(const xml::Element& e, const char* key);

/// Rotation of an element relative to its parent, from its `quat`. Call `make_standalone` first: it
/// converts all other rotation attributes into `quat`.
Eigen::Matrix3d rotation(const xml::Element& e);

/// Rewrites a document so that merging it does not change its meaning. Each section exists once,
/// rotations are quaternions, elements without a class get one with MuJoCo's defaults, assets with
/// only a file get a name, and joint ranges are in the target document's unit of angles.
/// \param into the target document.
void make_standalone(xml::Element& root, const xml::Element& into);

}  // namespace lcs::sim::mjcf
