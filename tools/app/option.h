/// \file
/// One option or argument of a command, stated once: name, type, range, help and the member of the
/// request that it sets, whose initial value is the default. From such rows come the options of the
/// program (tools/lcs/command_line.h), the command line that repeats a request, and the keyword
/// arguments of the Python functions (tools/python/keywords.h).
///
/// For each request a function `options_of` (options.cpp) lists the rows in the order of the help
/// text. The rows refer to the request, which must outlive them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "scenarios/input/reader.h"

namespace lcs::app {

using Texts = std::vector<std::string>;

/// The place that --out names. \param usual if it is not given.
inline std::filesystem::path place_of(const std::string& out, const std::filesystem::path& usual) {
  return out.empty() ? usual : std::filesystem::path(out);
}

struct Option {
  /// From `list` on, it takes several words, each after the option's name again.
  enum class Kind { flag, text, path, whole, number, list, paths, settings };

  struct More {                 ///< what few rows have
    std::string also = {};      ///< an option for the same value as the argument
    std::string needs = {};     ///< name of the option without which it means nothing
    std::string excludes = {};  ///< name of the option that it does not go with
    bool is_required = false;
    bool is_output = false;                    ///< names output files, or says how to write them
    bool is_joined = false;                    ///< a word is several texts, with commas
    std::int64_t high = 0;                     ///< greatest whole number; the least is 1
    input::Quantity quantity = {};             ///< of a number, in the SI unit
    std::optional<Kind> kind = {};             ///< if it does not follow from the value's type
    std::optional<std::string> keyword = {};   ///< in Python, if not the name; "": none
    std::function<std::string()> prints = {};  ///< of a flag that prints a text and does no more
  };

  std::string name;   ///< "--keep", or "SCENARIO" of an argument; "": only a keyword
  std::string type;   ///< of its value in help texts, such as "DIR"
  std::string about;  ///< help text
  Kind kind;
  bool is_optional;  ///< the value is absent until the option is given
  /// Takes a word, of a flag "true" or "false". \throws input::Error, std::exception
  std::function<void(const std::string&)> read;
  /// The words from which `read` makes the present value; none for an absent or empty one.
  std::function<Texts()> words;
  More more = {};

  bool is_argument() const { return !name.empty() && name.front() != '-'; }
  bool takes_several() const { return kind >= Kind::list; }
  /// Whether the flag makes its value false, as --no-video.
  bool is_negative() const { return name.starts_with("--no-"); }
  /// As "video" of --no-video, "detector_command" of --detector-command.
  std::string keyword() const;
};

/// The rows of a command.
class Options : public std::vector<Option> {
 public:
  explicit Options(std::string its_command) : command(std::move(its_command)) {}

  std::string command;  ///< its name

  /// \param member a bool, an int, a seed, a double, a text or texts, or an optional of one.
  /// \param about the help text.
  template <class T>
  void add_with_text(const std::string& name, const std::string& type, T* member,
                     const std::string& about, Option::More more = {});
  /// The same with the help text of options.txt.
  template <class T>
  void add(const std::string& name, const std::string& type, T* member, Option::More more = {}) {
    add_with_text(name, type, member, about(name), std::move(more));
  }
  /// The help text of options.txt for an option of this command, else of `*`, several commands.
  /// \throws std::logic_error if there is none.
  const std::string& about(const std::string& name) const;

  /// \name Rows of several commands
  ///@{
  void add_scenario(std::string& scenario) {
    add("SCENARIO", "", &scenario, {.is_required = true, .kind = Option::Kind::path});
  }
  /// \param seed may be an optional.
  template <class Seed>
  void add_seed(Seed& seed) {
    add("--seed", "N", &seed);
  }
  void add_set(Texts& sets) { add("--set", "KEY=VALUE", &sets, {.kind = Option::Kind::settings}); }
  /// \param otherwise the default folder, named in the help.
  void add_out(std::string& out, const std::string& otherwise);
  void add_force(bool& force) { add("--force", "", &force, {.is_output = true}); }
  void add_quiet(bool& quiet) { add("--quiet", "", &quiet); }
  ///@}
};

/// Splits "key=value", a filter setting given by `--set`.
/// \throws std::invalid_argument if there is no '='.
std::pair<std::string, std::string> key_and_value(const std::string& setting);

/// The words that make a request by these options: those whose value is not the usual one.
/// \param usual the same rows of a request as it is without options.
Texts words_of(const Options& options, const Options& usual);

/// The command line that makes the request, without `lcs`.
template <class Request>
requires requires(Request request) {
  options_of(request);
}
Texts arguments_of(Request request) {
  Request usual{};
  const Options options = options_of(request);
  Texts words = words_of(options, options_of(usual));
  words.insert(words.begin(), options.command);
  return words;
}

// ---- The kinds of members

template <class T>
inline constexpr Option::Kind kKindOf = std::is_same_v<T, bool>          ? Option::Kind::flag
                                        : std::is_integral_v<T>          ? Option::Kind::whole
                                        : std::is_floating_point_v<T>    ? Option::Kind::number
                                        : std::is_same_v<T, std::string> ? Option::Kind::text
                                                                         : Option::Kind::list;
template <class T>
inline constexpr Option::Kind kKindOf<std::optional<T>> = kKindOf<T>;

template <class T>
void read_into(T& out, const input::Value& word, const Option::More& more) {
  if constexpr (requires { out.has_value(); }) {
    read_into(out.emplace(), word, more);
  } else if constexpr (kKindOf<T> == Option::Kind::flag) {
    out = word.text == "true";
  } else if constexpr (std::is_same_v<T, int>) {
    out = static_cast<int>(input::as_integer(word, "the number", 1, more.high));
  } else if constexpr (kKindOf<T> == Option::Kind::whole) {
    out = input::as_seed(word, "the number");
  } else if constexpr (kKindOf<T> == Option::Kind::number) {
    out = input::as_quantity(word, "the number", more.quantity);
  } else if constexpr (kKindOf<T> == Option::Kind::text) {
    out = word.text;
  } else {
    if (!more.is_joined) return out.push_back(word.text);
    std::istringstream texts(word.text);
    for (std::string text; std::getline(texts, text, ',');) out.push_back(text);
  }
}

template <class T>
Texts words_in(const T& value) {
  if constexpr (requires { value.has_value(); }) {
    return value ? words_in(*value) : Texts{};
  } else if constexpr (kKindOf<T> == Option::Kind::flag) {
    return {value ? "true" : "false"};
  } else if constexpr (kKindOf<T> == Option::Kind::whole) {
    return {std::to_string(value)};
  } else if constexpr (kKindOf<T> == Option::Kind::number) {
    return {input::number_text(value)};
  } else if constexpr (kKindOf<T> == Option::Kind::text) {
    return value.empty() ? Texts{} : Texts{value};
  } else {
    return value;
  }
}

template <class T>
void Options::add_with_text(const std::string& name, const std::string& type, T* member,
                            const std::string& about, Option::More more) {
  const auto read = [name, member, more](const std::string& word) {
    read_into(*member, {input::Value::Kind::scalar, {name, 0}, word}, more);
  };
  const bool is_optional = requires {
    member->has_value();
  };
  push_back({name, type, about, more.kind.value_or(kKindOf<T>), is_optional, read,
             [member] { return words_in(*member); }, std::move(more)});
}

}  // namespace lcs::app
