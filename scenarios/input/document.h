/// \file
/// A YAML document as a plain tree; every value keeps its source line.
///
/// Scenarios use only YAML's maps, lists and scalars. Anchors, aliases, tags, multiple documents in
/// a file and duplicate keys are rejected.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/input/error.h"

namespace lcs::input {

struct Entry;

struct Value {
  enum class Kind { null, scalar, list, map };

  Value();
  Value(Kind kind_, Source where_, std::string text_ = "");

  Kind kind = Kind::null;
  std::string text;            ///< of a scalar
  std::vector<Value> items;    ///< of a list
  std::vector<Entry> entries;  ///< of a map, in file order
  Source where;                ///< for a list or map under a key: the key's place
};

struct Entry {
  std::string key;
  Source where;
  Value value;
};

// Defined after `Entry`, which must be complete.
inline Value::Value() = default;
inline Value::Value(Kind kind_, Source where_, std::string text_)
    : kind(kind_), text(std::move(text_)), where(std::move(where_)) {}

/// A value's kind as cited in messages: "a list", "a map", "nothing".
std::string_view kind_name(Value::Kind kind);

/// \throws Error if the file cannot be read, is not UTF-8, or is not exactly one YAML document.
Value parse_file(const std::filesystem::path& file);

/// Parses a text like `parse_file` parses a file. \param file cited in messages.
Value parse_document(const std::string& text, const std::filesystem::path& file);

/// Parses any value; line numbers start at `where.line`.
Value parse_text(const std::string& text, const Source& where);

/// YAML of a value in one line; parses to the same value.
std::string line_of(const Value& value);
/// YAML of a map; parses to the same map. Each key of it and of its direct submaps has its own
/// line, and so has each item of a nested list.
std::string yaml_text(const Value& root);

/// The scalars of the tree by their paths as in `apply_set`: {"ego.start.0", "-4 m"}. Empty lists
/// and maps and nulls have an empty text.
std::map<std::string, std::string> flattened(const Value& root);

/// Applies a `--set` assignment such as "ego.speed=0.7 m/s": replaces, adds or (with an empty
/// value) removes one value of the tree. Indices into lists count from 0. All text after "filter."
/// is one key, including dots. \throws Error citing the assignment.
void apply_set(Value& root, const std::string& assignment);
/// Sets the value of a key as `apply_set` does; null removes it. \throws Error citing `where`.
void set(Value& root, std::string_view key, Value value, const Source& where);

}  // namespace lcs::input
