/// \file
/// The meaning of MJCF beyond its text: numbers, rotations, defaults, and what else may mean
/// something different in another file that a document is merged into.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/xml.h"

namespace lcs::sim::mjcf {

/// The numbers that an attribute's text begins with; none where it is empty.
std::vector<double> numbers(const std::string& text);
void set_numbers(xml::Element& e, const char* key, const std::vector<double>& values);

/// The value of an attribute: the element's own, or else that of its class (its own class, or the
/// `childclass` of the nearest body around it). "" where there is neither.
std::string effective(const xml::Element& e, const char* key);

/// Rotation of an element relative to its parent, from its `quat`. Call `make_standalone` first,
/// which turns all other ways to write a rotation into that one.
Eigen::Matrix3d rotation(const xml::Element& e);

/// Rewrites a document so that it means the same when it is merged into another one: each section
/// is there once, rotations are quaternions, elements without a class get one with MuJoCo's
/// defaults, assets that had only a file get a name, and joint ranges are in the other document's
/// unit of angles. \param into the document that it is to be merged into.
void make_standalone(xml::Element& root, const xml::Element& into);

}  // namespace lcs::sim::mjcf
