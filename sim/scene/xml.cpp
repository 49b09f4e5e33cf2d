#include "sim/scene/xml.h"

#include <fmt/format.h>
#include <strings.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "tools/input/input_file.h"

namespace lcs::sim::xml {
namespace {

/// Size limits of MJCF text with mesh vertices, and of assets: images, meshes, height fields.
constexpr input::FileKind kModelFile{64 * input::kMebibyte, "give the path of an MJCF file"};
constexpr input::FileKind kAssetFile{input::kGibibyte, "give a file of the kind that it is"};

namespace fs = std::filesystem;
using tinyxml2::XMLDocument;
using tinyxml2::XMLNode;

// Attributes that contain a file path.
constexpr std::array<const char*, 7> kFiles = {"file",     "fileright", "fileleft", "fileup",
                                               "filedown", "filefront", "fileback"};

// Attributes that contain the name of another element.
constexpr std::array kReferences = {
    "texture", "material",  "class",      "childclass", "mesh",         "hfield",
    "joint",   "site",      "body",       "body1",      "body2",        "geom1",
    "geom2",   "target",    "objname",    "refname",    "tendon",       "actuator",
    "geom",    "cranksite", "slidersite", "refsite",    "jointinparent"};

// Contains "LINE FILE" of an element's source; no user's attribute has this name.
constexpr const char* kSource = "lcs:source";

[[noreturn]] void fail(const fs::path& file, int line, const std::string& message) {
  throw input::Error({file.string(), line}, message);
}

Document parse(const fs::path& file, const input::Source& where) {
  auto document = std::make_unique<XMLDocument>();
  const std::string text = input::InputFile(file, kModelFile, where).bytes();
  if (const std::size_t nul = text.find('\0'); nul != text.npos) {  // tinyxml2 would stop there
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(nul);
    fail(file, static_cast<int>(std::count(text.begin(), end, '\n')) + 1,
         "there is a NUL byte; is this a text file? remove it");
  }
  const tinyxml2::XMLError status = document->Parse(text.data(), text.size());
  if (status != tinyxml2::XML_SUCCESS) {
    fail(file, document->ErrorLineNum(),
         std::string("is not well-formed XML (") + XMLDocument::ErrorIDToName(status) +
             "); correct the file");
  }
  const Element* root = document->RootElement();
  const std::string_view kind = root ? root->Name() : "";
  if (kind != "mujoco" && kind != "mujocoinclude") {
    fail(file, root ? root->GetLineNum() : 1, "is not MJCF: its root element must be <mujoco>");
  }
  for_each(*document->RootElement(), [&](Element& e) {
    set_source(e, {file.string(), e.GetLineNum()});
  });
  return document;
}

/// The folders that a document's file names are relative to.
struct Folders {
  fs::path base, meshes, textures;
  bool strip = false;  ///< drop the folders from file names
};

Folders folders_of(const Element& root, const fs::path& file) {
  Folders folders{fs::absolute(file).parent_path(), "", ""};
  for (const Element* c = root.FirstChildElement("compiler"); c;
       c = c->NextSiblingElement("compiler")) {
    if (const char* both = c->Attribute("assetdir")) folders.meshes = folders.textures = both;
    if (const char* dir = c->Attribute("meshdir")) folders.meshes = dir;
    if (const char* dir = c->Attribute("texturedir")) folders.textures = dir;
    if (const char* strip = c->Attribute("strippath")) folders.strip = strip == std::string("true");
  }
  return folders;
}

void make_absolute(Element& root, const fs::path& file) {
  const Folders folders = folders_of(root, file);
  const auto resolve = [&](Element& e) {
    const bool picture = is_kind(e, "texture");
    for (const char* key : kFiles) {
      const char* value = e.Attribute(key);
      if (!value) continue;
      const fs::path name = folders.strip ? fs::path(value).filename() : fs::path(value);
      const fs::path path = folders.base / (picture ? folders.textures : folders.meshes) / name;
      const std::string normal = path.lexically_normal().string();
      std::error_code error;
      if (!fs::exists(path, error) && !error) {
        throw input::Error(source_of(e),
                           "file '" + normal + "' is missing; put it there or correct the name");
      }
      // MuJoCo opens the file itself, and would block on a pipe.
      const input::InputFile refused_if_unfit(normal, kAssetFile, source_of(e));
      e.SetAttribute(key, normal.c_str());
    }
  };
  for (Element* s = root.FirstChildElement("asset"); s; s = s->NextSiblingElement("asset")) {
    for_each(*s, resolve);
  }
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
    // relative to the main file, as in MuJoCo
    const fs::path path = main_file.parent_path() / attribute(*e, "file");
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

void prefix_names(Element& root, const std::string& prefix) {
  const auto put = [&](Element& e, const char* key) {
    if (const char* value = e.Attribute(key)) e.SetAttribute(key, (prefix + value).c_str());
  };
  const auto rename = [&](Element& e) {
    put(e, "name");
    for (const char* key : kReferences) put(e, key);
  };
  for (Element* e = root.FirstChildElement(); e; e = e->NextSiblingElement()) for_each(*e, rename);
}

void remove_all(Element& root, const char* kind) {
  for (Element *e = root.FirstChildElement(), *next = nullptr; e; e = next) {
    next = e->NextSiblingElement();
    if (is_kind(*e, kind)) {
      root.DeleteChild(e);
    } else {
      remove_all(*e, kind);
    }
  }
}

void append_children(Element& to, const Element& from) {
  for (const XMLNode* n = from.FirstChild(); n; n = n->NextSibling()) {
    to.InsertEndChild(n->DeepClone(to.GetDocument()));
  }
}

Element& section(Element& root, const char* kind) {
  if (Element* found = root.FirstChildElement(kind)) return *found;
  return *root.InsertNewChildElement(kind);
}

bool is_kind(const Element& element, std::string_view kind) {
  return element.Name() == kind;
}

Element* child_named(Element& parent, const char* kind, const std::string& name) {
  for (Element* e = parent.FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) {
    if (attribute(*e, "name") == name) return e;
  }
  return nullptr;
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

void set_source(Element& element, const input::Source& source) {
  element.SetAttribute(kSource, fmt::format("{} {}", source.line, source.file).c_str());
}

std::string tag(const Element& element) {
  const std::string name = attribute(element, "name");
  return name.empty() ? fmt::format("<{}>", element.Name())
                      : fmt::format("<{} name=\"{}\">", element.Name(), name);
}

Printed::Printed(XMLDocument& document) {
  std::vector<Origin> origins;  // in document order
  for_each(*document.RootElement(), [&](Element& e) {
    const Element* parent = e.Parent()->ToElement();
    origins.push_back(
        {source_of(e), tag(e), e.Name(), attribute(e, "name"), parent ? parent->Name() : ""});
  });
  for_each(*document.RootElement(), [](Element& e) { e.DeleteAttribute(kSource); });
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  text_ = printer.CStr();

  // MuJoCo counts lines with the same parser
  XMLDocument again;
  if (again.Parse(text_.data(), text_.size()) != tinyxml2::XML_SUCCESS) {
    throw input::Error({origins.front().source.file, 0},
                       std::string("cannot be read once its parts are put together (") +
                           XMLDocument::ErrorIDToName(again.ErrorID()) +
                           "); nest its elements less deeply");
  }
  auto origin = origins.begin();
  for_each(*again.RootElement(), [&](Element& e) {
    if (origin != origins.end()) origins_.emplace(e.GetLineNum(), std::move(*origin++));
  });
}

const Printed::Origin* Printed::at_line(int line) const {
  const auto found = origins_.find(line);
  return found == origins_.end() ? nullptr : &found->second;
}

const Printed::Origin* Printed::named(std::string_view kind, std::string_view name) const {
  for (const auto& [line, origin] : origins_) {
    if ((kind.empty() || origin.kind == kind) && origin.name == name) return &origin;
  }
  return nullptr;
}

const Printed::Origin* Printed::within(std::string_view section, int index) const {
  for (const auto& [line, origin] : origins_) {
    if (origin.section == section && index-- == 0) return &origin;
  }
  return nullptr;
}

const Printed::Origin* Printed::last(std::string_view kind) const {
  const Origin* found = nullptr;
  for (const auto& [line, origin] : origins_) {
    if (origin.kind == kind) found = &origin;
  }
  return found;
}

}  // namespace lcs::sim::xml
