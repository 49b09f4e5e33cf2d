#include "scenarios/input/reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "scenarios/input/message.h"
#include "scenarios/input/spelling.h"

namespace lcs::input {
namespace {

std::string quote(std::string_view text) {
  return std::string("'").append(text).append("'");
}

/// "did you mean 'speed'?", or the list of all known words.
std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
  if (const auto near = nearest(word, known)) return "did you mean '" + *near + "'?";
  if (known.empty()) return "remove it";
  return "known are " + joined(known, " and ");
}

void require_scalar(const Value& value, const std::string& path, std::string_view wanted) {
  if (value.kind == Value::Kind::scalar) return;
  throw Error(value.where, "{} is {}; give {}", path, kind_name(value.kind), wanted);
}

/// \param other alternative, for the message, for example " or auto"; "" without one.
template <class Integer>
Integer integer(const Value& value, const std::string& path, Integer low, Integer high,
                const std::string& other = "") {
  const std::string wanted =
      "a whole number from " + std::to_string(low) + " to " + std::to_string(high) + other;
  require_scalar(value, path, wanted);
  Integer number{};
  const char* const end = value.text.data() + value.text.size();
  const auto [rest, error] = std::from_chars(value.text.data(), end, number);
  // 010 is ambiguous: decimal or octal
  const std::size_t first = value.text.starts_with('-');
  const bool is_padded = value.text.size() > first + 1 && value.text[first] == '0';
  if (error != std::errc() || rest != end || is_padded || number < low || number > high) {
    throw Error(value.where, path + " is '" + value.text + "'; give " + wanted);
  }
  return number;
}

}  // namespace

std::string range_text(const Quantity& quantity) {
  const Range& range = quantity.range;
  std::string text;
  if (std::isfinite(range.low)) {
    text = (range.low_open ? "above " : "at least ") + number_text(range.low);
  }
  if (std::isfinite(range.high)) {
    text += (text.empty() ? "" : " and ") + std::string(range.high_open ? "below " : "at most ") +
            number_text(range.high);
  }
  const std::string_view unit = base_unit(quantity.dimension);
  return unit.empty() ? text : text + " " + std::string(unit);
}

double as_quantity(const Value& value, const std::string& path, const Quantity& quantity) {
  const auto [dimension, range] = quantity;
  const std::string_view unit = base_unit(dimension);
  require_scalar(value, path, unit.empty() ? "a number" : "a number in " + std::string(unit));
  double si = 0;
  try {
    si = parse_quantity(value.text, dimension);
  } catch (const std::invalid_argument& error) {
    throw Error(value.where, path + ": " + error.what());
  }
  const double low = to_si(range.low, dimension);
  const double high = to_si(range.high, dimension);
  if (si < low || si > high || (range.low_open && si == low) || (range.high_open && si == high)) {
    throw Error(value.where, path + " is '" + value.text + "'; it must be " + range_text(quantity));
  }
  return si;
}

std::int64_t as_integer(const Value& value, const std::string& path, std::int64_t low,
                        std::int64_t high, const std::string& other) {
  return integer(value, path, low, high, other);
}

std::size_t as_choice(const Value& value, const std::string& path,
                      const std::vector<std::string>& words, const std::string& other) {
  std::vector<std::string> all = words;
  if (!other.empty()) all.push_back(other);
  require_scalar(value, path, joined(all, " or "));
  const auto word = std::ranges::find(words, value.text);
  if (word == words.end()) {
    throw Error(value.where, path + " is '" + value.text + "'; give " + joined(all, " or "));
  }
  return static_cast<std::size_t>(word - words.begin());
}

std::uint64_t as_seed(const Value& value, const std::string& path) {
  return integer(value, path, std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max());
}

const std::string& as_text(const Value& value, const std::string& path) {
  require_scalar(value, path, "a text");
  if (value.text.empty()) throw Error(value.where, path + " is empty; give a text");
  return value.text;
}

const std::vector<Value>& as_list(const Value& value, const std::string& path,
                                  std::optional<std::size_t> size) {
  const std::string wanted = size ? "a list of " + std::to_string(*size) + ", as in [" +
                                        joined(std::vector<std::string>(*size, "0"), ", ") + "]"
                                  : std::string("a list, as in [...]");
  if (value.kind != Value::Kind::list) {
    throw Error(value.where, "{} is {}; give {}", path, kind_name(value.kind), wanted);
  }
  if (size && value.items.size() != *size) {
    throw Error(value.where, "{} is a list of {}; give {}", path, value.items.size(), wanted);
  }
  return value.items;
}

Reader::Reader(const Value& value, std::string path) : map_(value), path_(std::move(path)) {
  if (value.kind == Value::Kind::map) return;
  const bool null = value.kind == Value::Kind::null;
  throw Error(value.where, "{} is {}; give a map, as in {{key: value}}{}", path_,
              kind_name(value.kind), null ? ", or {} for its defaults" : "");
}

std::string Reader::path_of(std::string_view key) const {
  return (path_.empty() ? "" : path_ + ".") + std::string(key);
}

bool Reader::knows(std::string_view key) const {
  return std::ranges::find(known_, key) != known_.end();
}

const Value* Reader::find(std::string_view key) {
  if (!knows(key)) known_.emplace_back(key);
  const auto entry = std::ranges::find(map_.entries, key, &Entry::key);
  if (entry == map_.entries.end()) return nullptr;
  if (entry->value.kind == Value::Kind::null) {
    throw Error(entry->where, path_of(key) + " has no value; give one or remove the key");
  }
  return &entry->value;
}

const Value* Reader::require(std::string_view key) {
  const Value* value = find(key);
  if (!value) missing_.push_back(quote(key));
  return value;
}

std::optional<std::string> Reader::at_most_one_of(std::vector<std::string_view> keys) {
  std::ranges::stable_sort(keys, {}, [&](std::string_view key) {
    return std::ranges::find(known_, key) - known_.begin();
  });
  std::optional<std::string> given;
  for (const std::string_view key : keys) {
    const Value* value = find(key);
    if (!value) continue;
    if (given) {
      throw Error(value->where, "both " + path_of(*given) + " and " + path_of(key) +
                                    " are given; keep one of them");
    }
    given = key;
  }
  return given;
}

void Reader::exactly_one_of(std::initializer_list<std::string_view> keys) {
  if (at_most_one_of(keys)) return;
  std::vector<std::string> quoted;
  for (const std::string_view key : keys) quoted.push_back(quote(key));
  missing_.push_back(joined(quoted, " or "));
}

void Reader::refuse(std::string_view key, const std::string& what) {
  throw Error(find(key)->where, path_of(key) + what);
}

void Reader::finish() const {
  for (const Entry& entry : map_.entries) {
    if (knows(entry.key)) continue;
    throw Error(entry.where, "unknown key '{}'{}{}; {}", entry.key, path_.empty() ? "" : " in ",
                path_, suggestion(entry.key, known_));
  }
  if (!missing_.empty()) {
    throw Error(map_.where, "{} needs {}; add it (scenarios/README.md shows how)",
                path_.empty() ? "the scenario" : path_, missing_.front());
  }
}

}  // namespace lcs::input
