#include "sim/scene/model.h"

#include <fmt/format.h>

#include <algorithm>

namespace lcs::sim {
namespace {

/// Remedies by a phrase of MuJoCo's message; the first match applies.
struct Remedy {
  std::string_view words, remedy;
};
constexpr Remedy kRemedies[] = {
    {"repeated name", "give one of the two another name"},
    {"repeated default class", "give one of the two another class"},
    {" must be positive in geom", "give it a size of numbers above 0"},
    {"mass and inertia of moving bodies",
     "give the body a geom with size and density, or an <inertial> with mass and diaginertia"},
    {"mass is too small", "give its geoms a mass or density above 0"},
    {"mass, inertia or density are negative", "make them positive"},
    {"mass and inertia cannot be negative", "make them positive"},
    {"coplanar vertices", "give it thickness, or use a box"},
    {"qhull error",
     "its points lie in a plane, on a line, or are too few: give it thickness, or use a box"},
    {"mesh volume is too small",
     "close the mesh, turn its faces outwards, or enlarge it (its unit is the metre)"},
    {"mesh surface area is too small", "enlarge it: its unit is the metre"},
    {"inconsistent orientation", "turn all faces outwards, or leave the faces to MuJoCo"},
    {"mesh inertia", "close the mesh and turn its faces outwards"},
    {"ASCII", "save it as binary STL"},
    {"STL file", "save it anew as binary STL"},
    {"OBJ file", "save it anew as OBJ"},
    {"MSH file", "save it anew as binary STL"},
    {"SKN file", "save it anew"},
    {"PNG", "save the picture anew as PNG"},
    {"Unknown skin file type", "give an .skn file"},
    {"unsupported content type", "give a .png file"},
    {"plugin", "take it out: plugins are not loaded"},
    {"unrecognized attribute", "correct its spelling or take it away"},
    {"unrecognized element", "correct its spelling, or put it where MJCF has it"},
    {"number is too large", "give a smaller one"},
    {"invalid keyword", "give one of the words that MJCF has for it"},
    {"required attribute missing", "add it"},
    {"missing element", "add it"},
    {"bad format", "give numbers that are written as such, and integers as indices and counts"},
    {"does not have enough data", "give as many numbers as MJCF asks for"},
    {"has too much data", "give as many numbers as MJCF asks for"},
    {"unknown default", "define the class in <default>, or correct the name"},
    {"not found", "define it, or correct the name"},
    {"could not find", "define it, or correct the name"},
    {"unrecognized object", "define it, or correct the name"},
    {"free joint can only", "put the body right into the worldbody, with this joint alone"},
    {"nuser_", "raise it in <size>, or take numbers away from 'user'"},
    {"ould not create mj",
     "not enough memory: lower the numbers in <size>, or make textures and meshes smaller"},
    {"points, and can have", "choose a smaller one"},
    {"is one too many", "choose fewer or smaller ones"},
    {"a face of vertex", "correct its faces"},
    {"vertex index", "correct its faces"},
    {"index out of bounds", "correct the faces of the meshes"},
    {"not finite", "give finite numbers, also in the files of meshes, skins and height fields"},
    {"ould not allocate", "not enough memory: make the scene smaller, or raise ulimit -v"},
    {"too large", "make the scene smaller"},
    {"at least 4 ver", "give four or more"},
    {"incompatible size", "give one for each vertex"},
    {"unknown", "define it, or correct the name"},
    {"unrecognized name", "define it, or correct the name"},
    {"more than 6 dofs", "give it one joint of each direction at most, or a freejoint alone"},
    {"simulation is unstable",
     "look for huge masses, forces, stiffnesses, or bodies that begin inside each other"},
};

std::string remedy_of(std::string_view said) {
  for (const Remedy& r : kRemedies) {
    if (said.find(r.words) != std::string_view::npos) return std::string(r.remedy);
  }
  return "correct it";
}

/// Removes " (id = 5)", an index that the user cannot see, and " in geom ''".
void take_out_numbers(std::string& text) {
  for (std::size_t at; (at = text.find(" (id")) != std::string::npos;) {
    const std::size_t end = text.find(')', at);
    text.erase(at, end == std::string::npos ? end : end + 1 - at);
  }
  for (std::size_t end; (end = text.find(" ''")) != std::string::npos;) {
    const std::size_t at = text.rfind(" in ", end);
    const bool is_place = at != std::string::npos && text.find(' ', at + 4) == end;
    text.erase(is_place ? at : end, end + 3 - (is_place ? at : end));
  }
}

/// The message in one line, without MuJoCo's prefixes and suffixes.
std::string plain(std::string_view said) {
  for (const std::string_view prefix : {"XML Error", "Error"}) {
    if (!said.starts_with(prefix)) continue;
    said.remove_prefix(prefix.size());
    break;
  }
  for (const std::string_view prefix : {": ", "Schema violation: ", "engine error: "}) {
    if (said.starts_with(prefix)) said.remove_prefix(prefix.size());
  }
  said = said.substr(0, std::min(said.find("\nObject name = "), said.find("\nElement ")));
  std::string text;
  for (const char c : said) {
    const bool space = static_cast<unsigned char>(c) <= ' ';
    if (!space) text += c;
    if (space && !text.empty() && text.back() != ' ') text += ' ';
  }
  take_out_numbers(text);
  while (!text.empty() && (text.back() == ' ' || text.back() == '.' || text.back() == ':'))
    text.pop_back();
  return text;
}

}  // namespace

std::string in_one_line(const std::string& said, const std::string& more) {
  const std::string why = plain(said);
  return fmt::format("{}{}; {}", why, more, remedy_of(why));
}

}  // namespace lcs::sim
