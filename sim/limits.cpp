#include "sim/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/input_file.h"
#include "sim/picture_file.h"

namespace lcs::sim {
namespace {

namespace fs = std::filesystem;
using xml::Element;

/// The numbers that an attribute may be. Those of MuJoCo's schema (2.2.2) that it allocates, counts
/// or divides by; the others it looks at itself, or they do no harm.
struct Limit {
  std::string_view element, attribute;
  double least, most;
  const char* reason;
};
constexpr Limit kLimits[] = {
    {"size", "njmax", -1, 5000, "the solver's memory grows with its square: 1 GB"},
    {"size", "nconmax", -1, 20'000, "more contacts are never solved in time"},
    {"size", "nstack", -1, 1e8, "it is in numbers of 8 bytes: 800 MB"},
    {"size", "nuserdata", 0, 1e6, "they are copied with every state"},
    {"size", "nkey", 0, 1000, "each is a whole state"},
    {"size", "nuser_body", -1, 1000, "an attribute 'user' holds no more"},
    {"size", "nuser_jnt", -1, 1000, "an attribute 'user' holds no more"},
    {"size", "nuser_geom", -1, 1000, "an attribute 'user' holds no more"},
    {"size", "nuser_site", -1, 1000, "an attribute 'user' holds no more"},
    {"size", "nuser_cam", -1, 1000, "an attribute 'user' holds no more"},
    {"size", "nuser_tendon", -1, 1000, "an attribute 'user' holds no more"},
    {"size", "nuser_actuator", -1, 1000, "an attribute 'user' holds no more"},
    {"size", "nuser_sensor", -1, 1000, "an attribute 'user' holds no more"},
    {"option", "timestep", 1e-6, 1, "the compiler takes a step of it, in seconds"},
    {"option", "iterations", 0, 10'000, "each step may take so many"},
    {"option", "noslip_iterations", 0, 10'000, "each step may take so many"},
    {"option", "mpr_iterations", 0, 10'000, "each contact may take so many"},
    {"lengthrange", "timestep", 1e-3, 1, "the compiler takes inttotal / timestep steps"},
    {"lengthrange", "inttotal", 0, 100, "the compiler takes inttotal / timestep steps"},
    {"lengthrange", "inteval", 0, 100, "the compiler takes inttotal / timestep steps"},
    {"global", "offwidth", 1, 16'384, "software GL has no larger pictures"},
    {"global", "offheight", 1, 16'384, "software GL has no larger pictures"},
    {"quality", "shadowsize", 0, 16'384, "software GL has no larger pictures"},
    {"quality", "offsamples", 0, 64, "a picture of so many samples a pixel is kept"},
    {"quality", "numslices", 3, 512, "each round shape is drawn in numslices x numstacks pieces"},
    {"quality", "numstacks", 3, 512, "each round shape is drawn in numslices x numstacks pieces"},
    {"quality", "numquads", 1, 128, "each box is drawn in 6 x numquads x numquads pieces"},
    {"statistic", "extent", kLeastExtent_m, kMostExtent_m,
     "the clipping planes, 0.05 m and four extents, have no depth between them else"},
    {"statistic", "meaninertia", 1e-12, 1e12, "the solver divides by it"},
    {"statistic", "meanmass", 1e-12, 1e12, "forces are drawn in units of it"},
    {"statistic", "meansize", 1e-12, 1e12, "joints are drawn in units of it"},
    {"texture", "width", 0, 8192, "software GL has no larger textures"},
    {"texture", "height", 0, 6 * 8192.0, "software GL has no larger textures"},
    {"hfield", "nrow", 0, 2000, "all of it is drawn in every picture"},
    {"hfield", "ncol", 0, 2000, "all of it is drawn in every picture"},
    {"numeric", "size", 1, 500, "MuJoCo has room for so many"},
    {"skin", "subgrid", 0, 20, "each cell is divided into its square"},
    {"sensor", "dim", 1, 1000, "each reading holds so many"},
    {"user", "dim", 1, 1000, "each reading holds so many"},
};

// Of the whole document.
constexpr std::size_t kMostElements = 30'000;  // every name is compared with every other
constexpr int kMostTextures = 1000;            // MuJoCo's own
constexpr double kMostTextureBytes = 1e9;      // are counted in an int
// Of one of its parts.
constexpr double kMostTextureSide_px = 8192;  // of software GL
constexpr double kMostCubeSide_px = 4096;     // likewise
constexpr double kMostBodies = 2000;          // of a composite; each has joints of its own
constexpr std::size_t kMostVertices = 1'000'000;
constexpr std::size_t kMostNumerics = 500;  // of a <numeric>, which MuJoCo reads unbounded
constexpr scenario::FileKind kAssetFile{256 * scenario::kMebibyte,  // is read into memory
                                        "give a smaller file, of the kind that it is"};

// Attributes that are text, in which "inf" and "nan" are nothing special.
constexpr std::array<std::string_view, 31> kTexts = {
    "name",     "class",     "childclass", "file",    "fileright", "fileleft", "fileup",
    "filedown", "filefront", "fileback",   "texture", "material",  "mesh",     "hfield",
    "joint",    "joint1",    "joint2",     "site",    "body",      "body1",    "body2",
    "geom",     "geom1",     "geom2",      "target",  "objname",   "refname",  "tendon",
    "tendon1",  "tendon2",   "actuator"};

// Lengths, m: beyond the size of a scene that a camera sees.
constexpr std::array<std::string_view, 7> kLengths = {"pos",    "size",   "fromto", "vertex",
                                                      "refpos", "offset", "spacing"};

constexpr std::size_t kMostShown = 40;  // characters of a value, in a message

[[noreturn]] void refuse(const Element& e, const std::string& what) {
  throw scenario::Error(xml::source_of(e), xml::tag(e) + ": " + what);
}

std::vector<std::string_view> words(std::string_view text) {
  constexpr std::string_view kSpace = " \t\n\r\v\f";
  std::vector<std::string_view> found;
  for (std::size_t at = 0; (at = text.find_first_not_of(kSpace, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kSpace, at), text.size());
    found.push_back(text.substr(at, end - at));
    at = end;
  }
  return found;
}

/// What a word is as a number, if it is one; NaN and infinity are.
std::optional<double> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  if (error == std::errc::result_out_of_range) return std::numeric_limits<double>::infinity();
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

/// The first number of an attribute; nothing where it is absent or no number, which MuJoCo tells.
std::optional<double> number_in(const Element& e, const char* attribute) {
  const std::string text = xml::attribute(e, attribute);
  const auto found = words(text);
  return found.empty() ? std::nullopt : number(found.front());
}

void check_finite(const Element& e) {
  for (const auto* a = e.FirstAttribute(); a; a = a->Next()) {
    const std::string_view name = a->Name();
    if (name.find(':') != std::string_view::npos ||
        std::find(kTexts.begin(), kTexts.end(), name) != kTexts.end() ||
        (name == "data" && e.Name() == std::string_view("text"))) {
      continue;
    }
    const bool is_length = std::find(kLengths.begin(), kLengths.end(), name) != kLengths.end();
    for (const std::string_view word : words(a->Value())) {
      const std::optional<double> value = number(word);
      // a range may be open
      const bool open = value && std::isinf(*value) && name.ends_with("range");
      if (value && !std::isfinite(*value) && !open) {
        refuse(e, fmt::format("{} is {}; give a finite number", name, word.substr(0, kMostShown)));
      }
      if (value && is_length && std::abs(*value) > kMostExtent_m) {
        refuse(e, fmt::format("{} has {}, and a camera sees no farther than {:g} m; give a smaller "
                              "number",
                              name, word.substr(0, kMostShown), kMostExtent_m));
      }
    }
  }
}

void check_numbers(const Element& e) {
  const std::string_view kind = e.Name();
  for (const Limit& limit : kLimits) {
    if (kind != limit.element) continue;
    const std::string key(limit.attribute);
    if (!e.Attribute(key.c_str())) continue;
    // MuJoCo takes "12abc" for 12
    const std::optional<double> value = number_in(e, key.c_str());
    if (value && *value >= limit.least && *value <= limit.most) continue;
    refuse(e,
           fmt::format("{} is {}, and can be {:.10g} to {:.10g} ({}); give a number within these",
                       key, xml::attribute(e, key.c_str()).substr(0, kMostShown), limit.least,
                       limit.most, limit.reason));
  }
}

/// All numbers of an attribute. \throws scenario::Error where a word is none: MuJoCo would take
/// those before it and be silent.
std::vector<double> list(const Element& e, const char* attribute) {
  std::vector<double> values;
  const std::string text = xml::attribute(e, attribute);
  for (const std::string_view word : words(text)) {
    const std::optional<double> value = number(word);
    if (!value) {
      refuse(e, fmt::format("'{}' in {} is no number; correct it", word.substr(0, kMostShown),
                            attribute));
    }
    values.push_back(*value);
  }
  return values;
}

void check_indices(const Element& e, const char* attribute, std::size_t count) {
  for (const double index : list(e, attribute)) {
    if (index >= 0 && index < static_cast<double>(count) && index == std::floor(index)) continue;
    refuse(e, fmt::format("{} names vertex {:g}, and there are {} (0 to {}); correct it", attribute,
                          index, count, static_cast<double>(count) - 1));
  }
}

void check_file(const Element& e, const fs::path& file) {
  scenario::InputFile(file, kAssetFile, xml::source_of(e));
}

std::string read(const Element& e, const fs::path& file) {
  return scenario::InputFile(file, kAssetFile, xml::source_of(e)).bytes();
}

/// An integer of 4 bytes in a file.
std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::array<unsigned char, 4> b{};
  if (at + b.size() <= bytes.size()) std::memcpy(b.data(), bytes.data() + at, b.size());
  return std::uint32_t(b[0]) | std::uint32_t(b[1]) << 8 | std::uint32_t(b[2]) << 16 |
         std::uint32_t(b[3]) << 24;
}

bool has_extension(const fs::path& file, std::string_view extension) {
  std::string own = file.extension().string();
  std::transform(own.begin(), own.end(), own.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return own == extension;
}

struct Size {
  double columns = 0, rows = 0;
  double product() const { return columns * rows; }
};

/// What a picture's header says, PNG or MuJoCo's own; nothing where a PNG has none, which it tells.
/// \param bytes of a point in MuJoCo's own format.
Size picture_size(const Element& e, const fs::path& file, int bytes) {
  const std::string content = read(e, file);
  if (has_extension(file, ".png")) {
    const auto size = sim::picture_size(content).value_or(cv::Size2l());
    return {static_cast<double>(size.width), static_cast<double>(size.height)};
  }
  const Size own{double(word_at(content, 0)), double(word_at(content, 4))};
  if (static_cast<double>(content.size()) != 8 + bytes * own.product()) {
    refuse(e,
           fmt::format("'{}' is neither called .png nor in MuJoCo's own binary format; give a PNG "
                       "file",
                       file.string()));
  }
  return own;
}

/// \return its bytes.
double check_texture(const Element& e) {
  const bool flat = xml::attribute(e, "type") == "2d";
  const double most = flat ? kMostTextureSide_px : kMostCubeSide_px;
  const auto check = [&](const Size& size, const std::string& what, double parts) {
    if (size.columns / parts > most || size.rows > parts * most || size.columns < 0 ||
        size.rows < 0) {
      refuse(e, fmt::format("{} is {:g} x {:g} pixels, and software GL has room for {:g} x {:g}{}; "
                            "choose a smaller one",
                            what, size.columns, size.rows, most, most, flat ? "" : " a face"));
    }
    return 3 * size.product();
  };
  const std::string builtin = xml::attribute(e, "builtin");
  if (!builtin.empty() && builtin != "none") {
    const double width = number_in(e, "width").value_or(0);
    const double height = flat ? number_in(e, "height").value_or(0) : width;
    return (flat ? 1 : 6) * check({width, height}, "the texture", 1);
  }
  double bytes = 0;
  constexpr double kMostSquares = 12;  // that a grid of faces may have
  if (const std::string file = xml::attribute(e, "file"); !file.empty()) {
    bytes += check(picture_size(e, file, 3), "'" + file + "'", flat ? 1 : kMostSquares);
  }
  for (const char* side :
       {"fileright", "fileleft", "fileup", "filedown", "filefront", "fileback"}) {
    const std::string file = xml::attribute(e, side);
    if (!file.empty()) bytes += check(picture_size(e, file, 3), "'" + file + "'", 1);
  }
  return bytes;
}

void check_hfield(const Element& e) {
  const std::string file = xml::attribute(e, "file");
  if (file.empty()) return;
  constexpr double kMostPoints = 2000;  // as in the table
  const Size size = picture_size(e, file, 4);
  if (size.columns > kMostPoints || size.rows > kMostPoints) {
    refuse(e,
           fmt::format("'{}' has {:g} x {:g} points, and can have {:g} x {:g} (all of it is drawn "
                       "in every picture); give a coarser one",
                       file, size.columns, size.rows, kMostPoints, kMostPoints));
  }
}

/// What MuJoCo follows without a look in Wavefront's files: the numbers of vertices, normals and
/// texture coordinates in each face.
void check_obj(const Element& e, const fs::path& file) {
  const std::string content = read(e, file);
  std::array<std::size_t, 3> counts{};  // of v, vt, vn
  constexpr std::array<std::string_view, 3> kKinds = {"v", "vt", "vn"};
  struct Face {
    std::array<std::size_t, 3> counts;  // so far, for those that count backwards
    int line;
    std::string_view text;
  };
  std::vector<Face> faces;
  int line = 0;
  for (std::string_view rest = content; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view text = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    ++line;
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) continue;
    const std::string_view kind = text.substr(begin, text.find_first_of(" \t\r", begin) - begin);
    const auto found = std::find(kKinds.begin(), kKinds.end(), kind);
    if (found != kKinds.end()) ++counts[static_cast<std::size_t>(found - kKinds.begin())];
    if (kind == "f") faces.push_back({counts, line, text.substr(begin + 1)});
  }
  for (const Face& face : faces) {
    const auto complain = [&](const std::string& what) {
      refuse(e, fmt::format("'{}', line {}: {}; correct the file", file.string(), face.line, what));
    };
    for (const std::string_view corner : words(face.text)) {
      std::string_view rest = corner;
      for (std::size_t k = 0; k < counts.size(); ++k) {
        const std::size_t slash = std::min(rest.find('/'), rest.size());
        const std::string_view word = rest.substr(0, slash);
        rest.remove_prefix(std::min(slash + 1, rest.size()));
        if (word.empty()) {
          if (k == 0) complain(fmt::format("'{}' names no vertex", corner.substr(0, kMostShown)));
          if (counts[k] > 0) {
            complain(fmt::format("'{}' has no {}, and the file has some",
                                 corner.substr(0, kMostShown),
                                 k == 1 ? "texture coordinate" : "normal"));
          }
          continue;
        }
        const double index = number(word).value_or(0);
        const double place = index < 0 ? static_cast<double>(face.counts[k]) + index : index - 1;
        if (index == 0 || place < 0 || place >= static_cast<double>(counts[k])) {
          complain(fmt::format("a face names {} {}, and there are {}", kKinds[k],
                               word.substr(0, kMostShown), counts[k]));
        }
      }
    }
  }
}

/// MuJoCo's own binary format: sizes, vertices, normals, texture coordinates, faces.
void check_msh(const Element& e, const fs::path& file) {
  const std::string content = read(e, file);
  const double vertices = word_at(content, 0), normals = word_at(content, 4);
  const double coordinates = word_at(content, 8), faces = word_at(content, 12);
  const double expected = 16 + 4 * (3 * vertices + 3 * normals + 2 * coordinates + 3 * faces);
  if (static_cast<double>(content.size()) != expected) {
    refuse(e,
           fmt::format("'{}' is not as long as its header says; give a whole file", file.string()));
  }
  const std::size_t first_face = content.size() - static_cast<std::size_t>(12 * faces);
  for (std::size_t at = 16; at < first_face; at += 4) {
    if (!std::isfinite(std::bit_cast<float>(word_at(content, at)))) {
      refuse(e, fmt::format("'{}' has a number that is not finite; correct it", file.string()));
    }
  }
  for (std::size_t at = first_face; at < content.size(); at += 4) {
    if (word_at(content, at) < vertices) continue;
    refuse(e, fmt::format("'{}': a face names vertex {}, and there are {:g}; correct the file",
                          file.string(), word_at(content, at), vertices));
  }
}

void check_mesh(const Element& e) {
  const std::size_t vertices = list(e, "vertex").size() / 3;
  if (vertices > kMostVertices) {
    refuse(e, fmt::format("it has {} vertices, and can have {}; give a coarser one", vertices,
                          kMostVertices));
  }
  list(e, "normal");
  list(e, "texcoord");
  const fs::path file = xml::attribute(e, "file");
  if (file.empty()) {
    check_indices(e, "face", vertices);
    return;
  }
  if (e.Attribute("face")) refuse(e, "it has a file and faces too; remove one of the two");
  if (has_extension(file, ".obj")) check_obj(e, file);
  if (has_extension(file, ".msh")) check_msh(e, file);
  if (has_extension(file, ".stl")) check_file(e, file);  // MuJoCo looks at what is in it
}

/// MuJoCo's own binary format: sizes, vertices, texture coordinates, faces; then each bone's name,
/// place and attitude, 17 numbers of 4 bytes, and how many vertices and weights follow.
void check_skn(const Element& e, const fs::path& file) {
  const std::string content = read(e, file);
  const double all = static_cast<double>(content.size());
  double at =
      16 + 12.0 * word_at(content, 0) + 8.0 * word_at(content, 4) + 12.0 * word_at(content, 8);
  for (double bones = word_at(content, 12); bones > 0 && at <= all; --bones) {
    constexpr double kNamePlaceAttitude = 68;
    const auto count = static_cast<std::size_t>(at + kNamePlaceAttitude);
    at += kNamePlaceAttitude + 4 + 8.0 * word_at(content, count);
  }
  if (at != all) {
    refuse(e,
           fmt::format("'{}' is not as long as its sizes say; give a whole file", file.string()));
  }
}

void check_skin(const Element& e) {
  if (const std::string file = xml::attribute(e, "file"); !file.empty()) check_skn(e, file);
  const std::size_t vertices = list(e, "vertex").size() / 3;
  if (vertices > kMostVertices) refuse(e, "it has too many vertices; give a coarser one");
  list(e, "texcoord");
  if (e.Attribute("face") && !e.Attribute("file")) check_indices(e, "face", vertices);
  for (const Element* bone = e.FirstChildElement("bone"); bone;
       bone = bone->NextSiblingElement("bone")) {
    check_indices(*bone, "vertid", vertices);
    list(*bone, "vertweight");
  }
}

void check_composite(const Element& e) {
  double count = 1;
  for (const double n : list(e, "count")) count *= std::max(n, 1.0);
  if (count > kMostBodies) {
    refuse(e, fmt::format("its count makes {:g} bodies, and can make {:g} (each moves); give a "
                          "smaller one",
                          count, kMostBodies));
  }
}

void check_numeric(const Element& e) {
  if (list(e, "data").size() > kMostNumerics) {
    refuse(e,
           fmt::format("its data are more than {} numbers, for which MuJoCo has room; give fewer",
                       kMostNumerics));
  }
}

}  // namespace

void check_limits(Element& root) {
  std::size_t elements = 0;
  int textures = 0;
  double texture_bytes = 0;
  xml::for_each(root, [&](const Element& e) {
    const std::string_view kind = e.Name();
    if (++elements > kMostElements) {
      refuse(e, fmt::format("the scene has more than {} elements, each of whose names is compared "
                            "with every other; take some away",
                            kMostElements));
    }
    check_finite(e);
    check_numbers(e);
    const Element* parent = e.Parent() ? e.Parent()->ToElement() : nullptr;
    const bool is_asset = parent && parent->Name() == std::string_view("asset");
    if (kind == "composite") check_composite(e);
    if (kind == "numeric") check_numeric(e);
    if (!is_asset) return;
    if (kind == "mesh") check_mesh(e);
    if (kind == "skin") check_skin(e);
    if (kind == "hfield") check_hfield(e);
    if (kind != "texture") return;
    texture_bytes += check_texture(e);
    if (++textures > kMostTextures || texture_bytes > kMostTextureBytes) {
      refuse(e,
             fmt::format("with it the scene has {} textures of {:.0f} MB in all, and can have {} "
                         "of {:.0f} MB; choose fewer or smaller ones",
                         textures, texture_bytes / 1e6, kMostTextures, kMostTextureBytes / 1e6));
    }
  });
}

}  // namespace lcs::sim
