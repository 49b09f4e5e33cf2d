#include "scenarios/input/document.h"

#include <yaml-cpp/emitter.h>
#include <yaml-cpp/emittermanip.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <sstream>
#include <system_error>
#include <unordered_set>

#include "scenarios/input/input_file.h"
#include "scenarios/input/message.h"

namespace lcs::input {
namespace {

/// Larger than any scenario; rejects images and recordings given by mistake.
constexpr FileKind kScenarioFile{kMebibyte, "give the path of a scenario file (.yaml)"};

Entry* find(Value& map, std::string_view key) {
  const auto found = std::ranges::find(map.entries, key, &Entry::key);
  return found == map.entries.end() ? nullptr : &*found;
}

/// Builds the tree from yaml-cpp's events.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(const Source& where) : first_line_(where) {}

  Value take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    add({Value::Kind::null, at(mark)});
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw Error(at(mark), "YAML aliases are not known here; write the value out");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& text) override {
    refuse_tag(mark, tag);
    add({Value::Kind::scalar, at(mark), text});
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    refuse_tag(mark, tag);
    open({Value::Kind::list, at(mark)});
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    refuse_tag(mark, tag);
    open({Value::Kind::map, at(mark)});
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  /// An unfinished list or map; in a map, possibly with a key that waits for its value.
  struct Open {
    Value value;
    std::optional<Entry> waiting = std::nullopt;
    std::unordered_set<std::string> keys = {};
  };

  Source at(const YAML::Mark& mark) const {
    return {first_line_.file, first_line_.line == 0 ? 0 : first_line_.line + mark.line};
  }

  /// yaml-cpp uses "?" for plain and "!" for quoted scalars.
  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (tag.empty() || tag == "?" || tag == "!") return;
    throw Error(at(mark), "YAML tags such as '" + tag + "' are not known here; remove it");
  }

  void open(Value value) { stack_.push_back({std::move(value)}); }

  void close() {
    Value value = std::move(stack_.back().value);
    stack_.pop_back();
    add(std::move(value));
  }

  void add(Value value) {
    if (stack_.empty()) {
      root_ = std::move(value);
    } else if (Open& parent = stack_.back(); parent.value.kind == Value::Kind::list) {
      parent.value.items.push_back(std::move(value));
    } else if (parent.waiting) {
      if (value.kind != Value::Kind::scalar) value.where = parent.waiting->where;
      parent.waiting->value = std::move(value);
      parent.value.entries.push_back(std::move(*parent.waiting));
      parent.waiting.reset();
    } else {
      parent.waiting = key(parent, std::move(value));
    }
  }

  static Entry key(Open& map, Value value) {
    if (value.kind != Value::Kind::scalar || value.text.empty()) {
      throw Error(value.where, "a key is " + std::string(kind_name(value.kind)) + "; give a name");
    }
    if (!map.keys.insert(value.text).second) {
      throw Error(value.where, "key '{}' is given twice, first in line {}; remove one", value.text,
                  find(map.value, value.text)->where.line);
    }
    return {std::move(value.text), std::move(value.where), {}};
  }

  Source first_line_;
  std::vector<Open> stack_;
  Value root_;
};

/// yaml-cpp treats control characters as ends of file, guesses other encodings, and reports a
/// misleading error for a tab in the indentation.
void refuse_bad_text(std::string_view text, const Source& where) {
  Source here = where;
  bool indentation = true;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) throw Error(here, "this is not UTF-8; save the file as UTF-8");
    const auto lead = static_cast<std::uint8_t>(text.front());
    if (lead == 0x7F || (lead < 0x20 && lead != '\t' && lead != '\n' && lead != '\r')) {
      throw Error(here, "there is a control character; is this a text file? remove it");
    }
    if (lead == '\t' && indentation) {
      throw Error(here, "a tab indents this line; indent with spaces");
    }
    if (lead == '\n' && here.line > 0) ++here.line;
    indentation = lead == '\n' || (indentation && lead == ' ');
    text.remove_prefix(length);
  }
}

/// "ego.speed" -> {"ego", "speed"}; "filter.circle.mu_0" -> {"filter", "circle.mu_0"}
std::vector<std::string> split_path(std::string_view path, const Source& where) {
  std::vector<std::string> parts;
  for (bool more = true; more;) {
    const bool filter_key = parts.size() == 1 && parts[0] == "filter";
    const std::size_t dot = filter_key ? std::string_view::npos : path.find('.');
    more = dot != std::string_view::npos;
    parts.emplace_back(path.substr(0, dot));
    if (parts.back().empty()) {
      throw Error(where, "there is an empty part in the key; write it as in ego.speed=0.7");
    }
    if (more) path.remove_prefix(dot + 1);
  }
  return parts;
}

Value& item(Value& list, const std::string& part, const std::string& path, const Source& where) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc() || end != part.data() + part.size() || index >= list.items.size()) {
    throw Error(where, path + " is a list of " + std::to_string(list.items.size()) +
                           " with no item '" + part + "'; give an index from 0");
  }
  return list.items[index];
}

/// The value under `part`; added if the map lacks it.
Value& child(Value& parent, const std::string& part, const std::string& path, const Source& where) {
  if (parent.kind == Value::Kind::list) return item(parent, part, path, where);
  if (parent.kind == Value::Kind::scalar) {
    throw Error(where, path + " is '" + parent.text + "', which has no '" + part + "' in it; set " +
                           path + " itself");
  }
  parent.kind = Value::Kind::map;
  if (Entry* entry = find(parent, part)) return entry->value;
  parent.entries.push_back({part, where, {Value::Kind::null, where}});
  return parent.entries.back().value;
}

