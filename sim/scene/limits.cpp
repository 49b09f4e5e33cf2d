#include "sim/scene/limits.h"

#include <fmt/format.h>
#include <mujoco/mjxmacro.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/input/input_file.h"
#include "sim/pictures/picture_file.h"
#include "sim/scene/model.h"

namespace lcs::sim {
namespace {

using xml::Element;

/// The range of an attribute that MuJoCo does not check, and whose excess the trial in a
/// child process (sim/base/trial.h) does not reveal.
struct Limit {
  std::string_view element, attribute;  // "nuser_*": all with this prefix
  double least, most;
  const char* reason;
};
constexpr Limit kLimits[] = {
    {"size", "njmax", -1, 5000, "the solver's memory grows with its square: 1 GB"},
    {"size", "nconmax", -1, 20'000, "more contacts are never solved in time"},
    {"size", "nstack", -1, 1e8, "it is in numbers of 8 bytes: 800 MB"},
    {"size", "nuserdata", 0, 1e6, "they are copied with every state"},
    {"size", "nuser_*", -1, 1000, "an attribute 'user' holds no more"},
    {"option", "timestep", 1e-6, 1, "the simulation takes steps of it, in seconds"},
    {"option", "iterations", 0, 10'000, "each step may take so many"},
    {"option", "noslip_iterations", 0, 10'000, "each step may take so many"},
    {"option", "ccd_iterations", 0, 10'000, "each contact may take so many"},
    {"quality", "numslices", 3, 512, "each round shape is drawn in numslices x numstacks pieces"},
    {"quality", "numstacks", 3, 512, "each round shape is drawn in numslices x numstacks pieces"},
    {"quality", "numquads", 1, 128, "each box is drawn in 6 x numquads x numquads pieces"},
    {"statistic", "extent", kLeastExtent_m, kMostExtent_m,
     "the clipping planes, 0.05 m and four extents, have no depth between them else"},
    {"texture", "width", 0, 8192, "software GL has no larger textures"},
    {"texture", "height", 0, 6 * 8192.0, "software GL has no larger textures"},
    {"numeric", "size", 1, 500, "MuJoCo has room for so many"},
    {"skin", "subgrid", 0, 20, "each cell is divided into its square"},
    {"user", "dim", 1, 1000, "each reading holds so many"},
};

// Limits of the compiled model.
constexpr int kMostTextureSide_px = 8192;  // limit of software GL
constexpr int kMostCubeSide_px = 4096;     // limit of software GL
constexpr int kMostTextures = 1000;        // limit of MuJoCo's renderer
constexpr double kMostTextureBytes = 1e9;
constexpr int kMostHeightFieldSide = 2000;  // points; every image draws all of them

constexpr input::FileKind kAssetFile{256 * input::kMebibyte,  // read into memory
                                     "give an image, mesh or height field of at most 256 MiB"};

// Lengths, m; limited to the size of a scene that the camera renders.
constexpr std::array<std::string_view, 7> kLengths = {"pos",    "size",   "fromto", "vertex",
                                                      "refpos", "offset", "spacing"};

constexpr std::size_t kMostShown = 40;  // characters of a value, in a message

std::vector<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

/// Parses a word as a number, including NaN and infinity; empty if it does not parse.
std::optional<double> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

[[noreturn]] void refuse(const Element& e, const std::string& what) {
  throw input::Error(xml::source_of(e), xml::tag(e) + ": " + what);
}

void check_length(const Element& e, std::string_view name, const std::string& text) {
  if (std::ranges::find(kLengths, name) == kLengths.end()) return;
  for (const std::string& word : words(text)) {
    const std::optional<double> value = number(word);
    if (!value || std::abs(*value) <= kMostExtent_m) continue;
    refuse(e, fmt::format("{} has '{}', and a camera sees no farther than {:g} m; correct it", name,
                          word.substr(0, kMostShown), kMostExtent_m));
  }
}

void check_range(const Element& e, std::string_view name, const std::string& text) {
  for (const Limit& limit : kLimits) {
    const bool is_named =
        limit.attribute.ends_with('*')
            ? name.starts_with(limit.attribute.substr(0, limit.attribute.size() - 1))
            : name == limit.attribute;
    if (e.Name() != limit.element || !is_named) continue;
    const auto found = words(text);
    const auto value = found.empty() ? std::nullopt : number(found.front());
    if (value && *value >= limit.least && *value <= limit.most) continue;
    refuse(e,
           fmt::format("{} is {}, and can be {:.10g} to {:.10g} ({}); give a number within these",
                       name, text.substr(0, kMostShown), limit.least, limit.most, limit.reason));
  }
}

/// \param file of an asset. MuJoCo would block on a pipe, and allocate any image size.
void check_file(const Element& e, const fs::path& file) {
  const std::string bytes = input::InputFile(file, kAssetFile, xml::source_of(e)).bytes();
  const auto size = picture_size(bytes);
  if (size && size->width > 0 && size->height > kMostPixels / size->width) {
    refuse(e, fmt::format(
                  "'{}' is {} x {} pixels, and can have {} million in all; choose a smaller one",
                  file.string(), size->width, size->height, kMostPixels / 1'000'000));
  }
}

void require_finite(std::string_view, const void*, std::int64_t) {}  // integer arrays
/// \throws MujocoError
template <std::floating_point T>
void require_finite(std::string_view array, const T* values, std::int64_t count) {
  const bool may_be_open = array.ends_with("range");
  if (std::all_of(values, values + count, [&](T value) {
        return std::isfinite(value) || (may_be_open && !std::isnan(value));
      })) {
    return;
  }
  throw MujocoError(fmt::format("a number is not finite, for {}", array));
}

}  // namespace

void check_limits(Element& root) {
  xml::for_each(root, [](const Element& e) {
    for (const auto* a = e.FirstAttribute(); a; a = a->Next()) {
      if (std::string_view(a->Name()).starts_with("file")) check_file(e, a->Value());
      check_range(e, a->Name(), a->Value());
      check_length(e, a->Name(), a->Value());
    }
  });
}

bool has_endless(const Element& e) {
  for (const auto* a = e.FirstAttribute(); a; a = a->Next()) {
    if (std::string_view(a->Name()).ends_with("range")) continue;
    for (const std::string& word : words(a->Value())) {
      if (!std::isfinite(number(word).value_or(0))) return true;
    }
  }
  return false;
}

void check_compiled(const mjModel& m) {
  const auto fail = [&](mjtObj kind, int id, const std::string& what) {
    const char* name = mj_id2name(&m, kind, id);
    throw MujocoError(fmt::format("{} '{}' {}", mju_type2Str(kind), name ? name : "", what));
  };
  const auto check_size = [&](mjtObj kind, int id, int rows, int columns, int most_rows,
                              int most_columns) {
    if (rows >= 1 && rows <= most_rows && columns >= 1 && columns <= most_columns) return;
    fail(kind, id,
         fmt::format("has {} x {} points, and can have {} x {}", columns, rows, most_columns,
                     most_rows));
  };
  double bytes = 0;
  for (int i = 0; i < m.ntex; ++i) {
    const bool is_flat = m.tex_type[i] == mjTEXTURE_2D;
    const int side = is_flat ? kMostTextureSide_px : kMostCubeSide_px;
    check_size(mjOBJ_TEXTURE, i, m.tex_height[i], m.tex_width[i], is_flat ? side : 6 * side, side);
    bytes += 3.0 * m.tex_width[i] * m.tex_height[i];
    if (i < kMostTextures && bytes <= kMostTextureBytes) continue;
    fail(mjOBJ_TEXTURE, i,
         fmt::format("is one too many: with it there are {} textures of {:.0f} MB, and can be {} "
                     "of {:.0f} MB",
                     i + 1, bytes / 1e6, kMostTextures, kMostTextureBytes / 1e6));
  }
  for (int i = 0; i < m.nhfield; ++i) {
    check_size(mjOBJ_HFIELD, i, m.hfield_nrow[i], m.hfield_ncol[i], kMostHeightFieldSide,
               kMostHeightFieldSide);
  }
  for (int i = 0; i < m.nskin; ++i) {
    const int* const face = m.skin_face + 3 * m.skin_faceadr[i];
    const int* const end = face + 3 * m.skin_facenum[i];
    const int vertices = m.skin_vertnum[i];
    const auto wrong = std::find_if(face, end, [&](int v) { return v < 0 || v >= vertices; });
    if (wrong == end) continue;
    fail(mjOBJ_SKIN, i, fmt::format("has a face of vertex {}, and there are {}", *wrong, vertices));
  }
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"  // in MuJoCo's macro
#define X(type, name, rows, columns) \
  require_finite(#name, m.name, std::int64_t{m.rows} * (columns));
  MJMODEL_POINTERS_PREAMBLE((&m))
  MJMODEL_POINTERS
#undef X
#pragma GCC diagnostic pop
}

}  // namespace lcs::sim
