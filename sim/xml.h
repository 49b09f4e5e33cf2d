/// \file
/// MJCF as a tree: reading files, resolving what they name, and merging documents.
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

/// Reads an MJCF file with its `<include>`s in place, and every file that it names as an absolute
/// path (so `meshdir` and `texturedir` are done with). \param where is named in the error if the
/// file itself cannot be opened. Each element then knows where it was written, and so do its
/// copies.
/// \throws scenario::Error with the MJCF file and line: XML that does not parse, a missing file.
Document load(const std::filesystem::path& file, const scenario::Source& where);

/// Puts `prefix` before every name in a document, and before every use of one.
void prefix_names(Element& root, const std::string& prefix);

/// Removes all elements of a kind, wherever they are below the root.
void remove_all(Element& root, const char* kind);

/// Appends copies of all children.
void append_children(Element& to, const Element& from);

/// The first child of that kind; made where there is none.
Element& section(Element& root, const char* kind);

/// Calls `visit` for an element and all below it.
void for_each(Element& element, const std::function<void(Element&)>& visit);

/// Whether it is, as in `<geom>`, of that kind.
bool is_kind(const Element& element, std::string_view kind);

/// The child with that name attribute, or nullptr.
Element* child_named(Element& parent, const char* kind, const std::string& name);

std::string attribute(const Element& element, const char* name);  ///< "" where absent

/// Where an element, or the nearest one about it that knows, was written.
scenario::Source source_of(const Element& element);
void set_source(Element& element, const scenario::Source& source);

/// `<geom name="wall">`: what a message calls an element.
std::string tag(const Element& element);

/// A document as text, and where each line of it was written.
class Printed {
 public:
  Printed() = default;
  /// Takes from the document what its elements know of their sources.
  /// \throws scenario::Error if it is nested deeper than can be read again.
  explicit Printed(tinyxml2::XMLDocument& document);

  struct Origin {
    scenario::Source source;
    std::string tag;      ///< as `tag` has it
    std::string kind;     ///< the element's, as in "geom"
    std::string name;     ///< its name attribute, or ""
    std::string section;  ///< the kind of what it is in, or ""
  };
  const std::string& text() const { return text_; }
  /// Where the element on a line of the text comes from; nullptr where there is none.
  const Origin* at_line(int line) const;
  /// The first with that name of that kind, or of any if `kind` is empty; nullptr if there is none.
  const Origin* named(std::string_view kind, std::string_view name) const;
  /// The one of that index, from 0, among all in sections of that kind; nullptr if there is none.
  const Origin* within(std::string_view section, int index) const;
  /// The last of that kind, which overrules the others; nullptr if there is none.
  const Origin* last(std::string_view kind) const;

 private:
  std::string text_;
  std::map<int, Origin> origins_;  ///< by line
};

}  // namespace lcs::sim::xml
