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
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tools/input/reader.h"

namespace lcs::app {

using Texts = std::vector<std::string>;

struct Option {
  /// From `list` on, it takes several words, each after the option's name again.
  enum class Kind { flag, text, path, whole, number, list, paths, settings };

  struct Own {  ///< a value with a form of its own
    Kind kind;
    std::function<void(const std::string&)> read;
    std::function<Texts()> words;
  };
  using Value =
      std::variant<bool*, int*, std::optional<int>*, std::uint64_t*, std::optional<std::uint64_t>*,
                   double*, std::string*, std::optional<std::string>*, Texts*, Own>;

  struct More {                 ///< what few rows have
    std::string also = {};      ///< an option for the same value as the argument
    std::string needs = {};     ///< name of the option without which it means nothing
    std::string excludes = {};  ///< name of the option that it does not go with
    bool is_required = false;
    bool is_output = false;                    ///< names output files, or says how to write them
    bool is_joined = false;                    ///< a word is several texts, with commas
    std::int64_t high = 0;                     ///< greatest whole number; the least is 1
    input::Quantity quantity = {};             ///< of a number, whose unit is that of SI
    std::optional<Kind> kind = {};             ///< if it does not follow from the value's type
    std::optional<std::string> keyword = {};   ///< in Python, if not the name; "": none
    std::function<std::string()> prints = {};  ///< of a flag that prints a text and does no more
  };

  std::string name;  ///< "--keep", or "SCENARIO" of an argument; "": only a keyword
  std::string type;  ///< of its value in help texts, such as "DIR"
  Value value;
  std::string about;  ///< help text
  More more = {};

  /// Takes a word, of a flag "true" or "false". \throws input::Error, std::exception
  void read(const std::string& word) const;
  /// The words from which `read` makes the present value; none for an absent or empty one.
  Texts words() const;
  Kind kind() const;
  /// Whether the value is absent until the option is given.
  bool is_optional() const;
  bool is_argument() const { return !name.empty() && name.front() != '-'; }
  bool takes_several() const { return kind() >= Kind::list; }
  /// Whether the flag makes its value false, as --no-video.
  bool is_negative() const { return name.starts_with("--no-"); }
  /// As "video" of --no-video, "detector_command" of --detector-command.
  std::string keyword() const;
};

struct Options : std::vector<Option> {
  void add(const std::string& name, const std::string& type, Option::Value member,
           const std::string& about, Option::More more = {}) {
    push_back({name, type, std::move(member), about, std::move(more)});
  }

  /// \name Rows of several commands
  ///@{
  void add_scenario(std::string& scenario);
  void add_seed(Option::Value seed, const std::string& about = "Seed, instead of the scenario's");
  void add_set(Texts& sets, const std::string& about);
  /// \param otherwise the default folder, named in the help.
  void add_out(std::string& out, const std::string& otherwise);
  void add_force(bool& force);
  void add_quiet(bool& quiet) { add("--quiet", "", &quiet, "Print only errors and warnings"); }
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
requires requires {
  Request::kCommand;
}
Texts arguments_of(Request request) {
  Request usual{};
  Texts words = words_of(options_of(request), options_of(usual));
  words.insert(words.begin(), Request::kCommand);
  return words;
}

}  // namespace lcs::app
