#include "tools/app/option.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace lcs::app {
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
    if (option.kind == Option::Kind::flag) {
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
