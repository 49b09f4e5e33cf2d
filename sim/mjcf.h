/// \file
/// What MJCF means beyond its text: numbers, rotations, defaults, and whatever a file relies on
/// that another one which takes it in may say otherwise.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/xml.h"

namespace lcs::sim::mjcf {

/// The numbers that an attribute's text begins with; none where it is empty.
std::vector<double> numbers(const std::string& text);
void set_numbers(xml::Element& e, const char* key, const std::vector<double>& values);

/// An attribute of an element, or else what the element's class says: its own class, or the
/// `childclass` of the nearest body that it lies in. "" where nothing says.
std::string effective(const xml::Element& e, const char* key);

/// Rotation of an element against its parent, by its `quat`. Call `make_standalone` first, which
/// turns all other ways to write a rotation into that one.
Eigen::Matrix3d rotation(const xml::Element& e);

/// Rewrites a document so that it means the same when it is merged into another one: each section
/// is there once, rotations are quaternions, elements without a class get one with MuJoCo's
/// defaults, assets that are known by their files get names, and joint ranges are in the other
/// document's unit of angles. \param into the document that it is to be merged into.
void make_standalone(xml::Element& root, const xml::Element& into);

}  // namespace lcs::sim::mjcf
