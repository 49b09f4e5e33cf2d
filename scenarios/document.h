/// \file
/// A YAML document as a plain tree in which every value knows where it was written.
///
/// Of YAML, a scenario uses maps, lists and scalars. Anchors, aliases, tags and several documents
/// in a file are refused, and so are keys given twice.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/scenario.h"

namespace lcs::scenario {

struct Entry;

struct Value {
  enum class Kind { null, scalar, list, map };

  Value();
  Value(Kind kind_, Source where_, std::string text_ = "");

  Kind kind = Kind::null;
  std::string text;            ///< of a scalar
  std::vector<Value> items;    ///< of a list
  std::vector<Entry> entries;  ///< of a map, in the order of the file
  Source where;                ///< for a list or map under a key, where the key is
};

struct Entry {
  std::string key;
  Source where;
  Value value;
};

// Behind the entries that a value may hold.
inline Value::Value() = default;
inline Value::Value(Kind kind_, Source where_, std::string text_)
    : kind(kind_), text(std::move(text_)), where(std::move(where_)) {}

/// What a value is, as a message says it: "a list", "a map", "nothing".
std::string_view kind_name(Value::Kind kind);

/// \throws Error when the file cannot be read, is not UTF-8, or is not one YAML document.
Value parse_file(const std::filesystem::path& file);

/// Parses a text as `parse_file` does a file. \param file for messages.
Value parse_document(const std::string& text, const std::filesystem::path& file);

/// Any value, with the lines counted from `where.line`.
Value parse_text(const std::string& text, const Source& where);

/// YAML that reads back as a value, in one line.
std::string line_of(const Value& value);
/// YAML of a map that reads back as it, with a line for each key of it and of the maps in it, and
/// for each item of a list of lists.
std::string yaml_text(const Value& root);

/// What is written in the tree, by the paths that `apply_set` takes: {"ego.start.0", "-4 m"}. Empty
/// text for what holds nothing.
std::map<std::string, std::string> flattened(const Value& root);

/// Replaces, adds or (with nothing after the '=') removes one value of the tree, in the form that
/// `--set` has: "ego.speed=0.7 m/s". Lists are addressed by index from 0. What follows "filter." is
/// one key, dots included. \throws Error naming the assignment.
void apply_set(Value& root, const std::string& assignment);

}  // namespace lcs::scenario
