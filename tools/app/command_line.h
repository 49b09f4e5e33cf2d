/// \file
/// The command line that makes a request. `suite::shell_line` quotes it.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lcs::app {

/// Splits "key=value", a filter setting given by `--set`.
/// \throws std::invalid_argument if there is no '='.
inline std::pair<std::string, std::string> key_and_value(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos) {
    throw std::invalid_argument("--set takes KEY=VALUE, as hypotheses.prior=0.05, not '" + setting +
                                "'");
  }
  return {setting.substr(0, equals), setting.substr(equals + 1)};
}

class CommandLine {
 public:
  /// \param words the command and its arguments, such as {"run", "crossing.yaml"}.
  explicit CommandLine(std::vector<std::string> words) : words_(std::move(words)) {}

  void add(const std::vector<std::string>& words) {
    words_.insert(words_.end(), words.begin(), words.end());
  }
  /// An option with its value, unless the value is empty.
  void add(const char* option, const std::string& value) {
    if (!value.empty()) add({option, value});
  }
  /// An option that is repeated for each value.
  void add_each(const char* option, const std::vector<std::string>& values) {
    for (const std::string& value : values) add({option, value});
  }
  void add_flag(const char* option, bool is_set) {
    if (is_set) words_.emplace_back(option);
  }
  const std::vector<std::string>& words() const { return words_; }

 private:
  std::vector<std::string> words_;
};

}  // namespace lcs::app
