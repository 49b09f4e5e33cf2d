#include "tools/files/provenance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "scenarios/input/inputs_read.h"
#include "scenarios/input/message.h"
#include "scenarios/input/sha256.h"
#include "tools/files/output.h"

namespace lcs::files {
namespace {

constexpr const char* kRead = "read";
/// Entries beside a provenance's own; they determine no byte of a result.
constexpr std::array<std::string_view, 4> kCircumstances{"command", "started", "wall_s", "cpu_s"};

/// A fact's value in a message.
std::string text_of(const Json& facts, const std::string& name) {
  constexpr std::size_t kMostShown = 200;  // bytes
  if (!facts.contains(name)) return "not stated";
  const Json& value = facts.at(name);
  const std::string text = value.is_string() ? value.get<std::string>() : json_text(value);
  return fmt::format(
      "'{}'",
      input::one_line(text.size() <= kMostShown ? text : text.substr(0, kMostShown) + " ..."));
}

}  // namespace

Json Provenance::json() const {
  Json json = facts;
  json[kRead] = read;
  return json;
}

Provenance Provenance::from(const Json& json) {
  Provenance provenance;
  JsonNode(json, "")[kRead].each_entry([&](const std::string& path, const JsonNode& digest) {
    provenance.read[path] = digest.text();
  });
  for (const auto& [name, value] : json.items()) {
    if (name != kRead && std::ranges::count(kCircumstances, name) == 0) {
      provenance.facts[name] = value;
    }
  }
  return provenance;
}

Provenance read_how_made(const fs::path& folder) {
  const fs::path file = folder / kHowMadeFile;
  constexpr input::FileKind kKind{kMostJsonBytes, "make the result again"};
  return read_json(file, kKind, [](const JsonNode& node) { return Provenance::from(node.json()); });
}

void Provenance::add_read(const Provenance& of_unit, const std::string& unit) {
  for (const auto& [path, digest] : of_unit.read) {
    if (read.try_emplace(path, digest).first->second == digest) continue;
    throw std::runtime_error(
        fmt::format("{} has read {} in another state than the rest; leave the file alone while the "
                    "work lasts, and begin again",
                    unit, path));
  }
}

Provenance provenance_of(Json facts, const fs::path& base) {
  Provenance provenance{.facts = std::move(facts)};
  const std::vector<fs::path> own = folders_under_way();
  std::error_code error;
  const fs::path here = fs::current_path(error);
  for (const auto& [path, digest] : input::inputs_read()) {
    const auto is_in = [&path = path](const fs::path& folder) { return is_within(path, folder); };
    if (digest.empty() || std::ranges::any_of(own, is_in)) continue;
    const bool is_here = !error && is_within(path, here);
    provenance.read[!base.empty() ? path.lexically_relative(base)
                    : is_here     ? path.lexically_relative(here)
                                  : path] = digest;
  }
  return provenance;
}

std::string difference(const Provenance& a, const Provenance& b,
                       std::span<const std::string_view> but) {
  for (const Json* facts : {&a.facts, &b.facts}) {
    for (const auto& [name, value] : facts->items()) {
      const bool may_differ = std::ranges::count(but, name) > 0;
      const bool is_same =
          a.facts.contains(name) && b.facts.contains(name) && a.facts.at(name) == b.facts.at(name);
      if (may_differ || is_same) continue;
      return fmt::format("{} differs ({} and {})", input::one_line(name), text_of(a.facts, name),
                         text_of(b.facts, name));
    }
  }
  for (const auto& [path, digest] : a.read) {
    const auto found = b.read.find(path);
    if (found != b.read.end() && found->second != digest) {
      return input::one_line(path) + " differs";
    }
  }
  return "";
}

std::string changed_since(const Provenance& provenance, const fs::path& base) {
  for (const auto& [path, digest] : provenance.read) {
    std::error_code error;
    const fs::path real = fs::weakly_canonical(base / path, error);
    if (!fs::exists(real, error)) return input::one_line(path) + " is missing";
    if (input::sha256_of_file(real) != digest) {
      return input::one_line(path) + " was changed since";
    }
  }
  return "";
}

}  // namespace lcs::files