void remove(Value& parent, const std::string& part, const Source& where) {
  const Entry* entry = parent.kind == Value::Kind::map ? find(parent, part) : nullptr;
  if (!entry) throw Error(where, "there is nothing to remove; give a value after the '='");
  parent.entries.erase(parent.entries.begin() + (entry - parent.entries.data()));
}

void flatten(const Value& value, const std::string& path,
             std::map<std::string, std::string>& texts) {
  if (value.items.empty() && value.entries.empty()) {
    texts[path] = value.text;
    return;
  }
  const std::string prefix = path.empty() ? "" : path + ".";
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    flatten(value.items[i], prefix + std::to_string(i), texts);
  }
  for (const Entry& entry : value.entries) flatten(entry.value, prefix + entry.key, texts);
}

constexpr int kOneLine = 1000;  ///< a level at which everything is in one line

/// Nesting depth of lists and maps; 0 for a scalar.
int height(const Value& value) {
  int inner = -1;
  for (const Value& item : value.items) inner = std::max(inner, height(item));
  for (const Entry& entry : value.entries) inner = std::max(inner, height(entry.value));
  return inner + 1;
}

/// \param level number of enclosing maps. Maps of the first two levels, deeply nested maps
/// and nested lists have a line per key or item. All others are in one line.
void emit(YAML::Emitter& out, const Value& value, int level) {
  if (value.kind == Value::Kind::null) out << YAML::Null;
  if (value.kind == Value::Kind::scalar) out << value.text;
  if (value.kind == Value::Kind::list) {
    if (level >= kOneLine || height(value) < 2) out << YAML::Flow;
    out << YAML::BeginSeq;
    for (const Value& item : value.items) emit(out, item, std::max(level + 1, 2));
    out << YAML::EndSeq;
  }
  if (value.kind == Value::Kind::map) {
    if (level >= kOneLine || (level >= 2 && height(value) < 3) || value.entries.empty()) {
      out << YAML::Flow;
    }
    out << YAML::BeginMap;
    for (const Entry& entry : value.entries) {
      out << YAML::Key << entry.key << YAML::Value;
      emit(out, entry.value, level + 1);
    }
    out << YAML::EndMap;
  }
}

}  // namespace

std::string_view kind_name(Value::Kind kind) {
  constexpr std::string_view kNames[] = {"nothing", "a single value", "a list", "a map"};
  return kNames[static_cast<std::size_t>(kind)];
}

Value parse_text(const std::string& text, const Source& where) {
  refuse_bad_text(text, where);
  // yaml-cpp overlooks an unclosed quote if blanks end the text.
  std::istringstream stream(text.substr(0, text.find_last_not_of(" \t\r\n") + 1));
  TreeBuilder builder(where);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    Value root = builder.take();
    if (parser) {
      TreeBuilder second(where);
      if (parser.HandleNextDocument(second)) {
        throw Error(where, "there is more than one YAML document; keep one (remove '---')");
      }
    }
    return root;
  } catch (const YAML::Exception& error) {
    std::string message =
        "this is not YAML: " + error.msg + "; check indentation, brackets and quotes";
    if (where.line == 0 || error.mark.is_null()) throw Error(where, message);
    message += " near column " + std::to_string(error.mark.column + 1);
    throw Error({where.file, where.line + error.mark.line}, message);
  }
}

Value parse_file(const std::filesystem::path& file) {
  return parse_document(read_file(file, kScenarioFile), file);
}

Value parse_document(const std::string& text, const std::filesystem::path& file) {
  Value root = parse_text(text, {file.string(), 1});
  if (root.kind == Value::Kind::null) {
    throw Error({file.string(), 0},
                "the file is empty; see scenarios/README.md for a first scenario");
  }
  if (root.kind != Value::Kind::map) {
    throw Error({file.string(), 1}, "a scenario is a map of keys, and this is " +
                                        std::string(kind_name(root.kind)) +
                                        "; begin as in 'scene: lab'");
  }
  root.where = {file.string(), 1};
  return root;
}

std::map<std::string, std::string> flattened(const Value& root) {
  std::map<std::string, std::string> texts;
  flatten(root, "", texts);
  return texts;
}

void apply_set(Value& root, const std::string& assignment) {
  const Source where{"--set " + assignment, 0};
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw Error(where, "this is not of the form key=value; write it as in ego.speed=0.7");
  }
  set(root, assignment.substr(0, equals), parse_text(assignment.substr(equals + 1), where), where);
}

void set(Value& root, std::string_view key, Value value, const Source& where) {
  const std::vector<std::string> parts = split_path(key, where);
  Value* node = &root;
  std::string path;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    node = &child(*node, parts[i], path, where);
    path += (path.empty() ? "" : ".") + parts[i];
  }
  if (value.kind == Value::Kind::null) return remove(*node, parts.back(), where);
  Value& target = child(*node, parts.back(), path, where);
  target = std::move(value);
  if (Entry* entry = node->kind == Value::Kind::map ? find(*node, parts.back()) : nullptr) {
    entry->where = where;
  }
}

std::string line_of(const Value& value) {
  YAML::Emitter out;
  emit(out, value, kOneLine);
  return out.c_str();
}

std::string yaml_text(const Value& root) {
  YAML::Emitter out;
  emit(out, root, 0);
  return out.c_str();
}

}  // namespace lcs::input
