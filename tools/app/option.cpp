#include "tools/app/option.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <type_traits>

#include "tools/files/csv.h"

namespace lcs::app {
namespace {

template <class T>
void read_into(T& out, const input::Value& word, const Option::More& more) {
  if constexpr (requires { out.has_value(); }) {
    read_into(out.emplace(), word, more);
  } else if constexpr (std::is_same_v<T, bool>) {
    out = word.text == "true";
  } else if constexpr (std::is_same_v<T, int>) {
    out = static_cast<int>(input::as_integer(word, "the number", 1, more.high));
  } else if constexpr (std::is_same_v<T, std::uint64_t>) {
    out = input::as_seed(word, "the seed");
  } else if constexpr (std::is_same_v<T, double>) {
    out = input::as_quantity(word, "the number", more.quantity);
  } else if constexpr (std::is_same_v<T, std::string>) {
    out = word.text;
  } else if (more.is_joined) {
    for (const std::string_view text : bench::fields_of(word.text)) out.emplace_back(text);
  } else {
    out.push_back(word.text);
  }
}

template <class T>
Texts words_in(const T& value) {
  if constexpr (requires { value.has_value(); }) {
    return value ? words_in(*value) : Texts{};
  } else if constexpr (std::is_same_v<T, bool>) {
    return {value ? "true" : "false"};
  } else if constexpr (std::is_integral_v<T>) {
    return {std::to_string(value)};
  } else if constexpr (std::is_same_v<T, double>) {
    return {input::number_text(value)};
  } else if constexpr (std::is_same_v<T, std::string>) {
    return value.empty() ? Texts{} : Texts{value};
  } else {
    return value;
  }
}

template <class T>
Option::Kind kind_of(const T& value) {
  if constexpr (requires { value.has_value(); }) {
    return kind_of(typename T::value_type{});
  } else if constexpr (std::is_same_v<T, bool>) {
    return Option::Kind::flag;
  } else if constexpr (std::is_integral_v<T>) {
    return Option::Kind::whole;
  } else if constexpr (std::is_same_v<T, double>) {
    return Option::Kind::number;
  } else {
    return std::is_same_v<T, std::string> ? Option::Kind::text : Option::Kind::list;
  }
}

/// What the function for members gives; that for `Own` if the value is one.
template <class OfMember, class OfOwn>
auto visit(const Option::Value& value, const OfMember& of_member, const OfOwn& of_own) {
  return std::visit(
      [&](const auto& held) {
        if constexpr (std::is_same_v<decltype(held), const Option::Own&>) {
          return of_own(held);
        } else {
          return of_member(*held);
        }
      },
      value);
}

}  // namespace

void Option::read(const std::string& word) const {
  const input::Value text(input::Value::Kind::scalar, {name, 0}, word);
  visit(
      value, [&](auto& out) { read_into(out, text, more); },
      [&](const Own& own) { own.read(word); });
}

Texts Option::words() const {
  return visit(
      value, [](const auto& in) { return words_in(in); },
      [](const Own& own) { return own.words(); });
}

Option::Kind Option::kind() const {
  if (more.kind) return *more.kind;
  return visit(
      value, [](const auto& in) { return kind_of(in); }, [](const Own& own) { return own.kind; });
}

bool Option::is_optional() const {
  return visit(
      value,
      [](const auto& in) {
        return requires {
          in.has_value();
        };
      },
      [](const Own&) { return false; });
}

std::string Option::keyword() const {
  if (more.keyword) return *more.keyword;
  std::string word = name.substr(is_negative() ? 5 : name.find_first_not_of('-'));
  for (char& c : word) c = c == '-' ? '_' : static_cast<char>(std::tolower(c));
  return word;
}

std::pair<std::string, std::string> key_and_value(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos) {
    throw std::invalid_argument("--set takes KEY=VALUE, as hypotheses.prior=0.05, not '" + setting +
                                "'");
  }
  return {setting.substr(0, equals), setting.substr(equals + 1)};
}

void Options::add_scenario(std::string& scenario) {
  add("SCENARIO", "", &scenario,
      "The scenario: a YAML file, or the name of one of the project, as night",
      {.is_required = true, .kind = Option::Kind::path});
}

void Options::add_seed(Option::Value seed, const std::string& about) {
  add("--seed", "N", std::move(seed), about);
}

void Options::add_set(Texts& sets, const std::string& about) {
  add("--set", "KEY=VALUE", &sets, about + "; may be repeated", {.kind = Option::Kind::settings});
}

void Options::add_out(std::string& out, const std::string& otherwise) {
  // In Python an empty one is a text, since a path cannot be empty.
  const Option::Kind kind = out.empty() ? Option::Kind::text : Option::Kind::path;
  add("--out", "DIR", &out, "Folder for the results; " + otherwise + " if not given",
      {.is_output = true, .kind = kind});
}

void Options::add_force(bool& force) {
  add("--force", "", &force,
      "Replace a file of the same name that lcs did not write, or that was edited since",
      {.is_output = true});
}

Texts words_of(const Options& options, const Options& usual) {
  Texts words;
  for (std::size_t i = 0; i < options.size(); ++i) {
    const Option& option = options[i];
    const Texts values = option.words();
    const bool lacks_needed = std::ranges::any_of(options, [&](const Option& other) {
      return !other.name.empty() && other.name == option.more.needs && other.words().empty();
    });
    if (option.name.empty() || lacks_needed || values == usual[i].words()) continue;
    if (option.kind() == Option::Kind::flag) {
      words.push_back(option.name);
      continue;
    }
    for (const std::string& value : values) {
      if (!option.is_argument()) words.push_back(option.name);
      words.push_back(value);
    }
  }
  return words;
}

}  // namespace lcs::app
