/// \file
/// Reads JSON files with error messages that name the file and the place.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "scenarios/input/input_file.h"
#include "scenarios/input/message.h"

namespace lcs::files {

/// Keeps the order of its keys.
using Json = nlohmann::ordered_json;

/// JSON has finite numbers only.
inline Json number_or_null(std::optional<double> number) {
  return number && std::isfinite(*number) ? Json(*number) : Json(nullptr);
}

/// A parse error such as "not JSON at byte 12", with the number of lines before it.
struct JsonError : std::runtime_error {
  JsonError(const std::string& what, int lines_) : std::runtime_error(what), lines(lines_) {}
  int lines;
};

/// Limit of nesting. No document of this program is half as deep. Very deep ones overflow the stack
/// when they are written or destroyed.
inline constexpr int kDeepestJson = 64;

/// \throws JsonError if lists and objects are nested deeper than `kDeepestJson`.
void require_shallow(std::string_view text);

/// Parses JSON; all code uses this function. \throws JsonError
template <class Json>
Json parse_json(std::string_view text) {
  const auto lines_before = [&](std::size_t byte) {
    return static_cast<int>(std::ranges::count(text.substr(0, byte), '\n'));
  };
  require_shallow(text);
  try {
    return Json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    throw JsonError(fmt::format("not JSON at byte {}", error.byte), lines_before(error.byte));
  } catch (const nlohmann::json::exception&) {
    throw JsonError("there is a number that is too large", 0);
  }
}

/// \param where the text begins. \throws input::Error with `remedy` after the ';'.
template <class Json>
Json parse_json(std::string_view text, const input::Source& where, std::string_view remedy) {
  try {
    return parse_json<Json>(text);
  } catch (const JsonError& error) {
    throw input::Error({where.file, where.line + error.lines}, "{}; {}", error.what(), remedy);
  }
}

/// The text of JSON, in which U+FFFD replaces bytes that are no UTF-8, as names of files may have;
/// all code uses this function. `dump` alone throws.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// A JSON value with its path in the file. Each getter throws `JsonNode::Error` if the value has
/// another type, such as "scenarios[0].seed is not a whole number from 0".
class JsonNode {
 public:
  class Error : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
  };

  JsonNode(const Json& json, std::string path) : json_(json), path_(std::move(path)) {}

  JsonNode operator[](const char* key) const {
    require(json_.is_object(), "an object");
    const auto found = json_.find(key);
    const std::string path = path_.empty() ? key : path_ + "." + key;
    if (found == json_.end()) throw Error(path + " is missing");
    return {*found, path};
  }

  const Json& json() const { return json_; }
  bool has(const char* key) const { return json_.is_object() && json_.contains(key); }

  /// Calls `use(node)` for every item of a list.
  template <class Use>
  void each(const Use& use) const {
    require(json_.is_array(), "a list");
    for (std::size_t i = 0; i < json_.size(); ++i) {
      use(JsonNode(json_[i], fmt::format("{}[{}]", path_, i)));
    }
  }
  /// Calls `use(key, node)` for every entry, in the order of the file.
  template <class Use>
  void each_entry(const Use& use) const {
    require(json_.is_object(), "an object");
    for (const auto& [key, value] : json_.items()) {
      use(key, JsonNode(value, path_.empty() ? key : path_ + "." + key));
    }
  }

  bool is_text(std::string_view word) const { return json_.is_string() && json_ == word; }

  bool is_list() const { return json_.is_array(); }

  std::string text() const {
    require(json_.is_string(), "a text");
    return json_.get<std::string>();
  }
  bool flag() const {
    require(json_.is_boolean(), "true or false");
    return json_.get<bool>();
  }
  template <class Integer = std::uint64_t>
  Integer natural() const {
    require(json_.is_number_unsigned() && std::in_range<Integer>(json_.get<std::uint64_t>()),
            "a whole number from 0");
    return json_.get<Integer>();
  }
  std::int64_t whole() const {
    require(json_.is_number_integer() && (!json_.is_number_unsigned() ||
                                          std::in_range<std::int64_t>(json_.get<std::uint64_t>())),
            "a whole number");
    return json_.get<std::int64_t>();
  }
  double number() const {
    require(json_.is_number(), "a number");
    return json_.get<double>();
  }
  std::optional<double> figure() const {
    require(json_.is_number() || json_.is_null(), "a number or null");
    return json_.is_null() ? std::nullopt : std::optional(json_.get<double>());
  }
  std::vector<std::string> texts() const {
    std::vector<std::string> all;
    each([&](const JsonNode& item) { all.push_back(item.text()); });
    return all;
  }
  template <std::size_t N>
  std::array<double, N> numbers() const {
    require(json_.is_array() && json_.size() == N, fmt::format("a list of {} numbers", N));
    std::array<double, N> all{};
    std::size_t next = 0;
    each([&](const JsonNode& item) { all[next++] = item.number(); });
    return all;
  }

  void require(bool condition, std::string_view what) const {
    if (condition) return;
    const std::string_view place = path_.empty() ? "the file" : std::string_view(path_);
    // A NUL byte would end the message.
    throw Error(input::printable(fmt::format("{} is not {}", place, what)));
  }

 private:
  const Json& json_;
  std::string path_;
};

/// Parses a file and returns `use(node)` of its root.
/// \throws input::Error "FILE: fault; remedy", with the remedy of `kind`.
template <class Use>
std::invoke_result_t<Use, JsonNode> read_json(const std::filesystem::path& file,
                                              const input::FileKind& kind, const Use& use) {
  const auto json = parse_json<Json>(input::read_file(file, kind), {file.string(), 1}, kind.remedy);
  try {
    return use(JsonNode(json, ""));
  } catch (const JsonNode::Error& error) {
    throw input::Error({file.string(), 0}, "{}; {}", error.what(), kind.remedy);
  }
}

/// Size limit for files of figures, events or settings. Parsed, they take ten times as much memory.
inline constexpr std::uint64_t kMostJsonBytes = 256 * input::kMebibyte;

}  // namespace lcs::files
