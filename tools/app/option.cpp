#include "tools/app/option.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <stdexcept>
#include <string_view>

namespace lcs::app {

/// options.txt, embedded in the program.
extern const std::string_view kOptionTexts;

namespace {

using TextOf = std::map<std::pair<std::string, std::string>, std::string>;

/// Of sections "[command]" with lines "name: text", by command and name.
TextOf parsed(const std::string& file) {
  TextOf texts;
  std::istringstream lines(file);
  std::string command;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with('[')) command = line.substr(1, line.size() - 2);
    if (colon != std::string::npos) {
      texts[{command, line.substr(0, colon)}] = line.substr(colon + 2);
    }
  }
  return texts;
}

}  // namespace

const std::string& Options::about(const std::string& name) const {
  static const TextOf kTexts = parsed(std::string(kOptionTexts));
  for (const std::string& of : {command, std::string("*")}) {
    if (const auto found = kTexts.find({of, name}); found != kTexts.end()) return found->second;
  }
  throw std::logic_error("options.txt has no text for " + name + " of " + command);
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

void Options::add_out(std::string& out, const std::string& otherwise) {
  // In Python an empty one is a text, since a path cannot be empty.
  const Option::Kind kind = out.empty() ? Option::Kind::text : Option::Kind::path;
  add_with_text("--out", "DIR", &out, "Folder for the results; " + otherwise + " if not given",
                {.is_output = true, .kind = kind});
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
