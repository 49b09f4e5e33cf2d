/// \file
/// MJCF as a tree: reading files, resolving what they name, and merging documents.
#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "scenarios/scenario.h"

namespace lcs::sim::xml {

using Document = std::unique_ptr<tinyxml2::XMLDocument>;
using Element = tinyxml2::XMLElement;

/// Reads an MJCF file with its `<include>`s in place, and every file that it names as an absolute
/// path (so `meshdir` and `texturedir` are done with). \param where is to blame where the file
/// itself cannot be opened. \throws scenario::Error with the MJCF file and line: XML that does not
/// parse, a missing file.
Document load(const std::filesystem::path& file, const scenario::Source& where);

/// Puts `prefix` before every name in a document, and before every use of one.
void prefix_names(Element& root, const std::string& prefix);

/// Appends copies of all children.
void append_children(Element& to, const Element& from);

/// The first child of that kind; made where there is none.
Element& section(Element& root, const char* kind);

/// Calls `visit` for an element and all below it.
void for_each(Element& element, const std::function<void(Element&)>& visit);

/// The child with that name attribute, or nullptr.
Element* child_named(Element& parent, const char* kind, const std::string& name);

std::string attribute(const Element& element, const char* name);  ///< "" where absent

std::string print(const tinyxml2::XMLDocument& document);

}  // namespace lcs::sim::xml
