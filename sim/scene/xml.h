/// \file
/// MJCF as a tree, with all its files in one document, and the source of each element.
#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/scenario.h"

namespace lcs::sim::xml {

using Document = std::unique_ptr<tinyxml2::XMLDocument>;
using Element = tinyxml2::XMLElement;

/// Reads an MJCF or URDF file. Expands its `<include>`s and makes all file names absolute paths, of
/// the places where MuJoCo finds them. Each element and its copies keep their source file and line.
/// \param where cited in the error if the file itself cannot be opened. \throws input::Error with
/// the MJCF file and line: malformed XML, a missing file.
Document load(const std::filesystem::path& file, const input::Source& where);

/// Calls `visit` for an element and all its descendants.
void for_each(Element& element, const std::function<void(Element&)>& visit);

std::string attribute(const Element& element, const char* name);  ///< "" where absent

/// Source of an element, or of its nearest enclosing element with a source.
input::Source source_of(const Element& element);

/// Removes the sources, which MuJoCo would not understand, and returns them in document order.
std::vector<input::Source> take_sources(Element& root);

/// How a message cites an element: `<geom name="wall">`.
std::string tag(const Element& element);

}  // namespace lcs::sim::xml
