#include "sim/scene/xml.h"

#include <fmt/format.h>
#include <strings.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "scenarios/input/input_file.h"

namespace lcs::sim::xml {
namespace {

/// The size limit is of MJCF text with mesh vertices.
constexpr input::FileKind kModelFile{64 * input::kMebibyte, "give the path of an MJCF file"};

using namespace std::string_literals;
using tinyxml2::XMLDocument;
using tinyxml2::XMLNode;

// Contains "LINE FILE" of an element's source; no user's attribute has this name.
constexpr const char* kSource = "lcs:source";

Document parse(const fs::path& file, const input::Source& where) {
  auto document = std::make_unique<XMLDocument>();
  const std::string text = input::InputFile(file, kModelFile, where).bytes();
  if (const std::size_t nul = text.find('\0'); nul != text.npos) {  // tinyxml2 would stop there
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(nul);
    throw input::Error({file.string(), static_cast<int>(std::count(text.begin(), end, '\n')) + 1},
                       "there is a NUL byte; is this a text file? remove it");
  }
  const tinyxml2::XMLError status = document->Parse(text.data(), text.size());
  if (status != tinyxml2::XML_SUCCESS) {
    throw input::Error({file.string(), document->ErrorLineNum()},
                       std::string("is not well-formed XML (") +
                           XMLDocument::ErrorIDToName(status) + "); correct the file");
  }
  const Element* root = document->RootElement();
  const std::string_view kind = root ? root->Name() : "";
  if (kind != "mujoco" && kind != "mujocoinclude" && kind != "robot") {
    throw input::Error({file.string(), root ? root->GetLineNum() : 1},
                       "is not MJCF: its root element must be <mujoco> (or <robot>, in URDF)");
  }
  for_each(*document->RootElement(), [&](Element& e) {
    e.SetAttribute(kSource, fmt::format("{} {}", e.GetLineNum(), file.string()).c_str());
  });
  return document;
}

/// Makes the names of files absolute paths, of the first place of these where there is a file: from
/// the folder of the main file on, and from that of the included file that names it. MuJoCo looks
/// for models without the folders of <compiler>, and for other files by them or, as for skins,
/// without.
void make_absolute(Element& root, const fs::path& main_file) {
  fs::path meshes, textures;
  bool is_stripped = false;
  for_each(root, [&](Element& c) {
    if (c.Name() != "compiler"s) return;
    if (const char* both = c.Attribute("assetdir")) meshes = textures = both;
    if (const char* dir = c.Attribute("meshdir")) meshes = dir;
    if (const char* dir = c.Attribute("texturedir")) textures = dir;
    if (const char* strip = c.Attribute("strippath")) is_stripped = strip == std::string("true");
    for (const char* key : {"assetdir", "meshdir", "texturedir", "strippath"})
      c.DeleteAttribute(key);
  });
  for_each(root, [&](Element& e) {
    const fs::path by = e.Name() == "model"s     ? fs::path()
                        : e.Name() == "texture"s ? textures
                                                 : meshes;
    const fs::path base = fs::absolute(main_file).parent_path();
    const fs::path own = fs::absolute(source_of(e).file).parent_path();
    for (const auto* a = e.FirstAttribute(); a; a = a->Next()) {
      if (!std::string_view(a->Name()).starts_with("file")) continue;
      const fs::path value = a->Value(), name = is_stripped ? value.filename() : value;
      const std::array<fs::path, 4> places{base / by / name, own / by / name, base / name,
                                           own / name};
      const auto found = std::ranges::find_if(places, [](const fs::path& p) {
        std::error_code error;
        return fs::exists(p, error) || error;
      });
      if (found == places.end()) {
        const bool is_package = value.string().starts_with("package:");
        throw input::Error(
            source_of(e), "file '{}' is missing; {}", places.front().lexically_normal().string(),
            is_package ? "MuJoCo knows no packages: name it from this file's folder on"
                       : "put it there or correct the name");
      }
      e.SetAttribute(a->Name(), found->lexically_normal().c_str());
    }
  });
}

/// \param left number of files that may still be included.
void expand_includes(Element& parent, const fs::path& main_file, const fs::path& file, int depth,
                     int& left) {
  constexpr int kDeepest = 16;  // rejects a file that includes itself
  for (Element* e = parent.FirstChildElement(); e;) {
    Element* next = e->NextSiblingElement();
    // case-insensitive like MuJoCo, which would expand <Include> later
    if (::strcasecmp(e->Name(), "include") != 0) {
      expand_includes(*e, main_file, file, depth, left);
      e = next;
      continue;
    }
    const input::Source here{file.string(), e->GetLineNum()};
    if (depth >= kDeepest) throw input::Error(here, "includes are nested too deep");
    if (left-- == 0) throw input::Error(here, "more files are included than a scene has");
    // relative to the main file or else to this one, as in MuJoCo
    fs::path path = main_file.parent_path() / attribute(*e, "file");
    if (!fs::exists(path)) path = file.parent_path() / attribute(*e, "file");
    const Document included = parse(path, here);
    expand_includes(*included->RootElement(), main_file, path, depth + 1, left);
    XMLNode* after = e;
    for (const XMLNode* n = included->RootElement()->FirstChild(); n; n = n->NextSibling()) {
      after = parent.InsertAfterChild(after, n->DeepClone(parent.GetDocument()));
    }
    parent.DeleteChild(e);
    e = next;
  }
}

}  // namespace

Document load(const fs::path& file, const input::Source& where) {
  Document document = parse(file, where);
  int left = 1000;  // bounds files that include each other twice
  expand_includes(*document->RootElement(), file, file, 0, left);
  make_absolute(*document->RootElement(), file);
  return document;
}

void for_each(Element& element, const std::function<void(Element&)>& visit) {
  visit(element);
  for (Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement())
    for_each(*e, visit);
}

std::string attribute(const Element& element, const char* name) {
  const char* value = element.Attribute(name);
  return value ? value : "";
}

input::Source source_of(const Element& element) {
  for (const XMLNode* n = &element; n && n->ToElement(); n = n->Parent()) {
    const std::string text = attribute(*n->ToElement(), kSource);
    const std::size_t space = text.find(' ');
    if (space == std::string::npos) continue;
    input::Source source{text.substr(space + 1), 0};
    std::from_chars(text.data(), text.data() + space, source.line);
    return source;
  }
  return {};
}

std::vector<input::Source> take_sources(Element& root) {
  std::vector<input::Source> sources;
  for_each(root, [&](Element& e) { sources.push_back(source_of(e)); });
  for_each(root, [](Element& e) { e.DeleteAttribute(kSource); });
  return sources;
}

std::string tag(const Element& element) {
  const std::string name = attribute(element, "name");
  return name.empty() ? fmt::format("<{}>", element.Name())
                      : fmt::format("<{} name=\"{}\">", element.Name(), name);
}

}  // namespace lcs::sim::xml
