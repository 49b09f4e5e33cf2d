#include "sim/scene/xml.h"

#include <fmt/format.h>
#include <strings.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "scenarios/input/input_file.h"

namespace lcs::sim::xml {
namespace {

/// Size limits of MJCF text with mesh vertices, and of assets: images, meshes, height fields.
constexpr input::FileKind kModelFile{64 * input::kMebibyte, "give the path of an MJCF file"};
constexpr input::FileKind kNamedFile{input::kGibibyte, "give an image, mesh, hfield or model"};

namespace fs = std::filesystem;
using tinyxml2::XMLDocument;
using tinyxml2::XMLNode;

// Attributes that contain a file path.
constexpr std::array<const char*, 7> kFiles = {"file",     "fileright", "fileleft", "fileup",
                                               "filedown", "filefront", "fileback"};

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
    e.SetAttribute(kSource, fmt::format("{} {}", e.GetLineNum(), file.string()).c_str());
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
      const input::InputFile refused_if_unfit(normal, kNamedFile, source_of(e));
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

bool is_kind(const Element& element, std::string_view kind) {
  return element.Name() == kind;
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
