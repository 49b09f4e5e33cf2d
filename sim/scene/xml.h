/// \file
/// MJCF as a tree: reading files, resolving file names, and merging documents.
#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/scenario.h"

namespace lcs::sim::xml {

using Document = std::unique_ptr<tinyxml2::XMLDocument>;
using Element = tinyxml2::XMLElement;

/// Reads an MJCF file. Expands its `<include>`s and makes all file names absolute paths (so that
/// `meshdir` and `texturedir` are no longer needed). Each element and its copies keep their source
/// file and line. \param where cited in the error if the file itself cannot be opened.
/// \throws input::Error with the MJCF file and line: malformed XML, a missing file.
Document load(const std::filesystem::path& file, const input::Source& where);

/// Prefixes every name in a document, and every reference to a name.
void prefix_names(Element& root, const std::string& prefix);

/// Removes all elements of a kind below the root, at any depth.
void remove_all(Element& root, const char* kind);

/// Appends copies of all children.
void append_children(Element& to, const Element& from);

/// The first child of a kind; added if missing.
Element& section(Element& root, const char* kind);

/// Calls `visit` for an element and all its descendants.
void for_each(Element& element, const std::function<void(Element&)>& visit);

/// Whether an element has that kind (tag name), for example "geom".
bool is_kind(const Element& element, std::string_view kind);

/// The child with that kind and name attribute, or nullptr.
Element* child_named(Element& parent, const char* kind, const std::string& name);

std::string attribute(const Element& element, const char* name);  ///< "" where absent

/// Source of an element, or of its nearest enclosing element with a source.
input::Source source_of(const Element& element);
void set_source(Element& element, const input::Source& source);

/// How a message cites an element: `<geom name="wall">`.
std::string tag(const Element& element);

/// A document as text, with the source of each line.
class Printed {
 public:
  Printed() = default;
  /// Takes the sources from the document's elements.
  /// \throws input::Error if the document is nested too deep to be parsed again.
  explicit Printed(tinyxml2::XMLDocument& document);

  struct Origin {
    input::Source source;
    std::string tag;      ///< as returned by `tag`
    std::string kind;     ///< the element's kind, for example "geom"
    std::string name;     ///< its name attribute, or ""
    std::string section;  ///< the parent element's kind, or ""
  };
  const std::string& text() const { return text_; }
  /// Origin of the element on a line of the text; nullptr if there is no element.
  const Origin* at_line(int line) const;
  /// The first element of that name and kind (any kind if `kind` is empty), or nullptr.
  const Origin* named(std::string_view kind, std::string_view name) const;
  /// The element of that index, from 0, among all in sections of that kind, or nullptr.
  const Origin* within(std::string_view section, int index) const;
  /// The last element of that kind, which overrides the others, or nullptr.
  const Origin* last(std::string_view kind) const;

 private:
  std::string text_;
  std::map<int, Origin> origins_;  ///< by line
};

}  // namespace lcs::sim::xml
