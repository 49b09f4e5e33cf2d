/// \file
/// What MJCF means beyond its text: numbers, rotations, defaults, and whatever a file relies on
/// that another one which takes it in may say otherwise.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/xml.h"

namespace lcs::sim::mjcf {

/// As far as they are numbers; empty where there is no such attribute.
std::vector<double> numbers(const std::string& text);
void set_numbers(xml::Element& e, const char* key, const std::vector<double>& values);

/// The attribute of an element, or what the class gives it that it is of: its own, else the
/// `childclass` of the nearest body about it. "" where nothing says.
std::string effective(const xml::Element& e, const char* key);

/// Of an element in what it is in, as its `quat` says: `make_standalone` has made all others one.
Eigen::Matrix3d rotation(const xml::Element& e);

/// Makes a document mean the same in every other, and simpler: each section is there once,
/// rotations are quaternions, what it has no class for is of a class of its own (which begins with
/// MuJoCo's defaults), assets that are called by their files say so, and the ranges of its joints
/// are in the unit of angles that the other one has. \param into the document that is to take it
/// in.
void make_standalone(xml::Element& root, const xml::Element& into);

}  // namespace lcs::sim::mjcf
